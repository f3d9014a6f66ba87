"""How far the auditor itself can be trusted: mutation tests over all formulas of the registry."""

from collections.abc import Callable, Iterable
from typing import Any

from mechsym.audit.entries import Audited, Printed
from mechsym.audit.findings import Row, question_of
from mechsym.audit.mutants import Kills, Returns, kills, returns, total_kills, total_returns
from mechsym.quantities import record

# how often a formula of each verdict is spoiled; approximate ones take longer and say the same
_SPOILED = {"exact": 4, "approximate": 2}
_LARGEST = 260  # characters of a formula that is spoiled: longer ones only take time


@record
class Trust:
    """Results of the mutation tests."""

    kills: Kills
    returns: Returns  #: Spoiled formulas, exact and approximate ones


def trust(sources: Iterable[Audited], rows: list[Row], done: Callable[[], Any] = lambda: None) -> Trust:
    """Spoil the formulas that were judged right.

    Parameters
    ----------
    rows : list of dict
        Its verdicts, in the same order
    """
    entries = [entry for source in sources for entry in source.entries]
    refuted, returned = [], []
    for seed, (entry, row) in enumerate(zip(entries, rows, strict=True)):
        if isinstance(entry, Printed) and row["verdict"] in _SPOILED:
            question = question_of(entry)
            if row["verdict"] == "exact":
                refuted.append(kills(question))
            if len(entry.statement) <= _LARGEST:
                returned.append(returns(question, _SPOILED[row["verdict"]], seed))
        done()
    return Trust(kills=total_kills(refuted), returns=total_returns(returned))


def lines(found: Trust) -> list[str]:
    """The results in words.

    Returns
    -------
    lines : list of str
        Two rates with their counts, the kinds of slips, survivors and misses
    """
    k, r = found.kills, found.returns
    breakable = k.mutants - k.equivalent
    kinds = ", ".join(f"{kind} {back}/{all_}" for kind, (all_, back) in r.by_kind.items())
    return [
        f"kill rate: {100 * k.refuted / breakable:.1f} % ({k.refuted} of {breakable} mutants of exact formulas "
        f"refuted; "
        f"{k.equivalent} more are proved to be the same function)",
        f"repair rate: {100 * r.returned / r.spoiled:.1f} % ({r.returned} of {r.spoiled} spoiled formulas came back to "
        f"the original; by slip: {kinds})",
        *[f"survivor: {text}" for text in k.survivors],
        *[f"miss: {text}" for text in r.misses],
    ]
