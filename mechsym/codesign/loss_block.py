r"""Friction of a hinge and heat of its gas as unknowns and constraints of the programme.

.. math:: s' = \frac{V^{\gamma-1} - s}{x}, \quad \frac{T}{T_w} = s V^{1-\gamma}, \qquad
          \lambda' = M_\mathrm{friction} + \frac{(p_0 + p_a) A H}{(\gamma - 1)\,x}\Bigl(\frac{T}{T_w} - 1\Bigr)
          - \overline M

s is an unknown at each angle, one for each guide and each x = omega tau; lambda is the work that is lost beyond its
mean rate, and the mean torque M is taken from the load. The gas stores (p_0 + p_a) A H T / T_w / (gamma - 1) - p_a A z;
where exchange is fast (x below 1) temperatures differ too little for that, and its work stands in lambda instead.
"""

from typing import Any

import casadi as ca
import numpy as np

from mechsym.codesign.contact_block import contact_force
from mechsym.codesign.hardware import outside
from mechsym.codesign.loss import relaxation_time
from mechsym.codesign.points import Point, Samples
from mechsym.codesign.start import shapes
from mechsym.codesign.task import CoDesignTask
from mechsym.codesign.unknowns import Gathered, GuideSymbols
from mechsym.hinge import losses as law
from mechsym.hinge.losses import HingeLosses
from mechsym.hinge.thermal import gas_temperature, relaxation, thermal_pressure
from mechsym.quantities import quantity, record

_SMOOTH = 1e-3  # |rho'| is sqrt(rho'^2 + (_SMOOTH rho)^2), so that it has derivatives where a guide turns back
_FAST = 1.0  # omega tau below which the work of the gas is summed as work


@record
class Taken:
    """What friction and heat do to one motion."""

    work: Any  #: energy of the gas and work lost, shape (n,) [J]
    torque: Any  #: mean of what is lost [N*m]


@record
class Warmth:
    """Gas of the guides at one x."""

    x: float = quantity("rad", above=0, about="omega tau")
    ratio: tuple[Any, ...]  #: T / T_w of each guide, shape (n,) [-]


def warmths(
    task: CoDesignTask, samples: Samples, found: list[GuideSymbols], given: HingeLosses, gathered: Gathered
) -> list[Warmth]:
    """Temperatures at each point; points with the same x share their unknowns."""
    known: dict[float, Warmth] = {}
    made, started = [], shapes(task, samples)
    for point in task.points:
        x = round(point.omega * relaxation_time(task.hardware.n, point.omega, given), 12)
        if x not in known:
            ratio = (_warmth(g, z, task, samples, x, given, gathered) for g, z in zip(found, started, strict=True))
            known[x] = Warmth(x=x, ratio=tuple(ratio))
        made.append(known[x])
    return made


def taken(
    task: CoDesignTask, point: Point, samples: Samples, found: list[GuideSymbols], pressures: list[Any],
    warm: Warmth, given: HingeLosses, gathered: Gathered,
) -> Taken:  # fmt: skip
    """Energy of the gas, work lost and mean loss at one point; pressures at free height [Pa], one for each guide."""
    n, scale = samples.phi.size, 0.02 * abs(point.load_torque) * point.period
    unknown = gathered.unknown("lost", np.zeros(n))
    mean, lost = scale * unknown[0] / point.period, scale * ca.vertcat(0.0, unknown[1:])
    rate, stored = ca.SX(n, 1), ca.SX(n, 1)
    for guide, p0, ratio in zip(found, pressures, warm.ratio, strict=True):
        H, pa, A = guide.values["H"], outside(task.hardware), guide.values["A"]
        force = A * thermal_pressure(guide.path.z, H, p0, pa, ratio)
        rate += _friction(task, guide, force, point.omega, given)
        if warm.x > _FAST:
            heat = (p0 + pa) * A * H / (given.gamma - 1)
            stored += heat * ratio - pa * A * guide.path.z
            rate += heat * (ratio - 1) / warm.x
        else:
            rate -= force * task.hardware.count * task.hardware.shaft_ratio * guide.path.drho
    after = ca.vertcat(rate[1:], rate[0])
    steps = ca.DM(samples.step) * ((rate + after) / 2 - mean)
    gathered.group([((ca.vertcat(lost[1:], lost[0]) - lost - steps) / scale, 0.0, 0.0)])
    return Taken(work=stored + lost, torque=mean)


def _warmth(
    guide: GuideSymbols, z: np.ndarray, task: CoDesignTask, samples: Samples, x: float, given: HingeLosses,
    gathered: Gathered,
) -> Any:  # fmt: skip
    """T / T_w of the gas of a guide; `z` [m] is the closing that the programme starts from, x [rad]."""
    power, step = given.gamma - 1, samples.step / x
    start = 1 - z / task.hardware.H
    s = gathered.unknown("s", gas_temperature(start, samples.step, x, given.gamma, 1.0) * start**power)
    volume = (1 - guide.path.z / guide.values["H"]) ** power
    keep, first, last = (ca.DM(np.array(column)) for column in zip(*(relaxation(float(r)) for r in step), strict=True))
    after = ca.vertcat(volume[1:], volume[0])
    rows = ca.vertcat(s[1:], s[0]) - keep * s - first * volume - last * after
    gathered.group([(rows / ca.DM(np.maximum(step, 1e-3)), 0.0, 0.0)])
    return s / volume


def _friction(task: CoDesignTask, guide: GuideSymbols, force: Any, omega: float, given: HingeLosses) -> Any:
    """Torque on the crank that bearings, seals and guides take [N*m]; spring force of each roller in [N]."""
    h, path, values = task.hardware, guide.path, guide.values
    speed, radius, mass = h.shaft_ratio * omega, values["radius"], values["moving_mass"]
    N = contact_force(path, force, mass, speed)
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
