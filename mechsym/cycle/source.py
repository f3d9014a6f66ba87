"""What every kind of gas answers, and what it is told of the engine around it.

    record of [cycle] + EngineParts --> GasSource     at a speed: pressure on the pistons     over speeds: figures

A new kind is one file with its record and its source, and one row of `kinds.KINDS`; commands, sweeps, force chain and
case files follow from these answers. To most kinds a cylinder is enough: see `cylinder.CylinderGas`.
"""

import dataclasses
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.cycle.chamber import Motion
from mechsym.cycle.friction import Friction, NoFriction
from mechsym.cycle.gas import Gas
from mechsym.cycle.motion import piston_motion, piston_travel, pistons_of, slopes
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.mechanisms.loops import one_coordinate
from mechsym.mechanisms.plan import plan_of
from mechsym.quantities import record
from mechsym.quantities.records import Record

Progress = Callable[[int], object]  # called with the number of points that are done


def unseen(count: int) -> None:
    """No progress is shown."""


@record
class EngineParts:
    """What stands around a gas: a mechanism with its numbers, one of its pistons, the sections that the kind reads."""

    mechanism: str
    parameters: Record  #: The mechanism's numbers
    guesses: tuple[tuple[str, float], ...] = ()  #: Of coordinates that loops hold [rad] or [m]
    number: int = 0  #: Place of the piston's role in the declaration
    sections: tuple[tuple[str, Record], ...] = ()  #: By name
    friction: Friction = NoFriction()
    content: str = ""  #: What a mechanism's file holds, so that what is kept of it is not kept beyond it

    def section(self, name: str, default: object = None) -> Any:
        """The record of a section, or a default."""
        return dict(self.sections).get(name, default)

    @property
    def travel(self) -> ca.Function:
        """Travel of the piston from its top dead centre on, and its slope."""
        return piston_travel(self.mechanism, self.parameters, dict(self.guesses), self.number)

    @property
    def motion(self) -> Motion:
        """The same with the masses of the piston, and the mechanism's numbers still free."""
        numbers = dataclasses.asdict(self.parameters)
        return piston_motion(self.mechanism, numbers, dict(self.guesses), self.number)

    @property
    def pair(self) -> tuple[ca.Function, ca.Function]:
        """Travels of two pistons that share a gas, with their slopes, over the angle of the shaft.

        Raises BadInput: the mechanism has not two of them.
        """
        roles = plan_of(self.mechanism).parts(self.parameters)
        names = [role.travel for role in roles.faces or pistons_of(self.mechanism)]
        if len(names) != 2:
            raise BadInput(f"a Stirling cycle needs two pistons, hot one or displacer first; {len(names)} declared")
        mechanism = mechanisms.rigid(self.mechanism, self.parameters)
        if mechanism.dependents:
            mechanism = one_coordinate(mechanism, dict(self.guesses))
        first, second = (slopes(mechanism, name, {}) for name in names)
        return first, second


@record
class FiguresPage:
    """How people see figures over the speeds: tables with their titles, and how far the books close."""

    tables: tuple[tuple[str, tuple[str, ...]], ...]
    closing: Callable[[Json], str]
    peaks: bool = False  #: Whether the largest values and where they are stand below the tables
    words: Mapping[str, str] = dataclasses.field(default_factory=dict)  #: Of figures that it names otherwise


class GasSource(Protocol):
    """What every kind of gas answers; it is made of the record of `[cycle]` and its `EngineParts`."""

    page: FiguresPage

    def at(self, omega: float) -> Gas:
        """Gas at a speed [rad/s]."""

    def figures(self, omega: np.ndarray, progress: Progress = unseen) -> Json:
        """Figures over speeds [rad/s] by the names of `columns.CycleColumns`, of what one gas acts on."""

    def curves(self, omega: np.ndarray, operating: float) -> dict[str, np.ndarray]:
        """A cycle curve by curve at one of some speeds or that of operation [rad/s]; empty where none are known."""

    def picture(self, path: Path, curves: Mapping[str, np.ndarray]) -> Path:
        """Draw these curves."""

    @property
    def bound(self) -> float | None:
        """Efficiency that no such cycle exceeds; None where there is none [-]."""
