"""The swash-plate engine in space by hand formulas, what cannot be declared, and docs/space.md."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mechsym.derive import Mechanism, derive
from mechsym.errors import BadInput
from mechsym.mechanisms.record import bind
from mechsym.mechanisms.state import state

ROOT = Path(__file__).parents[2]
P = dict(R=0.06, offset=0.08, tilt=0.35, m_p=0.3, m_plate=1.2, I=0.004, A=0.0012, C=0.0022)


def test_a_swash_plate_by_hand():
    """x = R tan a (1 - cos); the plate presses with N along its normal; the bearing takes what the plate does."""
    mechanism = bind(str(ROOT / "examples/space/swash_engine.py"), P)
    phi, speed, F = 0.7, 150.0, np.array([900.0, 250.0, 400.0])
    R, t = P["R"], np.tan(P["tilt"])
    named = {f"F{k + 1}": f for k, f in enumerate(F)}
    found = state(mechanism, {"phi": phi, "phid": speed, "phidd": 0.0, **named}).outputs
    behind = phi - 2 * np.pi * np.arange(3) / 3
    assert [found[f"x{k}"] for k in (1, 2, 3)] == pytest.approx(R * t * (1 - np.cos(behind)), abs=1e-14)
    push = F - P["m_p"] * R * t * speed**2 * np.cos(behind)  # along the shaft, on the piston
    assert [found[f"R_z_S{k}"] for k in (1, 2, 3)] == pytest.approx(push, rel=1e-12)
    sides = [np.hypot(found[f"R_x_S{k}"], found[f"R_y_S{k}"]) for k in (1, 2, 3)]
    assert sides == pytest.approx(np.abs(push) * t, rel=1e-12)
    assert found["R_z_A"] == pytest.approx(push.sum(), rel=1e-12)
    # power: the pistons' work and that of their masses
    torque = float((push * R * t * np.sin(behind)).sum())
    assert found["driving_phi"] == pytest.approx(-torque, rel=1e-11)
    # the plate's products of inertia turn with it and bend the bearing, beside the pistons
    deviation = (P["C"] - P["A"]) * np.sin(P["tilt"]) * np.cos(P["tilt"]) * speed**2
    c, s = np.cos(phi), np.sin(phi)
    places = np.array([R * np.cos(phi - behind), R * np.sin(phi - behind), P["offset"] + R * t * np.cos(behind)]).T
    forces = np.array([[found[f"R_{a}_S{k}"] for a in "xyz"] for k in (1, 2, 3)])
    loads = np.cross(places, forces).sum(axis=0)  # of the plate on the pistons, about the bearing
    assert found["M_x_A"] == pytest.approx(loads[0] + deviation * s, abs=1e-9)
    assert found["M_y_A"] == pytest.approx(loads[1] - deviation * c, abs=1e-9)


def _pair(**how):
    m = Mechanism("bad", space=3)
    return m, m.link("one", mass="1 kg", inertia=("1 kg*m^2",) * 3), m.link("two", mass="1 kg", **how)


def _open(m, one, two):
    m.revolute("A", m.frame, one, axis="z", turns=m.coordinates("phi"))
    m.revolute("B", one, two, axis="x")


def _flat(m, one, two):
    m.revolute("A", m.frame, one, axis="z", turns=m.coordinates("phi"))
    m.revolute("B", one, two, axis="x", turns=m.coordinates("psi"))


def _held(m, one, two):
    m.revolute("A", m.frame, one, axis="z", turns=m.coordinates("phi"))
    m.revolute("B", one.at("1 m"), two, axis="z")
    m.fixed("C", m.frame.at("1 m"), two)


def _spinning(m, one, two):
    m.revolute("A", m.frame, one, axis="z", turns=m.coordinates("phi"))
    m.spherical("B", one.at("1 m"), two)
    m.revolute("D", m.frame.at("2 m"), other := m.link("other", mass="1 kg", inertia=("1 kg*m^2",) * 3), axis="y")
    m.spherical("C", two.at("2 m"), other.at(0, 0, "1 m"))


REFUSED = {
    "open": (_open, {"inertia": ("1 kg*m^2",) * 3}, "the loop is open: 1 freedom(s) more than coordinates (turn_B)"),
    "flat": (_flat, {"inertia": "1 kg*m^2"}, "the inertia of two is about z, and it turns about more"),
    "held": (_held, {"inertia": ("1 kg*m^2",) * 3}, "the loops hold what is declared to move, phi"),
    "spinning": (_spinning, {"inertia": (0, "1 kg*m^2", "1 kg*m^2"), "centre": ("1 m", 0, 0)}, "a rod that spins"),
    "axis": (lambda m, one, two: m.revolute("A", m.frame, one), {}, "needs an axis: axis='z'"),
    "direction": (lambda m, one, two: one.axis("w"), {}, "'w' is no direction; there are x, -x, y"),
    "across": (
        lambda m, one, two: (m.revolute("A", m.frame, one, axis="x"), m.universal("U", one, two, axis="x"), m.settle()),
        {},
        "are not square to one another",
    ),
    "body": (lambda m, one, two: m.body("b"), {}, "write b = m.link('b'"),
    "loose": (lambda m, one, two: m.settle(), {}, "hangs on nothing that is placed"),
    "space": (lambda m, one, two: Mechanism("four", space=4), {}, "there are 2 (the plane) and 3"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_is_refused_in_one_line(name):
    declare, how, told = REFUSED[name]
    m, one, two = _pair(**how)
    with pytest.raises(BadInput, match=re.escape(told)) as error:
        declare(m, one, two)
        derive(m)
    assert "\n" not in str(error.value)


@pytest.mark.slow
def test_the_page_does_what_it_says(tmp_path):
    for kind, file, text in re.findall(
        r"```(\w+)(?: file=(\S+))?\n(.*?)```", (ROOT / "docs/space.md").read_text(), re.S
    ):
        if file:
            (tmp_path / file).write_text(text)
        for line in text.splitlines() if kind == "sh" else ():
            done = subprocess.run(
                [sys.executable, "-m", *shlex.split(line)], cwd=tmp_path, capture_output=True, text=True
            )
            assert done.returncode == 0, (line, done.stderr)


def test_a_drawing_in_space_has_three_views_at_one_scale():
    from mechsym.mechanisms import own
    from mechsym.mechanisms.drawing import declared
    from mechsym.mechanisms.plots import figure_of

    file = str(ROOT / "examples/space/swash_engine.py")
    drawn = declared(bind(file, P), own.load(file).listing, lambda angle: [angle, 0.0, 0.0, 0.0])
    front, right, above, turned = figure_of(drawn, 0.4).axes
    assert [axes.get_title() for axes in (front, right, above)] == [
        "from the front: x, z", "from the right: y, z", "from above: x, y",
    ]  # fmt: skip
    spans = [np.ptp(axes.get_xlim()) for axes in (front, right, above, turned)]
    assert spans == pytest.approx([spans[0]] * 4)
    ring = max((line for line in above.patches), key=lambda patch: np.ptp(patch.get_path().vertices[:, 0]))
    assert np.ptp(ring.get_path().vertices[:, 1]) == pytest.approx(8 * P["R"] / 3, rel=0.05)  # the plate, from above


def test_what_a_loop_by_constraint_holds_is_no_formula_to_audit():
    from mechsym.audit import check_formula

    file = ROOT / "examples/space/gyroscope.py"
    kinetic = "mass*l**2*(thetad**2 + psid**2*sin(theta)**2)/2 + (A*(thetad**2 + psid**2*sin(theta)**2)"
    kinetic += " + C*(phid + psid*cos(theta))**2)/2"
    assert check_formula(kinetic, f"{file}:gyroscope.kinetic_energy")["verdict"] == "exact"
    with pytest.raises(BadInput, match="loop closed by constraint cannot be audited"):
        check_formula("R*tan(tilt)*(1 - cos(phi))", f"{ROOT / 'examples/space/swash_engine.py'}:x1")


@pytest.mark.slow
def test_a_linkage_in_space_is_swept_and_exported(tmp_path):
    case = str(ROOT / "examples/space/rssr.toml")
    for words in (
        ["sweep", case, "--over", "m2=0.6,0.8", "--set", "simulation.t_end=0.2 s", "--out", str(tmp_path / "sweep")],
        ["export", case, "--to", "c,julia", "--out", str(tmp_path / "export")],
    ):
        done = subprocess.run([sys.executable, "-m", "mechsym", *words, "--trust"] if words[0] == "sweep" else
                              [sys.executable, "-m", "mechsym", *words], capture_output=True, text=True)  # fmt: skip
        assert done.returncode == 0, done.stderr
    assert len((tmp_path / "sweep" / "sweep.csv").read_text().splitlines()) == 3
