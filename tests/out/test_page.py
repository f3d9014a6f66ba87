"""The page in a real browser: numbers of `simulate`, every slider moves the answer, no request, no error."""

import dataclasses
import errno
import json
import os
import subprocess
import sys
from pathlib import Path
from shutil import which

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases.new_engine import write_engine
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.export import ready
from mechsym.out.block import block_of
from mechsym.out.web import LiveRun, page, with_live
from mechsym.simulate import Settings, simulate

pytest.importorskip("ziglang", reason="the extra web is not installed")

CHROMIUM = which("chromium") or which("chromium-browser")


@pytest.fixture(scope="module")
def files(exported, tmp_path_factory):
    made = {}

    def get(name):
        if name not in made:
            made[name] = tmp_path_factory.mktemp("page") / f"{name}.html"
            made[name].write_text(page(exported(name)[1]), encoding="utf-8")
        return made[name]

    return get


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    if CHROMIUM is None:
        pytest.skip("no chromium is installed")
    with playwright.sync_playwright() as running:
        found = running.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield found
        found.close()


@pytest.fixture
def opened(browser, files):
    """A page that was opened from its file with the network off; its errors and its requests."""
    pages = []

    def get(name):
        context = browser.new_context(offline=True)
        tab = context.new_page()
        errors, requests = [], []
        tab.on("pageerror", lambda e: errors.append(str(e)))
        tab.on("console", lambda m: errors.append(m.text) if m.type == "error" else None)
        tab.on("request", lambda r: requests.append(r.url))
        tab.goto(files(name).as_uri())
        tab.wait_for_function("window.mechsym && window.mechsym.last")
        pages.append(context)
        return tab, errors, requests

    yield get
    for context in pages:
        context.close()


SOME = ("zotov-89", "chmielewski", "alpha-stirling", "generator")


@pytest.mark.slow
@pytest.mark.parametrize("name", [n if n in SOME else pytest.param(n, marks=pytest.mark.heavy) for n in cases.names()])
def test_numbers_are_those_of_simulate(opened, exported, name):
    run = exported(name)[0].problem
    tab, errors, requests = opened(name)
    wanted = simulate(run, Settings(tolerance=1e-13, check="none"))
    some = np.linspace(0, len(wanted.t) - 1, 40).astype(int)[1:]
    times = [float(wanted.t[i]) for i in some]
    found = tab.evaluate("times => mechsym.run({}, times, [], 1, 1e-13)", times)
    q = tab.evaluate("mechsym.data.angle")
    for state in (q, f"{q}d"):
        truth = wanted.columns[state][some][: len(found[state])]
        assert np.max(np.abs(np.array(found[state]) - truth)) <= 1e-9 * np.max(np.abs(truth)), state
    assert len(found["t"]) == len(times)
    assert errors == [] and all(url.startswith("file://") for url in requests) and len(requests) == 1


@pytest.mark.slow
def test_every_slider_and_the_misfire_move_the_answer(opened, tmp_path):
    tab, errors, _ = opened("zotov-89")
    first = tab.inner_text("#verdict").split("(")[0]
    ids = [e.get_attribute("id") for e in tab.query_selector_all("input[type=range]")]
    assert {"slider_p0", "slider_load_torque", "slider_gas_scale", "slider_phid", "misfire"} <= set(ids)
    for name in ids:
        tab.evaluate("id => {const e = document.getElementById(id); e.value = 0.25 * e.min + 0.75 * e.max; "
                     "if (id === 'misfire') e.value = 0; e.dispatchEvent(new Event('input'))}", name)  # fmt: skip
        assert tab.inner_text("#verdict").split("(")[0] != first, name
        tab.click("#back")
        assert tab.inner_text("#verdict").split("(")[0] == first, name
    tab.screenshot(path=str(tmp_path / "page.png"))
    assert errors == []


