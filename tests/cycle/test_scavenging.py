"""The turbocharged two-stroke against closed forms, limits and balances; no published test bed was found to compare."""

import dataclasses
import json
import math

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.cycle.breathing.flow import dew_point, flow_area, in_series, remaining, trapped_temperature
from mechsym.cycle.breathing.marine import scavenge
from mechsym.cycle.chamber import chamber_over, travel
from mechsym.cycle.kinds.two_stroke import solve
from mechsym.cycle.motion import piston_travel
from mechsym.errors import BadInput
from mechsym.jobs.gas import gas, source


@pytest.fixture(scope="module")
def engine():
    case = cases.load("zotov-142")
    cycle = case.need("cycle")
    room = chamber_over(piston_travel(case.mechanism, case.need("parameters")), cycle.bore, cycle.compression_ratio)
    section = dataclasses.replace(case.need("scavenging"), source="turbocharger")
    return section, cycle, room, case.need("operation").speed


def run(engine, cycle=None, **changes):
    section, usual, room, omega = engine
    return scavenge(dataclasses.replace(section, **changes), cycle or usual, room, omega)


def test_mass_energy_and_shaft_balance(engine):
    for change in ({}, {"altitude": 2500.0}, {"blower_pressure": 1e4, "stack_loss": 3e3, "cooler_loss": 2e3}):
        found = run(engine, **change)
        assert found.mass_residual < 1e-9
        assert found.energy_residual < 1e-9
        assert 0.98 * found.turbine == pytest.approx(found.compressor, rel=1e-9)


def test_flows_follow_isentropic_throats_written_out(engine):
    """The air through ports and valve, and the gas through the nozzle, by Saint-Venant and Wantzel's formula."""
    section, cycle, room, _ = engine
    found = run(engine)

    def through(area, p, T, behind, gamma, R):
        r = max(behind / p, (2 / (gamma + 1)) ** (gamma / (gamma - 1)))
        speed = math.sqrt(2 * gamma / (gamma - 1) * R * T * (1 - r ** ((gamma - 1) / gamma)))
        return area * p / (R * T) * r ** (1 / gamma) * speed

    area = flow_area(section, (cycle.evo, cycle.evc, cycle.spo), room)
    assert found.air == pytest.approx(through(area, found.p_s, found.T_s, found.p_r, 1.4, 1005 * 0.4 / 1.4), rel=1e-9)
    both = through(section.turbine_area, found.p_r, found.T_r, found.p_b, 1.34, 1130 * 0.34 / 1.34)
    assert found.air + found.fuel == pytest.approx(both, rel=1e-9)


def test_the_fuel_is_that_of_the_cycle_solved_with_what_was_found(engine):
    _, cycle, room, omega = engine
    found = run(engine)
    state = solve(dataclasses.replace(cycle, p_s=found.p_s, T_evc=found.T_evc), room)
    fuel = state.mass * cycle.c_v * state.dT / (cycle.lhv - cycle.c_v * state.dT)
    assert found.fuel == pytest.approx(fuel * omega / (2 * math.pi), rel=1e-9)


def test_choked_turbine_with_perfect_machines_has_a_closed_form(engine):
    """Without losses the work by mass of turbine and compressor is equal: the pressures follow from temperatures."""
    found = run(engine, compressor_efficiency=1.0, turbine_efficiency=1.0, shaft_efficiency=1.0)
    share = 1005 * found.T_1 * (found.ratio ** (0.4 / 1.4) - 1) / ((1 + found.fuel / found.air) * 1130 * found.T_r)
    assert found.p_r / found.p_b == pytest.approx((1 - share) ** (-1.34 / 0.34), rel=1e-9)


def test_areas_in_series_and_their_mean(engine):
    section, cycle, room, _ = engine
    assert float(in_series(3.0, 4.0)) == pytest.approx(2.4)
    assert float(in_series(0.0, 0.0)) == 0
    # a valve far wider than the ports leaves the ports: their mean by the trapezoidal rule of another grid
    wide = dataclasses.replace(section, valve_diameter=4.9, valve_lift=1.9)
    opened = (math.radians(100), math.radians(-100), cycle.spo)
    phi = np.linspace(cycle.spo, 2 * math.pi - cycle.spo, 20001)
    x = travel(room.motion, phi)[0] - travel(room.motion, cycle.spo)[0]
    mean = section.discharge * section.port_width * np.trapezoid(x, phi) / (2 * math.pi)
    assert flow_area(wide, opened, room) == pytest.approx(mean, rel=2e-3)


