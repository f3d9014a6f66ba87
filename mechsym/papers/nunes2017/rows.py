"""Every number of the thesis's engine model (chapters 2, 3 and 5) beside what its own method gives, and beside the
converged and the corrected cycle.

`printed` is the thesis's one-degree march (`cycle.method = "nunes2017_printed"`), `converged` the same equations
integrated until they no longer change, `corrected` the converged cycle with the errors of the model removed: vapour
arrives with the internal energy of the liquid, the piston feels the atmosphere on its back.
"""

from typing import Any

from mechsym.cases import load
from mechsym.papers.nunes2017 import chapter6, outlook, sizing, studied, text
from mechsym.papers.nunes2017.computed import ENGINES, MODELS, at_crossover, curves_of, difference, value
from mechsym.papers.nunes2017.facts import FACTS
from mechsym.papers.nunes2017.numbers import CROSSOVER, DIFFERENCES, OVER_SPEEDS, item_row


def rows() -> list[dict[str, Any]]:
    """The thesis's published numbers with their verdicts: engine model, parts, statements, outlook, chapter 6.

    Returns
    -------
    rows : list of dict
        Keys source, item, published, computed, rel_error, verdict, note, and converged, corrected (None where the
        models do not differ)
    """
    engine = engine_rows()
    found = engine + sizing.rows() + text.rows() + outlook.rows() + studied.rows(engine)
    return found + chapter6.rows(found)


def engine_rows() -> list[dict[str, Any]]:
    """The published numbers of chapters 2, 3 and 5."""
    models = {name: curves_of(changes) for name, changes in MODELS.items()}
    found = [item_row(item, {name: value(item, curves) for name, curves in models.items()}) for item in OVER_SPEEDS]
    for items, evaluate in ((CROSSOVER, at_crossover), (DIFFERENCES, difference)):
        found += [item_row(item, {name: evaluate(item, curves) for name, curves in models.items()}) for item in items]
    return found + facts()


def facts() -> list[dict[str, Any]]:
    """Published numbers that no cycle is needed for."""
    cases = {name: load(case, changes) for name, (case, changes) in ENGINES.items()}
    return [item_row(item, {"printed": fact(cases)}) for item, fact in FACTS]
