"""Chmielewski et al. (2015): start-up of a crankshaft with a flywheel on an elastic shaft."""

from mechsym.papers.sources import Source

SOURCE = Source(
    stem="002_d7297926d6c52225",
    name="chmielewski2015",
    title="Chmielewski, Bogucki, Guminski, Maczak (2015): Dynamic model of a crankshaft assembly with two "
    "degrees of freedom",
    tolerance=1e-4,  # 100 s through a resonance multiply what rounding differs by
)
