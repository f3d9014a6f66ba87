"""What the ideal hinge leaves out: nothing without friction and heat, the numbers of the specification with them."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from hinges import monotone_seal_torque

from mechsym import cases, jobs
from mechsym.cycle.pressure import unfired
from mechsym.hinge.guide import cut, fitted
from mechsym.hinge.price import misfire_share, price
from mechsym.hinge.rollers import HingeLosses
from mechsym.hinge.torque import torque
from mechsym.machine.record import lever
from mechsym.simulate.angle import tabulate
from mechsym.simulate.engine import reduced
from mechsym.simulate.steady import steady_state

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
NONE = HingeLosses(bearing_mu=0.0, seal_mu=0.0, guide_mu=0.0, tau=1e9, gamma=1.25)


def made(**changes):
    case = cases.load("zotov-89", changes)
    machine, wanted = jobs.machine(case), None
    wanted = torque(machine)
    return machine, wanted, cut(wanted, case.need("spring"), case.need("guide")), case.need("rollers")


@pytest.fixture(scope="module")
def ideal():
    return made()


def test_without_friction_and_heat_the_hinge_is_ideal(ideal):
    found = price(*ideal, NONE)
    assert found.losses.total < 1e-3
    # the mean temperature is the wall's, so the gas that is hot when it is pressed is cold at free height
    assert 1.0 < found.fill < 1.2
    assert found.speed_ripple < 2e-3
    assert found.gas_index == pytest.approx(1.25, abs=1e-9)


def test_losses_of_the_marine_engine(ideal):
    found = price(*ideal, HingeLosses())
    shares = {k: getattr(found.losses, k) / 9000 for k in ("bearing", "seal", "guide", "gas")}
    assert shares["bearing"] == pytest.approx(0.035, abs=0.002)
    assert shares["guide"] == pytest.approx(0.015, abs=0.002)
    assert 0.03 < shares["gas"] < 0.09
    work = ideal[1].work(np.linspace(0, 2 * np.pi, 1441))
    assert found.losses.seal == pytest.approx(monotone_seal_torque(float(np.ptp(work)), 0.01), rel=0.01)


def test_the_paths_own_seal_loss_is_proportional(ideal):
    double = dataclasses.replace(HingeLosses(), seal_mu=0.02)
    assert price(*ideal, double).losses.seal == pytest.approx(2 * price(*ideal, HingeLosses()).losses.seal)


def test_a_lost_combustion_stops_a_shaft_without_a_flywheel(ideal):
    assert misfire_share(*ideal) == 0.0


def test_a_flywheel_survives_a_lost_combustion():
    # the specification's guide is shaped for a range of speeds and its rollers have mass: 0.714, near but not this
    heavy, light = made(**{"flywheel.inertia": 2056}), made(**{"flywheel.inertia": 1000})
    assert misfire_share(*heavy) == pytest.approx(0.71, abs=0.03)
    assert 0.0 < misfire_share(*light) < misfire_share(*heavy)


def test_mass_on_the_rollers_presses_and_turns():
    light, heavy = made(), made(**{"rollers.moving_mass": "100 kg"})
    assert price(*heavy, HingeLosses()).losses.bearing > price(*light, HingeLosses()).losses.bearing
    # a guide that was cut for rollers without mass is not exact with them
    assert price(*heavy, NONE).speed_ripple > 5e-3 > price(*light, NONE).speed_ripple


def test_of_several_cylinders_the_worst_is_lost():
    """By the work that is missing behind each dead centre, summed over the angle."""
    case = cases.load(str(EXAMPLES / "v-twin.toml"))
    engine = jobs.machine(case)
    wanted = torque(engine)
    guide, rollers = cut(wanted, case.need("spring"), case.need("guide")), case.need("rollers")
    one = fitted(engine, wanted, guide)
    plain = reduced(one)
    phi = np.linspace(0, plain.period, 20001)
    before = steady_state(tabulate(plain), engine.omega)
    shares = []
    for lost in engine.several:
        cold, warm = unfired(lost.force, lost.period)(phi - lost.start), lost.force(phi - lost.start)
        moment = plain.torque(phi) + (cold - warm) * lever(engine.mechanism, lost.input)(phi) - wanted.load_torque
        work = np.concatenate([[0], np.cumsum((moment[1:] + moment[:-1]) / 2 * np.diff(phi))])
        inertia = plain.inertia(phi)
        speed = np.sqrt(2 * (inertia[0] * before.omega[0] ** 2 / 2 + work) / inertia)
        shares.append(speed.min() / before.speed_mean)
    assert len(shares) == 2
    # the load brakes a little less as the shaft slows
    assert misfire_share(engine, wanted, guide, rollers) == pytest.approx(min(shares), rel=0.01)
