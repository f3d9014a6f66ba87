"""Prymak (undated, in Ukrainian): forces in rodless (Balandin) mechanisms."""

from mechsym.papers.sources import Source

SOURCE = Source(
    stem="003_8746f5f4ad51b1d1",
    name="prymak",
    title="Prymak (undated): Study of the distribution of forces in connecting-rod-less mechanisms",
)
