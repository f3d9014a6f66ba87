"""Rods that hang on other rods in a crank train: places by hand, power, momentum, and the declared V-twin."""

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.forces.balance import balance, part
from mechsym.forces.loads import loads, power_residual
from mechsym.forces.mains import MainShaft, journals
from mechsym.forces.turn import at, crank_drive, turn
from mechsym.jobs.machine import turn as turn_of
from mechsym.mechanisms.crank_train import build, build_rigid
from mechsym.mechanisms.crank_train.firing import even_firing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, dead_centre, local_shift
from mechsym.mechanisms.drawn_parts import Line
from mechsym.mechanisms.record import evaluate
from mechsym.mechanisms.train_drawing import crank_train

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
DEG = math.pi / 180
R, ROD, A, SHORT, ANGLE = 0.05, 0.18, 0.05, 0.135, 60 * DEG


def v_engine(**changes):
    """Two throws, each with a master and a slave rod, on unequal offsets and with masses everywhere."""
    values = {
        "throw": (1, 1, 2, 2), "phase": (0.3, 0.3, 2.3, 2.3), "bank": (0.5, 0.5 - ANGLE) * 2, "r": R,
        "l1": (0.06, 0.04) * 2, "l2": (ROD - 0.06, SHORT - 0.04) * 2, "offset": (0.004, -0.003) * 2,
        "m_rod": (0.7, 0.4) * 2, "m_piston": (0.5, 0.45) * 2, "I_rod": (3e-3, 1e-3) * 2, "master": (0, 1, 0, 3),
        "knuckle": A, "knuckle_angle": -55 * DEG, "I0": 0.02, "m0": 1.5, "u0": 0.01, "u_phase": 0.4, "I_f": 0.3,
        "k": 1e5, "g": 9.81, "axis_tilt": 1.2, "z": (0.0, 0.1), "z_rod": (0.0, 0.0) * 2,
    }  # fmt: skip
    return CrankTrainParameters(**(values | changes))


def places(phi, sense=1.0, phase=0.3, bank=0.5):
    """Knuckle pin and both piston pins of the first throw, x + iy in the frame, by crossing circles with lines."""
    pin = R * np.exp(1j * sense * (phi + phase))

    def beyond(start, length, axis, offset):
        along = np.exp(1j * axis)
        seen = (start - 1j * sense * offset * along) * np.conj(along)
        return (seen.real + np.sqrt(length**2 - seen.imag**2) + 1j * sense * offset) * along

    master = beyond(pin, ROD, bank, 0.004)
    knuckle = pin + A * (master - pin) / ROD * np.exp(1j * -55 * DEG)
    return knuckle, master, beyond(knuckle, SHORT, bank - ANGLE, -0.003)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_travel_by_hand(sense):
    mechanism = build_rigid(v_engine(sense=sense))
    phi = np.arange(720) * 2 * np.pi / 720
    found = evaluate(mechanism, "kinematics", phi=phi)
    pistons = places(phi, sense)[2] * np.exp(-1j * (0.5 - ANGLE))
    travel = found["x_2"]
    assert travel + pistons.real == pytest.approx(np.full(720, pistons.real[0] + travel[0]), abs=1e-14)
    assert travel.min() > -1e-15
    orders = np.fft.rfft(travel) * 1j * np.arange(361)
    assert found["dx_2_dphi"] == pytest.approx(np.fft.irfft(orders), abs=1e-12 * R)


