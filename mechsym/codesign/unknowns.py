"""Unknowns and constraints of the programme as it is put together: guides with their springs, and the limits."""

import dataclasses
from collections.abc import Iterable

import casadi as ca
import numpy as np

from mechsym.codesign.basis import Basis, fitted, matrices
from mechsym.codesign.contact_block import Path, path_of
from mechsym.codesign.hardware import roller_inertia
from mechsym.codesign.points import Samples
from mechsym.codesign.settings import FREE
from mechsym.codesign.start import shapes, start_pressures
from mechsym.codesign.task import MOST_MASS, CoDesignTask
from mechsym.hinge.bounds.spring import ROOM
from mechsym.quantities import quantity, record

MASS = 100.0  # unit of a free mass [kg]
_LEAST, _MOST = 1e-3, 1e3  # pressures by those of the start


@record
class GuideSymbols:
    """One guide of the programme: symbols, all in SI."""

    coefficients: ca.SX  #: of the spline of z, shape (m,) [m]
    p0: ca.SX  #: excess pressure at each point, shape (k,) [Pa]
    largest: ca.SX  #: bound of all of them [Pa]
    scale: float = quantity("Pa", about="size of the pressures")
    #: hardware that may be free, as far as it has it: A [m^2], H, rho0, radius, width [m], moving_mass [kg]
    values: dict[str, ca.SX]
    shares: tuple[ca.SX, ...]  #: free ones of it by the values of the case [-]
    path: Path
    inertia: ca.SX  #: of the rollers about the crank, shape (n,) [kg*m^2]


@dataclasses.dataclass
class Gathered:
    """Unknowns and rows while the programme is put together."""

    unknowns: list[ca.SX] = dataclasses.field(default_factory=list)
    start: list[np.ndarray] = dataclasses.field(default_factory=list)
    box: list[np.ndarray] = dataclasses.field(default_factory=list)
    rows: list[list[ca.SX]] = dataclasses.field(default_factory=list)
    low: list[np.ndarray] = dataclasses.field(default_factory=list)
    high: list[np.ndarray] = dataclasses.field(default_factory=list)

    def unknown(self, name: str, start: np.ndarray, low: float = -np.inf, high: float = np.inf) -> ca.SX:
        """A column of unknowns with its start and bounds [-]."""
        found = ca.SX.sym(name, len(start))
        self.add(found, start, low, high)
        return found

    def add(self, symbols: ca.SX, start: np.ndarray, low: float = -np.inf, high: float = np.inf) -> None:
        """Unknowns that exist already, with their start and bounds [-]."""
        self.unknowns.append(symbols)
        self.start.append(np.clip(start, low, high))
        self.box.append(np.tile([low, high], (len(start), 1)))

    def group(self, pieces: Iterable[tuple[ca.SX, float, float]]) -> None:
        """Constraints that share terms, in pieces (rows, low, high): low <= rows <= high [-]."""
        self.rows.append([])
        for rows, low, high in pieces:
            self.rows[-1].append(rows)
            self.low.append(np.broadcast_to(low, rows.numel()))
            self.high.append(np.broadcast_to(high, rows.numel()))


def guides(task: CoDesignTask, samples: Samples, splines: Basis, gathered: Gathered) -> list[GuideSymbols]:
    """Symbols of each guide, with their start; the pressures of a guide stand below one bound."""
    B, B1, B2 = matrices(splines, samples.phi)
    pressures, found, given = start_pressures(task, samples), [], task.hardware
    count = 1 if task.schedule == "one" else len(task.points)
    for s, shape in enumerate(shapes(task, samples)):
        values, shares = _hardware(task, s, gathered)
        c = gathered.unknown(f"z{s}", fitted(splines, shape, samples.phi))
        scale = float(pressures[s].max())
        p0 = gathered.unknown(f"p{s}", np.ones(count), _LEAST, _MOST) * pressures[s][:count]
        largest = scale * gathered.unknown(f"p_max{s}", np.ones(1), _LEAST, _MOST)
        path = path_of(given, values["rho0"], B @ c, B1 @ c, B2 @ c)
        rollers = roller_inertia(
            path.rho, path.drho, values["moving_mass"], given.roller_inertia, values["radius"], given.count
        )
        found.append(GuideSymbols(
            coefficients=c, p0=ca.repmat(p0, len(task.points) // count, 1), largest=largest, scale=scale,
            values=values, shares=tuple(shares), path=path, inertia=given.shaft_ratio**2 * rollers,
        ))  # fmt: skip
    return found


def _hardware(task: CoDesignTask, s: int, gathered: Gathered) -> tuple[dict[str, ca.SX], list[ca.SX]]:
    given = task.hardware.values(*FREE, "moving_mass")
    values = {name: ca.SX(value) for name, value in given.items()}
    shares = []
    for name in task.free:
        if name == "moving_mass":
            values[name] = MASS * gathered.unknown(f"{name}{s}", np.ones(1), 0.0, MOST_MASS / MASS)
        else:
            shares.append(gathered.unknown(f"{name}{s}", np.ones(1), *FREE[name]))
            values[name] = given[name] * shares[-1]
    if ROOM.holds(task.hardware.spring, task.hardware.count) and set(task.free) & {"rho0", "H", "radius"}:
        # between the roller centres lie 2 rho = H - z + (2 rho0 - H); the rest beside the gas must hold both rollers
        gathered.group([(values["rho0"] - values["H"] / 2 - values["radius"], 0.0, np.inf)])
    return values, shares
