"""Every figure of every command: no text on another or out of the paper, ids once in a page, colours of the palette."""

import pytest
from built_in import DATA, needed
from click.testing import CliRunner
from pictures import colours, drawn, faults, ids, unitless

from mechsym import style
from mechsym.cli import mechsym
from mechsym.papers.sources import sources

CASES = (
    "alpha-stirling balandin chmielewski generator generator-breathing moroianu nunes-hypocycloid nunes-slider-crank "
    "opposed-pistons zotov-142 zotov-89"
).split()
SOON = {("cycle", "nunes-slider-crank"), ("cycle", "alpha-stirling"), ("simulate", "moroianu")}
DRAWS = {
    "cycle": ["alpha-stirling", "generator-breathing", "nunes-hypocycloid", "nunes-slider-crank"],
    "forces": [c for c in CASES if c not in ("alpha-stirling", "chmielewski")],
    "hinge": ["generator", "zotov-142", "zotov-89"],
    "simulate": CASES[1:],
    "size": ["nunes-hypocycloid", "nunes-slider-crank"],
}
RUNS = [(command, case) for command, cases in DRAWS.items() for case in cases]
ENGINES = {
    "ship": ["--kind", "two-stroke-crosshead", "--bore", "0.5", "--stroke", "2 m", "--cylinders", "1"],
    "six": ["--kind", "inline", "--bore", "86 mm", "--stroke", "86 mm", "--cylinders", "6"],
    "twin": ["--kind", "v", "--bore", "86 mm", "--stroke", "86 mm", "--cylinders", "2"],
}
_MAPS = ("sweep", "codesign")  # filled with a range of colours


def marked(run):
    return run if run in SOON else pytest.param(*run, marks=pytest.mark.slow)


def look(monkeypatch, folder, words):
    found = drawn(monkeypatch)
    done = CliRunner().invoke(mechsym, [*words, "--out", str(folder)])
    assert done.exit_code in (0, 1) and found, done.output
    figures = list({id(figure): figure for figure in found}.values())
    # before the figures are laid out anew for the test
    pages = {path.name: path.read_text(encoding="utf-8") for path in folder.rglob("*.html")}
    for name, text in pages.items():
        assert not ids(text), name
    pictures = [path.read_text(encoding="utf-8") for path in folder.rglob("*.svg")]
    for text in pictures:
        assert "<title id=" in text and "<desc id=" in text and "<text" in text
        assert colours(text) <= set(style.DARK) or words[0] in _MAPS
    assert {figure.get_label() or str(i): faults(figure) for i, figure in enumerate(figures) if faults(figure)} == {}
    assert {figure.get_label(): unitless(figure) for figure in figures if unitless(figure)} == {}


@pytest.mark.parametrize(("command", "case"), [marked(run) for run in RUNS])
def test_built_in_cases(command, case, tmp_path, monkeypatch):
    if case == "generator" and not DATA:
        pytest.skip("MECHSYM_TEST_DATA is not set: the measured diagrams are not here")
    values = needed(case) if command == "simulate" or case == "generator" else {}
    words = [word for key, value in values.items() for word in ("--set", f"{key}={value}")]
    look(monkeypatch, tmp_path / "out", [command, case, *words])


@pytest.mark.slow
@pytest.mark.parametrize("command", ["forces", "simulate"])
@pytest.mark.parametrize("name", ENGINES)
def test_new_engines(name, command, tmp_path, monkeypatch):
    written = CliRunner().invoke(mechsym, ["new", "engine", name, *ENGINES[name], "--out", str(tmp_path)])
    assert written.exit_code == 0, written.output
    look(monkeypatch, tmp_path / "out", [command, str(tmp_path / f"{name}.toml")])


@pytest.mark.slow
@pytest.mark.parametrize(
    "words",
    [
        ["forces", "zotov-89", "--comparison"],
        pytest.param(["forces", "nunes-slider-crank", "--comparison"], marks=pytest.mark.heavy),
        ["compare", "nunes-slider-crank", "nunes-hypocycloid"],
        ["simulate", "chmielewski", "--dampings", "1,5"],
        ["sweep", "zotov-89", "--over", "spring.p0=4..6 MPa:3"],
        ["sweep", "zotov-89", "--of", "guides", "--over", "spring.p0=4..6 MPa:3", "--over", "spring.H=0.8..1 m:3"],
        pytest.param(["optimise", "nunes-hypocycloid", "--set", "optimise.against=p_max"], marks=pytest.mark.heavy),
        pytest.param(["codesign", "zotov-89", "--ripple", "2%"], marks=pytest.mark.heavy),
        ["forces", "moroianu", "--units", "bar, rad, N, N*m, inch"],
    ],
    ids=" ".join,
)
def test_other_pictures(words, tmp_path, monkeypatch):
    look(monkeypatch, tmp_path / "out", words)


@pytest.mark.slow
def test_the_sheet_of_a_guide(tmp_path, monkeypatch):
    found = drawn(monkeypatch)
    done = CliRunner().invoke(mechsym, ["guide", "zotov-89", "--sheet", str(tmp_path / "sheet.svg")])
    assert done.exit_code == 0 and len(found) == 1, done.output
    assert not faults(found[0])


@pytest.mark.slow
@pytest.mark.heavy
@pytest.mark.parametrize("source", sources(None), ids=lambda s: s.name)
def test_the_figures_of_a_paper(source):
    if not DATA:
        pytest.skip("MECHSYM_TEST_DATA is not set: the measured diagrams are not here")
    figures = source.figures()
    assert {name: faults(figure) for name, figure in figures.items() if faults(figure)} == {}
    axes = [axis for figure in figures.values() for axis in figure.axes if axis.get_visible() and axis.axison]
    bare = [text for axis in axes for text in (axis.get_xlabel(), axis.get_ylabel()) if text and "[" not in text]
    assert not bare
