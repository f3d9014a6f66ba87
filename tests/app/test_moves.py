"""Each slider that a tab offers moves what the tab shows; each that it leaves out, with its reason, moves nothing."""

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.app import commands, hinge_answer, sliders
from mechsym.app.commands import Run
from mechsym.app.idle import idle
from mechsym.cli import mechsym

_NOISE = ("wall", "seconds", "residual", "doubt")  # differs between two equal runs, is round-off, or is about the case


def shown(tab, name, values):
    """All that a tab shows, without its picture; an answer in words is one too."""
    if tab == "hinge":
        a = hinge_answer(name, values)
        return a.good, a.words, a.rows, a.bars, a.doubts, tuple((c.name, c.x, c.y) for c in a.curves)
    done = CliRunner().invoke(mechsym, [*commands.words(tab, name, values), "--json"])
    if done.exception and not isinstance(done.exception, SystemExit):
        return str(done.exception)
    found: Run = commands._read(done.exit_code, done.stdout, done.stderr, ())
    return found.status, found.words, tuple(r for r in found.rows if not any(w in r[0] for w in _NOISE))


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
    here = [s for s in sliders(case) if s.key.partition(".")[0] in commands.reads(tab)]
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
@pytest.mark.parametrize(
    ("tab", "name"),
    [
        *(("cycle", name) for name in ("alpha-stirling", "balandin", "generator", "generator-breathing")),
        *(("forces", name) for name in ("balandin", "generator", "generator-breathing", "nunes-hypocycloid")),
    ],
)
def test_each_slider_of_a_run_moves_it(tab, name):
    held(tab, name)


def test_what_is_left_out_has_a_reason_that_follows_the_choice():
    given = idle(cases.load("zotov-89"), "hinge")
    assert given["rollers.rolling_arm"] == "friction is none" and "scavenging.warming" in given
    other = idle(cases.load("zotov-89", {"rollers.friction": "rolling", "scavenging.source": "turbocharger"}), "hinge")
    assert "rollers.rolling_arm" not in other and "scavenging.warming" not in other
    assert "cycle.lhv" not in given and "cycle.lhv" in idle(cases.load("zotov-89"), "simulate")
    assert not idle(cases.load("nunes-slider-crank"), "size")
    assert idle(cases.load("alpha-stirling"), "cycle")["stirling.wire"] == "kind is schmidt, without losses"
    assert idle(cases.load("nunes-slider-crank"), "forces")["friction.module"] == "there are no gears"
    assert "friction.mu_guide" in idle(cases.load("nunes-hypocycloid"), "forces")