@pytest.mark.slow
def test_a_number_outside_the_model_is_said_not_shown(opened):
    tab, errors, _ = opened("zotov-89")
    tab.evaluate("const e = document.getElementById('field_H'); e.value = 0.01; e.dispatchEvent(new Event('change'))")
    said = tab.inner_text("#verdict")
    assert "leave the range" in said or "stops" in said
    assert "NaN" not in tab.inner_text("body")
    assert errors == []


def test_numbers_are_shown_in_the_units_that_were_chosen(exported, monkeypatch):
    from mechsym.out.web import build
    from mechsym.quantities.display import choose

    monkeypatch.setattr(build, "webassembly", lambda block: b"")
    try:
        choose("bar, rad/s, kN*m")
        shown = build._data(exported("zotov-89")[1])["shown"]
    finally:
        choose(None)
    assert shown["Pa"] == (1e-5, "bar") and shown["rad/s"] == (1.0, "rad/s") and shown["N*m"] == (1e-3, "kN m")
    assert build._data(exported("zotov-89")[1])["shown"]["rad/s"][1] == "rpm"


def test_what_acts_is_told_with_its_kind(exported, monkeypatch):
    from mechsym.out.web import build

    monkeypatch.setattr(build, "webassembly", lambda block: b"")
    told = [(a["label"], a["unit"]) for a in build._data(exported("zotov-89")[1])["acting"]]
    assert told == [("gas", "N"), ("hinge", "N*m"), ("load", "N*m")]


@pytest.mark.slow
def test_pinned_curves_lie_beside_those_of_another_setting(opened):
    tab, errors, _ = opened("zotov-89")
    names = "Object.fromEntries(Object.entries(charts).map(([id, c]) => [id, c.series.slice(1).map(s => s.label)]))"
    alone = tab.evaluate(names)
    first = tab.evaluate("charts.speed.data[1].slice()")
    tab.click("#pin")
    tab.evaluate("const e = document.getElementById('field_p0'); e.value *= 1.05; e.dispatchEvent(new Event('change'))")
    both = tab.evaluate(names)
    for name, labels in alone.items():
        assert both[name] == [*labels, *(f"{one} pinned" for one in labels)], name
    now, kept = tab.evaluate("[charts.speed.data[1], charts.speed.data[2]]")
    assert np.allclose(kept, first, rtol=1e-9) and not np.allclose(now, first, rtol=1e-5)
    # all charts with both settings, drawn anew from their numbers [ms]
    cost = tab.evaluate("(() => { const t = performance.now(); for (const [id, s] of Object.entries({ ...shownNow }))"
                        " plot(id, s.series, s.xs, id, 'x'); return performance.now() - t; })()")  # fmt: skip
    print(f"overlay of two settings: {cost:.0f} ms")
    assert cost < 100 and errors == []


@pytest.mark.slow
def test_the_page_shows_the_chosen_units(browser, tmp_path):
    path = tmp_path / "p.html"
    done = CliRunner().invoke(mechsym, ["page", "zotov-89", "--units", "bar, rad/s, cm", "--out", str(path)])
    assert done.exit_code == 0, done.output
    tab = browser.new_context(offline=True).new_page()
    tab.goto(path.as_uri())
    tab.wait_for_function("window.mechsym && window.mechsym.last")
    assert "Speed at the end 9.32 rad/s" in tab.inner_text("#verdict")
    assert tab.locator("label", has=tab.locator("#slider_p0")).locator("output").inner_text() == "50 bar"
    tab.locator("#fields summary").click()
    assert tab.input_value("#field_H") == "100"  # cm
    before = tab.evaluate("mechsym.last.mean")
    tab.locator("#field_p0").fill("50")
    tab.locator("#field_p0").dispatch_event("change")
    assert tab.evaluate("mechsym.last.mean") == pytest.approx(before, rel=1e-12)
    tab.context.close()


