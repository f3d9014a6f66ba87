"""The converged cycle: order of the method, first law, work by torque, and the ideal limit."""

import dataclasses
import functools
import itertools

import numpy as np
import pytest

from mechsym import mechanisms
from mechsym.cases import load
from mechsym.cycle.chamber import chamber
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.closed.performance import performance
from mechsym.cycle.closed.run import FINE, closed_curves, closed_function, closed_map, dense, run
from mechsym.cycle.heat import Adiabatic, Annand, Hohenberg, NasaMixture, Woschni
from mechsym.cycle.kinds.spark_ignition import otto_efficiency
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine
from mechsym.quantities import RPM

SPEEDS = np.array([100.0, 1000.0, 4000.0, 8000.0]) * RPM


@pytest.fixture(scope="module")
def slider_crank():
    return engine(load("nunes-slider-crank"))


def cycle_of(machine, **changes):
    return dataclasses.replace(machine, cycle=dataclasses.replace(machine.cycle, **changes))


def period_of(machine):
    return functools.partial(closed_period, machine)


def work(machine, steps):
    function = closed_function(period_of(machine), ["omega"], steps)
    return float(function.call({"design": 4000 * RPM})["work"])


@pytest.mark.parametrize("wiebe_m", [2.0, 0.7247])
def test_observed_order(slider_crank, wiebe_m):
    machine = cycle_of(slider_crank, wiebe_m=wiebe_m)
    exact = work(machine, 640)
    errors = [abs(work(machine, n) - exact) for n in (20, 40)]
    assert np.log2(errors[0] / errors[1]) > (7.5 if wiebe_m == 2.0 else 6.0)


LAWS = [Annand(wall_temperature=350.0), Woschni(wall_temperature=400.0), Hohenberg(wall_temperature=400.0), Adiabatic()]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("vaporisation", ["latent_heat", "liquid_energy", "none"])
def test_first_law_closes(slider_crank, law, vaporisation):
    machine = dataclasses.replace(cycle_of(slider_crank, vaporisation=vaporisation), heat_transfer=law)
    found = performance(machine, {"omega": SPEEDS})
    assert np.abs(found.energy_residual).max() < 1e-10
    assert found.heat + found.work + found.exhaust + found.unburnt == pytest.approx(np.ones(4), abs=1e-10)


def test_first_law_closes_with_temperature_dependent_properties(slider_crank):
    machine = dataclasses.replace(slider_crank, gas=NasaMixture())
    found = performance(machine, {"omega": SPEEDS})
    assert np.abs(found.energy_residual).max() < 1e-10
    # heat capacities that grow with temperature cost part of the efficiency of gamma = 1.4
    assert np.all(found.efficiency < 0.95 * performance(slider_crank, {"omega": SPEEDS}).efficiency)


def test_a_wrong_energy_balance_would_show(slider_crank):
    result = run(period_of(slider_crank), {"omega": SPEEDS})
    scalars = result.scalars
    wrong = scalars["energy_end"] - scalars["energy_start"] + scalars["work"] - scalars["heat_released"]
    assert np.abs(wrong / scalars["heat_released"]).min() > 0.1


def integral_over_phases(result, values):
    """Simpson's rule over each phase's own variable s, in which everything is smooth."""
    ends = np.flatnonzero(np.diff(result.phi[0]) < 1e-12) + 1
    total = 0.0
    for phi, y, power in zip(np.split(result.phi[0], ends), np.split(values, ends), (1, 4, 1), strict=True):
        s = np.linspace(0.0, 1.0, phi.size)
        weights = np.ones(phi.size)
        weights[1:-1:2], weights[2:-1:2] = 4, 2
        slope = power * (phi[-1] - phi[0]) * s ** (power - 1)
        total += weights @ (y * slope) / (3 * (phi.size - 1))
    return total


@pytest.mark.parametrize("case, coordinate", [("nunes-slider-crank", "phi"), ("nunes-hypocycloid", "theta")])
def test_work_by_the_mechanism_s_torque_is_the_integral_of_p_dv(case, coordinate):
    loaded = load(case)
    machine, omega = engine(loaded), 6000 * RPM
    room = chamber(machine.chamber, machine.motion)
    result = run(period_of(machine), {"omega": omega}, steps=960)
    dynamics = mechanisms.build(loaded.mechanism, loaded.need("parameters")).functions["dynamics"]
    state = {coordinate: result.phi, f"{coordinate}d": omega, "F": result.p * room.area}
    values = dynamics.call(state | {n: 0 for n in dynamics.name_in() if n not in state})
    torque = np.asarray(values["generalized_force"] - values["bias"]).ravel() * room.pistons
    assert integral_over_phases(result, torque) == pytest.approx(result.scalars["work"][0], rel=1e-8)


