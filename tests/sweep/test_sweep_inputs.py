"""A sweep goes on with what the files say now: each kind of file that a case reads is edited between two sweeps."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.files import inputs
from mechsym.mechanisms import own
from mechsym.native import cache
from mechsym.report import case_report
from mechsym.sweep import Means, Plan, sweep

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
SWING = """
mechanism = "MECHANISM"
[parameters]
l = 1
mass = 2
[drive]
torque = 30
[simulation]
t_end = 1
"""
DECLARED = """
from mechsym.derive import Mechanism, sin
from helper import SHARE

def swing():
    m = Mechanism("swing", about="A bar about a pin.")
    phi = m.coordinates("phi")
    l, mass = m.parameters("l", "m", above=0), m.parameters("mass", "kg", above=0)
    M = m.inputs("M", "N*m")
    bar = m.link("bar", turns=phi, mass=mass, inertia=mass * l**2 / 12, centre=(SHARE * l, 0))
    m.pin("O", m.frame, bar)
    m.weight(0, -m.parameters("g", "m/s^2", default=9.81))
    m.torque(M, along=phi)
    return m
"""
HALF = "from sympy import Rational\nSHARE = Rational(1, 2)"
OWN = {
    "swing.toml": SWING.replace("MECHANISM", "./swing.py"), "swing.py": DECLARED,
    "helper.py": "from deeper import SHARE", "deeper.py": "from folder.deepest import SHARE",
    "folder/__init__.py": "", "folder/deepest.py": HALF,
}  # fmt: skip
PLUGIN = {
    "brought.toml": SWING.replace("MECHANISM", "swing"), "swings/__init__.py": "", "swings/below/__init__.py": "",
    "swings/below/helper.py": HALF, "swings/swing.py": DECLARED.replace("from helper", "from swings.below.helper"),
}  # fmt: skip
#: Case, and the sweep of it; then the file that is edited, and how
BAR = ("swing.toml", ("mass=2,3",), "simulate", ("speed_max",))
EDITS = {
    "case": (BAR, "swing.toml", "l = 1", "l = 2"),
    "mechanism": (BAR, "swing.py", "9.81", "9.82"),
    "helper": (BAR, "helper.py", "import SHARE", "import SHARE; SHARE *= 2"),
    "helper-of-helper": (BAR, "deeper.py", "import SHARE", "import SHARE; SHARE *= 2"),
    "package-beside": (BAR, "folder/deepest.py", "1, 2", "1, 3"),
    "plug-in": (("brought.toml", *BAR[1:]), "swings/swing.py", "9.81", "9.82"),
    "file-of-plug-in": (("brought.toml", *BAR[1:]), "swings/below/helper.py", "1, 2", "1, 3"),
    "diagram": (("generator.toml", ("m5=0.17,0.18",), "forces", ("max.side_force",)), "generator-synthetic.csv",
                "pressure_bar\n0,0.000000,4.321", "pressure_bar\n0,0.000000,4.331"),
    "torque": (("cam-balancer.toml", ("spring.p0=1.4,1.5 MPa",), "hinge", ("hinge_torque_max",)), "cam-balancer.csv",
               ",3.6782", ",3.9782"),
    "bearings": (("size.toml", ("bore=58,59 mm",), "size", ("all",)), "bearings.csv", "15100", "16100"),
    "materials": (("size.toml", ("bore=58,59 mm",), "size", ("all",)), "materials.toml", "1310 MPa", "1210 MPa"),
    "other-case": (("hinge.toml", ("spring.p0=5,6 MPa",), "hinge", ("retune",)), "other.toml", "142 rpm", "120 rpm"),
    "points": (("points.toml", ("spring.p0=5,6 MPa",), "codesign", ("flywheel_inertia",)), "points.csv", "89", "85"),
}  # fmt: skip
LONG = ("diagram", "torque", "bearings", "materials", "other-case", "points")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    beside = Path(cases.__file__).parent
    rules = beside.parent / "sizing" / "rules"
    texts = (
        OWN
        | PLUGIN
        | {name: (EXAMPLES / name).read_text() for name in ("cam-balancer.toml", "cam-balancer.csv", "compressor.py")}
    )
    texts |= {name: (beside / name).read_text() for name in ("generator.toml", "generator-synthetic.csv")}
    texts |= {name: (rules / name).read_text() for name in ("bearings.csv", "materials.toml")}
    files = 'materials_file = "materials.toml"\nbearings_file = "bearings.csv"\n'
    texts["size.toml"] = cases.text("nunes-hypocycloid").replace("[sizing]", f"[sizing]\n{files}#", 1)
    texts["hinge.toml"] = cases.text("zotov-89").replace('case = "zotov-142"', 'case = "other.toml"')
    texts["other.toml"] = cases.text("zotov-142")
    texts["points.toml"] = re.sub(r'curve = "propeller"', 'curve = "points.csv"', cases.text("zotov-89"))
    texts["points.csv"] = "speed [rpm],load [bar]\n89,8\n142,20\n"
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    # what was derived in an earlier test run says nothing of this one
    (tmp_path / "cache").mkdir()
    monkeypatch.setattr(cache, "writable", lambda: tmp_path / "cache")
    monkeypatch.setattr(own, "brought", lambda: {"swing": str(tmp_path / "swings" / "swing.py")})
    return tmp_path


def swept(plan, folder):
    case, over, analysis, show = plan
    return sweep(Plan(case=case, over=over, analysis=analysis, show=show), means=Means(folder=folder, jobs=1))


def marks(kind):
    return [pytest.mark.slow] * (kind in LONG) + [pytest.mark.heavy] * (kind == "points")  # co-designs


@pytest.mark.parametrize("kind", [pytest.param(k, marks=marks(k)) for k in EDITS])
def test_an_edited_file_is_read_anew(folder, kind):
    plan, name, old, new = EDITS[kind]
    (folder / "out").mkdir()
    first = swept(plan, folder / "out")
    assert (first.kept, swept(plan, folder / "out").kept) == (0, 2)
    text = (folder / name).read_text(encoding="utf-8")
    assert old in text
    (folder / name).write_text(text.replace(old, new), encoding="utf-8")
    second, fresh = swept(plan, folder / "out"), swept(plan, None)
    assert second.kept == 0 and second.aside
    np.testing.assert_equal(list(second.outcomes), list(fresh.outcomes))
    assert second.outcomes != first.outcomes
    # as it was: its points are there
    (folder / name).write_text(text, encoding="utf-8")
    assert swept(plan, folder / "out").kept == 2


def test_a_file_that_changes_while_a_sweep_runs_is_refused(folder):
    def edit(done):
        (folder / "helper.py").write_text(OWN["helper.py"] + "; SHARE *= 2")

    case, over, analysis, show = BAR
    plan = Plan(case=case, over=(*over, "drive.torque=20..40:9"), analysis=analysis, show=show)
    with pytest.raises(BadInput, match=r"helper.py has changed while the sweep ran"):
        sweep(plan, edit, Means(folder=folder, jobs=1))
    assert sweep(plan, means=Means(folder=folder, jobs=1)).kept == 0


@pytest.mark.slow
def test_processes_tell_what_they_have_read(folder):
    case, over, analysis, show = EDITS["torque"][0]
    plan = Plan(case=case, over=over, analysis=analysis, show=show)
    for kept in (0, 2):
        assert sweep(plan, means=Means(folder=folder, jobs=2)).kept == kept
    file = folder / "cam-balancer.csv"
    file.write_text(file.read_text().replace(",3.6782", ",3.9782"))
    assert sweep(plan, means=Means(folder=folder, jobs=2)).kept == 0


def test_a_file_that_is_not_there_is_an_input_too(tmp_path):
    with inputs.reads() as read:
        with pytest.raises(BadInput):
            inputs.read_text(tmp_path / "a.csv")
        with inputs.reads() as inner:
            (tmp_path / "b.csv").write_text("1")
            inputs.read_text(tmp_path / "b.csv")
    assert list(read) == [str(tmp_path / "a.csv"), str(tmp_path / "b.csv")] and list(inner) == [str(tmp_path / "b.csv")]
    assert inputs.changed(read) == []
    (tmp_path / "a.csv").write_text("1")
    assert inputs.changed(read) == [str(tmp_path / "a.csv")]
    with inputs.reads() as read:
        inputs.read_text(tmp_path / "b.csv")
        (tmp_path / "b.csv").write_text("2")
        inputs.read_text(tmp_path / "b.csv")
    assert inputs.changed(read) == [str(tmp_path / "b.csv")]


def test_summary_and_report_tell_what_was_read(folder):
    def told():
        done = CliRunner().invoke(mechsym, ["simulate", "swing.toml", "--out", "run"])
        assert done.exit_code == 0, done.output
        inputs_told = json.loads(Path("run/summary.json").read_text())["run"]["inputs"]
        report = case_report(cases.load("swing.toml"), ["simulate"])
        return {Path(name).name: content for name, content in inputs_told.items()}, report.digest

    first, report = told()
    assert set(first) == {"swing.toml", "swing.py", "helper.py", "deeper.py", "__init__.py", "deepest.py"}
    (folder / "deeper.py").write_text(OWN["deeper.py"] + "; SHARE *= 2")
    second, report_now = told()
    assert {name for name in first if first[name] != second[name]} == {"deeper.py"} and report != report_now


def test_two_helpers_of_one_name_are_not_mixed_up(folder):
    for name, share in (("a", "1, 2"), ("b", "1, 3")):
        (folder / name).mkdir()
        (folder / name / "swing.py").write_text(DECLARED)
        (folder / name / "helper.py").write_text(HALF.replace("1, 2", share))
    first, second = (own.load(f"./{name}/swing.py").code for name in "ab")
    assert first != second and not list(folder.rglob("__pycache__"))


#: Modules that read files which no user names for a result: texts of the package, what was written before, a cache
OTHER_READERS = set(
    """
    app/commands.py app/saving.py app/server.py audit/theory/catalogue.py cases/numbers.py cli/__init__.py cli/audit.py
    derive/build.py files/__init__.py files/inputs.py files/trust.py mechanisms/own.py mechanisms/record.py
    native/cache.py native/compiler.py
    out/cad/step.py out/fmi/build.py out/pdf.py out/web/build.py papers/rows.py proof/motion.py sweep/store.py
    transaction.py
""".split()
)


def test_files_of_the_user_are_read_in_one_place():
    root = Path(cases.__file__).parents[1]
    reading = re.compile(r"(\S+)\.(?:read_text|read_bytes)\(|\bopen\(|\b(?:loadtxt|genfromtxt|read_csv)\(")
    found = set()
    for path in root.rglob("*.py"):
        for line in path.read_text(encoding="utf-8").splitlines():
            own_text = "resources.files" in line or "(room /" in line or "_folder()" in line
            if reading.search(line) and not own_text and not line.strip().startswith(("#", ">>>")):
                found.add(path.relative_to(root).as_posix())
    assert found == OTHER_READERS
