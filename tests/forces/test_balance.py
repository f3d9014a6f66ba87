"""Balance of engines against closed forms, and weights that leave what they must."""

import cmath
import dataclasses
import json
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym.cases.new_engine import write_engine
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.forces.balance import Shaken, Weight, _with, amplitudes, balance, couple, part
from mechsym.forces.loads import BalanceWanted, shaking, verdict
from mechsym.forces.mains import MainShaft
from mechsym.forces.turn import Turn, crank_drive, turn
from mechsym.mechanisms.crank_train import CrankTrainParameters

M, R, ROD, OMEGA = 0.4377, 0.0375, 0.125, 502.6548245743669
UNIT = M * R * OMEGA**2  # force of a reciprocating mass at the crank radius [N]
A = 0.0888  # distance of two throws [m]


def harmonic(order: int, lam: float = R / ROD, terms: int = 40) -> float:
    """A_2n of the acceleration of a piston, by the series of the rod's root (order 1: 1)."""
    if order == 1:
        return 1.0
    n, total = order // 2, 0.0
    for j in range(n, terms):
        root = math.prod((0.5 - i) / (i + 1) for i in range(j))  # binom(1/2, j)
        total += 2 * root * (-(lam**2)) ** j * 4.0**-j * math.comb(2 * j, j - n)
    return 4 * n**2 / lam * (-1) ** n * total


def engine(phases: list[float], banks: list[float], throws: list[int], z: list[float], z_rod: float = 0.0) -> Turn:
    """Massless rods on throws without mass: angles [deg], places of the throws [m]."""
    parameters = CrankTrainParameters(
        throw=tuple(throws), phase=tuple(np.radians(phases)), bank=tuple(np.radians(banks)),
        firing=tuple(0.0 for _ in throws), r=R, l1=0.3 * ROD, l2=0.7 * ROD, m_rod=0.0, m_piston=M, I_rod=0.0,
        z_rod=z_rod, I0=1e-3, z=tuple(z), I_f=0.1, k=1e5,
    )  # fmt: skip
    return turn(crank_drive("crank_train", parameters), None, OMEGA)


def in_line(*phases: float) -> Turn:
    n = len(phases)
    return engine(list(phases), [0.0] * n, list(range(1, n + 1)), [A * k for k in range(n)])


def force(one: Turn) -> np.ndarray:
    return balance(one, weights="none").before.force


def test_harmonics_of_the_page() -> None:
    values = [harmonic(order, 0.3) for order in (2, 4, 6)]
    assert values == pytest.approx([0.3070506590621657, -0.00723769499682184, 0.000191936746636], rel=1e-11)


def test_what_is_left_of_one_cylinder_is_told_by_its_own_force() -> None:
    one = in_line(0)
    for order, share in ((1, 1.0), (2, harmonic(2))):
        (told,) = verdict(one, shaking(one), BalanceWanted(orders=(float(order),)))
        assert f"is left with {share * UNIT:.4g} N, {100 * share:.3g} % of one cylinder's" in told


def test_three_in_line() -> None:
    one = in_line(0, 240, 120)
    shaken = amplitudes(couple(one), one)
    for order in (1, 2, 4):
        assert shaken[order] == pytest.approx(math.sqrt(3) * A * abs(harmonic(order)) * UNIT, rel=1e-9)
    assert amplitudes(force(one), one)[6] == pytest.approx(3 * harmonic(6) * UNIT, rel=1e-9)
    assert max(amplitudes(force(one), one)[k] for k in (1, 2, 3, 4, 5)) < 1e-12 * UNIT


def test_four_in_line() -> None:
    one = in_line(0, 180, 180, 0)
    for order in (2, 4, 6):
        assert amplitudes(force(one), one)[order] == pytest.approx(4 * abs(harmonic(order)) * UNIT, rel=1e-9)
    assert amplitudes(force(one), one)[1] < 1e-12 * UNIT
    assert np.abs(couple(one)).max() < 1e-12 * UNIT


