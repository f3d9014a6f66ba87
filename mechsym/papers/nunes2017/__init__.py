"""Nunes (2017), a thesis: an opposed-piston engine, slider crank against geared hypocycloid."""

from mechsym.papers.sources import Source

SOURCE = Source(
    stem="004_e00ef50339108dab",
    name="nunes2017",
    title="Nunes (2017): Development of an opposed piston geared hypocycloid engine",
)
