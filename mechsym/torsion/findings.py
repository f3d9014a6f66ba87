"""What a reader of a run, or of a shaft, has to know first: criticals at the speed of operation, runs that drift."""

from collections.abc import Iterator

from mechsym.page.finding import LOOK_AT, NOT_MET, Finding
from mechsym.quantities.display import quantity_text
from mechsym.simulate.result import period_means
from mechsym.torsion.finished import FinishedRun
from mechsym.torsion.train import TrainVibration, critical_words

NEAR = 0.1  #: A critical speed so close to the speed of operation is told before any figure [-]
ON = 0.02  #: One so close to it is run at [-]
DRIFT = 1e-4  #: Change of the mean speed from one period to the next beyond which a run has not settled [-]
_PLANNED = ("turns", "t_end")


def criticals(train: TrainVibration | None) -> Iterator[Finding]:
    """Orders critical near the speed of operation; one at it, or beyond the rigid shaft's torque, is not met."""
    for one in train.criticals if train else ():
        if abs(one.away) <= NEAR:
            worse = abs(one.away) <= ON or (train is not None and one.torque > train.torque_rigid)
            yield Finding(rank=NOT_MET if worse else LOOK_AT, words=critical_words(one), value=one.away)


def drift(run: FinishedRun) -> Finding | None:
    """A run of an engine whose mean speed has not settled, or that is too short to tell."""
    if run.engine is None or run.result.end not in _PLANNED:
        return None
    means = period_means(run.result, run.engine.coordinate, run.engine.period)
    if len(means) < 3:
        return Finding(rank=LOOK_AT, words="the run is too short to have settled: its ripple is a transient's")
    last = float(means[-1] / means[-2] - 1)
    if abs(last) <= DRIFT:
        return None
    ends = " to ".join(quantity_text(float(speed), "rad/s", 5) for speed in (means[0], means[-1]))
    way = "rises" if last > 0 else "falls"
    words = f"the run has not settled: its mean speed still {way}, {ends}, and its ripple is a transient's"
    return Finding(rank=LOOK_AT, words=words, value=last)


def of_run(run: FinishedRun) -> Iterator[Finding]:
    """What of a run in time has to be known first."""
    if run.result.status in ("failed", "not converged", "chaotic"):
        yield Finding(rank=NOT_MET, words=run.summary.reason or f"the run is {run.result.status}")
    if run.result.end == "stall":
        yield Finding(rank=NOT_MET, words="the shaft stops", value=float(run.result.t[-1]), unit="s")
    yield from criticals(run.vibration)
    if settling := drift(run):
        yield settling
