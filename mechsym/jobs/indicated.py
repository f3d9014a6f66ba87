"""Case and measured crank torque -> cylinder pressure, with its 95 % interval and its gaps at the dead centres."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.forces.indicated import (
    NORMAL_95,
    CrankTorque,
    IndicatedPressure,
    gaps,
    pressure_from_torque,
    scatter,
    shaft_lines,
    work,
)
from mechsym.forces.turn import chain_of
from mechsym.jobs import own, own_gas
from mechsym.jobs.gas import gas, of
from mechsym.jobs.turn import drive_of
from mechsym.machine.torque_curve import read_torque
from mechsym.mechanisms.record import Mechanism
from mechsym.plausible import Doubt
from mechsym.quantities import RPM, record

_SAME = 1e-9  # of angles that are one [rad]
_SMOOTH = 0.005  # of the largest gas torque: what a smooth curve in coarse steps may look like noise


@record
class CommonGas:
    """One gas and what it pushes."""

    mechanism: Mechanism  #: With one coordinate
    areas: Mapping[str, float]  #: By input the force of one pascal, with its sign [m^2]
    held: Mapping[str, float]  #: Inputs that do not change [N] or [N*m]
    p_back: float  #: [Pa]
    period: float  #: [rad]


def indicated(case: Case, file: str, noise: float) -> tuple[CrankTorque, IndicatedPressure]:
    """Cylinder pressure of a case out of a measured torque on its shaft.

    Parameters
    ----------
    case : Case
        With `[operation]` and `[cycle]`, which gives areas, back pressure and period; its own pressure plays no part
    file : str
        CSV as `[torque] file` takes it, of one speed and one load
    noise : float
        Standard deviation of each torque in the file [N*m]

    Raises
    ------
    BadInput
        The file is refused, cylinders fire one after the other, or the noise hides the gas
    """
    table = read_torque(file)
    if len(table.curves) != 1:
        raise BadInput(
            f"{file}: has {len(table.curves)} curves; a pressure is told of one speed and one load at a time"
        )
    if not (math.isfinite(noise) and noise >= 0):
        raise BadInput(f"noise = {noise:g} N*m: give a standard deviation of 0 or more")
    ((place, curve),) = table.curves.items()
    phi, acting = table.angles[place], common_gas(case)
    if abs(table.period - acting.period) > _SAME:
        raise BadInput(f"{file}: goes over {math.degrees(table.period):g} deg, the cycle of {case.file} over "
                       f"{math.degrees(acting.period):g} deg; give one whole cycle")  # fmt: skip
    omega = place[0] if table.speeds else case.need("operation").speed
    measured = CrankTorque(phi=phi, torque=curve(phi), omega=omega, noise=noise, with_inertia=table.with_inertia)
    idle, lever = shaft_lines(acting.mechanism, acting.areas, phi, omega, acting.held)
    try:
        return measured, pressure_from_torque(measured, idle, lever, acting.p_back)
    except BadInput as error:
        raise BadInput(f"{file}: {error}") from None


def common_gas(case: Case) -> CommonGas:
    """The only gas of a case, on one piston or on several at once.

    Raises
    ------
    BadInput
        There is no cycle, or cylinders fire one after the other: the sum of their torques does not tell the shares
    """
    case.need("cycle")
    if own.is_own(case.mechanism):
        mechanism = own.one_coordinate(case)
        acting = own_gas.pistons(case, mechanism)
        _require_at_once(case, [piston.start for piston in acting], own_gas.period_of(acting))
        one = acting[0].gas
        areas = {piston.input: piston.gas.chamber.area for piston in acting}
        held = own.constants(case)
    else:
        drive, found = drive_of(case), gas(case)
        assert found is not None
        one, mechanism, held = found, drive.mechanism, {}
        period = one.pressure.period
        if one.pistons:
            areas = {f"F{i + 1}": area for i, area in enumerate(one.pistons)}
        else:
            with of(case):
                _require_at_once(case, chain_of(drive).fires(drive), period)
                pushed = chain_of(drive).pushes(drive, np.ones_like, one.chamber.area, np.zeros(1), period)
            areas = {name: float(force[0]) for name, force in pushed.items()}
    return CommonGas(
        mechanism=mechanism, areas=areas, held=held, p_back=one.p_back, period=one.pressure.period
    )  # fmt: skip


def _require_at_once(case: Case, fires: Sequence[float], period: float) -> None:
    if any(abs(math.remainder(angle - fires[0], period)) > _SAME for angle in fires):
        raise BadInput(f"{len(fires)} cylinders fire one after the other; the sum of their torques does not tell the "
                       "pressure of one: measure one cylinder alone, with a case of one cylinder")  # fmt: skip


def columns(found: IndicatedPressure) -> dict[str, Any]:
    """Table of what is told: angle, pressure, ends of its 95 % interval, rows of the gaps left out [deg, Pa]."""
    p, half, at = found.p[found.told], NORMAL_95 * found.error[found.told], found.told
    return {"phi_deg": np.degrees(found.phi[at]), "p_pa": p, "p_low_pa": p - half, "p_high_pa": p + half}


def period_of(found: IndicatedPressure) -> float:
    """One turn or two, as far as the angles go [rad]."""
    return 4 * math.pi if np.ptp(found.phi) > 2 * math.pi + _SAME else 2 * math.pi


def summary(case: Case, measured: CrankTorque, found: IndicatedPressure) -> dict[str, Any]:
    """What the torque tells, in numbers."""
    done, error = work(measured, found, period_of(found))
    return {
        "case": case.name,
        "speed_rpm": measured.omega / RPM,
        "noise": measured.noise,
        "samples": len(found.phi),
        "told": int(found.told.sum()),
        "work_j": done,
        "work_interval_j": [done - NORMAL_95 * error, done + NORMAL_95 * error],
        "gaps_deg": [[math.degrees(a), math.degrees(b)] for a, b in gaps(found)],
        "pressure": columns(found),
        "doubts": _doubts(measured, found),
    }


def _doubts(measured: CrankTorque, found: IndicatedPressure) -> list[Doubt]:
    doubts, seen = [], scatter(measured.torque)
    allowed = 2 * measured.noise + _SMOOTH * float(np.abs(found.gas).max())
    if seen > allowed:
        doubts.append(Doubt(code="torque_noise", quantity="noise [N*m]", value=seen, usual=f"at most {allowed:.4g}",
                            why="rows scatter more than --noise says; the intervals are too narrow"))  # fmt: skip
    highest = (found.p + NORMAL_95 * found.error)[found.told]
    if np.mean(highest < 0) > 0.05:
        doubts.append(Doubt(code="pressure_below_zero", quantity="p_high [Pa]", value=float(highest.min()),
                            usual="above 0", why="no gas pulls: look at the sign and zero of the torque, the angle, "
                            "friction, and whether inertia is in it"))  # fmt: skip
    return doubts
