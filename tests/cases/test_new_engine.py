"""A new engine is a case that the commands take as it is written; its cylinders fire at their dead centres, evenly."""

import json
import math

import numpy as np
import pytest
import scipy
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases.check import check_file
from mechsym.cases.cylinder_layout import boxer, in_line, in_v, opposed, radial
from mechsym.cases.new_engine import KINDS, write_engine
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.machine import turn
from mechsym.mechanisms import crank_train
from mechsym.mechanisms.crank_train.firing import refuse_wrong_firing
from mechsym.torsion.modes import matrices

TRAINS = [in_line(n, turns) for n in range(1, 13) for turns in (1, 2)] + [in_v(n) for n in (2, 4, 6, 8, 10, 12)]
TRAINS += [boxer(n) for n in range(2, 13, 2)] + [radial(n) for n in range(3, 12, 2)] + [in_v(n, True) for n in (8, 10)]
ENGINES = [
    ("two-stroke-crosshead", 500, 2000, 1), ("two-stroke-crosshead", 300, 1000, 1),
    ("two-stroke-crosshead", 600, 2400, 6), ("inline", 100, 120, 1), ("inline", 80, 90, 4), ("inline", 86, 86, 6),
    ("v", 90, 70, 2), ("v", 86, 86, 6), ("v", 95, 90, 8), ("opposed", 80, 80, 1), ("opposed", 80, 120, 3),
    ("hypocycloid", 60, 52, 1), ("boxer", 90, 70, 4), ("radial", 100, 110, 5),
]  # fmt: skip


def run(*words):
    return CliRunner().invoke(mechsym, [*map(str, words)], catch_exceptions=False)


@pytest.fixture
def written(tmp_path):
    return lambda kind, bore, stroke, count: str(write_engine(kind, bore * 1e-3, stroke * 1e-3, count, tmp_path)[0])


@pytest.mark.parametrize("found", TRAINS)
def test_cylinders_fire_evenly_and_on_their_pins(found):
    gaps = np.diff(sorted(found.firing), append=min(found.firing) + found.period)
    if len(found.throw) == 2 and found.throw == (1, 1):  # a twin on one pin
        assert sorted(gaps) == pytest.approx([270, 450])
    else:
        assert gaps == pytest.approx(found.period / len(found.throw))
    for bank, fires, phase in zip(found.bank, found.firing, found.phase, strict=True):
        assert math.remainder(phase + fires - bank, 360) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("hangs", [False, True])
def test_a_v8_has_the_usual_crank_whose_second_orders_cancel(hangs):
    found = in_v(8, hangs)
    assert [(p - found.phase[0]) % 360 for p in found.phase] == pytest.approx([0, 90, 270, 180] * 2)
    assert [1 + found.firing.index(90.0 * k) for k in range(8)] == [1, 5, 4, 2, 6, 3, 7, 8]
    bank, pin = np.radians(found.bank), np.radians(found.phase)
    for sign in (-1, 1):
        assert abs(np.sum(np.exp(1j * (bank + sign * 2 * (bank - pin))))) < 1e-12
    # the first order leaves a couple that turns with the shaft: sqrt(10) a, twice for two banks at a right angle
    couple = np.sum(np.array(found.throw) * np.exp(1j * pin))
    assert abs(couple) == pytest.approx(2 * math.sqrt(10))


def test_opposed_pistons_meet():
    found = opposed(3)
    assert found.firing[:3] == found.firing[3:] and set(found.bank) == {0.0, 180.0}
    assert all(math.remainder(b - a - 180, 360) == 0 for a, b in zip(found.phase[:3], found.phase[3:], strict=True))


@pytest.mark.parametrize("engine", ENGINES, ids=lambda e: f"{e[0]}-{e[3]}-{e[1]}")
def test_the_case_has_no_problem_and_no_doubt(engine, written):
    path = written(*engine)
    found, case = check_file(path), cases.load(path)
    assert found.problems == () and case.doubts == ()
    assert not found.commands["cycle"] and not found.commands["forces"]
    assert bool(found.commands["hinge"]) == (engine[0] != "two-stroke-crosshead" or engine[3] > 1)
    if case.mechanism == "crank_train":
        period = (4 if "chamber" in case.sections else 2) * math.pi
        refuse_wrong_firing(case.need("parameters"), period)


