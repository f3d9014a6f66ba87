r"""Friction of a hinge and heat of its gas as unknowns and constraints of the programme.

.. math:: s' = \frac{V^{\gamma-1} - s}{x}, \quad \frac{T}{T_w} = s V^{1-\gamma}, \qquad
          \lambda' = M_\mathrm{friction} + \frac{(p_0 + p_a) A H}{(\gamma - 1)\,x}\Bigl(\frac{T}{T_w} - 1\Bigr)
          - \overline M

s is an unknown at each angle, one for each guide and each x = omega tau; lambda is the work that is lost beyond its
mean rate, and the mean torque M is taken from the load. The gas stores (p_0 + p_a) A H T / T_w / (gamma - 1) - p_a A z;
where exchange is fast (x below 1) temperatures differ too little for that, and its work stands in lambda instead.
"""

import casadi as ca
import numpy as np

from mechsym.codesign.points import Point, Samples
from mechsym.codesign.start import shapes
from mechsym.codesign.task import CoDesignTask
from mechsym.codesign.unknowns import Gathered, GuideSymbols
from mechsym.hinge import losses as law
from mechsym.hinge.losses import HingeLosses
from mechsym.hinge.rollers import contact_force
from mechsym.hinge.springs.air_thermal import AirThermal
from mechsym.hinge.springs.face import lettered
from mechsym.hinge.springs.gas_heat import gas_temperature, relaxation
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Scalar

_SMOOTH = 1e-3  # |rho'| is sqrt(rho'^2 + (_SMOOTH rho)^2), so that it has derivatives where a guide turns back
_FAST = 1.0  # omega tau below which the work of the gas is summed as work


@record
class Taken:
    """What friction and heat do to one motion."""

    work: ca.SX  #: energy of the gas and work lost, shape (n,) [J]
    torque: Scalar  #: mean of what is lost [N*m]


@record
class Warmth:
    """Gas of the guides at one x."""

    walled: AirThermal  #: the spring of the case with a wall
    x: float = quantity("rad", above=0, about="omega tau")
    ratio: tuple[ca.SX, ...]  #: T / T_w of each guide, shape (n,) [-]


def warmths(
    task: CoDesignTask, samples: Samples, found: list[GuideSymbols], given: HingeLosses, gathered: Gathered
) -> list[Warmth | None]:
    """Temperatures at each point; points with the same x share their unknowns. None of a law without heat."""
    known: dict[float, Warmth] = {}
    made: list[Warmth | None]
    made, started = [], shapes(task, samples)
    for point in task.points:
        walled = task.hardware.spring.with_wall(given, point.omega)
        if walled is None:
            made.append(None)
            continue
        x = round(point.omega * walled.tau, 12)
        if x not in known:
            ratio = (_warmth(g, z, task, samples, x, given, gathered) for g, z in zip(found, started, strict=True))
            known[x] = Warmth(walled=walled, x=x, ratio=tuple(ratio))
        made.append(known[x])
    return made


def taken(
    task: CoDesignTask, point: Point, samples: Samples, found: list[GuideSymbols], pressures: list[ca.SX],
    warm: Warmth | None, given: HingeLosses, gathered: Gathered,
) -> Taken:  # fmt: skip
    """Energy of the gas, work lost and mean loss at one point; pressures at free height [Pa], one for each guide."""
    n, scale = samples.phi.size, 0.02 * abs(point.load_torque) * point.period
    unknown = gathered.unknown("lost", np.zeros(n))
    mean, lost = scale * unknown[0] / point.period, scale * ca.vertcat(0.0, unknown[1:])
    rate, stored = ca.SX(n, 1), ca.SX(n, 1)
    for s, (guide, p0) in enumerate(zip(found, pressures, strict=True)):
        z = guide.path.z
        if warm is None:
            spring = task.hardware.charged(p0, **guide.values)
            rate += _friction(task, guide, spring.force(z), point.omega, given)
            stored += spring.symbolic().energy(z)
            continue
        walled, ratio = lettered(warm.walled, {"A": guide.values["A"], "H": guide.values["H"], "p0": p0}), warm.ratio[s]
        force = walled.force(z, ratio)
        rate += _friction(task, guide, force, point.omega, given)
        if warm.x > _FAST:
            stored += walled.energy(z, ratio)
            rate += walled.capacity * (ratio - 1) / warm.x
        else:
            rate -= force * task.hardware.count * task.hardware.shaft_ratio * guide.path.drho
    after = ca.vertcat(rate[1:], rate[0])
    steps = ca.DM(samples.step) * ((rate + after) / 2 - mean)
    gathered.group([((ca.vertcat(lost[1:], lost[0]) - lost - steps) / scale, 0.0, 0.0)])
    return Taken(work=stored + lost, torque=mean)


def _warmth(
    guide: GuideSymbols, z: np.ndarray, task: CoDesignTask, samples: Samples, x: float, given: HingeLosses,
    gathered: Gathered,
) -> ca.SX:  # fmt: skip
    """T / T_w of the gas of a guide; `z` [m] is the closing that the programme starts from, x [rad]."""
    power, step = given.gamma - 1, samples.step / x
    start = 1 - z / task.hardware.spring.H
    s = gathered.unknown("s", gas_temperature(start, samples.step, x, given.gamma, 1.0) * start**power)
    volume = (1 - guide.path.z / guide.values["H"]) ** power
    keep, first, last = (ca.DM(np.array(column)) for column in zip(*(relaxation(float(r)) for r in step), strict=True))
    after = ca.vertcat(volume[1:], volume[0])
    rows = ca.vertcat(s[1:], s[0]) - keep * s - first * volume - last * after
    gathered.group([(rows / ca.DM(np.maximum(step, 1e-3)), 0.0, 0.0)])
    return s / volume


def _friction(task: CoDesignTask, guide: GuideSymbols, force: Scalar, omega: float, given: HingeLosses) -> Scalar:
    """Torque on the crank that bearings, seals and guides take [N*m]; spring force of each roller in [N]."""
    h, path, values = task.hardware, guide.path, guide.values
    speed, radius, mass = h.shaft_ratio * omega, values["radius"], values["moving_mass"]
    N = contact_force(force, path.rho, path.drho, path.d2rho, mass, speed)
    swing = ca.sqrt(path.drho**2 + (_SMOOTH * path.rho) ** 2)
    side = law.side_force(force, path.rho, path.drho, path.d2rho, mass, speed)
    bearing = law.bearing_torque(
        N, path.rho, path.drho, given.bearing_mu, given.bearing_radius or radius / 2, radius, h.count
    )
    return h.shaft_ratio * (
        bearing
        + law.seal_torque(force, swing, given.seal_mu, h.count)
        + law.guide_torque(side, path.drho, given.guide_mu, h.count)
    )
