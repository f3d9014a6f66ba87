"""What every kind of gas answers, and what it is told of the engine around it.

    record of [cycle] + EngineParts --> GasSource     at a speed: pressure on the pistons     over speeds: figures

A new kind is one file with its record and its source, and one row of `kinds.KINDS`; commands, sweeps, force chain and
case files follow from these answers. To most kinds a cylinder is enough: see `CylinderGas`.
"""

import dataclasses
import functools
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol

import casadi as ca
import numpy as np

from mechsym import mechanisms
from mechsym.cycle.chamber import Chamber, Motion, chamber_over, piston_force, travel
from mechsym.cycle.friction import Friction, NoFriction, brake_figures, friction_pressure
from mechsym.cycle.gas import Gas
from mechsym.cycle.motion import piston_motion, piston_travel, pistons_of, slopes
from mechsym.cycle.pressure import Pressure
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.mechanisms.loops import one_coordinate
from mechsym.mechanisms.plan import plan_of
from mechsym.quantities import RPM, record
from mechsym.quantities.display import residual_text
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


SHARES = ("heat", "work", "exhaust", "unburnt")  #: Of the heat of the fuel: where it goes
_UNKNOWN = dict.fromkeys(("sfc_g_kwh", "efficiency", "energy_residual", *SHARES), math.nan)  # without fuel
_POINTS = 1441
_COLD_AIR = 1.4  # no mixture of air, fuel and products has more


def _closing(figures: Json) -> str:
    worst = abs(figures["energy_residual"]).max()
    if worst != worst:
        known = np.isfinite(figures["sfc_g_kwh"]).all()
        fuel = "fuel as the temperature rise asks for, without heat to the walls" if known else "no fuel is known"
        return f"an algebraic cycle: {fuel}, no first law to close"
    return f"first law closed to {residual_text(worst, 1)} of the fuel's heating value"


BRAKE = ("speed_rpm", "brake_mep_kpa", "brake_sfc_g_kwh", "brake_power_kw", "brake_torque", "brake_efficiency",
         "mechanical_efficiency")  # fmt: skip
INDICATED = ("speed_rpm", "mep_kpa", "gross_mep_kpa", "pumping_mep_kpa", "friction_mep_kpa", "sfc_g_kwh", "power_kw",
             "torque_avg", "efficiency")  # fmt: skip
IN_CYLINDER = ("speed_rpm", "p_max_mpa", "p_max_angle_deg", "ca10_deg", "ca50_deg", "ca90_deg", "torque_max")
ENGINE_PAGE = FiguresPage(
    tables=(("brake", BRAKE), ("indicated", INDICATED), ("combustion, and largest torque", IN_CYLINDER)),
    closing=_closing,
    peaks=True,
)


def otto_bound(compression_ratio: float, gamma: float = _COLD_AIR) -> float:
    r"""Efficiency of the Otto cycle [-], by default with the most that a gas can have.

    .. math:: \eta = 1 - \varepsilon^{1-\gamma}
    """
    return float(1 - compression_ratio ** (1 - gamma))


class CylinderGas:
    """Gas of a cycle to which a cylinder is enough: a kind says `pressure`, and what else differs.

    cycle: with `bore`, `compression_ratio` and `p_back`; moved: crank angle [rad] to `x` [m] and `dx_dphi` [m/rad] of a
    piston, in place of that of the parts.
    """

    page = ENGINE_PAGE

    def __init__(self, cycle: Any, parts: EngineParts, moved: ca.Function | None = None) -> None:
        self.cycle, self.parts, self._moved = cycle, parts, moved

    def pressure(self, room: Chamber, omega: float) -> tuple[Pressure, dict[str, float]]:
        """Pressure at a speed [rad/s], and by the names of the columns what is known of the fuel."""
        raise NotImplementedError

    def p_back(self, omega: float) -> float:
        """Absolute pressure behind the piston [Pa] at a speed [rad/s]."""
        return float(self.cycle.p_back)

    @functools.cached_property
    def travel(self) -> ca.Function:
        """Travel of the piston."""
        return self.parts.travel if self._moved is None else self._moved

    def at(self, omega: float) -> Gas:
        """Gas at a speed [rad/s]."""
        room = self._room(omega)
        return Gas(pressure=self.pressure(room, omega)[0], chamber=room)

    def figures(self, omega: np.ndarray, progress: Progress = unseen) -> Json:
        """Figures of one cylinder over speeds [rad/s]; nan of the fuel where the cycle knows none."""
        rows = []
        for speed in map(float, omega):
            rows.append(self._row(speed))
            progress(1)
        columns = {key: np.array([row[key] for row in rows]) for key in rows[0]}
        fractions = {name: columns.pop(name) for name in SHARES}
        return {"speed_rpm": omega / RPM} | columns | {"fractions": fractions, "loads": {}}

    def curves(self, omega: np.ndarray, operating: float) -> dict[str, np.ndarray]:
        """None at any speed [rad/s]: the gas tells its pressure itself."""
        return {}

    def picture(self, path: Path, curves: Mapping[str, np.ndarray]) -> Path:
        """Nothing is drawn without curves."""
        raise NotImplementedError

    @property
    def bound(self) -> float | None:
        """Efficiency that no such cycle exceeds [-]."""
        return otto_bound(self.cycle.compression_ratio)

    def _room(self, omega: float) -> Chamber:
        return chamber_over(self.travel, self.cycle.bore, self.cycle.compression_ratio, self.p_back(omega))

    def _row(self, omega: float) -> Json:
        room = self._room(omega)
        pressure, fuel = self.pressure(room, omega)
        work = pressure.mean_indicated * room.displacement
        phi = np.linspace(-math.pi, math.pi, _POINTS)
        # the same chamber over a piston with its mass, for the largest force
        heavy = dataclasses.replace(room, motion=self._motion)
        force = piston_force(heavy, phi, omega, pressure.absolute(phi))
        row = {
            "torque_avg": work / (2 * math.pi), "torque_max": float(np.max(force * travel(heavy.motion, phi)[1])),
            "power_kw": work * omega / (2 * math.pi) / 1e3, "mep_kpa": pressure.mean_indicated / 1e3,
            "p_max_mpa": pressure.p_max / 1e6, "p_max_angle_deg": math.degrees(pressure.phi_p_max),
            "t_max_k": pressure.t_max, "force_max": float(np.max(force)),
        } | _UNKNOWN | fuel  # fmt: skip
        law = self.parts.friction
        if isinstance(law, NoFriction):
            return row
        lost = float(friction_pressure(law, pressure.p_max, room.stroke * omega / math.pi, omega))
        burnt = (row["sfc_g_kwh"] * work / 3.6e9, work / row["efficiency"])
        return row | brake_figures(work, lost, room.displacement, 2 * math.pi, omega, burnt)

    @functools.cached_property
    def _motion(self) -> Motion:
        return self.parts.motion
