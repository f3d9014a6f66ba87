"""Every number of the thesis's engine model (chapters 2, 3 and 5) beside what its own method gives, and beside the
converged and the corrected cycle.

`printed` is the thesis's one-degree march (`cycle.method = "nunes2017_printed"`), `converged` the same equations
integrated until they no longer change, `corrected` the converged cycle with the errors of the model removed: vapour
arrives with the internal energy of the liquid, the piston feels the atmosphere on its back.
"""

import tomllib
from collections.abc import Sequence
from importlib import resources

import numpy as np

from mechsym.cases import load
from mechsym.cycle.chamber import chamber, travel
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine
from mechsym.papers.nunes2017 import numbers, outlook, sizing
from mechsym.papers.nunes2017.numbers import ENGINES, FACTS, MODELS, curves_of, item_row, items, value
from mechsym.papers.rows import NOT_COMPUTABLE, Row, claim, listed, row
from mechsym.quantities import record


def rows() -> list[Row]:
    """The thesis's published numbers with their verdicts: engine model, parts, statements, outlook, chapter 6."""
    engine = engine_rows()
    others = engine + sizing.rows() + _statements() + outlook.rows() + outlook.studied_rows(engine)
    return others + undecided(others)


def engine_rows() -> list[Row]:
    """The published numbers of chapters 2, 3 and 5, and those that no cycle is needed for."""
    models = {name: curves_of(changes) for name, changes in MODELS.items()}
    rows = []
    for table, evaluate in (
        ("speeds", value), ("crossover", numbers.at_crossover), ("differences", numbers.difference),
    ):  # fmt: skip
        for item in items(table):
            rows.append(item_row(item, {name: evaluate(item, curves) for name, curves in models.items()}))
    cases = {name: load(case, changes) for name, (case, changes) in ENGINES.items()}
    return rows + [item_row(item, {"printed": fact(cases)}) for item, fact in FACTS]


def _statements() -> list[Row]:
    # what the text says of its curves in words or with "about", beside the thesis's own march
    curves = curves_of(MODELS["printed"])
    rows = []
    for item in items("beginnings"):
        computed = value(item, curves)
        off = computed / float(item.published) - 1
        rows.append(claim(item.item, item.published, computed, abs(off) <= item.about, f"{100 * off:+.0f} %"))
    unburnt = curves["slider_crank"]["unburnt"]
    varied = float(100 * np.ptp(unburnt) / unburnt.max())
    crank, hypocycloid = (_moved(case) for case in ("nunes-slider-crank", "nunes-hypocycloid"))
    near = [float(np.mean(x < 0.1 * 0.052)) for x, _ in (crank, hypocycloid)]
    orders = [np.abs(np.fft.rfft(d2x)) for _, d2x in (crank, hypocycloid)]
    higher = [float(spectrum[2:].max() / spectrum[1]) for spectrum in orders]
    return [
        *rows,
        listed("nunes2017", "unburnt", varied, abs(varied / 2.5 - 1) < 0.1),
        listed("nunes2017", "top", near[1] / near[0], near[1] > near[0], own=near[1], rival=near[0]),
        listed("nunes2017", "sinusoidal", higher[1], higher[1] < 1e-12, rival=higher[0]),
    ]


def _moved(case: str) -> tuple[np.ndarray, np.ndarray]:
    machine = engine(load(case))
    room = chamber(machine.chamber, machine.motion)
    x, _, d2x = travel(room.motion, np.linspace(0, 2 * np.pi, 3601)[:-1])
    return np.asarray(x), np.asarray(d2x)


@record
class Sentence:
    """One sentence of the chapter."""

    section: str  #: 6, 6.1 or 6.2
    begins: str  #: Its first words
    decided: tuple[str, ...] = ()  #: How the items of the rows that decide it begin
    left: str = ""  #: Why nothing decides it, or part of it


def _sentences() -> tuple[Sentence, ...]:
    text = (resources.files("mechsym.papers.nunes2017") / "chapter6.toml").read_text(encoding="utf-8")
    listed = tomllib.loads(text)["sentence"]
    return tuple(Sentence(**{**one, "decided": tuple(one.get("decided", ()))}) for one in listed)


SENTENCES = _sentences()  # of `chapter6.toml`, in the order of the text


def undecided(others: Sequence[Row]) -> list[Row]:
    """Rows of the sentences of chapter 6 that nothing decides; refused where a row is missing that should."""
    items = [one.item for one in others]
    for sentence in SENTENCES:
        for start in sentence.decided:
            if not any(item.startswith(start) for item in items):
                raise BadInput(f"chapter 6, {sentence.begins!r}: no row begins with {start!r}")
    return [
        row(f"section {one.section}: {one.begins!r} ..", None, None, NOT_COMPUTABLE, one.left)
        for one in SENTENCES
        if one.left
    ]