@pytest.mark.slow
def test_the_file_is_small_and_names_nothing_outside(files):
    text = files("zotov-89").read_text().replace("https://github.com/leeoniya/uPlot", "")
    assert len(text) < 250_000
    assert "http" not in text and "src=" not in text and "{{" not in text


@pytest.mark.slow
def test_without_the_extra_one_line_names_it(tmp_path):
    code = (
        "import sys, importlib.util as u; f = u.find_spec; "
        "u.find_spec = lambda n, *a: None if n == 'ziglang' else f(n, *a); from mechsym.cli import main; main()"
    )
    words = ["page", "zotov-89", "--out", str(tmp_path / "p.html")]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and not list(Path(tmp_path).iterdir())
    assert done.stderr.strip() == "mechsym: a page that simulates needs the extra web: pip install 'mechsym[web]'"


@pytest.mark.slow
def test_the_command_says_what_it_wrote(tmp_path):
    path = tmp_path / "p.html"
    done = CliRunner().invoke(mechsym, ["page", "zotov-89", "--out", str(path), "--json"])
    assert done.exit_code == 0, done.output
    assert json.loads(done.output)["written"] == [str(path)]


def live(name):
    return LiveRun(name=name, about="", ready=lambda: ready(cases.load(name)))


@pytest.mark.slow
def test_a_report_simulates_where_the_compiler_is(browser, tmp_path):
    """The section of a report is the page itself, with the numbers of the page, and nothing else changes."""
    report = tmp_path / "r.html"
    report.write_text(with_live("<!doctype html><html><body><h1>before</h1></body></html>", [live("zotov-89")]))
    assert report.stat().st_size < 200_000
    tab = browser.new_context(offline=True).new_page()
    tab.goto(report.as_uri())
    inner = tab.frame_locator("iframe")
    inner.locator("#verdict").wait_for()
    assert "ripple 0 %" in inner.locator("#verdict").inner_text()
    assert tab.inner_text("h1") == "before" and "zotov-89 simulates here" in tab.inner_text("h2")
    tab.context.close()


