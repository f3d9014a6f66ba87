"""Driven coordinates: two robots against Newton and Euler in maximal coordinates, words, files, what is refused."""

import inspect
import time
from pathlib import Path

import numpy as np
import pytest
import robots
from click.testing import CliRunner

from mechsym import cases, cli
from mechsym.cases.outcomes import of_motion
from mechsym.errors import BadInput
from mechsym.forces.driven import WORDS, numbers, rise_of
from mechsym.jobs.forces import motion
from mechsym.jobs.machine import mechanism_of
from mechsym.mechanisms import evaluate, loops, state

G = 9.81
SIX_BAR = Path(__file__).parents[2] / "examples" / "mechanisms" / "watt-six-bar.toml"


class Bodies:
    """Bodies with their centres' places and angles, pins and drives: M a = W + J' lam, J a = -gamma."""

    def __init__(self):
        self.mass, self.centre, self.pins, self.angle = [], [], [], {}

    def body(self, name, mass, inertia, centre, angle):
        self.angle[name] = angle
        self.mass += [mass, mass, inertia]
        self.centre.append(np.array([centre, 0.0]))

    def pin(self, name, first, second):
        """Points in the axes of two bodies; the frame's body is None."""
        self.pins.append((name, first, second))

    def point(self, X, end):
        """Place, slopes by (x, y, angle), and what the square of the turning speed adds."""
        name, at = end
        if name is None:
            return np.array(at), None, None, np.zeros(2)
        k = list(self.angle).index(name)
        c, s = np.cos(X[3 * k + 2]), np.sin(X[3 * k + 2])
        arm = np.array([[c, -s], [s, c]]) @ (np.array(at) - self.centre[k])
        return X[3 * k : 3 * k + 2] + arm, k, np.array([[1, 0, -arm[1]], [0, 1, arm[0]]]), -arm

    def rows(self, X, V, drives):
        gap, J, gamma = [], [], []
        for _, first, second in self.pins:
            (p, i, Ji, a), (r, j, Jj, b) = self.point(X, first), self.point(X, second)
            row = np.zeros((2, len(X)))
            for k, slope, sign in ((i, Ji, 1), (j, Jj, -1)):
                if k is not None:
                    row[:, 3 * k : 3 * k + 3] += sign * slope
            turn = [0.0 if k is None else V[3 * k + 2] ** 2 for k in (i, j)]
            gap.append(p - r), J.append(row), gamma.append(a * turn[0] - b * turn[1])
        for name, angle in drives:
            row = np.zeros((1, len(X)))
            row[0, 3 * list(self.angle).index(name) + 2] = 1
            gap.append([X[3 * list(self.angle).index(name) + 2] - angle]), J.append(row), gamma.append([0.0])
        return np.concatenate(gap), np.vstack(J), np.concatenate(gamma)

    def solve(self, X, driven, also=()):
        """Pose, accelerations, forces of the pins on their second bodies and torques.

        driven: (body, angle, speed, acceleration); also: (body, angle, speed) of what moves freely.
        """
        X, places = X.copy(), [(d[0], d[1]) for d in (*driven, *also)]
        for _ in range(50):
            gap, J, _ = self.rows(X, 0 * X, places)
            X -= np.linalg.solve(J, gap)
            if np.abs(gap).max() < 1e-15:
                break
        speeds = np.zeros(len(J))
        speeds[len(J) - len(places) :] = [d[2] for d in (*driven, *also)]
        V = np.linalg.solve(J, speeds)
        _, J, gamma = self.rows(X, V, [(d[0], d[1]) for d in driven])
        right = -gamma
        right[len(J) - len(driven) :] += [d[3] for d in driven]
        M, W = np.diag(self.mass), np.zeros(len(X))
        W[1::3] = -G * np.array(self.mass[1::3])
        K = np.block([[M, -J.T], [J, np.zeros((len(J), len(J)))]])
        solution = np.linalg.solve(K, np.concatenate([W, right]))
        lam = solution[len(X) :]
        forces = {}
        for k, (name, *_) in enumerate(self.pins):
            forces |= {f"R_x_{name}": -lam[2 * k], f"R_y_{name}": -lam[2 * k + 1]}
        torques = lam[len(J) - len(driven) :]
        return X, V, solution[: len(X)], forces, torques

    def energy(self, X, V):
        return 0.5 * np.dot(self.mass, V**2) + G * np.dot(self.mass[1::3], X[1::3])

    def guess(self):
        X = np.zeros(3 * len(self.angle))
        X[2::3] = [*self.angle.values()]
        return X


