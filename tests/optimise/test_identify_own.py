"""Parameters of mechanisms in files of one's own; the truth comes from geometry and work written out by hand."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import solve_ivp

from mechsym import cases, jobs
from mechsym.cli import mechsym
from mechsym.errors import BadInput

BAR = """from mechsym.derive import Mechanism


def bar():
    m = Mechanism("bar")
    phi = m.coordinates("phi")
    a, b, c, d, unseen = m.parameters("a b c d unseen", "m", above=0)
    m2, m3 = m.parameters("m2 m3", "kg", low=0)
    I1, I2, I3 = m.parameters("I1 I2 I3", "kg*m^2", above=0)
    k = m.parameters("k", "N*m*s/rad", low=0)
    M, W = m.inputs("M W", "N*m")
    crank = m.link("crank", turns=phi, inertia=I1)
    rod = m.link("rod", mass=m2, centre=(b / 2, 0), inertia=I2)
    rocker = m.link("rocker", mass=m3, centre=(c / 2, 0), inertia=I3)
    m.pin("A", m.frame, crank)
    m.pin("B", crank.at(a), rod)
    m.pin("D", m.frame.at(d), rocker)
    m.pin("C", rod.at(b), rocker.at(c), branch=1)
    m.torque(M, along=phi)
    m.torque(W, along=phi)
    m.damper(k, stretch=rocker.angle)
    m.draw_line((0, 0), (unseen, 0))
    m.rotor("crank", angle=phi, drive=M)
    return m
"""
CASE = """mechanism = "./bar.py"
[parameters]
a = 0.1
b = 0.35
c = 0.25
d = 0.3
unseen = 0.1
m2 = 1.0
m3 = 1.0
I1 = {I1}
I2 = 0.01
I3 = 0.01
k = {k}
[drive]
torque = "2 N*m"
[inputs]
W = 0.5
[simulation]
t_end = "1 s"
"""
I1, K, TORQUE = 0.1, 0.3, 2.5  # of drive and constant together


def poses(phi, a=0.1, b=0.35, c=0.25, d=0.3):
    """Angles of rod and rocker and centres of the four-bar, with the pin C on the left of the way from B to D."""
    B, D = a * np.exp(1j * phi), d
    way = D - B
    share = (b**2 - c**2 + abs(way) ** 2) / (2 * abs(way))
    C = B + way / abs(way) * (share + 1j * np.sqrt(b**2 - share**2))
    return np.array([np.angle(C - B), np.angle(C - D), *_parts((B + C) / 2), *_parts((D + C) / 2)])


def _parts(z):
    return z.real, z.imag


def inertia(phi, step=1e-5):
    """Reduced inertia and the rocker's turn by the crank's; five-point differences."""
    at = [poses(phi + n * step) for n in (-2, -1, 1, 2)]
    slope = (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * step)
    return I1 + 0.01 * slope[0] ** 2 + 0.01 * slope[1] ** 2 + np.sum(slope[2:] ** 2), slope[1]


def motion(t, y):
    J, rocker = inertia(y[0])
    dJ = (inertia(y[0] + 1e-3)[0] - inertia(y[0] - 1e-3)[0]) / 2e-3
    return [y[1], (TORQUE - K * rocker**2 * y[1] - dJ * y[1] ** 2 / 2) / J]


@pytest.fixture(autouse=True)
def working_folder(tmp_path, monkeypatch):
    """The folder of all that a test writes: what lies below it is the user's own."""
    monkeypatch.chdir(tmp_path.parent)


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    """Folder with declaration, case whose values are off, and a trace with noise of 0.02 rad/s."""
    folder, t = tmp_path_factory.mktemp("bench"), np.linspace(0, 1, 151)
    (folder / "bar.py").write_text(BAR)
    (folder / "bar.toml").write_text(CASE.format(I1=0.16, k=0.1))
    speed = solve_ivp(motion, (0, 1), [0.4, 12.0], rtol=1e-8, atol=1e-8, t_eval=t).y[1]
    rows = np.column_stack([t, speed + np.random.default_rng(7).normal(0, 0.02, len(t))])
    np.savetxt(folder / "trace.csv", rows, delimiter=",", header="t [s],phid [rad/s]", comments="")
    return folder


def identified(bench, *words, trace="trace.csv"):
    line = ["identify", str(bench / "bar.toml"), "--trace", str(bench / trace), "--json", *words]
    return CliRunner().invoke(mechsym, line)


def test_inertia_and_damping_of_a_four_bar_come_back_within_their_intervals(bench):
    done = identified(bench, "--free", "I1,k", "--set", "simulation.phi_start=0.4")
    found = json.loads(done.stdout)
    for name, true in (("I1", I1), ("k", K)):
        estimate = found["parameters"][name]
        assert estimate["low"] < true < estimate["high"] and estimate["high"] - estimate["low"] < 0.1 * true
    assert done.exit_code == 0 and found["noise"] == pytest.approx(0.02, rel=0.2)


