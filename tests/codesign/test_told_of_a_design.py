"""Numbers and words that are made of a design: losses, bound, prices of limits, goals of realised hardware."""

import dataclasses
import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from click.testing import CliRunner
from codesigns import design

from mechsym.cli import mechsym
from mechsym.codesign import certificate, result
from mechsym.codesign.front import worth_it
from mechsym.codesign.points import Point
from mechsym.codesign.realise import GOALS, _closing
from mechsym.codesign.task import Active, Hardware
from mechsym.hinge.rollers import HingeLosses, LossTorques
from mechsym.hinge.springs.air import AirAbsolute

SPRING = AirAbsolute(A=0.03, H=1.0, n=1.3, p0=2e5)
HARDWARE = Hardware(spring=SPRING, rho0=0.6, radius=0.1, width=0.1, moving_mass=80.0, roller_inertia=0.4)


@pytest.mark.parametrize(
    ("taken", "radius", "used"), [("beside", None, 0.05), ("none", None, None), ("inside", 0.03, 0.03)]
)
def test_losses_by_the_load_of_each_point(taken, radius, used):
    points = [SimpleNamespace(load_torque=load, omega=omega) for load, omega in ((-2000.0, 10.0), (5000.0, 15.0))]
    task = SimpleNamespace(points=points, losses=None if taken == "beside" else HingeLosses())
    lossy = SimpleNamespace(ripple=0.03, time_ripple=0.031, energy_residual=1e-9, fill=1.1)
    found = result._losses(SimpleNamespace(
        design=SimpleNamespace(task=task, tracks=[SimpleNamespace(hardware=HARDWARE)]), taken=taken,
        assumed=HingeLosses(bearing_radius=radius), lossy=(lossy, lossy),
        losses=(LossTorques(bearing=100.0, seal=50.0, guide=30.0, rolling=0.0, gas=20.0),
                LossTorques(bearing=200.0, seal=0.0, guide=0.0, rolling=0.0, gas=50.0)),
    ))  # fmt: skip
    assert found.share == pytest.approx((0.1, 0.05)) and found.shaft_efficiency == pytest.approx((0.9, 0.95))
    # the engine gives what the load keeps and what is lost beside it
    assert found.extra_fuel == pytest.approx((200 / 1800, 250 / 4750))
    assert found.in_programme is (taken != "beside") and found.fill == (1.1, 1.1)
    assert (found.assumed and found.assumed.bearing_radius) == used


@pytest.mark.parametrize(
    ("least", "springs", "proven", "words"),
    [
        ((1234.0, 0.0), 1, True, "no guide does with less than 1234 kg*m^2 in all, proven by 60 and 142 rpm"),
        ((1234.0, 0.0), 1, False, "no guide does with less than 1234 kg*m^2 in all, in doubles, by 60 and 142 rpm"),
        ((1234.0, 0.0), 2, True, "with 2 springs nothing is proven: these points may need no flywheel"),
        ((0.0, 0.0), 1, True, "with 1 spring nothing is proven: these points may need no flywheel"),
    ],
)
def test_a_bound_says_what_it_is(least, springs, proven, words):
    bound = SimpleNamespace(
        total_inertia=least, speeds_rpm=(60.0, 142.0), proven=proven, kind="proven" if proven else "in doubles"
    )
    said = result.bound_words(SimpleNamespace(bound=bound, p0=[[1.0]] * springs))
    assert said.replace("·", "*").replace(" kg m²", " kg*m^2") == words


def test_a_price_is_that_of_a_unit_for_people():
    active = (
        Active(limit="ripple", multiplier=-5000.0, unit="-"),
        Active(limit="roller_reaction", multiplier=2e-3, unit="N"),
    )
    rows = result.prices(SimpleNamespace(active=active, with_given_hardware=None))
    assert [name for name, _ in rows] == ["ripple, 1 % more", "roller reaction, 1 kN more"]
    assert rows[0][1].startswith("saves 50 ") and rows[1][1].startswith("costs 2 ")
    assert all(words.endswith("of flywheel") for _, words in rows)
    (freed,) = result.prices(SimpleNamespace(active=active[:1], with_given_hardware=object()))
    assert freed[1].endswith("of flywheel and rollers")