def rough(bodies, driven, also=()):
    """The pose that closes with the rough angles: places first, by least squares."""
    X = bodies.guess()
    places = [(d[0], d[1]) for d in (*driven, *also)]
    for _ in range(20):
        gap, J, _ = bodies.rows(X, 0 * X, places)
        straight = [k for k in range(len(X)) if k % 3 != 2]
        X[straight] -= np.linalg.lstsq(J[:, straight], gap, rcond=None)[0]
    return X


def five_bar():
    one = Bodies()
    for name, angle in (("left", 120), ("right", 60), ("left_rod", 50), ("right_rod", 130)):
        mass, centre, inertia, _ = robots.FIVE_BAR[name]
        one.body(name, mass, inertia, centre, np.radians(angle))
    long = {name: (values[3], 0.0) for name, values in robots.FIVE_BAR.items()}
    one.pin("O", (None, (0.0, 0.0)), ("left", (0.0, 0.0)))
    one.pin("Q", (None, (robots.BASE, 0.0)), ("right", (0.0, 0.0)))
    one.pin("A", ("left", long["left"]), ("left_rod", (0.0, 0.0)))
    one.pin("B", ("right", long["right"]), ("right_rod", (0.0, 0.0)))
    one.pin("P", ("left_rod", long["left_rod"]), ("right_rod", long["right_rod"]))
    return one, {"left_turn": "left", "right_turn": "right"}


def three_rrr():
    one = Bodies()
    for k in (1, 2, 3):
        for kind, angles in (("crank", robots.CRANK_POSE), ("rod", robots.ROD_POSE)):
            mass, centre, inertia, _ = robots.RRR[kind]
            one.body(f"{kind}{k}", mass, inertia, centre, np.radians(angles[k - 1]))
    one.body("platform", *robots.PLATFORM, 0.0, 0.0)
    for k, (x, y) in enumerate(robots.CORNERS, 1):
        one.pin(f"M{k}", (None, (robots.MOTORS * x, robots.MOTORS * y)), (f"crank{k}", (0.0, 0.0)))
        one.pin(f"A{k}", (f"crank{k}", (robots.RRR["crank"][3], 0.0)), (f"rod{k}", (0.0, 0.0)))
        one.pin(f"P{k}", (f"rod{k}", (robots.RRR["rod"][3], 0.0)), ("platform", (robots.PINS * x, robots.PINS * y)))
    return one, {f"q_{k}": f"crank{k}" for k in (1, 2, 3)}


ROBOTS = {
    "five_bar": (five_bar, {"left_turn": (120, 10, 1), "right_turn": (60, 8, 2)}),
    "three_rrr": (three_rrr, {"q_1": (249, 6, 1), "q_2": (9, 5, 2), "q_3": (129, 5, 3)}),
}


def written(folder, name, section, table=None, start=""):
    (folder / "robot.py").write_text(
        inspect.getsource(robots).partition("\ndef ")[0] + "\n\n" + inspect.getsource(getattr(robots, name))
    )
    if table is not None:
        (folder / "path.csv").write_text("\n".join(",".join(map(str, row)) for row in table) + "\n")
    text = f'mechanism = "./robot.py"\n[parameters]\ng = "{G} m/s^2"\n{start}[motion]\n{section}\n'
    (folder / "case.toml").write_text(text)
    return cases.load(str(folder / "case.toml"))


def path_of(name, rows=201):
    """A path of one second, in the degrees of the file."""
    curves, t = ROBOTS[name][1], np.linspace(0.0, 1.0, rows)
    columns = [mean + size * np.sin(2 * np.pi * order * t + order) for mean, size, order in curves.values()]
    return [["t [s]", *(f"{q} [deg]" for q in curves)], *np.column_stack([t, *columns]).tolist()]


