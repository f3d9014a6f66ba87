"""What chapter 4 of the thesis computes with: the shipped case, its materials, and the peaks of the thesis's march."""

from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

from mechsym.cases import load
from mechsym.cycle.chamber import chamber
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.engine import columns, over_speeds
from mechsym.jobs.cycle import engine, speed_range
from mechsym.jobs.size import printed_parts
from mechsym.quantities import RPM, record
from mechsym.sizing.hypocycloid.masses import PrintedMasses
from mechsym.sizing.rules import bearing_data, materials
from mechsym.sizing.rules.bearing_data import Bearing
from mechsym.sizing.rules.materials import Material
from mechsym.sizing.wants import Wants

CASE = "nunes-hypocycloid"


@record
class Chapter4:
    """Data of the thesis's hypocycloid engine as the shipped case has them."""

    wants: Wants
    printed: PrintedMasses
    bore: float  #: Bore [m]
    e: float  #: Throw of the planet's centre; the stroke of a piston is 4 e [m]
    area: float  #: Of a piston [m^2]
    clearance: float  #: Volume at top dead centre [m^3]
    fuel: float  #: In a cycle [kg]
    heating_value: float  #: Of the fuel [J/kg]
    top_rpm: float  #: Maximum rated speed [rpm]
    peaks: Mapping[str, Any]  #: `p` [Pa], `F` [N], `T` [N*m], and over the speeds `rpm` and `tooth` [N]
    materials: Mapping[str, Material]
    bearings: Mapping[str, Bearing]

    def material(self, part: str) -> Material:
        """The material that the case chooses for a part: piston, cylinder, gears, crankshaft, shaft."""
        return self.materials[getattr(self.wants, part)]


@cache
def chapter4() -> Chapter4:
    """Everything from the case `nunes-hypocycloid`, the peaks by the thesis's own march."""
    case = load(CASE, {"cycle.method": "nunes2017_printed"})
    machine, omega = engine(case), case.need("operation").speed
    room = chamber(machine.chamber, machine.motion)
    found = columns(over_speeds(machine, speed_range(case.need("speeds"))))
    peaks = {
        "p": found["p_max_mpa"].max() * 1e6, "F": found["force_max"].max(), "T": found["torque_max"].max(),
        "rpm": found["speed_rpm"], "tooth": found["loads"]["tooth_force"],
    }  # fmt: skip
    return Chapter4(
        wants=case.need("sizing"), printed=printed_parts(case), bore=case.need("chamber").bore,
        e=case.need("parameters").e, area=float(room.area), clearance=float(room.clearance),
        fuel=float(closed_period(machine, {"omega": omega}).fuel), heating_value=machine.cycle.heating_value,
        top_rpm=omega / RPM, peaks=peaks, materials=materials.load(), bearings=bearing_data.catalogue(),
    )  # fmt: skip


def area_printed(given: Chapter4) -> float:
    """Area of a piston as table 3.2 prints it, ten times too large.

    Returns
    -------
    area : float
        0.02827 for 0.002827 [m^2]
    """
    return float(np.round(10 * given.area, 5))
