"""One small handle on an FMU of either version, for comparisons: states, rates, indicators, events, steps."""

import contextlib
import ctypes
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from mechsym.errors import BadInput, MissingExtra

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

    def next_event(self) -> float | None:
        """Time of the next time event, if there is one [s]."""
        self.unit.enterEventMode()
        found = self._update()
        self.unit.enterContinuousTimeMode()
        return float(found[5]) if found[4] else None

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
    fmpy = _fmpy()
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


def _fmpy() -> ModuleType:
    try:
        import fmpy
    except ImportError:
        raise MissingExtra("running an FMU needs the extra fmu: pip install 'mechsym[fmu]'") from None
    return fmpy
