"""What a reader has to know before any figure: findings, the worst first."""

from collections.abc import Iterable, Sequence

from mechsym.quantities import record

NOT_MET, LOOK_AT, LEAST_SURE = 1, 2, 3
WORDS = {NOT_MET: "not met", LOOK_AT: "look at", LEAST_SURE: "least sure"}  #: Of a rank, for people
_MARKS = {NOT_MET: "no", LOOK_AT: "open"}


@record
class Finding:
    """One thing that decides whether the figures behind it may be used."""

    rank: int  #: 1 not met, 2 to be looked at, 3 least sure
    words: str  #: A sentence without its stop
    value: float | None = None  #: What it is about [its unit]
    unit: str = "-"

    @property
    def mark(self) -> str:
        """Its colour on a page: `no`, `open`, or none."""
        return _MARKS.get(self.rank, "")

    @property
    def line(self) -> str:
        """Its line in a text.

        >>> Finding(rank=2, words="the run has not settled").line
        'look at: the run has not settled'
        """
        return f"{WORDS[self.rank]}: {self.words}"


def ranked(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Findings with the worst first, each sentence once."""
    return tuple(sorted({one.words: one for one in findings}.values(), key=lambda one: one.rank))


def title_mark(findings: Sequence[Finding]) -> str:
    """The colour of a title, which is that of the worst finding."""
    return min(findings, key=lambda one: one.rank).mark if findings else ""
