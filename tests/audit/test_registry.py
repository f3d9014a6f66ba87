"""The registry holds every numbered relation of the sources; claims of the text are tied to computations."""

import re

import pytest

from mechsym.audit.hosts.sources import Listed, Printed, TextClaim, question_of, row
from mechsym.audit.judge.asked import Asked
from mechsym.audit.judge.asked import question_of as asked_by_user
from mechsym.audit.read.statement import statement
from mechsym.audit.theory.catalogue import names, theory
from mechsym.errors import BadInput
from mechsym.papers import sources

# numbers that are not in the texts: 001 (1) and (5)
NUMBERED = {
    "zotov2024": [str(n) for n in range(1, 15)],
    "moroianu2017": ["2", "3", "4", *(str(n) for n in range(6, 14))],
    "chmielewski2015": [str(n) for n in range(1, 12)],
    "prymak": [str(n) for n in range(1, 11)],
    "nunes2017": [f"2.{n}" for n in range(1, 80)] + [f"3.{n}" for n in range(1, 18)],
}
PRINTED = [(s.name, e) for s in sources() for e in s.entries if isinstance(e, Printed)]


@pytest.mark.parametrize("source", sources(), ids=lambda s: s.name)
def test_every_numbered_relation_is_there(source):
    found = [e.equation for e in source.entries if not isinstance(e, TextClaim)]
    missing = [n for n in NUMBERED[source.name] if n not in found]
    assert not missing


def test_there_are_more_than_sixty_rows_over_five_sources():
    assert len(sources()) == 5
    assert sum(len(s.entries) for s in sources()) > 160
    assert len(PRINTED) > 90


@pytest.mark.parametrize(("short", "entry"), PRINTED, ids=[f"{s}-{e.equation}-{e.claim[:30]}" for s, e in PRINTED])
def test_every_formula_is_read_in_known_letters(short, entry):
    question = question_of(entry)
    assert question.quantity in question.theory.tape
    assert set(question.hold) <= set(question.theory.letters)


def test_verdicts_that_are_given_are_definitions_or_empirical():
    given = {e.verdict for s in sources() for e in s.entries if isinstance(e, Listed)}
    assert given == {"definition", "empirical"}


def test_a_misprint_says_what_it_does_to_its_number():
    printed = next(e for s, e in PRINTED if s == "nunes2017" and e.statement == "CR**(-gamma)")
    told = row("004", printed)
    assert told["verdict"] == "misprint"
    # p4 = p3 CR^-gamma; as printed it is no pressure, so it has no unit
    assert "at the source's data it is 0.03981 as printed and 5.4" in told["effect"]
    assert told["effect"].endswith("Pa as derived") and told["effect"] in told["note"]


def test_no_correction_is_entered_by_hand():
    assert not {f for f in Printed.__dataclass_fields__ if re.search("correct|verdict|repair", f)}


@pytest.mark.parametrize("name", ["zotov2024", "000_9f2b746dc1abd296", "000", "000_9f2b746dc1abd296.txt"])
def test_sources_are_found_by_stem_and_short_name(name):
    assert sources(name)[0].name == "zotov2024"


def test_unknown_sources_are_refused_with_the_list():
    with pytest.raises(BadInput, match="moroianu2017"):
        sources("nobody1999")


@pytest.mark.parametrize("name", names())
def test_every_theory_can_be_built(name):
    found = theory(name)
    assert found.results and set(found.results) <= set(found.tape)
    assert not found.angle or found.angle in found.letters


def test_a_case_of_another_mechanism_is_refused():
    with pytest.raises(BadInput, match="is of the mechanism"):
        theory("crosshead", "chmielewski")


def test_letters_at_zero_that_are_not_mentioned_stay_at_zero():
    def hold(text, against):
        return asked_by_user(Asked(text=text, against=against), statement(text)).hold

    assert hold("F", "crosshead.generalized_force") == {"axis_tilt": 0.0}
    assert hold("F*cos(axis_tilt)", "crosshead.generalized_force") == {}
    assert hold("r", "crosshead.dx_dphi") == {}