@pytest.mark.parametrize("counts", [(2, 6), pytest.param(range(1, 13), marks=pytest.mark.slow)], ids=["some", "all"])
@pytest.mark.parametrize("kind", ["two-stroke-crosshead", "inline", "v", "boxer", "radial", "opposed"])
def test_no_order_that_cylinders_add_up_to_is_critical_at_the_speed(kind, counts, tmp_path):
    """Phase-vector sums over the modes of the case as written: those of a half and more lie 10 % off."""
    for count in counts:
        counts_of = {"v": range(2, 13, 2), "boxer": range(2, 13, 2), "radial": range(3, 12, 2)}
        if count not in counts_of.get(kind, range(13)):
            continue
        if (kind, count) == ("two-stroke-crosshead", 1):
            continue
        case = cases.load(str(write_engine(kind, 0.086, 0.086, count, tmp_path)[0]))
        values, omega = case.need("parameters"), case.need("operation").speed
        linear, step = matrices(crank_train.build(values)), 0.5 if "chamber" in case.sections else 1.0
        squares, shapes = scipy.linalg.eigh(linear.stiffness, linear.mass)
        for square, shape in zip(squares[1:], shapes.T[1:], strict=True):
            moved = shape[np.array(values.throw) - 1]
            for order in np.arange(1, round(12 / step) + 1) * step:
                together = abs(np.sum(moved * np.exp(1j * order * np.array(values.firing)))) / np.abs(moved).sum()
                away = abs(math.sqrt(square) / (order * omega) - 1)
                assert together < 0.5 or away > 0.0999, f"{case.name}: order {order:g} is {away:.2%} off"


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES, ids=lambda e: f"{e[0]}-{e[3]}-{e[1]}")
def test_the_commands_take_it_as_it_is(engine, written):
    path = written(*engine)
    for command in ("check", "cycle", "forces"):
        done = run(command, path, "--json", "--strict")
        assert done.exit_code == 0, done.output
    cycle, opposed = json.loads(run("cycle", path, "--json").output), engine[0] == "opposed"
    assert cycle["cylinders"] == engine[3] * (2 if opposed else 1)
    assert cycle["each"] == ("piston" if opposed else "cylinder")
    if engine[0] == "two-stroke-crosshead" and engine[3] == 1:
        assert json.loads(run("hinge", path, "--json").output)["guide"]["feasible"]


@pytest.mark.slow
def test_one_cylinder_is_carried_over_its_compression(written):
    told = json.loads(run("simulate", written("hypocycloid", 80, 80, 1), "--no-check", "--json").output)
    assert told["end"] == "turns" and told["speed_min"] > 0.9 * told["speed_mean"]


@pytest.mark.parametrize(("words", "message"), [
    (("engine", "--kind", "v", "--bore", "0.09", "--stroke", "0.08", "--cylinders", "7"), "a V engine here has 2, 4"),
    (("engine", "--kind", "inline", "--bore", "86 kg", "--stroke", "0.08"), "--bore = '86 kg' has the wrong dimension"),
    (("engine", "--kind", "inline", "--stroke", "0.08"), "an engine needs --bore"),
    (("engine", "--kind", "inline", "--bore", "86 m", "--stroke", "0.08"), "1 mm to 10 m"),
    (("engine", "--bore", "86 mm", "--stroke", "0.08"), f"an engine needs --kind: {', '.join(KINDS)}"),
    (("mechanism",), "a mechanism needs a NAME"),
])  # fmt: skip
def test_what_is_missing_is_said(words, message, tmp_path):
    with pytest.raises(BadInput, match=message):
        run("new", *words, "--out", tmp_path)


def test_out_may_name_the_file(tmp_path):
    sizes = ("--kind", "inline", "--bore", "86 mm", "--stroke", "86 mm")
    run("new", "engine", *sizes, "--out", tmp_path / "my.toml")
    run("new", "engine", "other.toml", *sizes, "--out", tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir() if path.is_file()) == ["my.toml", "other.toml"]
    with pytest.raises(BadInput, match="exists"):
        run("new", "engine", *sizes, "--out", tmp_path / "my.toml")
    with pytest.raises(BadInput, match="both name the file"):
        run("new", "engine", "third", *sizes, "--out", tmp_path / "fourth.toml")
    with pytest.raises(BadInput, match="give a folder"):
        run("new", "mechanism", "press", "--out", tmp_path / "press.toml")


def test_nothing_is_overwritten(tmp_path):
    words = ("new", "engine", "mine", "--kind", "inline", "--bore", "86 mm", "--stroke", "86 mm", "--out", tmp_path)
    assert run(*words).exit_code == 0 and (tmp_path / "mine.toml").exists()
    with pytest.raises(BadInput, match="exists"):
        run(*words)


