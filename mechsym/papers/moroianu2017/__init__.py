"""Moroianu (2017): the force chain of a marine engine, without any data."""

from mechsym.papers.sources import Source

SOURCE = Source(
    stem="001_a140ef4f7e005dde", name="moroianu2017", title="Moroianu (2017): The dynamic design of the marin engines"
)