@given(st.floats(0, 4), st.floats(0, 1))
def test_what_stays_behind_has_its_limits(delivery, displaced):
    share = remaining(delivery, displaced)
    assert 0 <= share <= 1
    assert share <= math.exp(-delivery) + 1e-12  # perfect mixing keeps the most
    assert share >= max(0.0, 1 - delivery) - 1e-12  # nothing is displaced twice


def test_mixture_follows_volumes_over_many_cycles():
    """The periodic temperature against the cycles followed one by one."""
    T, fresh, share, rise = 300.0, 330.0, 0.2, 2.5
    for _ in range(200):
        T = 1 / ((1 - share) / fresh + share / (rise * T))
    assert trapped_temperature(fresh, share, rise) == pytest.approx(T, rel=1e-12)


def test_dew_point_gives_back_the_air_itself():
    assert dew_point(1e5, (1e5, 298.15), 1.0) == pytest.approx(298.15, abs=1e-9)
    assert dew_point(1e5, (1e5, 293.15), 0.5) == pytest.approx(273.15 + 9.3, abs=0.05)  # psychrometric tables


def test_height_hot_air_and_a_wide_nozzle_cost_pressure(engine):
    usual = run(engine)
    assert run(engine, altitude=2000.0).p_s < usual.p_s
    assert run(engine, turbine_area=1.2e-3).p_s < usual.p_s
    assert run(engine, ambient_temperature=318.0).p_s < usual.p_s
    assert run(engine, blower_pressure=1e4).p_s > usual.p_s


@pytest.mark.parametrize(
    ("change", "words"),
    [({"turbine_area": 0.1}, "at no scavenge pressure"), ({"turbine_area": 1e-5}, ""), ({"port_width": 1e-6}, "")],
)
def test_impossible_hardware_is_refused(engine, change, words):
    with pytest.raises(BadInput, match=words or "scavenging"):
        run(engine, **change)


def test_the_built_in_cases_keep_their_pressure_unless_asked():
    for name, p_s in (("zotov-89", 1.6e5), ("zotov-142", 3.6e5)):
        case = cases.load(name)
        assert source(case).charged(case.need("operation").speed)[0].p_s == p_s
    turbo = cases.load("zotov-142", {"scavenging.source": "turbocharger"})
    cycle, state = source(turbo).charged(turbo.need("operation").speed)
    assert state.p_s == cycle.p_s == pytest.approx(3.6e5, rel=0.02)
    found = gas(turbo)
    assert any("turbocharger" in fact for fact in found.pressure.facts)
    scavenging = float(found.pressure.absolute(math.pi))
    assert scavenging == pytest.approx(0.9749 * state.p_s - 0.1029e5, rel=1e-12)


def test_command_shows_the_turbocharger_over_the_speeds():
    shown = CliRunner().invoke(
        mechsym, ["cycle", "zotov-142", "--set", "scavenging.source=turbocharger", "--speeds", "120:142:22", "--json"]
    )
    assert shown.exit_code == 0, shown.output
    found = json.loads(shown.stdout)
    assert found["p_in_kpa"][0] < found["p_in_kpa"][1]
    assert max(found["mass_residual"] + found["energy_residual"]) < 1e-9
    assert found["dew_margin_k"][1] > 0


def test_other_kinds_are_told():
    keys = {"scavenging.turbine_area": 1e-3, "scavenging.port_width": 0.1, "scavenging.valve_diameter": 0.1,
            "scavenging.valve_lift": 0.03}  # fmt: skip
    base = [a for key, value in keys.items() for a in ("--set", f"{key}={value}")]
    for case in ("nunes-slider-crank", "chmielewski"):
        shown = CliRunner().invoke(mechsym, ["cycle", case, *base])
        assert "Traceback" not in shown.output
