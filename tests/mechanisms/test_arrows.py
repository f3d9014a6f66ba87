"""Forces and paths in the moving machine, read off its scene: moment about the shaft, places of joints, paths."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from mechsym import cases, jobs
from mechsym.cases.new_engine import write_engine
from mechsym.forces.arrows import charged, pressed
from mechsym.forces.shown import drawing_of
from mechsym.hinge.limits import at_angles
from mechsym.hinge.shown import scenes
from mechsym.jobs.export import turning
from mechsym.mechanisms.turning import ARROW, FRAMES, scene

OWN = Path(__file__).parents[2] / "examples" / "mechanisms"


def shown_of(found):
    drawn = charged(scene(drawing_of(found), "machine"), found.turn.drive, found.turn.acting)
    return pressed(drawn, found.turn)


def vectors(shown, load):
    """Places [m] and forces [N] of an arrow at the frames, y upwards."""
    at, to = (np.array(load[key]) * [1, -1] @ [1, 1j] for key in ("at", "to"))
    return at / shown["scale"], to * shown["most"] / ARROW


@pytest.mark.parametrize("name", ["zotov-89", "generator", "nunes-hypocycloid", "opposed-pistons"])
def test_arrows_on_the_crank_pins_turn_the_shaft_with_its_torque(name):
    found = jobs.forces(cases.load(name))
    shown, turn = shown_of(found), found.turn
    loads = {one["name"]: vectors(shown, one) for one in shown["loads"]}
    pins, shafts = ([v for n, v in loads.items() if n.startswith(kind)] for kind in ("crank pin", "main bearing"))
    assert len(pins) == len(shafts) == len(found.loads.pins)
    moment = sum(
        pin.sense * ((at - shaft) * force.conj()).imag * -1
        for pin, (at, force), (shaft, _) in zip(found.loads.pins, pins, shafts, strict=True)
    )
    phi = np.linspace(0, 2 * np.pi * shown["turns"], shown["count"], endpoint=False)
    asked = np.interp(phi, turn.phi, turn.torque - found.loads.weight_torque, period=turn.period)
    pixel = shown["most"] / ARROW * sum(pin.radius for pin in found.loads.pins)  # arrows are rounded to pixels
    assert np.abs(moment - asked).max() < pixel + 0.01 * np.abs(asked).max()


@pytest.mark.parametrize("name", ["whitworth", "atkinson"])
def test_arrows_of_a_linkage_stand_at_its_joints(name):
    shown = shown_of(jobs.forces(cases.load(str(OWN / f"{name}.toml"))))
    assert len(shown["loads"]) == {"whitworth": 6, "atkinson": 7}[name]
    for k in range(0, FRAMES, FRAMES // 10):
        drawn = (s["moves"][k] if s["moves"] else s["at"] for s in shown["shapes"])
        corners = np.concatenate([np.reshape(at, (-1, 2)) for at in drawn])
        for load in shown["loads"]:
            assert np.hypot(*(corners - load["at"][k % len(load["at"])]).T).min() < 1.0, (load["name"], k)


def at_one_place(shown, names):
    """Sum of the arrows of these names [N], and their places [m]."""
    arrows = [vectors(shown, one) for one in shown["loads"] if one["name"] in names]
    assert len(arrows) == len(names)
    at = arrows[0][0]
    assert all(np.abs(other - at).max() < 2 / shown["scale"] for other, _ in arrows)
    return sum(force for _, force in arrows), at


@pytest.mark.parametrize(
    "name, pairs",
    [
        ("zotov-89", [("crosshead pin", "side force")]),
        ("opposed-pistons", [("piston pin 1", "side force 1"), ("piston pin 2", "side force 2")]),
        ("balandin", [("journal a", "side force a"), ("journal b", "side force b")]),
        (str(OWN / "compressor.toml"), [("rod on piston, pin P", "frame on piston, slider G")]),
        (str(OWN / "whitworth.toml"), [("link on ram, pin C", "frame on ram, slider G")]),
    ],
)
def test_guides_take_what_rods_press_across_the_way_of_a_piston(name, pairs):
    """A piston is accelerated along its way alone: across it pin, guide and weight are in balance. On the page too."""
    case = cases.load(name)
    shown = turning(case)[0]
    parameters = case.sections["parameters"]
    weight = 9.81 * sum(v for k, v in vars(parameters).items() if k.startswith("m") and np.isscalar(v))
    for pair in pairs:
        force, at = at_one_place(shown, pair)
        way = at[np.abs(at - at[0]).argmax()] - at[0]
        across = (force * np.conj(way / abs(way))).imag
        side, _ = at_one_place(shown, pair[1:])
        pixel = 1.5 * shown["most"] / ARROW
        assert np.abs(across).max() < pixel + weight and np.abs(side).max() > 4 * pixel, pair


@pytest.mark.slow
def test_cylinders_of_a_row_have_the_gas_and_the_arrows_of_their_own(tmp_path):
    path, *_ = write_engine("inline", 0.086, 0.086, 4, tmp_path)
    case = cases.load(str(path))
    shown, one = turning(case)[0], jobs.forces(case).turn
    phi = np.linspace(0, 2 * np.pi * shown["turns"], shown["count"], endpoint=False)
    beside = {
        load["name"]: vectors(shown, load) for load in shown["loads"] if len(np.unique(np.array(load["at"])[:, 0])) == 1
    }
    assert {f"piston pin {k}" for k in (1, 2, 3, 4)} < beside.keys()
    for k in (1, 2, 3, 4):
        at, force = beside[f"piston pin {k}"]
        asked = np.interp(phi, one.phi, one.reactions[f"piston_pin_force_along_{k}"], period=one.period)
        assert np.abs(force - 1j * asked).max() < 1.5 * shown["most"] / ARROW
    for gas in shown["gases"]:
        number = shown["shapes"][gas["piston"]]["of"]
        asked = np.interp(phi, one.phi, one.inputs[f"F{number}"], period=one.period)
        share = np.array(gas["share"])
        assert np.abs(share[np.arange(len(phi)) % len(share)] - 100 * asked / shown["most"]).max() < 2.5


def test_tracks_press_on_the_rollers_as_the_spring_does_outwards():
    design = jobs.hinge(cases.load("zotov-89"))
    shown = scenes(design)[-1]
    theta = np.linspace(0, 2 * np.pi, shown["count"], endpoint=False)
    force = at_angles(design.usable, design.rollers, theta).force
    assert len(shown["loads"]) == 2
    centre = np.array(shown["origin"]) * [1, -1] @ [1, 1j] / shown["scale"]
    for load in shown["loads"]:
        at, pressed_by = vectors(shown, load)
        inwards = -(pressed_by * (at - centre).conj()).real / np.abs(at - centre)
        assert np.abs(inwards - force).max() < 0.01 * force.max()


def test_the_path_of_a_watched_point_is_drawn_where_it_moves(tmp_path):
    for end in ("py", "toml"):
        shutil.copy(OWN / f"whitworth.{end}", tmp_path)
    file = tmp_path / "whitworth.py"
    text = file.read_text(encoding="utf-8")
    text = text.replace("    return m\n", '    m.watch(rocker.at(s), "tip")\n    return m\n')
    file.write_text(text, encoding="utf-8")
    (shown,) = turning(cases.load(str(tmp_path / "whitworth.toml")))
    (path,) = (np.reshape(s["at"], (-1, 2)) for s in shown["shapes"] if s["role"] == "trace")
    step = np.hypot(*np.diff(path, axis=0).T).max()
    ends = [np.array(s["moves"]) for s in shown["shapes"] if s["role"] == "joint" and s["moves"]]
    away = [max(np.hypot(*(path - at).T).min() for at in moves) for moves in ends]
    assert len(path) > 90 and min(away) < 0.6 * step < 20  # the rocker's end is a joint