def test_boxer_four() -> None:
    b = 0.04
    one = engine([0, 180, 180, 0], [0, 180, 0, 180], [1, 2, 3, 4], [0, b, A, A + b])
    for order in (2, 4, 6):
        assert amplitudes(couple(one), one)[order] == pytest.approx(2 * b * abs(harmonic(order)) * UNIT, rel=1e-9)
    assert amplitudes(couple(one), one)[1] < 1e-12 * UNIT
    assert np.abs(force(one)).max() < 1e-12 * UNIT


def test_v6_of_60_degrees() -> None:
    """Pins split against the banks, as even firing wants: forwards at one and four times, backwards at twice."""
    phases = [pin for at in (0.0, 240.0, 120.0) for pin in (at, at + 60)]
    one = engine(phases, [30, -30] * 3, [1, 1, 2, 2, 3, 3], [0, A, 2 * A])
    turned = couple(one)
    for n in (1, -2, 4):
        assert abs(part(turned, one, n)) == pytest.approx(1.5 * A * abs(harmonic(abs(n))) * UNIT, rel=1e-9)
        assert abs(part(turned, one, -n)) < 1e-12 * UNIT
    assert max(amplitudes(force(one), one)[k] for k in (1, 2, 4)) < 1e-12 * UNIT


def test_v8_of_90_degrees() -> None:
    throws = [0.0, 90.0, 270.0, 180.0]
    phases = [pin for at in throws for pin in (at, at)]
    one = engine(phases, [45, -45] * 4, [k for k in (1, 2, 3, 4) for _ in "ab"], [A * k for k in range(4)])
    turned = couple(one)
    assert abs(part(turned, one, 1)) == pytest.approx(math.sqrt(10) * A * UNIT, rel=1e-9)
    assert max(abs(part(turned, one, n)) for n in (-1, 2, -2)) < 1e-12 * UNIT
    four = [part(force(one), one, n) for n in (4, -4)]
    assert sum(map(abs, four)) == pytest.approx(4 * math.sqrt(2) * abs(harmonic(4)) * UNIT, rel=1e-9)
    assert abs(four[0]) == pytest.approx(abs(four[1]), rel=1e-9)  # in the plane of symmetry
    assert max(amplitudes(force(one), one)[k] for k in (1, 2)) < 1e-12 * UNIT


def test_radial_of_five() -> None:
    banks = [72.0 * k for k in range(5)]
    one = engine([0.0] * 5, banks, [1] * 5, [0.0])
    values = force(one)
    for n, order in ((1, 1), (-4, 4), (6, 6)):
        assert abs(part(values, one, n)) == pytest.approx(2.5 * abs(harmonic(order)) * UNIT, rel=1e-9)
        assert abs(part(values, one, -n)) < 1e-12 * UNIT
    assert amplitudes(values, one)[2] < 1e-12 * UNIT


@pytest.mark.parametrize("count", range(1, 13))
def test_arrows_of_a_row(count: int) -> None:
    """Evenly spaced throws of any number: forces and couples are sums of arrows exp(i k phase)."""
    phases = 2 * math.pi * np.arange(count) / count
    one = in_line(*np.degrees(phases))
    z = A * (np.arange(count) - (count - 1) / 2)
    forces, couples = amplitudes(force(one), one), amplitudes(couple(one), one)
    for order in (1, 2, 4, 6):
        arrows = np.exp(1j * order * phases)
        size = abs(harmonic(order)) * UNIT
        assert forces[order] == pytest.approx(size * abs(arrows.sum()), rel=1e-9, abs=1e-12 * UNIT)
        assert couples[order] == pytest.approx(size * abs((z * arrows).sum()), rel=1e-9, abs=1e-12 * UNIT)


@pytest.mark.parametrize("angle", [60.0, 90.0])
@pytest.mark.parametrize("throws", [1, 2, 4])
def test_arrows_of_a_v(throws: int, angle: float) -> None:
    phases = [90.0 * k for k in range(throws)]
    one = engine(
        [at for at in phases for _ in "ab"], [angle / 2, -angle / 2] * throws,
        [k + 1 for k in range(throws) for _ in "ab"], [A * k for k in range(throws)],
    )  # fmt: skip
    for n in (1, -1, 2, -2, 4, -4):
        banks = np.radians([angle / 2, -angle / 2])
        # a piston on the axis at bank b has the angle phi + phase - b from its own dead centre
        arrows = [np.exp(1j * (b + n * (math.radians(at) - b))) for at in phases for b in banks]
        wanted = abs(sum(arrows)) * abs(harmonic(abs(n))) * UNIT / 2
        assert abs(part(force(one), one, n)) == pytest.approx(wanted, rel=1e-9, abs=1e-12 * UNIT)


