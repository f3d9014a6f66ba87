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
from mechsym.cycle.chamber import chamber_over
from mechsym.cycle.heat import Adiabatic, Annand, Hohenberg, Woschni
from mechsym.cycle.kinds import gas_in_cylinder
from mechsym.cycle.kinds.two_stroke_zone import TwoStrokeZone, shares, two_stroke_zone
from mechsym.errors import BadInput
from mechsym.jobs.forces import forces
from mechsym.jobs.machine import machine


def room(cycle, case):
    return chamber_over(kinematics(case), cycle.bore, cycle.compression_ratio)


def kinematics(case):
    return mechanisms.build(case.mechanism, case.need("parameters")).functions["kinematics"]


def zone_of(name, **changes):
    case = load(name)
    known = {f.name for f in dataclasses.fields(TwoStrokeZone)}
    values = {k: v for k, v in dataclasses.asdict(case.need("cycle")).items() if k in known}
    return TwoStrokeZone(**values | changes), case


def speed(case):
    return case.need("operation").speed


@pytest.mark.parametrize("name", ["zotov-89", "zotov-142"])
def test_it_meets_the_algebraic_cycle(name):
    cycle, case = zone_of(name)
    gas = gas_in_cylinder(cycle, kinematics(case), speed(case))
    integrated = gas.pressure
    algebraic = gas_in_cylinder(case.need("cycle"), kinematics(case)).pressure
    assert integrated.mean_indicated == pytest.approx(algebraic.mean_indicated, rel=1e-6)
    assert integrated.p_max == pytest.approx(algebraic.p_max, rel=0.05)
    phi = np.radians(np.linspace(-100, 100, 401))
    assert np.abs(integrated.absolute(phi) - algebraic.absolute(phi)).max() < 0.06 * algebraic.p_max
    assert integrated.period == 2 * math.pi and len(integrated.kinks) == 5
    assert gas.p_back == 101325.0


