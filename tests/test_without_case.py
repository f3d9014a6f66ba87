"""Gas, forces, friction and engine cycle from records and numbers, with no case file anywhere."""

import dataclasses
import math

import numpy as np
import pytest

from mechsym import cycle, forces
from mechsym.cycle.friction import NoFriction
from mechsym.cycle.heat import Adiabatic, ConstantGamma
from mechsym.cycle.kinds.spark_ignition import SparkIgnition
from mechsym.cycle.kinds.two_stroke import TwoStrokeMarine
from mechsym.forces.friction import NoRings
from mechsym.mechanisms.crosshead import CrossheadParameters
from mechsym.quantities import RPM

DEG = math.pi / 180
CRANK = CrossheadParameters(r1=0, r2=0.5, l1=0.8, l2=0.75, m1=0, m2=150, m3=150, m4=200, m5=110, I01=30, IC2=50)
DIESEL = TwoStrokeMarine(
    bore=0.3, compression_ratio=17, mean_indicated_pressure=12e5, p_s=2.5e5, T_evc=370, evc=-100 * DEG,
    duration=60 * DEG, evo=110 * DEG, spo=140 * DEG, n_c=1.35, n_e=1.3, a_p=5, m_p=1.5, a_d=4, m_d=0.8, b=0.6,
)  # fmt: skip
PETROL = cycle.ClosedEngine(
    chamber=cycle.ChamberParameters(bore=0.08, compression_ratio=10),
    motion=cycle.piston_motion("crosshead", dataclasses.asdict(CRANK)),
    cycle=SparkIgnition(
        intake_pressure=1e5, intake_temperature=300, ignition=-10 * DEG, duration=40 * DEG, air_fuel_ratio=14.6,
        stoichiometric_ratio=14.6, heating_value=44e6, vaporisation="none",
    ),
    gas=ConstantGamma(), heat_transfer=Adiabatic(), friction_pressure=NoFriction(),
)  # fmt: skip
COEFFICIENTS = forces.Friction(
    mu_guide=0.05, mu_pin=0.01, mu_main=0.01, radius_piston_pin=0.06, radius_crank_pin=0.1, radius_main=0.12
)


@pytest.fixture(scope="module")
def turn():
    gas = cycle.gas_in_cylinder(DIESEL, cycle.piston_travel("crosshead", CRANK))
    return forces.turn(forces.crank_drive("crosshead", CRANK), gas, 90 * RPM)


def test_gas_gives_the_mean_pressure_that_was_wanted(turn):
    work = turn.gas_power.mean() / turn.omega * 2 * math.pi
    assert work == pytest.approx(12e5 * math.pi / 4 * 0.3**2 * 1.0, rel=1e-3)
    assert turn.gas.force(0.0) == pytest.approx((turn.gas.pressure.absolute(0.0) - 101325) * turn.gas.chamber.area)


def test_forces_and_friction(turn):
    found = forces.forces(turn, COEFFICIENTS)
    assert turn.torque.mean() * turn.omega == pytest.approx(found.losses.indicated_power, rel=1e-12)
    assert found.columns["crank_pin_load"].max() > 0.5 * turn.gas.force(turn.phi).max()
    assert 0.8 < found.losses.mechanical_efficiency < 1
    law = forces.fit([turn], COEFFICIENTS, NoRings()).law
    assert law.constant == pytest.approx(found.losses.friction_mean_pressure, rel=1e-12)


def test_an_engine_over_the_speeds_without_losses_is_below_otto():
    found = cycle.columns(cycle.over_speeds(PETROL, np.array([60.0, 120.0])))
    assert found["speed_rpm"] == pytest.approx([60 / RPM, 120 / RPM])
    released = 1 - found["fractions"]["unburnt"]
    otto = 1 - 10 ** (1 - ConstantGamma().gamma)
    assert np.all(found["efficiency"] < otto * released) and np.all(found["efficiency"] > 0.9 * otto * released)
    gas = cycle.gas_of_engine(PETROL, 60.0)
    assert gas.pressure.p_max / 1e6 == pytest.approx(found["p_max_mpa"][0], rel=1e-4)
    # the gas exchange at intake pressure gives back nothing over a whole stroke
    assert gas.pressure.mean_indicated / 1e3 == pytest.approx(found["mep_kpa"][0], rel=1e-4)


@pytest.mark.parametrize("room", [cycle, forces])
def test_a_room_shows_its_names_only(room):
    assert dir(room) == sorted(room.__all__) and 5 <= len(dir(room)) <= 12
    assert all(getattr(room, name) is not None for name in room.__all__)
