"""Case and measured crank torque -> cylinder pressure, with its 95 % interval and its gaps at the dead centres."""

import math
from collections.abc import Mapping

import numpy as np

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.forces import textbook as physics
from mechsym.forces.textbook import CrankTorque, IndicatedPressure
from mechsym.forces.turn import period_of as period_of_gas
from mechsym.jobs.machine import acting_on, constants, drive_of
from mechsym.machine.torque_curve import read_torque
from mechsym.mechanisms.record import Mechanism
from mechsym.plausible import Doubt
from mechsym.quantities import RPM, record
from mechsym.quantities.results import Columns, computed, part, result, seen
from mechsym.quantities.units import NORMAL_95, NewtonMetre

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


@result
class TorquePressure:
    """What a measured torque on the shaft tells of the pressure in the cylinder."""

    case: str = part()
    measured: CrankTorque
    indicated: IndicatedPressure

    @property
    def period(self) -> float:
        """One turn or two, as far as the angles go [rad]."""
        return 4 * math.pi if np.ptp(self.indicated.phi) > 2 * math.pi + _SAME else 2 * math.pi

    @computed("rpm")
    def speed_rpm(self) -> float:
        """Speed of the shaft."""
        return self.measured.omega / RPM

    noise: float = seen("measured.noise", "N*m")  #: Standard deviation of each torque

    @computed("-")
    def samples(self) -> int:
        """Angles of the file."""
        return len(self.indicated.phi)

    @computed("-")
    def told(self) -> int:
        """Angles at which the torque tells the pressure."""
        return int(self.indicated.clear.sum())

    @computed("J")
    def work_j(self) -> float:
        """Work of the gas over the period."""
        return physics.work(self.measured, self.indicated, self.period)[0]

    @computed("J")
    def work_interval_j(self) -> list[float]:
        """It holds the work 19 times in 20."""
        error = physics.work(self.measured, self.indicated, self.period)[1]
        return [self.work_j - NORMAL_95 * error, self.work_j + NORMAL_95 * error]

    @computed("deg")
    def gaps_deg(self) -> list[list[float]]:
        """Where nothing is told, as the piston hardly moves."""
        return [[math.degrees(a), math.degrees(b)] for a, b in physics.gaps(self.indicated)]

    @computed()
    def pressure(self) -> Columns:
        """Pressure over the angle with the ends of its 95 % interval, where it is told."""
        at = self.indicated.clear
        p, half = self.indicated.p[at], NORMAL_95 * self.indicated.error[at]
        curves = {"phi_deg": np.degrees(self.indicated.phi[at]), "p_pa": p, "p_low_pa": p - half, "p_high_pa": p + half}
        return Columns(curves, {"phi_deg": "deg", **dict.fromkeys(("p_pa", "p_low_pa", "p_high_pa"), "Pa")})

    @computed()
    def doubts(self) -> list[Doubt]:
        """What of the torque is possible and not usual."""
        measured, pressure = self.measured, self.indicated
        doubts, seen = [], physics.scatter(measured.torque)
        allowed = 2 * measured.noise + _SMOOTH * float(np.abs(pressure.gas).max())
        if seen > allowed:
            why = "rows scatter more than --noise says; the intervals are too narrow"
            usual = f"at most {allowed:.4g}"
            doubts.append(Doubt(code="torque_noise", quantity="noise [N*m]", value=seen, usual=usual, why=why))
        highest = (pressure.p + NORMAL_95 * pressure.error)[pressure.clear]
        if np.mean(highest < 0) > 0.05:
            why = (
                "no gas pulls: look at the sign and zero of the torque, the angle, friction, and whether inertia is "
                "in it"
            )
            least = float(highest.min())
            doubts.append(
                Doubt(code="pressure_below_zero", quantity="p_high [Pa]", value=least, usual="above 0", why=why)
            )
        return doubts


def indicated(case: Case, file: str, noise: NewtonMetre) -> TorquePressure:
    """Cylinder pressure of a case out of a measured torque on its shaft.

    case: with `[operation]` and `[cycle]`, which gives areas, back pressure and period; its own pressure plays no part.
    file: CSV as `[torque] file` takes it, of one speed and one load. noise: standard deviation of each torque in the
    file. Raises BadInput: the file is refused, cylinders fire one after the other, or the noise hides the gas.
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
    idle, lever = physics.shaft_lines(acting.mechanism, acting.areas, phi, omega, acting.held)
    try:
        pressure = physics.pressure_from_torque(measured, idle, lever, acting.p_back)
    except BadInput as error:
        raise BadInput(f"{file}: {error}") from None
    return TorquePressure(case=case.name, measured=measured, indicated=pressure)


def common_gas(case: Case) -> CommonGas:
    """The only gas of a case, on one piston or on several at once.

    Raises BadInput: there is no cycle, or cylinders fire one after the other: the sum of their torques does not tell
    the shares.
    """
    case.need("cycle")
    drive = drive_of(case)
    acts = acting_on(case, drive)
    fires, period = [one.face.fires for one in acts], period_of_gas(acts)
    if not acts[0].gas.pistons and any(abs(math.remainder(at - fires[0], period)) > _SAME for at in fires):
        raise BadInput(
            f"{case.file}: {len(fires)} cylinders fire one after the other; the sum of their torques does not tell the "
            "pressure of one: measure one cylinder alone, with a case of one cylinder"
        )
    areas: dict[str, float] = {}
    for one in acts:
        areas[one.face.input] = areas.get(one.face.input, 0.0) + one.area * one.face.sense
    return CommonGas(
        mechanism=drive.mechanism, areas=areas, held=constants(case), p_back=acts[0].gas.p_back,
        period=acts[0].gas.pressure.period,
    )  # fmt: skip