_TYPICAL = [ENGINES[k] for k in (1, 2, 3, 7, 9, 11, 12, 13)]
EVERY_GAS = [(*engine, "exchange") for engine in _TYPICAL]
EVERY_GAS += [(*engine, "closed") for engine in _TYPICAL if "stroke" not in engine[0] and engine[0] != "opposed"]


@pytest.mark.slow
@pytest.mark.parametrize("engine", EVERY_GAS, ids=lambda e: f"{e[0]}-{e[3]}-{e[4]}")
def test_no_gas_force_jumps(engine, tmp_path):
    """Halving the step halves the largest difference between neighbours, down to a twentieth of a degree."""
    kind, bore, stroke, count, gas = engine
    case = cases.load(str(write_engine(kind, bore * 1e-3, stroke * 1e-3, count, tmp_path, gas=gas)[0]))
    acting = turn(case).acting[-1]  # of a radial a piston whose rod hangs
    period, largest = acting.gas.pressure.period, []
    for step in (0.4, 0.2, 0.1, 0.05, 0.025):
        phi = np.linspace(0, period, round(math.degrees(period) / step) + 1)
        largest.append(np.abs(np.diff(acting.force(phi))).max())
    assert np.array(largest[:-1]) / largest[1:] == pytest.approx([2.0] * 4, rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("engine", EVERY_GAS, ids=lambda e: f"{e[0]}-{e[3]}-{e[4]}")
def test_brake_figures_stand_first(engine, tmp_path):
    """Words of the field in the text; the parts of friction and what is left at the shaft are the whole."""
    kind, bore, stroke, count, gas = engine
    path = str(write_engine(kind, bore * 1e-3, stroke * 1e-3, count, tmp_path, gas=gas)[0])
    text, told = run("cycle", path).output, json.loads(run("cycle", path, "--json").output)
    places = [text.index(word) for word in ("BMEP", "BSFC", "brake power", "IMEP", "FMEP", "indicated power")]
    assert places == sorted(places)
    assert told["brake_mep_kpa"][0] == pytest.approx(told["mep_kpa"][0] - told["friction_mep_kpa"][0], rel=1e-12)
    assert told["mechanical_efficiency"][0] == pytest.approx(told["brake_power_kw"][0] / told["power_kw"][0], rel=1e-12)
    if "gross_mep_kpa" in told:
        assert told["mep_kpa"][0] == pytest.approx(told["gross_mep_kpa"][0] + told["pumping_mep_kpa"][0], rel=1e-12)
        assert 8e2 < told["mep_kpa"][0] < 12e2
    assert told["ca10_deg"][0] < told["ca50_deg"][0] < told["ca90_deg"][0]
    if kind == "radial":  # whose pistons have strokes of their own
        assert "look at: strokes differ by up to 0.5" in text
    if friction := json.loads(run("forces", path, "--json").output).get("friction"):
        assert friction["mechanical_efficiency"] == pytest.approx(told["mechanical_efficiency"][0], rel=2e-4)
        assert sum(friction["places"].values()) == pytest.approx(friction["power"], rel=1e-12)
        assert friction["indicated_power"] - friction["power"] == pytest.approx(
            1e3 * told["brake_power_kw"][0], rel=2e-4
        )


def test_crossheads_of_one_cylinder_and_of_many_are_as_heavy(tmp_path):
    one, many = (
        cases.load(str(write_engine("two-stroke-crosshead", 0.6, 2.4, count, tmp_path)[0])).need("parameters")
        for count in (1, 6)
    )
    moving, rod = one.m3 + one.m4 + one.m5, one.m2
    assert many.m_piston == pytest.approx(moving, rel=1e-3) and many.m_rod == pytest.approx(rod, rel=1e-3)
    assert max(many.z) / 5 == pytest.approx(1.7 * 0.6)


@pytest.mark.parametrize("count", range(4, 13))
def test_a_two_stroke_fires_in_an_order_that_leaves_small_couples(count):
    # m r omega^2 of one cylinder at one pitch is 1; the order 1-3-5-..-4-2 leaves more than one of it up to 29
    z = np.arange(count) - (count - 1) / 2
    pins = np.radians(in_line(count, turns=1).phase)
    couples = [abs(np.sum(z * np.exp(1j * k * pins))) for k in (1, 2)]
    assert sorted(in_line(count, turns=1).phase) == pytest.approx([360 * i / count for i in range(count)])
    assert couples[0] < 1.5 and (couples[1] < 1.5 or count in (4, 5, 6))
    assert count != 6 or couples[0] < 1e-9