@pytest.mark.parametrize("ratio", [6.0, 10.0, 14.0])
def test_instant_combustion_without_losses_is_the_otto_cycle(slider_crank, ratio):
    machine = cycle_of(
        slider_crank,
        vaporisation="none",
        ignition=-1e-5,
        ignition_slope=0.0,
        duration=2e-5,
        duration_slope=0.0,
    )
    machine = dataclasses.replace(machine, heat_transfer=Adiabatic())
    scalars = run(period_of(machine), {"omega": 3000 * RPM, "chamber.compression_ratio": ratio}).scalars
    efficiency = scalars["work"][0] / scalars["heat_released"][0]
    assert efficiency == pytest.approx(otto_efficiency(ratio, machine.gas.gamma), abs=1e-6)


def test_dense_output_meets_a_finer_integration(slider_crank):
    coarse, fine = (run(period_of(slider_crank), {"omega": 3000 * RPM}, steps=n) for n in (120, 1920))
    phi, p, t = (a[0] for a in dense(coarse))
    nodes = np.append(np.diff(fine.phi[0]) > 1e-12, True)
    for found, exact in ((p, fine.p), (t, fine.t)):
        true = np.interp(phi, fine.phi[0, nodes], exact[0, nodes])
        assert np.abs(found / true - 1).max() < 5e-5


def test_steps_are_doubled_until_the_first_law_closes(slider_crank):
    machine = dataclasses.replace(slider_crank, gas=NasaMixture())
    result = run(period_of(machine), {"omega": SPEEDS}, steps=60)
    assert result.phi.shape[1] == 243 and np.abs(result.residual).max() < 1e-10


def test_what_cannot_converge_is_refused_with_the_residual(slider_crank):
    with pytest.raises(BadInput, match=r"does not converge at omega = 1e-06: first-law residual"):
        run(period_of(slider_crank), {"omega": 1e-6})


@pytest.mark.parametrize(
    "changes, reason",
    [
        ({"cycle.ignition": np.pi + 0.2}, "after the exhaust opens"),
        ({"cycle.ignition": -np.pi - 0.1}, "before the inlet closes"),
        ({"cycle.duration": 3.3}, "combustion ends after the exhaust opens"),
    ],
)
def test_combustion_outside_the_closed_period_is_refused(slider_crank, changes, reason):
    with pytest.raises(BadInput, match=reason):
        run(period_of(slider_crank), {"omega": SPEEDS, **changes})


def test_map_over_any_parameter(slider_crank):
    ratios = np.array([8.0, 10.0, 12.0])
    found = performance(slider_crank, {"omega": 4000 * RPM, "chamber.compression_ratio": ratios})
    assert np.all(np.diff(found.efficiency) > 0) and np.all(np.diff(found.p_max) > 0)
    alone = performance(slider_crank, {"omega": np.array([4000 * RPM])})
    assert found.efficiency[1] == pytest.approx(alone.efficiency[0], rel=1e-13)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("gas", ["constant_gamma", "nasa"])
def test_many_designs_give_what_single_ones_give(slider_crank, law, gas):
    machine = dataclasses.replace(slider_crank, heat_transfer=law)
    if gas == "nasa":
        machine = dataclasses.replace(machine, gas=NasaMixture())
    designs = np.array([np.linspace(600, 9000, 12) * RPM, np.linspace(0.9, 1.1, 12) * 1e5])
    names = ["omega", "cycle.intake_pressure"]
    one, many = closed_function(period_of(machine), names, 40), closed_map(period_of(machine), names)(designs, 40)
    for i, design in enumerate(designs.T):
        for name, value in one.call({"design": design}).items():
            wanted = np.asarray(value).ravel()
            scale = np.maximum(np.abs(wanted), 1e-3 * np.abs(wanted).max())
            assert np.all(np.abs(many[name][i] - wanted) <= 1e-11 * scale), name


@pytest.mark.parametrize("wiebe_m", [2.0, 0.7247])
def test_curves_are_smooth_from_event_to_event(slider_crank, wiebe_m):
    build = period_of(cycle_of(slider_crank, wiebe_m=wiebe_m))
    fine = closed_curves(run(build, {"omega": 4000 * RPM}, 7680))
    phi, p, t = fine.even(np.radians(0.01))
    usual = closed_curves(run(build, {"omega": 4000 * RPM}, FINE)).at(phi)
    np.testing.assert_allclose(usual[0], p, atol=1e-8 * p.max())
    np.testing.assert_allclose(usual[1], t, atol=1e-8 * t.max())
    for before, after in itertools.pairwise(fine.phases):  # there the curves meet, their slopes need not
        assert before.last == pytest.approx(after.first, abs=1e-15)
        np.testing.assert_allclose(before.spline(1.0), after.spline(0.0), rtol=1e-12)