@pytest.mark.parametrize("name", ROBOTS)
def test_torques_and_reactions_of_a_robot_on_a_path_are_newtons_and_eulers(tmp_path, name):
    case = written(tmp_path, name, 'file = "path.csv"\nperiodic = true', path_of(name))
    found = motion(case)
    table, (bodies, by) = found.columns, ROBOTS[name][0]()
    worst, X = 0.0, None
    for k in range(0, 1000, 10):
        driven = [(body, *(float(table[f"{q}{dots}"][k]) for dots in ("", "d", "dd"))) for q, body in by.items()]
        X = rough(bodies, driven) if X is None else X
        X, _, _, forces, torques = bodies.solve(X, driven)
        wanted = forces | {f"driving_{q}": v for q, v in zip(by, torques, strict=True)}
        worst = max(worst, *(abs(table[n][k] - v) for n, v in wanted.items()))
    assert worst < 1e-10 * max(np.abs(table[n]).max() for n in wanted)
    assert numbers(found, "case").power_residual < 1e-13


@pytest.mark.slow
@pytest.mark.parametrize("name", ROBOTS)
def test_a_thousand_points_take_a_fifth_of_a_second(tmp_path, name):
    from mechsym.mechanisms import driven

    found = motion(written(tmp_path, name, 'file = "path.csv"\nperiodic = true', path_of(name)))
    one, table = found.one, found.columns
    state = [np.array([table[f"{q}{dots}"] for q in one.driven]) for dots in ("", "d", "dd")]
    start = {q: table[q][0] for q in one.mechanism.coordinates}
    inputs, took = [0.0] * len(one.mechanism.inputs), []
    for _ in range(3):
        began = time.process_time()
        path = driven.path(one, lambda t: tuple(state), table["t"], start, inputs)
        driven.outputs(one, path, inputs)
        took.append(time.process_time() - began)
    assert min(took) < 0.2


def test_the_spline_of_a_file_follows_the_curve_behind_its_points(tmp_path):
    table = motion(written(tmp_path, "five_bar", 'file = "path.csv"\nperiodic = true', path_of("five_bar"))).columns
    for q, (mean, size, order) in ROBOTS["five_bar"][1].items():
        angle = 2 * np.pi * order * table["t"] + order
        wanted = np.radians(mean + size * np.sin(angle))
        np.testing.assert_allclose(table[q], wanted, atol=1e-9)
        bent = -np.radians(size) * (2 * np.pi * order) ** 2 * np.sin(angle)
        np.testing.assert_allclose(table[f"{q}dd"], bent, atol=2e-5 * np.abs(bent).max())


def test_what_nothing_drives_moves_freely(tmp_path):
    section = 'left_turn = "cycloid"\nrise = "-20 deg"\nduration = "0.15 s"\nt_end = "0.15 s"'
    case = written(tmp_path, "five_bar", section, start='[start]\nleft_turn = "120 deg"\nright_turn = "60 deg"\n')
    found = motion(case)
    table, (bodies, _) = found.columns, five_bar()
    assert (found.one.driven, found.one.free) == (("left_turn",), ("right_turn",))
    energies, X = [], None
    for k in range(0, 1000, 37):
        driven = [("left", *(float(table[f"left_turn{dots}"][k]) for dots in ("", "d", "dd")))]
        also = [("right", *(float(table[f"right_turn{dots}"][k]) for dots in ("", "d")))]
        X, V, A, forces, (torque,) = bodies.solve(rough(bodies, driven, also) if X is None else X, driven, also)
        assert table["right_turndd"][k] == pytest.approx(A[5], rel=1e-10)
        assert table["driving_left_turn"][k] == pytest.approx(torque, rel=1e-9)
        assert table["R_x_P"][k] == pytest.approx(forces["R_x_P"], rel=1e-9)
        energies.append(bodies.energy(X, V))
    gained = energies[-1] - energies[0]  # 999 = 27 * 37; at rest at first, then moved by the drive and by its weight
    assert numbers(found, "case").work["left_turn"] == pytest.approx(gained, rel=1e-9)


@pytest.mark.parametrize("word", WORDS)
def test_a_word_goes_from_rest_to_rest_with_its_slopes(word):
    x = np.linspace(0, 1, 4001)
    s, ds, dds = rise_of(word)(x)
    assert (s[0], s[-1], ds[0], ds[-1]) == pytest.approx((0, 1, 0, 0), abs=1e-14)
    assert (dds[0], dds[-1]) == pytest.approx((0, 0), abs=1e-12)
    for value, slope in ((s, ds), (ds, dds)):
        middle = (value[2:] - value[:-2]) / (x[2] - x[0])
        np.testing.assert_allclose(middle, slope[1:-1], atol=6e-3 * np.abs(slope).max())
    # textbook: largest accelerations of a rise 1 in the time 1
    peaks = {
        "cycloid": 2 * np.pi,
        "3-4-5": 10 / np.sqrt(3),
        "4-5-6-7": 84 * np.sqrt(5) / 25,
        "modified sine": 4 * np.pi**2 / (4 + np.pi),
        "trapezium": 16 / 3,
    }
    assert np.abs(dds).max() == pytest.approx(peaks[word], rel=1e-6)


