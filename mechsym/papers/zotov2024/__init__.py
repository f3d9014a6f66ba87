"""Zotov et al. (2024): a crosshead engine whose elastic hinge holds the crank speed constant."""

from mechsym.papers.sources import Source

SOURCE = Source(
    stem="000_9f2b746dc1abd296",
    name="zotov2024",
    title="Zotov, Tokarev, Valeev, Fatkullina (2024): Two-stroke engine with constant crank angular velocity",
)
