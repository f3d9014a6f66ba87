"""What a tab says of the JSON of its command: units of people, round-off named, pinned values beside their own."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner
from pictures import contrast

from mechsym import cases
from mechsym.app import commands
from mechsym.app.answers import Answer, Bar, Plotted
from mechsym.app.commands import Run
from mechsym.app.markup import bars, chart, run_groups, run_head, table
from mechsym.app.told import told, unit_of
from mechsym.cli import mechsym
from mechsym.style import DARK, QUIET

_DARK_PAGE = "#121212"  # of the browser's framework


def rows(found, units=None):
    return dict(told(found, units or {}))


def test_numbers_stand_in_units_of_people():
    units = {"t_end": "s", "speeds.phi.mean": "rad/s", "p_max_mpa": "MPa", "vibration.natural": "rad/s",
             "twist[0].twist_peak": "rad", "speed_rpm": "rpm"}  # fmt: skip
    given = {"speed_rpm": 89.0, "t_end": 2.0, "speeds": {"phi": {"mean": 9.42477796}}, "p_max_mpa": [7.4],
             "vibration": {"natural": [62.831853, 125.663706]}, "twist": [{"of": "a", "twist_peak": 0.1}]}  # fmt: skip
    assert rows(given, units) == {"speed": "89 rpm", "end of the run": "2 s", "speeds, phi, mean": "90 rpm",
                           "largest pressure": "7.4 MPa",
                           "vibration, natural frequency": "10, 20 Hz",
                           "twist 1": "of a; largest twist 5.73 deg"}  # fmt: skip


def test_round_off_is_named_or_zero():
    given = {"energy": {"work": {"gas": 1.1e6, "hinge": -1.9e-5}}, "power_residual": 3e-16, "tolerance": 1e-10}
    units = {"energy.work.gas": "J", "energy.work.hinge": "J", "tolerance": "-", "power_residual": "-"}
    shown = {"power left over": "0", "tolerance": "1e-10"}
    assert rows(given, units) == shown | {"energy, work, gas": "1100 kJ", "energy, work, hinge": "0 J"}


def test_what_belongs_together_stands_in_one_row():
    orders = {"order": [0.0, 1.0, 2.0], "amplitude": [9000.0, 500.0, 1e-9], "phase": [0.0, 0.1, 0.2]}
    given = {"max": {"phi_deg": 359.0, "F": 2000.0}, "min": {"phi_deg": 0.0, "F": -10.0},
             "angle_of_max_deg": {"F": 12.5}, "torque_orders": orders, "facts": ["one", "two"],
             "wiebe": {"start": {"value": 0.1, "confidence": 0.01}}}  # fmt: skip
    assert told(given, {"max.F": "N", "wiebe.start.value": "rad", "torque_orders.amplitude": "N*m"}) == [
        ("assumed", "one"), ("assumed", "two"),
        ("least to largest over the turn, F", "-0.01 to 2 kN, largest at 12.5 deg"),
        ("torque orders", "mean 9 kN m; order 1: 500 N m"), ("wiebe, start", "5.73 deg ± 0.573 deg"),
    ]  # fmt: skip


def test_what_swings_is_drawn_before_an_angle_that_goes_on(tmp_path):
    lines = ["t [s],phi [rad],work [J],psi [rad]", "0,0,5,0.1", "1,50,2500,-0.2", "2,100,7000,0.1"]
    (tmp_path / "series.csv").write_text("\n".join(lines), encoding="utf-8")
    found = commands._curves(tmp_path / "series.csv", "t")
    assert [c.y_name for c in found] == ["work [kJ]", "psi [deg]", "phi [deg]"]
    assert found[0].y == pytest.approx((0.005, 2.5, 7.0)) and found[0].x_name == "time [s]"


def test_sentences_of_one_name_stand_beside_their_own():
    shown = table([("facts", "a"), ("facts", "b")], [("facts", "c"), ("facts", "d")])
    assert "<td>a</td><td>c</td>" in shown and "<td>b</td><td>d</td>" in shown
    long = "a sentence of more than forty letters, which stays"
    assert f"<td>{long}</td><td>the same</td>" in table([("facts", long)], [("facts", long)])


def numbers(path, found):
    """Every number under its path."""
    if isinstance(found, dict) and found.keys() != {"order", "amplitude", "phase"}:
        return [n for k, v in found.items() for n in numbers(f"{path}.{k}" if path else k, v)]
    if isinstance(found, list):
        return [n for i, v in enumerate(found) for n in numbers(path if isinstance(v, float) else f"{path}[{i}]", v)]
    return [path] if isinstance(found, float) else []


PAIRS = [(t, n) for n in cases.names() for t in commands.tabs(cases.load(n)) if t not in ("hinge", "size")]


@pytest.mark.slow
@pytest.mark.heavy
@pytest.mark.parametrize(("tab", "name"), PAIRS)
def test_the_unit_of_every_number_is_known(tab, name):
    answer = json.loads(CliRunner().invoke(mechsym, [tab, name, "--json", "--with-units"]).stdout)
    found = {k: v for k, v in answer["value"].items() if k not in ("doubts", "accepted", "headline", "min", "max")}
    assert [path for path in numbers("", found) if not unit_of(path, answer["units"])[1]] == []


def test_two_units_of_one_name_are_told_apart():
    units = {"heat_in_j": "J", "heat_in_kw": "kW"}
    assert rows({"heat_in_j": 353.8, "heat_in_kw": 3.54}, units) == {"heat in j": "353.8 J", "heat in kw": "3.54 kW"}


def test_what_only_rounds_is_no_number():
    weight = {"unbalance": -5.1e-18, "angle_deg": 177.6, "rms_before": 1.451e-12}
    given = {"shaking": {"counterweight": weight}, "rodless": {"resultant_off_crank_deg": 8.4e-15}}
    units = {"shaking.counterweight.unbalance": "kg*m", "shaking.counterweight.rms_before": "N"}
    units["rodless.resultant_off_crank_deg"] = "deg"
    none = {"shaking, counterweight, unbalance": "0 kg m"}
    none["shaking, counterweight, before, root mean square"] = "0 N"
    assert rows(given, units) == none | {"rodless, resultant off crank": "0 deg"}
    assert rows({"verified": {"energy_residual": [6.6e-14, -2.3e-13]}}, {"verified.energy_residual": "-"}) == {
        "verified, energy left over": "0 at most"
    }
    assert rows({"findings": ["carries 70.21 N*m of it"]}) == {"findings": "carries 70.21 N m of it"}


def test_torque_and_pressure_are_drawn_first_in_units_of_people(tmp_path):
    lines = ["phi_deg,p_pa,x [m],y [m],z [m],force_n,t_k,torque_nm",
             "0,1e5,0,0,0,1,300,2000", "1,2e6,1,1,1,2,400,-3000"]  # fmt: skip
    (tmp_path / "cycle.csv").write_text("\n".join(lines), encoding="utf-8")
    found = commands._curves(tmp_path / "cycle.csv", "phi")
    assert [c.y_name for c in found][:3] == ["pressure p [MPa]", "torque [kN m]", "x [mm]"] and found[
        0
    ].x_name == "crank angle [deg]"


def test_a_speed_is_drawn_first_also_where_it_is_held(tmp_path):
    lines = ["t [s],work [J],phid [rad/s],psid [rad/s]", "0,5,10,1", "1,2500,10.000000000001,-1", "2,7000,10,1"]
    (tmp_path / "series.csv").write_text("\n".join(lines), encoding="utf-8")
    found = commands._curves(tmp_path / "series.csv", "t")
    assert [c.y_name for c in found] == ["crank speed [rpm]", "speed of psi [rpm]", "work [kJ]"]
    assert len(set(found[0].y)) == 1  # round-off is no ripple
    assert found[0].y[0] == pytest.approx(300 / np.pi)


def test_loads_say_where_they_act_and_by_which_rod():
    given = {"max": {"R_x_A": 2000.0, "two_mass_N": 5.0}, "min": {"R_x_A": 0.0, "two_mass_N": -5.0},
             "reactions": {"R_x_A": "crank on rod"}}  # fmt: skip
    assert told(given, {"max.R_x_A": "N", "max.two_mass_N": "N"}) == [
        ("least to largest over the turn, R x A (crank on rod)", "0 to 2 kN"),
        ("with the rod as two masses, N", "-5 to 5 N"),
    ]


def test_a_bar_is_as_long_as_what_is_used_of_its_limit():
    limits = (Bar(name="a", text="8 of at most 10 MPa", kept=True, margin=0.2),
              Bar(name="b", text="over", kept=False, margin=-0.5),
              Bar(name="c", text="no limit", kept=True, margin=None))  # fmt: skip
    shown = bars(Answer(good=True, words="", bars=limits))
    assert re.findall(r"width:(\d+)%", shown) == ["80", "100"]  # one without a limit has none
    assert "NOT kept: over" in shown and shown.count("NOT kept") == 1


def test_a_run_is_read_its_numbers_first_the_rest_in_groups():
    rows = (("speed", "89 rpm"), ("work, gas", "9 <J>"), ("work, load", "-9 J"), ("reason", "long " * 30))
    done = Run(status=0, words="", rows=rows)
    head, groups = run_head(done), run_groups(done)
    assert "89 rpm" in head and "work" not in head and "long" not in head
    assert "<h3>work</h3>" in groups and "<td>gas</td><td>9 &lt;J&gt;</td>" in groups and "<h3>reason</h3>" in groups
    assert "exit status" not in head and "refused" in run_head(Run(status=2, words="why"))
    assert "srcdoc=" not in groups and "&lt;p&gt;page" in run_groups(Run(status=0, words="", page="<p>page"))


def test_grey_text_can_be_read_on_both_papers():
    assert contrast(QUIET, "#ffffff") >= 4.5 and contrast(DARK[QUIET], _DARK_PAGE) >= 4.5
    told = str(chart([(Plotted(name="a", chart="c", x=(0.0, 1.0), y=(0.0, 1.0), x_name="t", y_name="p"), "solid")]))
    assert told.count("':color'") == 7 and QUIET in told and DARK[QUIET] in told  # the browser knows which paper it is


def test_curves_that_are_not_drawn_are_counted():
    run = commands.Run(status=0, words="", undrawn=3)
    assert "0 of 3 curves are drawn" in run_groups(run) and "drawn" not in run_groups(replace(run, undrawn=0))
