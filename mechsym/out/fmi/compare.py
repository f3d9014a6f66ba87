"""An FMU against the simulation it was made from: `python -m mechsym.out.fmi.compare e.fmu zotov-89`.

me      its rates and event indicators, integrated here by DOP853 of scipy from event to event
cs      its own integrator, asked for the times of the results
cvode   model exchange as an importer does it, with CVode of fmpy
"""

import contextlib
import ctypes
import dataclasses
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from mechsym.errors import BadInput, MissingExtra
from mechsym.jobs.export import named
from mechsym.out.fmi.build import ALLOWED
from mechsym.quantities import record
from mechsym.simulate import Problem, Settings, simulate

if TYPE_CHECKING:
    from fmpy.fmi1 import _FMU
    from fmpy.model_description import ModelDescription

_TOLERANCE = 1e-13  # asked of co-simulation


class Driven:
    """An instance of an FMU, initialised; values in SI."""

    def __init__(self, unit: "_FMU", description: "ModelDescription") -> None:
        self.unit = unit
        self.second = description.fmiVersion.startswith("2")
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        rates = [v for v in description.modelVariables if v.derivative is not None]
        self.state_names = [v.derivative.name for v in rates]
        self.rate_references = [v.valueReference for v in rates]
        self.inputs = self._with(description, "input")
        self.parameters = self._with(description, "parameter")
        self.outputs = [r for r in self._with(description, "output") if r > max(self.rate_references, default=0)]
        self.longest = np.inf  # step of an integrator that may not pass over the knots of a table [s]
        self.indicator_count = description.numberOfEventIndicators or len(description.eventIndicators or ())

    def _with(self, description: "ModelDescription", causality: str) -> list[int]:
        return [v.valueReference for v in description.modelVariables if v.causality == causality]

    def get(self, references: list[int]) -> list[float]:
        """Values by reference [SI]."""
        return (self.unit.getReal if self.second else self.unit.getFloat64)(references)

    def set(self, references: list[int], values: list[float]) -> None:
        """Set values by reference [SI]."""
        (self.unit.setReal if self.second else self.unit.setFloat64)(references, values)

    def states(self) -> np.ndarray:
        """The continuous states, shape (n,) [SI]."""
        return np.array(self.get([self.references[n] for n in self.state_names]))

    def _at(self, t: float, x: np.ndarray) -> None:
        self.unit.setTime(t)
        x = np.ascontiguousarray(x, dtype=float)
        self.unit.setContinuousStates(_pointer(x), len(x))

    def rates(self, t: float, x: np.ndarray) -> np.ndarray:
        """Rates, shape (n,) [SI/s], at a time [s] and a state [SI]."""
        self._at(t, x)
        out = np.zeros(len(x))
        read = self.unit.getDerivatives if self.second else self.unit.getContinuousStateDerivatives
        read(_pointer(out), len(out))
        return out

    def indicators(self, t: float, x: np.ndarray) -> np.ndarray:
        """Event indicators, shape (k,) [-], at a time [s] and a state [SI]."""
        if not self.indicator_count:
            return np.zeros(0)
        self._at(t, x)
        out = np.zeros(self.indicator_count)
        self.unit.getEventIndicators(_pointer(out), len(out))
        return out

    def event(self, t: float, x: np.ndarray) -> bool:
        """Handle an event at a time [s] and a state [SI]; whether it ends the run."""
        self._at(t, x)
        self.unit.enterEventMode()
        ends = self._update()[1]
        self.unit.enterContinuousTimeMode()
        return bool(ends)

    def _update(self) -> tuple[bool, ...]:
        return (self.unit.newDiscreteStates if self.second else self.unit.updateDiscreteStates)()

    def completed(self, t: float, x: np.ndarray) -> np.ndarray:
        """A state that a step of the integrator has reached, put back on the loops where the unit asks for it [SI]."""
        self._at(t, x)
        if not self.unit.completedIntegratorStep()[0]:
            return x
        self.event(t, x)
        return self.states()

    def next_event(self) -> float | None:
        """Time of the next time event, if there is one [s]."""
        self.unit.enterEventMode()
        event = self._update()
        self.unit.enterContinuousTimeMode()
        return float(event[5]) if event[4] else None

    def step(self, t: float, length: float) -> bool:
        """A step of co-simulation from a time over a length [s]; whether the run has ended."""
        if not self.second:
            return bool(self.unit.doStep(t, length)[1])
        import fmpy.fmi1

        try:
            self.unit.doStep(t, length)
        except fmpy.fmi1.FMICallException:
            return True
        return False


