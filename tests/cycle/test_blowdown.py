"""The blowdown against its closed choked form, against mass and first law integrated finely, and as one book."""

import dataclasses
import math
from functools import partial

import numpy as np
import pytest
import scipy

from mechsym import cases
from mechsym.cases.new_engine import write_engine
from mechsym.cycle.closed.model import closed_period, open_period
from mechsym.cycle.closed.performance import design_function, performance
from mechsym.cycle.heat import properties
from mechsym.errors import BadInput
from mechsym.jobs.cycle import cycle, engine
from mechsym.jobs.gas import gas, one_cylinder

OPENS, T_END = math.radians(118), 1500.0


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return str(write_engine("inline", 0.08, 0.09, 1, tmp_path_factory.mktemp("new"), gas="closed")[0])


def opened(file, omega, **overrides):
    """The open period, with p and V at its start, R and gamma."""
    machine = engine(one_cylinder(cases.load(file)))
    machine = dataclasses.replace(machine, blowdown=dataclasses.replace(machine.blowdown, **overrides))
    found = open_period(partial(closed_period, machine), {"omega": np.array([omega])}, np.array([T_END]))
    of = properties(machine.gas, T_END, 1.0)
    return machine, found, float(of.gas_constant), float(1 + of.gas_constant / of.heat_capacity)


def volume(machine, phi):
    """By the slider crank, of the record's own lengths."""
    values = machine.motion.parameters
    r, rod = values["r"], values["l1"] + values["l2"]
    area = math.pi / 4 * machine.chamber.bore**2
    x = r + rod - r * np.cos(phi) - np.sqrt(rod**2 - (r * np.sin(phi)) ** 2)
    return area * (2 * r / (machine.chamber.compression_ratio - 1) + x)


def valve_area(machine, phi):
    valve = machine.blowdown
    u = 2 * (phi - OPENS) / (valve.exhaust_closes - OPENS) - 1
    lift = valve.exhaust_lift * (1 - u**2) ** 3
    around, through = math.pi * valve.exhaust_diameter * lift, math.pi / 4 * valve.exhaust_diameter**2
    return valve.valves * valve.discharge * np.minimum(around, through)


@pytest.mark.parametrize("omega", [100.0, 420.0])
def test_while_choked_it_is_an_integral_over_the_angle(file, omega):
    machine, found, R, gamma = opened(file, omega, pressure=1.0)
    first = volume(machine, OPENS)
    flux = math.sqrt(gamma) * (2 / (gamma + 1)) ** ((gamma + 1) / (2 * (gamma - 1)))
    phi, p = found.phi[0], found.p[0]

    def told(end):
        inside = scipy.integrate.quad(
            lambda a: valve_area(machine, a) * (volume(machine, a) / first) ** (-(gamma + 1) / 2), OPENS, end,
            epsabs=0, epsrel=1e-11, limit=200,
        )[0]  # fmt: skip
        u = 1 + (gamma - 1) / 2 * flux * math.sqrt(R * T_END) / (omega * first) * inside
        return p[0] * (u ** (-2 / (gamma - 1)) * first / volume(machine, end)) ** gamma

    for end in (math.radians(150), math.pi, math.radians(250)):
        k = int(np.argmin(np.abs(phi - end)))
        assert p[k] == pytest.approx(told(phi[k]), rel=2e-6)


@pytest.mark.parametrize("omega", [60.0, 200.0, 420.0])
def test_mass_and_first_law_integrated_finely_say_the_same(file, omega):
    machine, found, R, gamma = opened(file, omega)
    outside, cv = machine.blowdown.pressure, R / (gamma - 1)
    first, p_1 = volume(machine, OPENS), found.p[0, 0]

    def rate(phi, y):
        m, E, _ = y
        room, slope = volume(machine, phi), (volume(machine, phi + 1e-6) - volume(machine, phi - 1e-6)) / 2e-6
        p, T = (gamma - 1) * E / room, E / (m * cv)
        up, down, there = (p, outside, T) if p >= outside else (outside, p, T * (outside / p) ** (1 - 1 / gamma))
        ratio = max(down / up, (2 / (gamma + 1)) ** (gamma / (gamma - 1)))
        psi = math.sqrt(2 * gamma / (gamma - 1) * max(ratio ** (2 / gamma) - ratio ** (1 + 1 / gamma), 0.0))
        flow = math.copysign(valve_area(machine, phi) * up / math.sqrt(R * there) * psi / omega, p - outside)
        return [-flow, -flow * gamma * cv * there - p * slope, p * slope]

    start = [p_1 * first / (R * T_END), p_1 * first / (gamma - 1), 0.0]
    fine = scipy.integrate.solve_ivp(
        rate, (OPENS, 2 * math.pi), start, "Radau", rtol=1e-9, atol=[1e-12, 1e-8, 1e-8], max_step=0.01,
        t_eval=[math.pi, 1.5 * math.pi, 2 * math.pi],
    )  # fmt: skip
    p = (gamma - 1) * fine.y[1] / volume(machine, fine.t)
    phi = found.phi[0]
    for at, wanted in zip(fine.t, p, strict=True):
        assert np.interp(at, phi, found.p[0]) == pytest.approx(wanted, rel=2e-4)
    room = volume(machine, phi)
    assert np.trapezoid(found.p[0], room) == pytest.approx(fine.y[2, -1], abs=1e-4 * p_1 * first)


def test_figures_and_pressure_are_one_book(file):
    case = cases.load(file)
    found, acting = cycle(case), gas(case)
    # the curve is straight between angles a quarter of a degree apart
    assert 1e3 * found["mep_kpa"][0] == pytest.approx(acting.pressure.mean_indicated, rel=1e-4)
    phi = np.linspace(math.pi, 3 * math.pi, 40001)
    work = np.trapezoid(acting.pressure.absolute(phi), volume(engine(one_cylinder(case)), phi))
    assert 1e3 * found["pumping_mep_kpa"][0] == pytest.approx(work / acting.chamber.displacement, rel=1e-4)
    shares = sum(float(values[0]) for values in found["fractions"].values())
    assert shares == pytest.approx(1, abs=1e-9)


def test_the_optimiser_sees_the_same_work(file):
    machine = engine(one_cylinder(cases.load(file)))
    one = performance(machine, {"omega": np.array([400.0])})
    told = design_function(machine, ["omega"])(design=400.0)
    assert float(told["mep"]) == pytest.approx(float(one.mep[0]), rel=1e-7)


def test_without_a_valve_it_drops_at_once(file):
    case = cases.load(file)
    with_valve = performance(engine(one_cylinder(case)), {"omega": np.array([400.0])})
    sections = {name: data for name, data in case.sections.items() if name != "blowdown"}
    bare = dataclasses.replace(case, sections=sections)
    without = performance(engine(one_cylinder(bare)), {"omega": np.array([400.0])})
    assert without.pumping_mep[0] == 0 and -1e5 < with_valve.pumping_mep[0] < 0
    # the gas pushes on while it leaves: more work before bottom dead centre, less behind it
    assert with_valve.mep[0] - with_valve.pumping_mep[0] > without.mep[0]


def test_an_exhaust_below_the_inlet_is_refused(file):
    with pytest.raises(BadInput, match="below cycle.intake_pressure"):
        cycle(cases.load(file, {"blowdown.pressure": "80 kPa"}))