def test_lanchester_shafts_of_a_four() -> None:
    one = in_line(0, 180, 180, 0)
    done = balance(one, weights="none", shafts=(2,))
    left = amplitudes(done.after.force, one)
    assert left[2] < 1e-12 * UNIT
    assert left[4] == pytest.approx(4 * abs(harmonic(4)) * UNIT, rel=1e-9)
    assert {weight.order for weight in done.shafts} == {2, -2}
    # each shaft carries half of 4 m r A_2 / 4, since it turns twice as fast
    for sense in (2, -2):
        total = sum(weight.unbalance for weight in done.shafts if weight.order == sense)
        assert total == pytest.approx(M * R * harmonic(2) / 2, rel=1e-9)


def test_shafts_one_above_the_other_take_roll() -> None:
    """A pair of twice the crank's speed at x = +- h/2: h times half of the force that it balances."""
    one = in_line(0, 180, 180, 0)
    done = balance(one, weights="none", shafts=(2,), apart=0.05)
    assert done.before.roll is not None and done.after.roll is not None
    before, after = (amplitudes(roll, one)[2] for roll in (done.before.roll, done.after.roll))
    assert after < before
    added = done.after.roll - done.before.roll
    assert amplitudes(added, one)[2] == pytest.approx(0.05 * 4 * harmonic(2) * UNIT / 2, rel=1e-9)
    assert added == pytest.approx(amplitudes(added, one)[2] * np.sin(2 * one.phi) * np.sign(added[10]), abs=1e-9 * UNIT)
    assert amplitudes(done.after.force, one)[2] < 1e-12 * UNIT


def test_a_single_cylinder_keeps_half() -> None:
    one = in_line(0)
    done = balance(one)
    assert [weight.unbalance for weight in done.counterweights] == pytest.approx([M * R / 2], rel=1e-9)
    assert amplitudes(done.after.force, one)[1] == pytest.approx(UNIT / 2, rel=1e-9)


def test_weights_that_are_too_small_take_what_they_can() -> None:
    one = in_line(0, 240, 120)
    free = balance(one).counterweights[0].unbalance
    done = balance(one, largest=free / 2)
    assert max(weight.unbalance for weight in done.counterweights) <= free / 2 * (1 + 1e-9)
    whole = amplitudes(couple(one), one)[1]
    # of the part that turns with the crank, half of the whole, half is taken
    assert amplitudes(done.after.couple, one)[1] == pytest.approx(0.75 * whole, rel=1e-6)


def test_weights_for_the_bearings_shake_the_frame_no_more() -> None:
    one = in_line(0, 240, 120)
    frame, mains = balance(one, weights="webs"), balance(one, weights="webs", least="mains")
    largest = [max(journal.load.max() for journal in done.after.journals) for done in (frame, mains)]
    assert largest[1] < 0.999 * largest[0]
    for kind in ("force", "couple"):
        left = [amplitudes(getattr(done.after, kind), one)[1] for done in (frame, mains)]
        assert left[1] == pytest.approx(left[0], rel=1e-6, abs=1e-6 * UNIT * A)


def test_no_step_from_the_weights_for_the_bearings_lowers_their_peak() -> None:
    # the problem is convex: where no small step that leaves the frame as it is helps, none does
    one = in_line(0, 180, 180, 0)
    before, best = balance(one, weights="none").before, balance(one, weights="webs", least="mains").counterweights
    z = np.array([weight.z for weight in best])
    free = np.linalg.svd(np.array([np.ones(4), z]))[2][2:]  # neither a force nor a couple
    least, size = peak(one, before, best), max(weight.unbalance for weight in best)
    for direction in (*free, free[0] + free[1], free[0] - free[1]):
        for turned in np.exp(2j * math.pi * np.arange(8) / 8):
            vectors = [w.vector + 0.2 * size * turned * d for w, d in zip(best, direction, strict=True)]
            moved = [
                dataclasses.replace(w, unbalance=abs(v), angle=cmath.phase(v))
                for w, v in zip(best, vectors, strict=True)
            ]
            assert peak(one, before, moved) > 0.999 * least


