"""Right formulas spoiled once or twice, and what the auditor says of them."""

import random
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from benchmarks.auditor.spoiler import KINDS, one
from benchmarks.auditor.truth import same
from mechsym.audit.hosts.formula import check_formula
from mechsym.quantities import record


@record
class Spoiled:
    """A right formula, how it was spoiled, and the auditor's row."""

    against: str
    kind: str
    right: str
    text: str
    verdict: str
    correction: str
    repaired: bool

    @property
    def passed(self) -> bool:
        """Whether the user would be told that the formula holds."""
        return self.verdict in ("exact", "truncation", "convention")


def content(name: str) -> dict[str, Any]:
    """A data file of the trials."""
    return tomllib.loads((Path(__file__).parent / name).read_text(encoding="utf-8"))


def singles(each: int, seed: int) -> list[Spoiled]:
    """Every form spoiled once by every kind of slip that applies, `each` kinds a form."""
    generator, forms, found = random.Random(seed), content("forms.toml"), []
    for form in forms["form"]:
        for kind in generator.sample(KINDS, each):
            spoiled = _different(forms, form, form["text"], generator, kind)
            if spoiled is not None:
                found.append(_asked(forms, form, *spoiled))
    return found


def doubles(each: int, seed: int) -> list[Spoiled]:
    """Every form spoiled twice, `each` times."""
    generator, forms, found = random.Random(seed), content("forms.toml"), []
    for form in forms["form"]:
        for _ in range(each):
            first = _different(forms, form, form["text"], generator)
            second = first and _different(forms, form, first[1], generator)
            if first and second:
                found.append(_asked(forms, form, f"{first[0]}, {second[0]}", second[1]))
    return found


def literature() -> list[Spoiled]:
    """Slips of a list that was written by hand."""
    forms, listed = content("forms.toml"), content("literature.toml")
    known = {**forms, "ranges": {**forms["ranges"], **listed["ranges"]}}
    return [
        _asked(known, {**form, "text": form["right"]}, how, text)
        for form in listed["form"]
        for how, text in form["spoiled"]
    ]


def defined(forms: Mapping[str, Any], against: str) -> dict[str, str]:
    """Derived names that formulas of a theory may use."""
    return dict(forms["define"].get(against.partition(".")[0], forms["define"]["common"]))


def _different(
    forms: Mapping[str, Any], form: Mapping[str, Any], text: str, generator: random.Random, kind: str = ""
) -> tuple[str, str] | None:
    # a slip that changes nothing is none
    for _ in range(20):
        spoiled = one(text, form.get("alike", {}), generator, kind)
        if spoiled is None:
            return None
        if not any(
            same(spoiled[1], other, forms["ranges"], defined(forms, form["against"])) for other in {text, form["text"]}
        ):
            return spoiled
    return None


def _asked(forms: Mapping[str, Any], form: Mapping[str, Any], kind: str, text: str) -> Spoiled:
    row = check_formula(text, form["against"])
    correction = row["correction"] or ""
    return Spoiled(
        against=form["against"],
        kind=kind,
        right=form["text"],
        text=text,
        verdict=row["verdict"],
        correction=correction,
        repaired=bool(correction) and same(correction, form["text"], forms["ranges"], defined(forms, form["against"])),
    )