def test_it_fires_at_its_own_dead_centre():
    one = v_engine()
    mechanism = build_rigid(one)
    for i, fires in enumerate(even_firing(one, 2 * math.pi), 1):
        top = evaluate(mechanism, "kinematics", phi=np.array([fires]))
        assert top[f"x_{i}"] == pytest.approx(0, abs=1e-12)
        assert top[f"dx_{i}_dphi"] == pytest.approx(0, abs=1e-12)
    # a slave's own is not where its crank points to its head
    assert abs(dead_centre(one)[1]) > 0.5 * DEG and len(local_shift(one)) == 4


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_power_and_momentum(sense):
    """At a speed that is held: forces on pins give the power, those on the frame the momentum."""
    one = v_engine(sense=sense)
    drive = crank_drive("crank_train", one)
    plain = turn(drive, None, 200.0)
    pushed = {f"F{i}": 1e4 * (1 + np.cos(plain.phi - i)) for i in (1, 2, 3, 4)}
    done = at(drive, None, 200.0, plain.phi, held=pushed)
    assert power_residual(done, loads(done)) < 1e-12
    assert np.abs(done.torque + done.driving).max() < 1e-9 * np.abs(done.torque).max()
    R = done.reactions
    frame = sum(R[f"main_bearing_force_x_{k}"] + 1j * R[f"main_bearing_force_y_{k}"] for k in (1, 2))
    mass = 2 * (0.7 + 0.4 + 0.5 + 0.45) + 2 * 1.5
    frame = frame + mass * 9.81 * (-np.sin(1.2) - 1j * np.cos(1.2))
    for i, bank in enumerate((0.5, 0.5 - ANGLE) * 2, 1):
        frame = frame + (1j * sense * R[f"side_force_{i}"] - pushed[f"F{i}"]) * np.exp(1j * bank)
    rate = done.momentum["momentum_rate_x"] + 1j * done.momentum["momentum_rate_y"]
    assert np.abs(frame - rate).max() < 1e-10 * np.abs(rate).max()


def test_energy_is_that_of_the_places():
    one = v_engine(m0=0.0, u0=0.0, g=0.0)
    mechanism, h, u = build_rigid(one), 1e-6, 150.0
    phi = 1.1

    def bodies(at):
        total = []
        for phase in (0.3, 2.3):
            knuckle, master, slave = places(at, phase=phase)
            pin = 0.05 * np.exp(1j * (at + phase))
            rods = pin + 0.06 * (master - pin) / ROD, knuckle + 0.04 * (slave - knuckle) / SHORT
            turns = np.angle(master - pin), np.angle(slave - knuckle)
            total += [
                (0.7, rods[0], 3e-3, turns[0]),
                (0.4, rods[1], 1e-3, turns[1]),
                (0.5, master, 0, 0),
                (0.45, slave, 0, 0),
            ]
        return total

    energy = (2 * 0.02 + 0.3) * u**2 / 2
    for after, before in zip(bodies(phi + h), bodies(phi - h), strict=True):
        speed, turning = (after[1] - before[1]) * u / (2 * h), (after[3] - before[3]) * u / (2 * h)
        energy += after[0] * abs(speed) ** 2 / 2 + after[2] * turning**2 / 2
    found = evaluate(mechanism, "energy", phi=phi, phid=u)["kinetic_energy"]
    assert found == pytest.approx(energy, rel=1e-9)


def test_a_knuckle_pin_at_the_crank_pin_is_two_rods_side_by_side():
    short = {"l1": (0.06, 0.06) * 2, "l2": (0.12, 0.12) * 2}
    hung = turn(crank_drive("crank_train", v_engine(knuckle=0.0, **short)), None, 200.0)
    beside = turn(crank_drive("crank_train", v_engine(master=0.0, **short)), None, 200.0)
    for name in ("main_bearing_force_x_1", "main_bearing_force_y_2", "side_force_2", "side_force_1"):
        assert hung.reactions[name] == pytest.approx(
            beside.reactions[name], abs=1e-9 * np.abs(hung.reactions[name]).max()
        )
    both = beside.reactions["pin_force_x_1"] + beside.reactions["pin_force_x_2"]
    assert hung.reactions["pin_force_x_1"] == pytest.approx(both, abs=1e-9 * np.abs(both).max())


def test_elastic_and_rigid_shaft_agree():
    one = v_engine()
    names = {f"phi{k}": 0.7 for k in (1, 2)} | {"phi_f": 0.7}
    elastic = evaluate(build(one), "kinematics", **names)
    rigid = evaluate(build_rigid(one), "kinematics", phi=0.7)
    assert elastic["x_4"] == pytest.approx(rigid["x_4"], rel=1e-14)