def _pointer(values: np.ndarray) -> "ctypes._Pointer[ctypes.c_double]":
    return values.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


@contextlib.contextmanager
def driven(path: Path, kind: str, tolerance: float = _TOLERANCE) -> Iterator[Driven]:
    """An FMU unpacked, loaded and initialised as model exchange (`me`) or co-simulation (`cs`), to a tolerance [-]."""
    try:
        import fmpy
    except ImportError:
        raise MissingExtra("running an FMU needs the extra fmu: pip install 'mechsym[fmu]'") from None
    from fmpy import fmi2, fmi3

    with tempfile.TemporaryDirectory() as folder:
        fmpy.extract(str(path), unzipdir=folder)
        description = fmpy.read_model_description(folder)
        second = description.fmiVersion.startswith("2")
        classes = {(True, "me"): fmi2.FMU2Model, (True, "cs"): fmi2.FMU2Slave, (False, "me"): fmi3.FMU3Model,
                   (False, "cs"): fmi3.FMU3Slave}  # fmt: skip
        interface = description.modelExchange if kind == "me" else description.coSimulation
        if interface is None:
            raise BadInput(f"{path}: this FMU has no {kind}")
        unit = classes[second, kind](
            guid=description.guid, unzipDirectory=folder, modelIdentifier=interface.modelIdentifier, instanceName="run"
        )
        unit.instantiate()
        if second:
            unit.setupExperiment(tolerance=tolerance, startTime=0.0)
            unit.enterInitializationMode()
        else:
            unit.enterInitializationMode(tolerance=tolerance, startTime=0.0)
        unit.exitInitializationMode()
        handle = Driven(unit, description)
        if kind == "me":
            handle._update()
            unit.enterContinuousTimeMode()
        try:
            yield handle
        finally:
            unit.terminate()
            unit.freeInstance()


TOLERANCE = 1e-13  # of all runs that are compared
# where two motions meet rounding is large: an importer's own integrator, which cannot step over it, does best with few
# digits; tolerance of a run, and what may differ
_MEETING = {"me": (1e-10, 1e-6), "cs": (1e-12, 1e-9), "cvode": (1e-10, 1e-6)}
POINTS = 200
_LEAST = 1e-6  # SI: what no state of its unit exceeds is rounding, as the way of a slide that nothing moves
_STILL = 0.1  # of the largest of its unit: what moves less is measured by that
_FIRST = 1e-2  # of a segment: a first step over knots of a table, chosen by its slope alone, hides what it missed
_LONGEST = 1 / 32  # of the time between two samples, for the same reason


@record
class Difference:
    """How far an FMU is from the simulation."""

    kind: str  #: me, cs or cvode
    largest: float  #: over states and times, as a share of each state's largest value [-]
    t_end: float  #: of both runs [s]
    points: int
    allowed: float = ALLOWED  #: More than that is a difference; rounding is larger where two motions meet [-]


def compare(path: Path, problem: Problem, kinds: tuple[str, ...] = ("me", "cs")) -> tuple[Difference, ...]:
    """Run an FMU in each kind and compare its states with the simulation at even times."""
    t_end = float(simulate(problem, Settings(check="none")).t[-1]) if problem.turns else problem.t_end
    t = np.linspace(problem.t_start, t_end, POINTS + 1)
    same = dataclasses.replace(problem, output=tuple(t[1:]), t_end=t_end, turns=None)
    result = simulate(same, Settings(tolerance=TOLERANCE, check="none"))
    meets = any(e.kind == "bifurcation" for e in result.happened.events)
    q = problem.mechanism.coordinates
    wanted = np.array([result.columns[n] for n in (*q, *(f"{c}d" for c in q))]).T
    rows, units = [], problem.mechanism.state_units
    peaks = np.abs(wanted).max(axis=0)
    # what stands still beside others of its unit is measured by them
    alike = [max(p for p, other in zip(peaks, units, strict=True) if other == unit) for unit in units]
    sizes = np.maximum(np.maximum(peaks, np.array(alike) * _STILL), _LEAST)
    for kind in kinds:
        tolerance, allowed = _MEETING[kind] if meets else (TOLERANCE, ALLOWED)
        run = _RUNS[kind](path, t, tolerance)
        count = min(len(run), len(wanted))
        largest = float(np.max(np.abs(run[:count] - wanted[:count]) / sizes))
        rows.append(Difference(kind=kind, largest=largest, t_end=t_end, points=len(run), allowed=allowed))
    return tuple(rows)


