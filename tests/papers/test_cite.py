"""What is cited: the source of every built-in case, the laws that it chose, entries that BibTeX can read."""

import re
from pathlib import Path

import pytest

import mechsym
from mechsym import cases
from mechsym.cases import schema
from mechsym.cycle.kinds import KINDS
from mechsym.errors import BadInput
from mechsym.papers.cite import bibliography, cited
from mechsym.papers.sources import sources

ENTRIES = bibliography()


def keys(name):
    return [row["key"] for row in cited(name)]


@pytest.mark.parametrize("name", cases.names())
def test_every_built_in_case_cites_its_source_and_the_program(name):
    source = {one.stem: one.name for one in sources()}.get(cases.load(name).source)
    assert keys(name)[0] == "mechsym" and (source is None or source in keys(name))


def test_a_law_is_cited_where_it_is_chosen():
    assert "woschni1967" in keys("generator-breathing") and "annand1963" not in keys("generator-breathing")
    assert "annand1963" in keys("nunes-slider-crank") and "shen2020" in keys("zotov-89")
    assert "shen2020" not in keys("chmielewski")


def test_what_an_entry_is_cited_for_exists():
    """A word of a law, a kind of cycle, a section, a source: none that no case can have."""
    for key, entry in ENTRIES.items():
        for reason in entry.get("when", ()):
            place, sign, value = reason.partition("=")
            section, _, field = place.partition(".")
            if not sign:
                assert section in schema.sections(), (key, reason)
            elif section == "cycle":
                assert field == "kind" and value in KINDS, (key, reason)
            elif field:
                chosen, records = schema.ENTRIES[section]
                assert field == chosen and value in records, (key, reason)
            else:
                assert place in ("source", "mechanism"), (key, reason)


def test_the_sources_are_those_of_the_citation_file():
    citation = (Path(__file__).parents[2] / "CITATION.cff").read_text(encoding="utf-8")
    for source in sources():
        assert f'title: "{ENTRIES[source.name]["title"]}'[:40] in citation.replace("; undated", "")


def test_bibtex_is_balanced_and_has_what_every_entry_needs():
    for row in cited("zotov-89"):
        assert re.match(rf"@\w+\{{{row['key']},\n", row["bibtex"]) and row["bibtex"].count("{") == row["bibtex"].count(
            "}"
        )
        assert {"title", "author"} <= ENTRIES[row["key"]].keys()
    assert f"version = {{{mechsym.__version__}}}" in cited("zotov-89")[0]["bibtex"]


def test_a_name_that_is_nothing_is_refused_with_the_nearest():
    with pytest.raises(BadInput, match="neither a case, a mechanism nor a source.*zotov-89"):
        cited("zotov-8")
