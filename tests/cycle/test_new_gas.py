"""A gas that lives in tests goes through every command by its answers alone."""

import json
import re

import numpy as np
import pulsed_gas
import pytest
from click.testing import CliRunner

from mechsym.app.idle import idle
from mechsym.app.sliders import sliders
from mechsym.cases import load, schema, text
from mechsym.cli import mechsym
from mechsym.cycle.kinds import KINDS
from mechsym.jobs.gas import gas

SECTION = """[cycle]
kind = "pulse"
bore = "0.3 m"
compression_ratio = 17
p_mean = "20 bar"
swing = "16 bar"
throttled = "0.4 bar*s/rad"

[spring]"""


@pytest.fixture
def case(monkeypatch, tmp_path):
    """zotov-89 with this gas in place of its own."""
    monkeypatch.setitem(KINDS, "pulse", pulsed_gas.ROW)
    monkeypatch.setitem(schema.ENTRIES["cycle"][1], "pulse", pulsed_gas.ROW.cycle)
    before, _, rest = text("zotov-89").partition("[cycle]")
    behind = rest.partition("[spring]")[2].partition("[codesign]")
    file = tmp_path / "pulse.toml"
    file.write_text(before + SECTION + behind[0] + "[simulation]" + behind[2].partition("[simulation]")[2])
    return str(file)


def told(*words):
    found = CliRunner().invoke(mechsym, [*words, "--json"], catch_exceptions=False)
    assert found.exit_code in (0, 1), found.output
    return json.loads(found.stdout)


def peak(case, rpm):
    return float(gas(load(case, {"operation.speed": f"{rpm} rpm"})).pressure.p_max)


def test_the_pressure_follows_the_speed(case):
    slow, fast = peak(case, 60), peak(case, 120)
    assert slow == pytest.approx(36e5 - 0.4e5 * 2 * np.pi, rel=1e-9)
    assert fast == pytest.approx(36e5 - 0.4e5 * 4 * np.pi, rel=1e-9)


def test_figures_forces_and_flywheel(case):
    figures = told("cycle", case, "--speeds", "60,120")
    assert figures["p_max_mpa"] == pytest.approx([peak(case, 60) / 1e6, peak(case, 120) / 1e6], rel=1e-9)
    assert figures["power_kw"][1] > figures["power_kw"][0] > 0 and figures["efficiency"] == [None, None]
    assert told("forces", case)["max"]["p"] == pytest.approx(peak(case, 89), rel=1e-6)
    wheel = told("flywheel", case, "--ripple", "2%")
    assert wheel["torque_mean"] == pytest.approx(told("cycle", case)["torque_avg"][0], rel=1e-6)


def test_hinge_and_run(case):
    hinge = told("hinge", case, "--set", "trials.turns=4")
    assert hinge["p_max_bar"] == pytest.approx(peak(case, 89) / 1e5, rel=1e-9)
    assert hinge["load_torque"] == pytest.approx(told("cycle", case)["torque_avg"][0], rel=1e-6)
    run = told("simulate", case, "--set", "simulation.turns=4")
    assert abs(run["energy_residual"]) < 1e-8 and run["status"] == "converged"


def test_sweep_check_and_report(case, tmp_path):
    swept = told("sweep", case, "--of", "cycle", "--over", "operation.speed=60,120rpm", "--jobs", "1")
    assert swept["failed"] == []
    assert swept["data"]["p_max_mpa"] == pytest.approx([peak(case, 60) / 1e6, peak(case, 120) / 1e6], rel=1e-9)
    checked = told("check", case)
    assert checked["problems"] == [] and not any(checked["commands"][name] for name in ("cycle", "hinge", "simulate"))
    report = CliRunner().invoke(mechsym, ["report", case, "--out", str(tmp_path / "report.html")])
    assert report.exit_code == 0, report.output
    assert "pulse" in (tmp_path / "report.html").read_text()


@pytest.mark.parametrize("line", [
    "size CASE", "export CASE --to c --out c", "guide CASE --sheet sheet.svg",
    pytest.param(
        "codesign CASE --curve constant_speed --loads 1 --speeds 80,100 --ripple 5% --losses none",
        marks=pytest.mark.heavy,
    ),
    "fmu CASE --platforms none --out machine.fmu",
])  # fmt: skip
@pytest.mark.slow
def test_what_is_made_of_it(case, line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    told(*line.replace("CASE", case).split())


def test_the_workbench_has_its_sliders(case):
    keys = {slider.key for slider in sliders(load(case))}
    assert {"cycle.swing", "cycle.throttled"} <= keys and not {"cycle.swing", "operation.speed"} & set(
        idle(load(case), "cycle")
    )


@pytest.mark.slow
def test_a_page_takes_it(case, tmp_path):
    """Its force acts in the run that the page turns."""
    file = tmp_path / "page.html"
    assert told("page", case, "--set", "simulation.turns=1", "--out", str(file))["written"] == [str(file)]
    assert re.search(r'"label":\s*"gas"', file.read_text())
