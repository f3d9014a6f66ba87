"""`mechsym audit`: exit statuses, keys, one line for bad input."""

import json
from types import SimpleNamespace

import pytest

from mechsym import cli

KEYS = {
    "source", "equation", "claim", "verdict", "max_rel_error", "order", "correction", "corrected_max_rel_error", "note",
}  # fmt: skip


@pytest.fixture
def run(monkeypatch, capsys):
    def command(*arguments):
        monkeypatch.setattr("sys.argv", ["mechsym", "audit", *arguments])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        out, err = capsys.readouterr()
        return SimpleNamespace(returncode=ended.value.code or 0, stdout=out, stderr=err)

    return command


@pytest.mark.parametrize(
    ("formula", "status", "verdict"),
    [
        (r"\frac{R \sin(\varphi+\psi)}{\cos\psi}", 0, "exact"),
        ("R*sin(phi)", 0, "truncation"),
        ("R*sin(phi - psi)/cos(psi)", 1, "misprint"),
        ("R*R", 1, "wrong"),
    ],
)
def test_own_formula(run, formula, status, verdict):
    done = run("--formula", formula, "--against", "crosshead.dx_dphi", "--letters", "R=r1+r2", "--json")
    row = json.loads(done.stdout)
    assert done.returncode == status, done.stderr
    assert row["verdict"] == verdict and set(row) >= KEYS


X = ("--formula", "r*(1 - cos(phi))", "--against", "slider_crank.x")
BAD = [
    (("--formula", "__import__('os')", "--against", "crosshead.inertia"), "not a known function"),
    (("--formula", "q", "--against", "crosshead.inertia"), "unknown letter"),
    (("--formula", "r", "--against", "crosshead.nothing"), "no quantity"),
    (("--formula", "r", "--against", "nobody.inertia"), "theories are"),
    (("--formula", "r"), "needs --against"),
    (("--formula", "r", "--against", "crosshead.x", "--case", "chmielewski"), "is of the mechanism"),
    (("--formula", "r", "--against", "crosshead.x", "--letters", "R"), "LETTER=EXPRESSION"),
    (("--formula", "r", "--against", "crosshead.x", "--source", "prymak"), "stand alone"),
    ((*X, "--letters", "R=r, R=l"), "two meanings"),
    ((*X, "--assume", "phid = 0, phid = 5"), "assumed already"),
    ((*X, "--assume", "r > l"), "no values of the letters keep it"),
    ((*X, "--assume", "r = -1"), "lies between 0 and inf"),
    ((*X, "--assume", "l < r/2, l > r"), "contradicts itself"),
    ((*X, "--claim", "within 1"), "is 100 %"),
    (("--against", "crosshead.x"), "belong to --formula"),
    (("--source", "nobody"), "is not known"),
    (("--source", "prymak", "--write"), "all sources"),
    (("--file", "/nowhere.toml"), "cannot be read"),
]


@pytest.mark.parametrize(("arguments", "reason"), BAD, ids=[" ".join(a)[:40] for a, _ in BAD])
def test_bad_input_ends_with_one_line(run, arguments, reason):
    done = run(*arguments)
    assert done.returncode == 2
    assert reason in done.stderr and done.stderr.count("\n") == 1 and not done.stdout


@pytest.mark.parametrize(
    ("option", "idle"), [(("--letters", "q=r+l"), "q of --letters"), (("--assume", "m = 0"), "m = 0")]
)
def test_what_is_not_read_is_told(run, option, idle):
    row = json.loads(run(*X, *option, "--claim", "within 99 %", "--json").stdout)
    assert f"not read: {idle}" in row["note"]


@pytest.mark.parametrize("assume", ["r < l", "l > 2*r, l < 9*r", "r < l/3", "phid = 0, phidd = 0"])
def test_assumptions_that_machines_keep_are_taken(run, assume):
    done = run(*X, "--assume", assume, "--claim", "within 99 %", "--json")
    assert done.returncode == 0 and "not read" not in json.loads(done.stdout)["note"]


def test_file_of_formulas(run, tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(
        """
        [[formula]]
        name = "velocity"
        text = '\\frac{R\\sin(\\varphi+\\psi)}{\\cos\\psi}'
        against = "crosshead.dx_dphi"
        letters = {R = "r1 + r2"}

        [[formula]]
        text = "inertia*phid**2"
        against = "crosshead.kinetic_energy"
        """
    )
    done = run("--file", str(file), "--json")
    rows = json.loads(done.stdout)
    assert done.returncode == 1 and [r["verdict"] for r in rows] == ["exact", "misprint"]
    assert rows[0]["equation"] == "velocity"


@pytest.mark.parametrize(
    ("content", "reason"),
    [("x = [", "not valid TOML"), ("a = 1", "no [[formula]]"), ("[[formula]]\ntext = 'r'", "text and against"),
     ("[[formula]]\ntext = 'r'\nagainst = 'crosshead.x'\nwho = 'me'", "keys are"),
     ("[[formula]]\ntext = 3\nagainst = 'crosshead.x'", "text in quotes")],
)  # fmt: skip
def test_bad_files_are_refused(run, tmp_path, content, reason):
    file = tmp_path / "bad.toml"
    file.write_text(content)
    done = run("--file", str(file))
    assert done.returncode == 2 and reason in done.stderr and done.stderr.count("\n") == 1


def test_what_cannot_be_read_is_a_row_and_the_others_are_judged(run, tmp_path):
    file = tmp_path / "mine.toml"
    right = "text = 'r*sin(phi + psi)/cos(psi)'\nagainst = 'crosshead.dx_dphi'"
    file.write_text(f"[[formula]]\ntext = 'q'\nagainst = 'crosshead.x'\n[[formula]]\n{right}")
    done = run("--file", str(file), "--json")
    rows = json.loads(done.stdout)
    assert done.returncode == 3 and [r["verdict"] for r in rows] == ["untestable", "exact"]
    assert "unknown letter 'q'" in rows[0]["note"]


def test_one_source_agrees_with_the_record(run):
    done = run("--source", "prymak", "--json")
    rows = json.loads(done.stdout)
    assert done.returncode == 0, done.stderr
    assert {r["source"] for r in rows} == {"003_8746f5f4ad51b1d1"} and all(set(r) >= KEYS for r in rows)


@pytest.mark.parametrize(
    ("angle", "formula", "verdict"),
    [
        ("pi/2", "r + l - sqrt(l**2 - r**2)", "exact"),
        ("pi", "2*r", "exact"),
        ("pi/4", "r*(1 - sqrt(2)/2) + l - sqrt(l**2 - r**2/2)", "exact"),
        ("pi/4", "r*(1 - cos(phi)) + l - sqrt(l**2 - r**2*sin(phi)**2)", "exact"),
        ("1.5", "r*(1 - cos(phi)) + l - sqrt(l**2 - r**2*sin(phi)**2)", "exact"),
    ],
)
def test_a_pose_may_be_assumed(run, angle, formula, verdict):
    words = ("--formula", formula, "--against", "slider_crank.x", "--assume", f"phi = {angle}", "--json")
    assert json.loads(run(*words).stdout)["verdict"] == verdict