def test_free_rollers_count_as_flywheel():
    free = dataclasses.replace(design(), task=dataclasses.replace(design().task, free=("radius",)))
    both = design().flywheel + certificate.rollers_inertia(design())
    assert worth_it(free, 1.001 * both, 0.0).status == "optimal"
    assert worth_it(free, 0.999 * both, 0.0).status == "infeasible"
    assert worth_it(design(), 0.999 * both, 0.0).status == "optimal"


def test_goals_of_hardware():
    z = np.array([0.1, 0.3])
    path = SimpleNamespace(rho=np.array([0.55, 0.45]), drho=np.array([0.1, -0.2]), d2rho=np.zeros(2), z=z)
    at = HARDWARE.station(path, SPRING, 9.0)
    assert GOALS["gas_volume"](at) == pytest.approx(0.03 * 1.0)
    # what 2 bar beyond the air outside are after a polytrope to 0.7 of the length, beyond it again
    assert GOALS["spring_pressure"](at) == pytest.approx((2e5 + 101325.0) * (1 / 0.7) ** 1.3 - 101325.0)
    assert GOALS["roller_reaction"](at) == at.reaction.max()


def test_a_closing_stores_what_is_asked():
    phi = np.linspace(0, 2 * math.pi, 50)
    U, dU, d2U = 900 * (1 - np.cos(phi)), 900 * np.sin(phi), 900 * np.cos(phi)
    z, dz, d2z = _closing(HARDWARE, (U, dU, d2U), 0.05)
    stored = SPRING.energy(z) - SPRING.energy(0.05)
    assert stored == pytest.approx(U, abs=1e-7) and z.min() == pytest.approx(0.05)
    assert SPRING.force(z) * dz == pytest.approx(dU, abs=1e-9)
    assert SPRING.stiffness(z) * dz**2 + SPRING.force(z) * d2z == pytest.approx(d2U, abs=1e-8)


def test_what_a_proof_knows_of_its_points():
    period, phi = 2 * math.pi, np.array([0.0, 1.0, 3.0])
    nothing = np.zeros_like
    one, other = (
        Point(omega=omega, load_torque=load, law=law, period=period, work=lambda x: 300 * np.cos(x), inertia=nothing,
              torque=nothing, kinks=())
        for omega, load, law in ((10.0, -40.0, "propeller"), (20.0, 90.0, "constant"))
    )  # fmt: skip
    facts = certificate._facts([one, other], phi, 0.5, certificate.Terms(rollers=8.0, ambient=70.0))
    assert facts.works == pytest.approx(np.array([3 * np.cos(phi), 0.75 * np.cos(phi)]))
    assert facts.sides == pytest.approx(np.array([[4.0, 0.7], [4.0, 70 / 400]]))
    assert facts.lag == pytest.approx([0.5 * 40 * math.pi / 100, 0.0])
    assert facts.share == pytest.approx(np.array([1.0, 2.0, period - 3]) / period)


def test_programs_get_the_unit_of_a_price_and_of_what_was_asked_besides():
    asked = "codesign zotov-89 --speeds 75,142 --realise gas_volume --cylinders 2 --json --with-units".split()
    units = json.loads(CliRunner().invoke(mechsym, asked, catch_exceptions=False).stdout)["units"]
    assert (units["active[0].multiplier"], units["active[1].multiplier"]) == ("kg*m^2", "kg*m^2/N")
    assert (units["realised.before"], units["realised.guides[0].A"]) == ("m^3", "m^2")
    assert units["cylinders[1].flywheel_inertia_bare"] == "kg*m^2"