def _exchange(path: Path, t: np.ndarray, tolerance: float) -> np.ndarray:
    """Whole steps from event to event and from sample to sample: what is interpolated is three digits worse."""
    with driven(path, "me", tolerance) as unit:
        now, x = float(t[0]), unit.states()
        unit.longest = _LONGEST * float(t[1] - t[0])
        rows = [x]
        for sample in t[1:]:
            # a sample may be an event itself, met a rounding error before
            while sample - now > 1e-12 * t[-1]:
                jump = unit.next_event()
                until = min(jump, sample) if jump is not None and jump > now else float(sample)
                events = [_indicator(unit, i, (now, x, z)) for i, z in enumerate(unit.indicators(now, x))]
                run = _solved(unit, tolerance, (now, until), x, events)
                met = run.status == 1
                x = np.asarray((_solved(unit, tolerance, (now, float(run.t[-1])), x) if met else run).y[:, -1])
                now = float(run.t[-1])
                if (met or now == jump) and unit.event(now, x):
                    return np.array([*rows, x])
            rows.append(x)
    return np.array(rows)


def _solved(
    unit: Driven,
    tolerance: float,
    span: tuple[float, float],
    x: np.ndarray,
    events: Sequence[Callable[..., float]] = (),
) -> "scipy.optimize.OptimizeResult":
    return scipy.integrate.solve_ivp(
        unit.rates, span, x, method=_Importer, events=events or None, rtol=tolerance, atol=tolerance,
        first_step=_FIRST * (span[1] - span[0]), max_step=unit.longest, unit=unit,
    )  # fmt: skip


class _Importer(scipy.integrate.DOP853):  # type: ignore[misc]  # scipy has no types
    """DOP853 that tells the unit of each step, as an importer does, and goes on from where it is put back."""

    y: np.ndarray

    def __init__(self, *arguments: Any, unit: Driven, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.unit = unit

    def step(self) -> str | None:
        message = super().step()
        x = self.unit.completed(self.t, self.y)
        if x is not self.y:
            self.y, self.f = x, self.fun(self.t, x)
        return message


def _indicator(
    unit: Driven, index: int, start: tuple[float, np.ndarray, float]
) -> Callable[[float, np.ndarray], float]:
    now, x, first = start
    if abs(first) < 1e-9:
        # just passed: the sign is that of the next moment
        later = unit.indicators(now, x + 1e-6 * unit.rates(now, x))[index]
        first = float(np.sign(later - first))

    def event(s: float, z: np.ndarray) -> float:
        return first if s == now else float(unit.indicators(s, z)[index])

    event.terminal = True  # type: ignore[attr-defined]
    return event


def _steps(path: Path, t: np.ndarray, tolerance: float) -> np.ndarray:
    with driven(path, "cs", tolerance) as unit:
        rows = [unit.states()]
        for start, end in zip(t[:-1], t[1:], strict=True):
            ended = unit.step(float(start), float(end - start))
            rows.append(unit.states())
            if ended:
                break
    return np.array(rows)


def _cvode(path: Path, t: np.ndarray, tolerance: float) -> np.ndarray:
    with driven(path, "me", tolerance) as unit:
        names = unit.state_names
    import fmpy

    run = fmpy.simulate_fmu(
        str(path), fmi_type="ModelExchange", start_time=float(t[0]), stop_time=float(t[-1]), output=names,
        relative_tolerance=tolerance, output_interval=float(t[1] - t[0]),
    )  # fmt: skip
    last = np.append(np.diff(run["time"]) > 0, True)
    times = run["time"][last]
    nearest = np.abs(times[:, None] - t[None, :]).argmin(axis=0)
    return np.array([run[n][last][nearest] for n in names]).T


_RUNS: Mapping[str, Callable[[Path, np.ndarray, float], np.ndarray]] = {"me": _exchange, "cs": _steps, "cvode": _cvode}


def main(arguments: list[str]) -> int:
    """Compare the FMU of the first argument with the case of the second; KEY=VALUE behind them override the case."""
    path, name, *settings = arguments
    run = named(name, dict(text.split("=", 1) for text in settings))
    differences = compare(Path(path), run.problem)
    for d in differences:
        words = f"largest difference {d.largest:.2g} of the largest value"
        print(f"{d.kind}: {words}, {d.points} points to {d.t_end:.6g} s")
    return int(any(d.largest > d.allowed for d in differences))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