def peak(one: Turn, before: Shaken, weights: Sequence[Weight]) -> float:
    return max(float(held.load.max()) for held in _with(one, before, weights, (), MainShaft()).journals)


def _turning(values: np.ndarray, times: int) -> np.ndarray:
    """Derivative of a periodic complex signal by the angle, by its spectrum."""
    orders = np.fft.fftfreq(len(values), 1 / len(values))
    return np.fft.ifft(np.fft.fft(values) * (1j * orders) ** times)


@pytest.mark.parametrize("seed", [*range(4), *(pytest.param(s, marks=pytest.mark.slow) for s in range(4, 30))])
def test_engines_of_any_kind_shake_as_their_masses_accelerate(seed: int) -> None:
    """Pins, banks, offsets, hung rods at random: places by complex numbers, differentiated by their spectrum."""
    g = np.random.default_rng(seed)
    throws, rows, count = int(g.integers(1, 8)), int(g.integers(1, 3)), 512
    n, hung = throws * rows, rows == 2 and g.random() < 0.5
    throw, phase = np.tile(np.arange(throws), rows), g.uniform(0, 2 * math.pi, n)
    master = np.tile(np.arange(throws), rows) if hung else np.zeros(n, int)
    phase[throws:] = phase[: n - throws] if hung else phase[throws:]
    spans = {"l1": (0.03, 0.06), "l2": (0.08, 0.12), "bank": (-1, 1), "offset": (-4e-3, 4e-3), "m_rod": (0.3, 0.8),
             "m_piston": (0.3, 0.9), "I_rod": (1e-3, 4e-3), "z_rod": (-0.01, 0.01)}  # fmt: skip
    spans |= {"knuckle": (0.01, 0.03), "knuckle_angle": (-0.5, 0.5)} if hung else {}
    p = {name: g.uniform(*span, n) for name, span in spans.items()} | {"phase": phase}
    p |= {name: g.uniform(*span, throws) for name, span in (("u0", (-0.05, 0.05)), ("u_phase", (0, 6)))}
    z, r, omega = np.cumsum(g.uniform(0.06, 0.12, throws)), g.uniform(0.02, 0.05), g.uniform(50, 600)
    hangs = tuple(int(m) + 1 if hung and i >= throws else 0 for i, m in enumerate(master))
    train = CrankTrainParameters(
        **{name: tuple(map(float, values)) for name, values in p.items()}, throw=tuple(int(t) + 1 for t in throw),
        z=tuple(map(float, z)), r=r, master=hangs, firing=(0.0,) * n, I0=0.01, I_f=0.1, k=1e5,
    )  # fmt: skip
    one = turn(crank_drive("crank_train", train), None, omega)
    phi, force, couple_, energy, swirl = 2 * math.pi * np.arange(count) / count, 0j, 0j, 0.0, 0.0
    for k in range(throws):
        pull = omega**2 * p["u0"][k] * np.exp(1j * (phi + p["u_phase"][k]))
        force, couple_ = force + pull, couple_ + (z[k] - (z[0] + z[-1]) / 2) * pull
    at = {}
    for i in range(n):
        way, start = np.exp(1j * p["bank"][i]), r * np.exp(1j * (phi + p["phase"][i]))
        if hangs[i]:
            pin, wrist = at[hangs[i] - 1]
            start = pin + p["knuckle"][i] * (wrist - pin) / abs(wrist - pin) * np.exp(1j * p["knuckle_angle"][i])
        length, own = p["l1"][i] + p["l2"][i], start / way
        wrist = (own.real + np.sqrt(length**2 - (own.imag - p["offset"][i]) ** 2) + 1j * p["offset"][i]) * way
        at[i] = start, wrist
        lever = z[throw[i]] + p["z_rod"][i] - (z[0] + z[-1]) / 2
        pointing = (wrist - start) / length
        for mass, place in (
            (p["m_rod"][i], start + p["l1"][i] * pointing),
            (p["m_piston"][i], wrist),
            (p["I_rod"][i], pointing),
        ):
            moved = omega**2 * _turning(place, 2)
            if place is not pointing:
                force, couple_ = force - mass * moved, couple_ - lever * mass * moved
            # a unit vector with the inertia as its mass turns as the rod does
            swirl = swirl + mass * (np.conj(place) * moved).imag
            energy = energy + mass * abs(omega * _turning(place, 1)) ** 2 / 2
    # the load is no part of the frame: it gives what the masses take of power at constant speed
    roll = -swirl + _turning(energy, 1).real
    before = balance(one, weights="none").before
    assert before.roll is not None
    for mine, its in ((before.force, force), (before.couple, couple_), (before.roll, roll)):
        for order in (*range(-12, 0), *range(1, 13)):
            wanted = np.mean(its * np.exp(-1j * order * phi))
            assert abs(part(mine, one, order) - wanted) < 1e-12 * max(np.abs(its).max(), 1e-9)
    held = [sum(getattr(journal, way) for journal in before.journals) for way in "xy"]
    for way, whole in zip("xy", held, strict=True):
        carried = -sum(one.reactions[f"main_bearing_force_{way}_{k + 1}"] for k in range(throws))
        assert throws == 1 or np.abs(whole - carried).max() < 1e-12 * np.abs(carried).max()