def test_a_report_says_what_is_missing_for_the_page(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    text = with_live("<body>all of it</body></html>", [live("zotov-89")])
    assert text.startswith("<body>all of it<h2") and text.endswith("</body></html>")
    assert "Not in this report: a page that simulates needs the extra web: pip install" in text
    assert "iframe" not in text


def test_what_cannot_be_exported_is_said_in_the_report():
    def refuse():
        raise BadInput("w.toml: <closed> by constraints")

    text = with_live("<body></body>", [LiveRun(name="w", about="", ready=refuse)])
    assert "Not in this report: w.toml: &lt;closed&gt; by constraints" in text


@pytest.mark.parametrize(("name", "turns"), [("zotov-89", 1), ("generator", 2), ("chmielewski", 1)])
def test_the_curves_of_the_page_go_over_a_whole_cycle(exported, name, turns):
    from mechsym.out.web.build import _data

    assert _data(exported(name)[1])["period"] == pytest.approx(turns * 2 * np.pi, rel=1e-12)


def test_the_shaft_of_a_new_engine_is_as_elastic_as_that_of_its_run(tmp_path):
    from mechsym.out.web.build import _data

    case = cases.load(str(write_engine("inline", 0.086, 0.086, 2, tmp_path / "two.toml")[0]))
    block = block_of(case.name, case.about, ready(case))
    found = _data(block)
    assert found["speed"] == "phi_fd" and found["angle"] == "phi_f" and len(block.states) == 6
    assert {curve.state for curve in block.curves} == {0, 1}  # each gas force on its own throw
    sliders = {s["name"]: s["sets"] for s in found["sliders"]}
    assert sliders["phi_fd"] == ["phi1d", "phi2d", "phi_fd"]  # it starts without twist
    assert sliders["load_torque"] == ["load_torque"]


@pytest.mark.slow
def test_nobody_is_offered_a_misfire_without_gas(opened):
    tab, errors, _ = opened("chmielewski")
    assert not tab.is_visible("#misfire") and tab.is_visible("#slider_k1") and errors == []


def test_a_system_without_a_process_left_has_failed_and_makes_no_report_without_its_page(monkeypatch):
    def full(*_, **__):
        raise BlockingIOError(errno.EAGAIN, os.strerror(errno.EAGAIN))

    block = block_of("chmielewski", "", ready(cases.load("chmielewski")))
    monkeypatch.setattr(subprocess, "Popen", full)
    with pytest.raises(OSError, match=os.strerror(errno.EAGAIN)):
        page(block)


@pytest.mark.slow
def test_a_loop_by_constraint_passes_its_dead_point_in_the_browser_and_has_a_slider_for_each_letter(browser, tmp_path):
    linkages = Path(__file__).parents[2] / "examples" / "mechanisms" / "linkages.py"
    case = tmp_path / "swings.toml"
    case.write_text(
        f'mechanism = "{linkages}:chebyshev"\n[drive]\ntorque = "2 N*m"\n[simulation]\nt_end = "1 s"\n'
        "tolerance = 1e-12\n"
    )
    done = CliRunner().invoke(mechsym, ["simulate", str(case), "--trust", "--json"])
    told = json.loads(done.output)
    assert {event["kind"] for event in told["events"]} == {"dead_point"}
    done = CliRunner().invoke(mechsym, ["page", str(case), "--out", str(tmp_path / "p.html")])
    assert done.exit_code == 0, done.output
    tab = browser.new_context(offline=True).new_page()
    tab.goto((tmp_path / "p.html").as_uri())
    tab.wait_for_function("window.mechsym && window.mechsym.last")
    found = tab.evaluate("mechsym.run({}, [1], [], 1, 1e-13)")
    assert [found["phi"][0], found["phid"][0]] == pytest.approx(
        [told["final_state"]["phi"], told["final_state"]["phid"]], rel=1e-9
    )
    letters = {e.get_attribute("id") for e in tab.query_selector_all("input[type=range]")}
    assert letters >= {"slider_crank_inertia", "slider_coupler_mass", "slider_rocker_u"}
    tab.context.close()


def test_what_slides_goes_in_metres_and_each_coordinate_has_a_curve(browser, tmp_path):
    """A crane: its trolley slides, its load swings; the verdict is that of the run."""
    case = cases.load(str(Path(__file__).parents[1] / "plausible" / "own" / "crane.toml"))
    run = simulate(ready(case).problem, Settings(check="none"))
    file = tmp_path / "crane.html"
    file.write_text(page(block_of(case.name, case.about, ready(case))), encoding="utf-8")
    tab = browser.new_page()
    tab.goto(file.as_uri())
    tab.wait_for_function("window.mechsym && window.mechsym.last")
    said = tab.inner_text("#verdict")
    ends = [f"{v:.4g}" for v in (run.columns["sd"].min(), run.columns["sd"].max())]
    assert "rpm" not in said
    assert f"{ends[0]} to {ends[1]} m/s" in said
    assert tab.inner_text("#speed b") == "speed [m/s] over time"
    assert tab.inner_text("#moves_rad b") == "coordinates [deg] over time"
    assert tab.inner_text("#moves_m b") == "coordinates [mm] over time"
    for q in ("s", "theta"):
        drawn = tab.evaluate(f"window.mechsym.last.r.{q}")
        assert len(drawn) == len(tab.evaluate("window.mechsym.last.r.t"))
        assert drawn[-1] == pytest.approx(run.columns[q][-1], rel=1e-6)
    tab.close()


def test_words_of_a_case_are_no_page(exported):
    """A comment of HTML within a script would keep the script from ending."""
    block = dataclasses.replace(exported("zotov-89")[1], about="</script><!-- <script> & ü")
    (data,) = [line for line in page(block).splitlines() if line.startswith("const data = ")]
    assert "<" not in data
    assert json.loads(data.removeprefix("const data = ").rstrip(";"))["about"] == block.about
