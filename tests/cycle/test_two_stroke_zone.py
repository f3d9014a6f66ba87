"""The integrated two-stroke cycle beside the algebraic one."""

import dataclasses
import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import mechanisms
from mechsym.cases import load, text
from mechsym.cli.cycle import cycle as cycle_command
from mechsym.cycle.dead_centres import chamber_over
from mechsym.cycle.kinds import back_pressure, cylinder_pressure
from mechsym.cycle.kinds.two_stroke_zone import TwoStrokeZone, shares, two_stroke_zone
from mechsym.errors import BadInput


def room(cycle, case):
    return chamber_over(kinematics(case), cycle.bore, cycle.compression_ratio)


def kinematics(case):
    return mechanisms.build(case.mechanism, case.need("parameters")).functions["kinematics"]


def zone_of(name, **changes):
    case = load(name)
    known = {f.name for f in dataclasses.fields(TwoStrokeZone)}
    values = {k: v for k, v in dataclasses.asdict(case.need("cycle")).items() if k in known}
    values |= {"speed": case.need("operation").speed} | changes
    return TwoStrokeZone(**values), case


@pytest.mark.parametrize("name", ["zotov-89", "zotov-142"])
def test_it_meets_the_algebraic_cycle(name):
    cycle, case = zone_of(name)
    integrated, _ = cylinder_pressure(cycle, kinematics(case))
    algebraic, _ = cylinder_pressure(case.need("cycle"), kinematics(case))
    assert integrated.mean_indicated == pytest.approx(algebraic.mean_indicated, rel=1e-6)
    assert integrated.p_max == pytest.approx(algebraic.p_max, rel=0.05)
    phi = np.radians(np.linspace(-100, 100, 401))
    assert np.abs(integrated.absolute(phi) - algebraic.absolute(phi)).max() < 0.06 * algebraic.p_max
    assert integrated.period == 2 * math.pi and len(integrated.kinks) == 5
    assert back_pressure(cycle) == 101325.0


@pytest.mark.parametrize("law", ["woschni", "hohenberg", "annand", "none"])
@pytest.mark.parametrize("gas", ["nasa", "constant_gamma"])
def test_energy_is_accounted_for(law, gas):
    cycle, case = zone_of("zotov-142", heat_transfer=law, properties=gas)
    zone = two_stroke_zone(cycle, room(cycle, case))
    found = shares(cycle, zone)
    assert abs(zone.result.residual[0]) < 1e-10
    assert sum(found.values()) == pytest.approx(1.0, abs=1e-12)
    assert (found["heat"] > 0.05) == (law != "none")
    assert 0.35 < found["work"] < 0.6 and 0 < found["unburnt"] < 0.03


def test_heat_to_the_walls_costs_fuel():
    fuel = {}
    for law in ("none", "woschni"):
        cycle, case = zone_of("zotov-89", heat_transfer=law)
        fuel[law] = two_stroke_zone(cycle, room(cycle, case)).fuel
    assert fuel["woschni"] > 1.1 * fuel["none"]


def test_pressure_is_continuous_but_for_nothing():
    cycle, case = zone_of("zotov-89")
    pressure, _ = cylinder_pressure(cycle, kinematics(case))
    for kink in pressure.kinks:
        assert pressure.absolute(kink + 1e-9) == pytest.approx(pressure.absolute(kink - 1e-9), rel=1e-6)


def test_a_mean_pressure_beyond_the_air_is_refused():
    cycle, case = zone_of("zotov-89", mean_indicated_pressure=30e5)
    with pytest.raises(BadInput, match="with all the air burnt"):
        two_stroke_zone(cycle, room(cycle, case))


def test_events_out_of_order_are_refused():
    with pytest.raises(BadInput, match="order must be"):
        zone_of("zotov-89", evo=0.3)


def test_command_on_both_cycles(tmp_path):
    algebraic = CliRunner().invoke(cycle_command, ["zotov-89", "--json"], catch_exceptions=False)
    found = json.loads(algebraic.stdout)
    assert found["mep_kpa"] == [pytest.approx(800)] and found["efficiency"] == [None]
    lines = text("zotov-89").replace("two-stroke-marine", "two-stroke-zone").splitlines()
    gone = ("n_c", "n_e", "R =", "c_v", "crank_side")
    case = tmp_path / "zone.toml"
    case.write_text("\n".join([*(line for line in lines if not line.startswith(gone))]) .replace(
        'p_back = "101325 Pa"', 'speed = "89 rpm"\np_back = "101325 Pa"'))  # fmt: skip
    result = CliRunner().invoke(cycle_command, [str(case), "--speeds", "60,142", "--json"], catch_exceptions=False)
    found = json.loads(result.stdout)
    assert found["mep_kpa"] == pytest.approx([800, 800])
    assert found["efficiency"][0] < found["efficiency"][1]  # slower: more time for heat to reach the walls
    assert max(map(abs, found["energy_residual"])) < 1e-10