def test_mains_carry_what_hangs():
    done = turn(crank_drive("crank_train", v_engine()), None, 250.0)
    throws = -sum(done.reactions[f"main_bearing_force_x_{k}"] for k in (1, 2))
    total = sum(journal.x for journal in journals(done, MainShaft()))
    assert np.abs(total - throws).max() <= 1e-12 * np.abs(throws).max() + 1e-9


def test_a_radial_of_five_shakes_twice_a_turn():
    """Concentric rods leave nothing of order 2; a master rod with four slaves does (the page of the engine office)."""
    banks = tuple(72 * DEG * k for k in range(5))
    shared = {"throw": (1,) * 5, "phase": 0.0, "bank": banks, "r": R, "m_rod": 0.0, "I_rod": 0.0, "m_piston": 0.5,
              "I0": 1e-3, "I_f": 0.1, "k": 1e5}  # fmt: skip
    alike = CrankTrainParameters(l1=0.06, l2=0.12, **shared)
    hung = CrankTrainParameters(
        l1=0.06, l2=(0.12, *(0.12 - A,) * 4), master=(0, 1, 1, 1, 1), knuckle=A, knuckle_angle=banks, **shared
    )
    left = []
    for train in (alike, hung):
        one = turn(crank_drive("crank_train", train), None, 200.0)
        force = balance(one, weights="none").before.force
        left.append(max(abs(part(force, one, n)) for n in (2, -2)) / (0.5 * R * 200.0**2))
    assert left[0] < 1e-12 and left[1] > 1e-3


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"master": (0, 5, 0, 3)}, "is no rod on a crank pin; those are 1, 3"),
        ({"master": (0, 1, 0, 2)}, "is no rod on a crank pin; those are 1, 3"),
        ({"master": (0, 3, 0, 3)}, "the same throw and phase"),
    ],
)
def test_wrong_masters(changes, why):
    with pytest.raises(BadInput, match=why):
        v_engine(**changes)


@pytest.mark.slow
def test_the_declared_v_twin():
    """The example is derived from its links and pins: the same numbers by another way."""
    case = cases.load(str(EXAMPLES / "v-twin.toml"))
    case = dataclasses.replace(case, sections={k: v for k, v in case.sections.items() if k != "cycle"})
    wanted, p = turn_of(case), case.need("parameters")
    train = CrankTrainParameters(
        throw=(1, 1), phase=0.0, bank=(0.0, p.v), r=p.r, l1=(p.l / 3, p.l2 / 2), l2=(2 * p.l / 3, p.l2 / 2),
        m_rod=(p.m_rod, p.m_rod / 2), I_rod=(p.I_rod, p.I_rod / 3), m_piston=p.m_p, master=(0, 1), knuckle=p.ra,
        knuckle_angle=p.v, I0=p.I, I_f=1e-9, k=1e5,
    )  # fmt: skip
    found = turn(crank_drive("crank_train", train), None, wanted.omega)
    for mine, its in (("pin_force_x_1", "R_x_A"), ("pin_force_y_1", "R_y_A"), ("knuckle_force_x_2", "R_x_K")):
        size = np.abs(wanted.reactions[its]).max()
        assert np.abs(found.reactions[mine] - wanted.reactions[its]).max() < 1e-10 * size
    assert found.torque == pytest.approx(wanted.torque, abs=1e-10 * np.abs(wanted.torque).max())


def test_the_drawing_stands_where_the_pins_are():
    two = {"throw": (1, 1), "phase": 0.3, "bank": (0.5, 0.5 - ANGLE), "master": (0, 1), "z": 0.0, "z_rod": 0.0}
    two |= {n: getattr(v_engine(), n)[:2] for n in ("l1", "l2", "offset", "m_rod", "m_piston", "I_rod")}
    drawn = list(crank_train(v_engine(**two), 0.7, None))
    ends = [point for line in drawn if isinstance(line, Line) and line.role == "rod" for point in line.points]
    found = np.array([complex(*point) for point in ends])
    for wanted in places(0.7):  # the shaft stands upright: its axis is the drawing's y
        assert np.abs(found - 1j * wanted).min() < 1e-12