LAWS = [
    Woschni(wall_temperature=550.0),
    Hohenberg(wall_temperature=550.0),
    Annand(wall_temperature=550.0, a=0.26, radiation=3.27e-8),
    Adiabatic(),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize("gas", ["nasa", "constant_gamma"])
def test_energy_is_accounted_for(law, gas):
    cycle, case = zone_of("zotov-142", properties=gas)
    zone = two_stroke_zone(cycle, room(cycle, case), speed(case), law)
    found = shares(cycle, zone)
    assert abs(zone.result.residual[0]) < 1e-10
    assert sum(found.values()) == pytest.approx(1.0, abs=1e-12)
    assert (found["heat"] > 0.05) == (law != Adiabatic())
    assert 0.35 < found["work"] < 0.6 and 0 < found["unburnt"] < 0.03


def test_heat_to_the_walls_costs_fuel():
    cycle, case = zone_of("zotov-89")
    without, assumed = (two_stroke_zone(cycle, room(cycle, case), speed(case), law).fuel for law in (Adiabatic(), None))
    assert assumed > 1.1 * without


def test_pressure_is_continuous_but_for_nothing():
    cycle, case = zone_of("zotov-89")
    pressure = gas_in_cylinder(cycle, kinematics(case), speed(case)).pressure
    for kink in pressure.kinks:
        assert pressure.absolute(kink + 1e-9) == pytest.approx(pressure.absolute(kink - 1e-9), rel=1e-6)


def test_a_mean_pressure_beyond_the_air_is_refused():
    cycle, case = zone_of("zotov-89", mean_indicated_pressure=30e5)
    with pytest.raises(BadInput, match="with all the air burnt"):
        two_stroke_zone(cycle, room(cycle, case), speed(case))


def test_events_out_of_order_are_refused():
    with pytest.raises(BadInput, match="order must be"):
        zone_of("zotov-89", evo=0.3)


def test_command_on_both_cycles(tmp_path):
    algebraic = CliRunner().invoke(cycle_command, ["zotov-89", "--json"], catch_exceptions=False)
    found = json.loads(algebraic.stdout)
    assert found["mep_kpa"] == [pytest.approx(800)]
    heat_mj = found["sfc_g_kwh"][0] / 1000 * load("zotov-89").need("cycle").lhv / 1e6  # of the fuel of a kWh
    assert found["efficiency"] == [pytest.approx(3.6 / heat_mj)]
    found = cycle_of(zone_file(tmp_path), "--speeds", "60,142")
    assert found["mep_kpa"] == pytest.approx([800, 800])
    assert found["efficiency"][0] < found["efficiency"][1]  # slower: more time for heat to reach the walls
    assert max(map(abs, found["energy_residual"])) < 1e-10


def zone_file(folder, section="", key=""):
    """zotov-89 with its cycle integrated, a key of it and a section added."""
    lines = text("zotov-89").replace("two-stroke-marine", "two-stroke-zone").splitlines()
    gone = ("n_c", "n_e", "R =", "c_v", "crank_side")
    kept = "\n".join(line for line in lines if not line.startswith(gone))
    folder.mkdir(exist_ok=True)
    case = folder / "zone.toml"
    case.write_text(kept.replace('p_back = "101325 Pa"', f'{key}\np_back = "101325 Pa"\n{section}'))
    return str(case)


def cycle_of(case, *words):
    return json.loads(CliRunner().invoke(cycle_command, [case, *words, "--json"], catch_exceptions=False).stdout)


NOTHING = {
    "none": "",
    "woschni": 'wall_temperature = "550 K"\nc1 = 0\nc2 = 0',
    "hohenberg": 'wall_temperature = "550 K"\nc1 = 0',
    "annand": 'wall_temperature = "550 K"\na = 0\nradiation = 0',
}


def test_every_law_without_its_coefficients_is_adiabatic(tmp_path):
    found = {law: cycle_of(zone_file(tmp_path, f'[heat_transfer]\nlaw = "{law}"\n{keys}'))
             for law, keys in NOTHING.items()}  # fmt: skip
    for law, one in found.items():
        assert one["fractions"]["heat"] == [0.0], law
        assert one["efficiency"] == pytest.approx(found["none"]["efficiency"], rel=1e-9), law
        balance = one["fractions"]["heat"][0] + one["fractions"]["work"][0] + one["fractions"]["exhaust"][0]
        assert balance + one["fractions"]["unburnt"][0] == pytest.approx(1.0, abs=1e-12)
        assert abs(one["energy_residual"][0]) < 1e-10


def test_the_section_tells_the_walls_to_every_command(tmp_path):
    """Colder walls take more heat, from the compression on, and the peak is lower: in cycle, hinge and forces alike."""
    heat, peak, push = [], [], []
    for kelvin in (450, 650):
        case = zone_file(tmp_path, f'[heat_transfer]\nlaw = "hohenberg"\nwall_temperature = "{kelvin} K"')
        one = cycle_of(case)
        heat.append(one["fractions"]["heat"][0])
        peak.append(one["p_max_mpa"][0])
        loaded = load(case)
        assert machine(loaded).gas.pressure.p_max == pytest.approx(1e6 * peak[-1], rel=1e-9)
        push.append(float(forces(loaded).columns["p"].max()))
    assert heat[0] > 1.2 * heat[1] and peak[0] < 0.99 * peak[1]
    assert push == pytest.approx([1e6 * p for p in peak], rel=1e-3)


def test_the_speed_of_operation_is_the_speed_of_the_heat(tmp_path):
    """An older file says a speed in [cycle] too: it is told that nothing reads it, and nothing does."""
    now, older = zone_file(tmp_path), zone_file(tmp_path / "older", key='speed = "60 rpm"')
    one, other = cycle_of(now), cycle_of(older)
    assert {name: one[name] for name in one if name != "doubts"} == {n: other[n] for n in other if n != "doubts"}
    (said,) = (doubt for doubt in other["doubts"] if doubt["quantity"] == "unread keys: cycle.speed")
    assert "operation.speed tells it" in said["why"] and said not in one["doubts"]
    slow, fast = (machine(load(now, {"operation.speed": f"{rpm} rpm"})).gas.pressure for rpm in (60, 120))
    assert slow.t_max > fast.t_max  # more time at the wall: the same mean pressure takes more fuel
    assert slow.p_max == pytest.approx(1e6 * cycle_of(now, "--speeds", "60")["p_max_mpa"][0], rel=1e-9)


def test_a_cycle_that_loses_heat_needs_its_speed():
    cycle, case = zone_of("zotov-89")
    with pytest.raises(BadInput, match="speed = nan"):
        gas_in_cylinder(cycle, kinematics(case))


def test_the_law_is_a_section_and_no_key_of_the_cycle(tmp_path):
    case = zone_file(tmp_path)
    for key in ("heat_transfer", "wall_temperature"):
        with pytest.raises(BadInput, match=r"\[heat_transfer\]"):
            load(case, {f"cycle.{key}": "woschni"})