REFUSED = {
    "nothing is driven": ("", None, "drives nothing; give one of left_turn, right_turn"),
    "a word is not known": ('left_turn = "cycloyd"', None, "neither a speed.*did you mean 'cycloid'"),
    "a word has no rise": ('left_turn = "cycloid"\nduration = 1', None, "needs motion.rise, in rad"),
    "a rise has another unit": ('left_turn = "cycloid"\nduration = 1\nrise = "3 mm"', None, "motion.rise"),
    "a speed has another unit": ('left_turn = "3 m/s"', None, "motion.left_turn"),
    "an output is driven": ('tip_x = "1 m/s"', None, "key motion.tip_x is not known"),
    "a coordinate twice": ('file = "path.csv"\nleft_turn = "1 rpm"', "path", "stands in the section and in"),
    "a column is not known": ('file = "path.csv"', [["t [s]", "left [deg]"], [0, 1]], "is no time t and no coordinate"),
    "no time": ('file = "path.csv"', [["left_turn [deg]"], [0]], "has the columns t"),
    "few rows": ('file = "path.csv"', [["t [s]", "left_turn [deg]"], [0, 120], [1, 121]], "at least 7 rows"),
    "time falls": ('file = "path.csv"', [["t", "left_turn"], *([t % 8, 2] for t in range(9))], "must rise"),
    "no number": ('file = "path.csv"', [["t", "left_turn"], [0, 2], [1, "nan"]], "not finite"),
    "no repeat": ('file = "path.csv"\nperiodic = true', [["t", "left_turn"], *([t, 2 + t / 9] for t in range(9))],
                  "does not repeat"),
    "beyond the file": ('file = "path.csv"\nt_end = 20', "path", "after the last row"),
    "few points": ('left_turn = "1 rpm"\npoints = 3', None, "points"),
    "out of reach": ('left_turn = "cycloid"\nrise = "80 deg"\nduration = 1\nright_turn = "-40 deg/s"', None,
                     "opens or locks at t = 0"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_driven_is_refused_in_one_line(tmp_path, what):
    section, table, words = REFUSED[what]
    start = '[start]\nleft_turn = "120 deg"\nright_turn = "60 deg"\n'
    with pytest.raises(BadInput, match=words) as error:
        motion(written(tmp_path, "five_bar", section, path_of("five_bar") if table == "path" else table, start))
    assert "\n" not in str(error.value)


def test_a_path_through_a_dead_point_of_a_loop_is_refused(tmp_path):
    section = 'q_1 = "cycloid"\nrise = "150 deg"\nduration = "1 s"\nq_2 = "0 rpm"\nq_3 = "0 rpm"'
    start = '[start]\nq_1 = "249 deg"\nq_2 = "9 deg"\nq_3 = "129 deg"\n'
    with pytest.raises(BadInput, match="dead point|opens or locks"):
        motion(written(tmp_path, "three_rrr", section, start=start))


def test_more_drives_than_freedoms_are_refused(tmp_path):
    section = "\n".join(f'{q} = "1 rpm"' for q in ("q_1", "q_2", "q_3", "theta_rod1"))
    with pytest.raises(BadInput, match="4 drives .* for 3 degrees of freedom"):
        motion(
            written(tmp_path, "three_rrr", section, start='[start]\nq_1 = "249 deg"\nq_2 = "9 deg"\nq_3 = "129 deg"\n')
        )


def test_a_link_that_a_loop_holds_may_be_driven(tmp_path):
    first = motion(written(tmp_path, "three_rrr", 'file = "path.csv"\nperiodic = true', path_of("three_rrr")))
    table = first.columns
    names = ("q_1", "q_2", "theta_rod3")
    rows = [["t", *names], *np.column_stack([table["t"], *(table[q] for q in names)]).tolist()]
    start = f'[start]\nq_3 = "{table["q_3"][0]} rad"\n'
    second = motion(written(tmp_path, "three_rrr", 'file = "path.csv"\nperiodic = true', rows, start=start))
    assert second.one.dependents != first.one.dependents
    np.testing.assert_allclose(second.columns["q_3"], table["q_3"], atol=1e-9)
    # the same motion, driven elsewhere, takes the same power
    powers = [sum(found.columns[f"power_{q}"] for q in found.one.driven) for found in (first, second)]
    np.testing.assert_allclose(*powers, atol=1e-5 * np.abs(powers[0]).max())


def test_a_state_with_its_accelerations_tells_the_same_forces(tmp_path):
    found = motion(written(tmp_path, "three_rrr", 'file = "path.csv"\nperiodic = true', path_of("three_rrr")))
    table, mechanism = found.columns, found.one.mechanism
    letters = [f"q_{k}{dots}" for k in (1, 2, 3) for dots in ("", "d", "dd")]
    at = state(mechanism, {n: float(table[n][250]) for n in letters})
    for name, value in at.outputs.items():
        assert value == pytest.approx(table[name][250], rel=1e-9, abs=1e-10), name
    free = state(mechanism, {n: float(table[n][250]) for n in letters if n != "q_3dd"})
    assert "driving_q_3" not in free.outputs
    assert at.outputs["driving_q_1"] != pytest.approx(free.outputs["driving_q_1"], rel=1e-3)


def test_a_loop_closed_by_constraint_tells_the_inertia_that_its_crank_feels():
    case = cases.load(str(SIX_BAR))
    mechanism = mechanism_of(case)
    reduced = loops.reduced(mechanism)[0]
    told = state(mechanism, {"phi": 0.7}).outputs
    wanted = evaluate(reduced, "kinematics", phi=0.7)
    for name in ("inertia", "dinertia_dphi"):
        assert told[name] == pytest.approx(float(wanted[name][0]), rel=1e-12)
    slope = [state(mechanism, {"phi": 0.7 + step}).outputs["inertia"] for step in (-1e-5, 1e-5)]
    assert told["dinertia_dphi"] == pytest.approx((slope[1] - slope[0]) / 2e-5, rel=1e-7)


@pytest.mark.parametrize("options, words", [
    (["zotov-89", "--set", "motion.phi=60 rpm"], "a motion takes no [cycle]; leave [cycle] or [motion] out"),
    (["chmielewski", "--set", "motion.phi2=60 rpm"], "a motion takes no [drive]; leave [drive] or [motion] out"),
    ([str(SIX_BAR), "--set", "motion.phi=60 rpm", "--comparison"], "--comparison: is for a turn"),
])  # fmt: skip
def test_a_motion_takes_nothing_of_a_turn(options, words):
    ran = CliRunner().invoke(cli.mechsym, ["forces", *options])
    assert words in str(ran.exception)
    assert isinstance(ran.exception, BadInput)


BOTH = 'left_turn = "cycloid"\nright_turn = "cycloid"\n'


@pytest.mark.parametrize("section, doubted", [
    ('rise = 13\nduration = "60 s"', "angle"),  # degrees were meant: more than two turns
    ('rise = "10 deg"\nduration = "0.8 ms"', "point_speed link_stress"),  # 2 * 0.1745 rad / 0.8 ms * 0.25 m = 109 m/s
    ('rise = "10 deg"\nduration = "1 s"\nt_end = "60 s"\npoints = 100', "sampling"),
    ('rise = "10 deg"\nduration = "1 s"\npoints = 100', ""),
])  # fmt: skip
def test_a_motion_is_judged_by_how_far_and_how_fast_it_goes(tmp_path, section, doubted):
    case = written(tmp_path, "five_bar", BOTH + section)
    found = motion(case)
    assert {d.code for d in of_motion(case, found)} == set(doubted.split())
    assert "points" not in section or len(found.columns["t"]) == 100


@pytest.mark.parametrize("section, words", [
    ('left_turn = "30 rpm"\nperiodic = true', "motion.periodic is for a file"),
    ('left_turn = "30 rpm"\nrise = 1', "motion.rise is for 'cycloid'"),
    (BOTH + 'rise = 1\nduration = "1 s"\npoints = 100.5', "no whole number"),
])  # fmt: skip
def test_what_a_motion_does_not_read_is_refused(tmp_path, section, words):
    with pytest.raises(BadInput, match=words):
        motion(written(tmp_path, "five_bar", section))