def test_a_length_is_found_though_the_loop_opens_on_the_way(bench):
    words = ("--free", "b", "--set", "b=0.42", "--set", f"I1={I1}", "--set", f"k={K}")
    estimate = json.loads(identified(bench, *words).stdout)["parameters"]["b"]
    assert estimate["low"] < 0.35 < estimate["high"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--free", "unseen"), "no motion shows unseen: "),
        (("--free", "m2,m3,I1,I2,I3"), "the trace does not determine m2, m3, I1, I2, I3: "),
        (("--free", "I1", "--set", "a=2"), "a loop is open at phi = 0, where the search starts, "),
        (("--free", "I1", "--set", "a=0.5"), "a loop is open on the way that the trace tells from phi = 0 "),
    ],
)
def test_what_cannot_be_found_is_told_in_one_line(bench, words, told):
    error = identified(bench, *words).exception
    assert isinstance(error, BadInput) and "\n" not in str(error)
    assert str(error).startswith(str(bench / "trace.csv")) and told in str(error)


SLED = """from mechsym.derive import Mechanism


def sled():
    m = Mechanism("sled")
    x = m.coordinates("x", "m")
    mass = m.parameters("mass", "kg", above=0)
    k = m.parameters("k", "N/m", low=0)
    m.body("block", mass=mass, at=(x, 0))
    m.spring(k, stretch=x)
    return m
"""


def test_a_coordinate_may_be_a_length(tmp_path):
    (tmp_path / "sled.py").write_text(SLED)
    case, trace = tmp_path / "sled.toml", tmp_path / "trace.csv"
    case.write_text('mechanism = "./sled.py"\n[parameters]\nmass = 2.0\nk = 200.0\n')
    t = np.linspace(0, 2, 201)
    rate, damping = np.sqrt(300 / 2 - (1.5 / 4) ** 2), 1.5 / 4
    speed = np.exp(-damping * t) * np.cos(rate * t)
    noisy = speed + np.random.default_rng(3).normal(0, 0.005, len(t))
    np.savetxt(trace, np.column_stack([t, noisy]), delimiter=",", header="t [s],xd [m/s]", comments="")
    words = ["identify", str(case), "--trace", str(trace), "--free", "k,friction.viscous", "--json"]
    found = json.loads(CliRunner().invoke(mechsym, words, catch_exceptions=False).stdout)["parameters"]
    for name, true, unit in (("k", 300, "N/m"), ("friction.viscous", 1.5, "N*s/m")):
        assert found[name]["low"] < true < found[name]["high"] and found[name]["unit"] == unit


def test_the_card_of_a_sliding_run_has_metres_a_second(tmp_path):
    (tmp_path / "sled.py").write_text(SLED)
    case = tmp_path / "sled.toml"
    start, run = "[start]\nx = 0.0\nxd = 2.0\n", '[simulation]\nt_end = "0.5 s"\n'
    case.write_text(f'mechanism = "./sled.py"\n[parameters]\nmass = 2.0\nk = 0.0\n{start}{run}')
    _, speed = jobs.run(cases.load(str(case)), check="none").view.cards
    assert (speed.name, speed.value) == ("speed of x", "steady at 2 m/s")


def test_the_table_of_a_run_of_its_own_is_read_back(tmp_path):
    (tmp_path / "sled.py").write_text(SLED)
    case = tmp_path / "sled.toml"
    case.write_text(
        'mechanism = "./sled.py"\n[parameters]\nmass = 2.0\nk = 200.0\n[start]\nx = 0.1\n[simulation]\nt_end = "1 s"\n'
    )
    run = CliRunner().invoke(mechsym, ["simulate", str(case), "--out", str(tmp_path / "run")], catch_exceptions=False)
    series = tmp_path / "run" / "series.csv"
    assert series.read_text().startswith("t [s],x [m],xd [m/s],") and "mean [m/s]" in run.stdout
    words = ["identify", str(case), "--trace", str(series), "--free", "mass", "--set", "mass=2.5", "--json"]
    found = json.loads(CliRunner().invoke(mechsym, words, catch_exceptions=False).stdout)
    assert found["parameters"]["mass"]["value"] == pytest.approx(2, rel=1e-5)


def test_a_crank_train_is_refused_in_one_line(bench):
    words = ["identify", "opposed-pistons", "--trace", str(bench / "trace.csv"), "--free", "r"]
    error = CliRunner().invoke(mechsym, words).exception
    assert isinstance(error, BadInput) and "case opposed-pistons: crank_train is put together" in str(error)
