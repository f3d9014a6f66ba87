"""Losses of a hinge against a second way to each: energy, sliding speeds, virtual work."""

import numpy as np
import pytest
from hinges import monotone_seal_torque

from mechsym.errors import BadInput
from mechsym.hinge import rollers

PHI = np.linspace(0, 2 * np.pi, 3601)[:-1]
RHO, DRHO, D2RHO = 0.7 + 0.1 * np.cos(PHI), -0.1 * np.sin(PHI), -0.1 * np.cos(PHI)


def test_a_monotone_spring_loses_twice_its_swing_in_the_seals():
    z = 2 * (0.8 - RHO)
    force = 2e5 / (1 - z) ** 1.25
    swing = 2e5 / 0.25 * ((1 - z.max()) ** -0.25 - (1 - z.min()) ** -0.25)
    # U counts 2 F drho for both rollers: F z' with z = 2 (rho0 - rho)
    mean = np.mean(rollers.seal_torque(force, DRHO, 0.01, 2))
    assert mean == pytest.approx(monotone_seal_torque(swing, 0.01), rel=1e-5)


def test_bearing_turns_at_the_rolling_speed_and_the_shafts():
    radius, bearing = 0.1, 0.05
    length = np.hypot(RHO, DRHO)  # path by angle of the shaft
    sliding = bearing * (length / radius + 1)
    torque = rollers.bearing_torque(np.full(PHI.size, 1e5), RHO, DRHO, 0.002, bearing, radius, 2)
    assert torque == pytest.approx(2 * 0.002 * 1e5 * sliding)


def test_side_force_carries_the_torque_of_the_track():
    force, mass, omega = np.full(PHI.size, 1e5), 80.0, 12.0
    side = rollers.side_force(force, RHO, DRHO, D2RHO, mass, omega)
    # torque of the shaft on the mass is the rate of its angular momentum less that of the track: S rho
    radial = force + mass * omega**2 * (RHO - D2RHO)
    momentum = mass * omega**2 * 2 * RHO * DRHO  # d(m rho^2 omega)/dt
    assert side * RHO == pytest.approx(radial * DRHO - momentum)


def test_guide_friction_has_no_sign():
    side = rollers.side_force(np.full(PHI.size, 1e5), RHO, DRHO, D2RHO, 0.0, 12.0)
    torque = rollers.guide_torque(side, DRHO, 0.05, 2)
    assert torque.min() >= 0
    assert torque == pytest.approx(rollers.guide_torque(-side, DRHO, 0.05, 2))


def test_all_of_them():
    made = rollers.LossTorques(bearing=1.0, seal=2.0, guide=3.0, rolling=4.0, gas=5.0)
    assert made.total == 15.0


def test_assumed_values_are_those_that_are_told():
    assumed = rollers.HingeLosses()
    assert (assumed.bearing_mu, assumed.bearing_radius, assumed.seal_mu, assumed.guide_mu) == (0.0018, 0.0, 0.01, 0.05)
    assert (assumed.tau, assumed.gamma, assumed.wall_temperature) == (0.0, 1.4, 320.0)


@pytest.mark.parametrize(
    ("name", "inside", "outside"),
    [
        ("bearing_mu", 0.1, 0.105), ("bearing_mu", 0.0, -1e-9), ("bearing_radius", 0.0, -1e-9), ("seal_mu", 0.5, 0.51),
        ("seal_mu", 0.0, -1e-9), ("guide_mu", 0.5, 0.51), ("guide_mu", 0.0, -1e-9), ("tau", 0.0, -1e-9),
        ("gamma", 1.01, 1.0), ("gamma", 1.99, 2.0), ("wall_temperature", 201.0, 200.0),
        ("wall_temperature", 799.0, 800.0),
    ],
)  # fmt: skip
def test_settings_end_where_the_unit_must_be_wrong(name, inside, outside):
    assert getattr(rollers.HingeLosses(**{name: inside}), name) == inside
    with pytest.raises(BadInput, match=f"{name} = .* is out of range"):
        rollers.HingeLosses(**{name: outside})


@pytest.mark.parametrize("name", ["bearing", "seal", "guide", "rolling", "gas"])
def test_a_loss_gives_nothing(name):
    none = dict.fromkeys(("bearing", "seal", "guide", "rolling", "gas"), 0.0)
    assert rollers.LossTorques(**none).total == 0.0
    with pytest.raises(BadInput, match=name):
        rollers.LossTorques(**none | {name: -1e-9})
