"""Poses at rest against closed forms: a rod on a torsion spring, a double pendulum, a snap-through arch."""

import math

import pytest
import scipy
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.run import at_rest

HEAD = "from mechsym.derive import Mechanism, cos, sin, sqrt, pi\n\ndef own():\n    m = Mechanism('own')\n"
ROD = """    a = m.coordinates("a")
    rod = m.link("rod", turns=a, mass="1 kg", centre=("0.5 m", 0), inertia="0.1 kg*m^2")
    m.pin("O", m.frame, rod)
    m.weight(0, -9.81)
"""
SPRING = ROD + '    m.spring("4 N*m/rad", stretch=a)\n    m.damper("0.1 N*m*s/rad", stretch=a)\n'
DOUBLE = """    a, b = m.coordinates("a b")
    one, two = m.link("one", turns=a), m.link("two", turns=b)
    m.pin("O", m.frame, one)
    m.pin("A", one.at("1 m"), two)
    m.body("p", mass="1 kg", at=one.at("1 m"))
    m.body("q", mass="1 kg", at=two.at("1 m"))
    m.weight(0, -9.81)
"""
ARCH = """    y = m.coordinates("y", "m")
    h, L = m.parameters("h", "m", default=1), m.parameters("L", "m", default="1.2 m")
    m.body("top", mass="2 kg", at=(0, y))
    m.spring("50 N/m", stretch=sqrt(h**2 + y**2) - L)
"""


def rests(tmp_path, body, start=""):
    (tmp_path / "own.py").write_text(HEAD + body + "    return m\n")
    file = tmp_path / "own.toml"
    file.write_text(f'mechanism = "./own.py"\n{start}\n[simulation]\nt_end = 1\n')
    return at_rest(cases.load(str(file)))


def test_a_damped_rod_on_a_spring(tmp_path):
    (pose,) = rests(tmp_path, SPRING).rests
    angle = scipy.optimize.brentq(lambda x: 4.905 * math.cos(x) + 4 * x, -2, 0, xtol=1e-15)
    stiffness, inertia = 4 - 4.905 * math.sin(angle), 0.1 + 0.25
    assert pose.at["a"] == pytest.approx(angle, abs=1e-12)
    assert pose.kind == "stable"
    assert pose.growth == pytest.approx(-0.1 / (2 * inertia), rel=1e-6)
    assert pose.frequencies == pytest.approx([math.sqrt(stiffness / inertia - pose.growth**2)], rel=1e-7)
    assert pose.potential_energy == pytest.approx(4.905 * math.sin(angle) + 2 * angle**2, rel=1e-12)


def test_a_double_pendulum_rests_in_four_poses(tmp_path):
    found = rests(tmp_path, DOUBLE)
    kinds = {(round(math.sin(p.at["a"])), round(math.sin(p.at["b"]))): p for p in found.rests}
    assert {at: p.kind for at, p in kinds.items()} == {
        (-1, -1): "stable", (1, 1): "unstable", (1, -1): "unstable", (-1, 1): "unstable",
    }  # fmt: skip
    squares = [9.81 * (2 - math.sqrt(2)), 9.81 * (2 + math.sqrt(2))]
    assert kinds[-1, -1].frequencies == pytest.approx([math.sqrt(w) for w in squares], rel=1e-7)
    assert not found.complete


def test_an_arch_snaps_through(tmp_path):
    found = rests(tmp_path, ARCH, '[start]\ny = "0.5 m"')
    at = {round(p.at["y"], 9): p for p in found.rests}
    low = math.sqrt(1.2**2 - 1)
    assert sorted(at) == pytest.approx([-low, 0, low], abs=1e-8)
    assert [at[y].kind for y in sorted(at)] == ["stable", "unstable", "stable"]
    stiff = 50 * (low / 1.2) ** 2
    assert at[max(at)].frequencies == pytest.approx([math.sqrt(stiff / 2)], rel=1e-6)


def test_what_friction_holds_is_refused_and_the_command_tells(tmp_path):
    with pytest.raises(BadInput, match="holds it at rest in whole ranges"):
        rests(tmp_path, ROD + '    m.friction("O", mu=0.1, radius="10 mm")\n')
    rests(tmp_path, SPRING)
    done = CliRunner().invoke(mechsym, ["simulate", str(tmp_path / "own.toml"), "--rest", "--trust"])
    assert done.exit_code == 0
    assert "stable" in done.output
    assert "-47.48" in done.output


LIFT = """    phi = m.coordinates("phi")
    bar = dict(mass="8 kg", centre=("0.5 m", 0))
    a, b = m.link("a", turns=phi, pose="30 deg", **bar), m.link("b", pose="150 deg", **bar)
    top, foot = m.link("top", mass="40 kg", pose=0), m.link("foot", mass="1 kg")
    m.pin("O", m.frame, a)
    m.slider("F", m.frame, foot)
    m.pin("J", foot, b)
    m.pin("X", a.at("0.5 m"), b.at("0.5 m"))
    m.pin("W", b.at("1 m"), top)
    m.slot("Z", top.line(), a.at("1 m"))
    m.weight(0, -9.81)
    m.spring("12 kN/m", stretch=foot.at().x - m.parameters("free", "m", default="0.6 m"))
"""


@pytest.mark.slow
def test_a_scissor_lift_rests_between_its_singular_poses(tmp_path):
    found = rests(tmp_path, LIFT)
    weight = 9.81 * (8 + 40)  # half of two bars, the top

    def push(x):
        return weight * math.cos(x) - 12000 * (math.cos(x) - 0.6) * math.sin(x)

    roots = [scipy.optimize.brentq(push, low, high, xtol=1e-15) for low, high in ((-1.2, -0.6), (0, 0.2), (0.6, 1.2))]
    assert [p.at["phi"] for p in found.rests] == pytest.approx(roots, abs=1e-11)
    assert [p.kind for p in found.rests] == ["stable", "unstable", "stable"]
    # its bars lie on one another at a right angle: accelerations change their sign there by a pole
    assert found.singular == pytest.approx([-math.pi / 2, math.pi / 2], abs=1e-3)
    assert not found.complete
