"""The workbench without a browser: its sliders, what the address may say, answers, saved cases, runs."""

import asyncio
import os
import subprocess
import sys

import numpy as np
import pytest

from mechsym import cases
from mechsym.app import Slider, hinge_answer, run, safe, server, sliders, tabs
from mechsym.app.answers import moving
from mechsym.app.saving import case_text
from mechsym.errors import BadInput


@pytest.mark.parametrize("name", cases.names())
def test_no_end_of_a_slider_is_refused(name):
    found = sliders(cases.load(name))
    assert found
    for slider in found:
        assert slider.low <= slider.value <= slider.high
        for end in (slider.low, slider.high):
            cases.load(name, {slider.key: end})


@pytest.mark.parametrize(("name", "key"), [("nunes-hypocycloid", "sizing.rings"), ("zotov-89", "codesign.springs")])
def test_a_whole_number_moves_in_whole_steps(name, key):
    whole = next(s for s in sliders(cases.load(name)) if s.key == key)
    assert isinstance(whole, Slider) and whole.step == 1 and whole.low == round(whole.low)


@pytest.mark.parametrize(
    ("name", "texts", "words"),
    [
        ("/etc/passwd", {}, "not built in"),
        ("zotov-89", {"cycle.diagram": "/etc/passwd"}, "no value"),
        ("zotov-89", {"mechanism": "./own.py"}, "no value"),
        ("zotov-89", {"spring.p0": "5 MPa; rm"}, "not a number"),
        ("zotov-89", {"spring.p0": "nan"}, "not finite"),
    ],
)
def test_an_address_can_name_numbers_only(name, texts, words):
    with pytest.raises(BadInput, match=words):
        safe(name, "zotov-142", texts)


def test_an_address_sets_what_it_may():
    assert safe("zotov-89", "zotov-89", {"spring.p0": "5.2e6"}) == {"spring.p0": 5.2e6}


def test_the_answer_is_that_of_the_command():
    from mechsym.jobs.hinge import hinge

    answer, design = hinge_answer("zotov-89", {"spring.p0": 6e6}), hinge(cases.load("zotov-89", {"spring.p0": 6e6}))
    reason = design.verdict.reason.removeprefix("within all limits; ")  # beside a missed target
    assert answer.words == f"{design.answer} ({reason})" and answer.good == design.target.met
    wanted = next(c for c in answer.curves if c.name == "wanted")
    assert np.array(wanted.y) * 1e3 == pytest.approx(design.hinge.torque(np.radians(wanted.x)), rel=1e-3, abs=1)
    assert [b.kept for b in answer.bars] == [c.kept for c in design.verdict.checks]


def test_what_is_impossible_is_a_sentence():
    answer = hinge_answer("zotov-89", {"spring.n": 3.0})
    assert not answer.good and "spring" in answer.words and not answer.curves
    assert not hinge_answer("zotov-89", {"guide.rho0": 0.3}).good


def test_guide_and_mechanism_turn_to_scale_with_their_gas():
    answer = hinge_answer("zotov-89", {})
    machine, hinge = answer.scenes()
    wide = [shown["size"][0] / shown["scale"] for shown in (machine, hinge)]
    assert 2 < wide[0] < 6 and 1.6 < wide[1] < 2.4
    assert machine["gases"] and any("share" in shape for shape in hinge["shapes"])
    page = moving(answer, "<zotov>")
    assert 'class="angle"' in page and "<zotov>" not in page


def test_a_saved_case_is_the_case_with_its_values_and_comments():
    text = case_text("zotov-89", {"spring.p0": 6.25e6, "operation.speed": 9.0, "parameters.m1": 85.0})
    assert "p0 = 6250000.0" in text
    assert text.count("#") == cases.text("zotov-89").count("#")
    with pytest.raises(BadInput, match="n = 3 is out of range"):
        case_text("zotov-89", {"spring.n": 3.0})


def test_tabs_are_the_commands_that_the_case_has_sections_for():
    assert "hinge" in tabs(cases.load("zotov-89")) and "codesign" in tabs(cases.load("zotov-89"))
    assert "hinge" not in tabs(cases.load("nunes-hypocycloid")) and "size" in tabs(cases.load("nunes-hypocycloid"))


@pytest.mark.slow
def test_a_run_is_that_of_the_command_and_what_is_refused_is_said():
    done = asyncio.run(run(["forces", "moroianu"]))
    rows = dict(done.rows)
    assert (
        done.status == 0
        and " kN, largest at " in rows["least to largest over the turn, side force"]
        and "rodless" not in rows
    )
    refused = asyncio.run(run(["cycle", "zotov-89", "--set", "cycle.bore=60"]))
    assert refused.status == 2 and "bore" in refused.words


@pytest.mark.slow
def test_check_reads_the_page_without_a_browser():
    pytest.importorskip("nicegui", reason="the extra app is not installed")
    outside = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST")}
    command = [sys.executable, "-m", "mechsym", "app", "zotov-89", "--check"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False, env=outside)
    assert done.returncode == 0, done.stderr
    assert "sliders, hinge" in done.stdout


@pytest.mark.slow
def test_without_the_extra_one_line_names_it():
    code = (
        "import sys; sys.modules['nicegui'] = None; from mechsym.cli import main; sys.argv = ['mechsym', 'app']; main()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2
    assert done.stderr.strip() == "mechsym: the workbench needs the extra app: pip install 'mechsym[app]'"


def test_why_the_server_ended_is_told_once():
    code = "import sys; print('mechsym: no such thing', file=sys.stderr); sys.exit(2)"
    with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True) as ended:
        ended.wait()
        with pytest.raises(BadInput, match="^no such thing$"):
            server._page_of(ended)
