"""Each slider that a tab offers moves what the tab shows; each that it leaves out, with its reason, moves nothing."""

import functools
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.app import commands, hinge_answer, sliders
from mechsym.app.commands import Run
from mechsym.app.idle import idle
from mechsym.cli import mechsym

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
JSON = ("--json", "--with-units")
# differs between two equal runs, is round-off, or is about the case
_NOISE = ("wall", "time it took", "seconds", "residual", "doubt")


def shown(tab, name, values):
    """All that a tab shows, without its picture; an answer in words is one too."""
    if tab == "hinge":
        a = hinge_answer(name, values)
        return a.good, a.words, a.rows, a.bars, a.doubts, tuple((c.name, c.x, c.y) for c in a.curves)
    done = CliRunner().invoke(mechsym, [*commands.words(tab, name, {**_short(tab, name), **values}), *JSON])
    if done.exception and not isinstance(done.exception, SystemExit):
        return str(done.exception)
    found: Run = commands.run_of(done.exit_code, done.stdout, done.stderr)
    words = [line for line in found.words.splitlines() if not line.startswith(("doubt", "accepted"))]
    return found.status, words, tuple(r for r in found.rows if not any(w in r[0] for w in _NOISE))


def _short(tab, name):
    """A run of few turns, where the case counts turns: what moves it moves a long one too."""
    return {"simulation.turns": 3} if tab == "simulate" and "simulation.turns" in _keys(name) else {}


@functools.lru_cache
def _keys(name):
    return {s.key for s in sliders(cases.load(name))}


def moved(tab, name, slider, before):
    """Whether one end of a slider or the other changes what is shown, alone or once no other value is zero."""
    ends = (slider.high, slider.low)
    if any(shown(tab, name, {slider.key: end}) != before for end in ends):
        return True
    here = [s for s in sliders(cases.load(name)) if s.key.partition(".")[0] == slider.key.partition(".")[0]]
    lifted = {s.key: s.high for s in here if s.value == 0 and s.key != slider.key}
    if not lifted:
        return False
    before = shown(tab, name, lifted)
    return any(shown(tab, name, {**lifted, slider.key: end}) != before for end in ends)


def split(tab, name):
    """Sliders of a tab that are offered, and those that are not."""
    case = cases.load(name)
    here = [s for s in sliders(case) if s.key.partition(".")[0] in commands.reads(tab, case)]
    left_out = idle(case, tab)
    return [s for s in here if s.key not in left_out], [s for s in here if s.key in left_out]


def held(tab, name):
    before = shown(tab, name, {})
    offered, left_out = split(tab, name)
    assert offered
    assert [s.key for s in offered if not moved(tab, name, s, before)] == []
    assert [s.key for s in left_out if moved(tab, name, s, before)] == []


@pytest.mark.slow
def test_each_slider_of_the_hinge_moves_it():
    held("hinge", "zotov-89")


@pytest.mark.slow
@pytest.mark.heavy
@pytest.mark.parametrize(("tab", "name"), [(tab, n) for n in cases.names() for tab in commands.tabs(cases.load(n))])
def test_each_slider_of_a_run_moves_it(tab, name):
    held(tab, name)


@pytest.mark.slow
@pytest.mark.parametrize("tab", ["cycle", "forces"])
def test_each_slider_of_an_own_mechanism_moves_it(tab):
    held(tab, str(EXAMPLES / "compressor.toml"))


def test_what_is_left_out_has_a_reason_that_follows_the_choice():
    given = idle(cases.load("zotov-89"), "hinge")
    assert given["rollers.rolling_arm"] == "friction is none" and "scavenging.warming" in given
    other = idle(cases.load("zotov-89", {"rollers.friction": "rolling", "scavenging.source": "turbocharger"}), "hinge")
    assert "rollers.rolling_arm" not in other and "scavenging.warming" not in other
    assert "cycle.lhv" not in given and "cycle.lhv" in idle(cases.load("zotov-89"), "simulate")
    sized = idle(cases.load("nunes-slider-crank"), "size")
    assert sized["operation.speed"] == "sized at the speeds of [speeds]" and "speeds.highest" not in sized
    assert "parameters.m4" in sized and "parameters.m4" not in idle(cases.load("moroianu"), "size")
    assert idle(cases.load("alpha-stirling"), "size")["stirling.wire"] == "kind is schmidt, without losses"
    assert idle(cases.load("nunes-slider-crank"), "forces")["friction.module"].startswith("the mechanism has no")
    assert "friction.mu_guide" in idle(cases.load("nunes-hypocycloid"), "forces")


def letters(tab, name):
    return {k.removeprefix("parameters.") for k in idle(cases.load(name), tab) if k.startswith("parameters.")}


def test_letters_that_enter_nothing_are_left_out_of_any_mechanism():
    assert letters("cycle", str(EXAMPLES / "compressor.toml")) == {"I", "I_rod", "m_rod", "m_piston"}
    assert not letters("forces", str(EXAMPLES / "compressor.toml"))  # its table has the inertia on the shaft
    assert not letters("simulate", str(EXAMPLES / "compressor.toml"))
    assert not letters("forces", "nunes-hypocycloid")
    assert {"m1", "m2", "I01"} <= letters("cycle", "zotov-89") and not letters("hinge", "zotov-89")
    assert letters("cycle", "opposed-pistons") == {"I0", "I_f", "c", "m0", "u0"}  # put together of throws
    assert letters("forces", "opposed-pistons") == {"m0"}  # nothing weighs
    assert letters("cycle", "balandin") == {"I1", "I_link", "m_link", "u1"}
    assert letters("simulate", "balandin") == {"u1"} and not letters("forces", "balandin")


def test_masses_that_balance_each_other_move_no_torque():
    """Three pistons a third of a turn apart, and the foot of Jansen's leg, a triangle that moves as one part."""
    assert letters("cycle", str(EXAMPLES / "swash-plate.toml")) == {"I", "m_p"}
    assert letters("simulate", str(EXAMPLES / "walking-leg.toml")) == {"h", "i"}


ROLES = """    m.bearing("shaft", reactions=("R_x_O", "R_y_O"), turns=phi, radius=e)
    m.guide("cylinder", reaction="R_n_G", travel=x)
"""


@pytest.mark.slow
def test_friction_of_an_own_mechanism_is_offered_where_its_roles_say(tmp_path):
    text = (EXAMPLES / "compressor.py").read_text(encoding="utf-8")
    case = (EXAMPLES / "compressor.toml").read_text(encoding="utf-8") + FRICTION
    (tmp_path / "compressor.toml").write_text(case, encoding="utf-8")
    (tmp_path / "compressor.py").write_text(text, encoding="utf-8")
    offered, _ = split("forces", str(tmp_path / "compressor.toml"))
    assert not [s for s in offered if s.key.startswith("friction.")]
    (tmp_path / "compressor.py").write_text(text.replace("    return m\n", ROLES + "    return m\n"), encoding="utf-8")
    offered, _ = split("forces", str(tmp_path / "compressor.toml"))
    assert {s.key for s in offered if s.key.startswith("friction.")} == {"friction.mu_pin", "friction.mu_guide"}


FRICTION = """
[friction]
mu_guide = 0.05
mu_pin = 0.01
mu_main = 0.01
radius_piston_pin = "10 mm"
radius_crank_pin = "15 mm"
radius_main = "20 mm"
"""