def test_bearings_without_places_are_refused() -> None:
    with pytest.raises(BadInput, match=r"give shaft\.bearings"):
        balance(in_line(0), least="mains")


def test_command(tmp_path: Path) -> None:
    words = ["balance", "zotov-89", "--weights", "none", "--shafts", "1,2", "--out", str(tmp_path), "--json"]
    done = CliRunner().invoke(mechsym, words, catch_exceptions=False)
    told = json.loads(done.output)
    assert told["before"]["force"]["1"] > 1e4
    assert told["after"]["force"]["1"] == told["after"]["force"]["2"] == 0
    assert told["after"]["force"]["4"] == pytest.approx(told["before"]["force"]["4"], rel=1e-12)
    assert told["before"]["force"]["4"] > 200
    heads = (tmp_path / "mounts.csv").read_text().splitlines()[0]
    assert heads.startswith("order [-],force_x_before [N]")
    assert "<svg" in (tmp_path / "report.html").read_text()


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["--shafts", "1.5"], "turn 1 to 4 times as fast"),
        (["--largest", "5 kg"], "kg*m"),
        (["--largest", "-1"], "more than 0"),
        (["--least", "mains"], "shaft.bearings"),
    ],
)
def test_bad_options(words: list[str], why: str) -> None:
    with pytest.raises(BadInput) as refused:
        CliRunner().invoke(mechsym, ["balance", "zotov-89", *words], catch_exceptions=False)
    assert why in str(refused.value)


@pytest.mark.parametrize(
    ("kind", "cylinders", "words"),
    [("inline", 4, "largest left: force of order 2, "), ("inline", 5, "largest left: couple of order 2, "),
     ("v", 8, "largest left: force of order 4, "), ("opposed", 3, "no force and no couple is left that shakes")],
)  # fmt: skip
def test_what_shakes_is_said_and_a_millionth_of_a_bearing_s_load_is_nothing(tmp_path, kind, cylinders, words):
    case = str(write_engine(kind, 0.09, 0.11 if kind == "opposed" else 0.088, cylinders, tmp_path)[0])
    text = CliRunner().invoke(mechsym, ["balance", case], catch_exceptions=False).output
    assert text.splitlines()[1].startswith(words)


def test_counterweights_of_a_new_v8_take_the_whole_first_order(tmp_path):
    case = str(write_engine("v", 0.096, 0.092, 8, tmp_path, gas="closed")[0])
    told = json.loads(CliRunner().invoke(mechsym, ["balance", case, "--json"], catch_exceptions=False).output)["before"]
    # it is written to six digits
    assert told["couple"].get("1", 0.0) < 1e-5 * told["main_bearing_max"] * 0.1
    assert told["force"].get("1", 0.0) == told["force"].get("2", 0.0) == 0.0
