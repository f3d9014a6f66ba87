"""A Python file that a case names runs where it is the user's own, and elsewhere when he has said so."""

import json
import os
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput

# leaves a mark beside itself whenever it runs
DISC = """
from pathlib import Path

from mechsym.derive import Mechanism

(Path(__file__).parent / "ran").touch()


def disc():
    m = Mechanism("disc", about="A disc.")
    phi = m.coordinates("phi")
    J = m.parameters("J", "kg*m^2", above=0)
    M = m.inputs("M", "N*m")
    m.rotor("disc", angle=phi, drive=M, inertia=J)
    w = m.link("wheel", turns=phi, inertia=J)
    m.pin("O", m.frame, w)
    m.torque(M, along=phi)
    return m
"""
CASE = """
mechanism = "{}"
[parameters]
J = 2
[drive]
torque = "3 N*m"
[simulation]
t_end = "1 s"
"""
FORMULA = '[[formula]]\nname = "law"\ntext = "J*phidd"\nagainst = "{}:bias"\n'
DEFAULT = ["simulate", "engine.toml"]


def typed(*words):
    """A command as typed: exit status and what it says of bad input."""
    done = CliRunner().invoke(mechsym, list(words))
    if isinstance(done.exception, BadInput):
        return 2, str(done.exception)
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return done.exit_code, done.output


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """A home, a folder in it that is worked in, and one beside that with a case and what it names."""
    for folder in ("home/work", "home/mail"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "home/mail/disc.py").write_text(DISC)
    (tmp_path / "home/mail/engine.toml").write_text(CASE.format("./disc.py"))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("USERPROFILE", str(tmp_path / "home"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path / "home/work")
    return tmp_path / "home"


def ran(machine, folder="mail"):
    mark = machine / folder / "ran"
    there = mark.exists()
    mark.unlink(missing_ok=True)
    return there


FOREIGN = {
    "case and file elsewhere": (["simulate", "../mail/engine.toml"], {}),
    "their full path": (["simulate", "{home}/mail/engine.toml"], {}),
    "a case at hand names a file elsewhere": (DEFAULT, {"engine.toml": CASE.format("../mail/disc.py")}),
    "a link to elsewhere": (DEFAULT, {"engine.toml": CASE.format("./link.py")}),
    "one of two cases": (["compare", "nunes-slider-crank", "../mail/engine.toml"], {}),
    "the points of a sweep": (["sweep", "../mail/engine.toml", "--over", "parameters.J=1..2:2"], {}),
    "a study": (["study", "s.toml"], {"s.toml": 'title = "t"\ncase = "../mail/engine.toml"\n[[sweep]]\nname = "a"\n'
                                                'over = ["parameters.J=1..2:2"]\n'}),
    "a list of formulas": (["audit", "--file", "f.toml"], {"f.toml": FORMULA.format("../mail/disc.py")}),
    "an export": (["export", "../mail/engine.toml", "--to", "c", "--out", "c"], {}),
    "the workbench": (["app", "../mail/engine.toml", "--check"], {}),
}  # fmt: skip


@pytest.mark.parametrize(("words", "files"), FOREIGN.values(), ids=FOREIGN)
def test_a_program_from_elsewhere_is_not_run(machine, words, files):
    for name, text in files.items():
        Path(name).write_text(text)
    os.symlink("../mail/disc.py", "link.py")
    code, said = typed(*(word.format(home=machine) for word in words))
    assert not ran(machine)
    if code != 3:  # a list of formulas has a row for each, this one untestable
        assert code == 2 and "\n" not in said.strip()
    assert str(machine / "mail/disc.py") in said and "--trust" in said


def test_told_once_for_a_folder_it_is_kept(machine):
    assert typed("simulate", "../mail/engine.toml", "--trust")[0] == 0 and ran(machine)
    (machine / "mail/disc.py").write_text(DISC.replace("A disc.", "Another."))
    assert typed("simulate", "../mail/engine.toml")[0] == 0 and ran(machine)
    (machine / "mail/later").mkdir()  # what is unpacked below it later is another folder
    (machine / "mail/later/disc.py").write_text(DISC.replace("A disc.", "A third."))
    (machine / "mail/later/engine.toml").write_text(CASE.format("./disc.py"))
    assert typed("simulate", "../mail/later/engine.toml")[0] == 2 and not ran(machine, "mail/later")


def test_the_same_content_is_not_run_again_and_so_not_asked_for(machine):
    assert typed("simulate", "../mail/engine.toml", "--trust")[0] == 0 and ran(machine)
    (machine / "copy").mkdir()
    for name in ("disc.py", "engine.toml"):
        (machine / "copy" / name).write_text((machine / "mail" / name).read_text())
    assert typed("simulate", "../copy/engine.toml")[0] == 0 and not ran(machine, "copy")


def test_what_is_the_users_own_runs_without_a_word(machine, monkeypatch):
    code, said = typed("eval", "../mail/disc.py", "--set", "J=2", "--set", "M=3")  # as `python disc.py`
    assert code == 0 and ran(machine), said
    (machine / "mail/disc.py").write_text(DISC.replace("A disc.", "Another."))
    monkeypatch.chdir(machine / "mail")
    assert typed("simulate", "engine.toml")[0] == 0 and ran(machine)
    (machine / "work/inner").mkdir()
    (machine / "work/inner/disc.py").write_text(DISC.replace("A disc.", "A third."))
    (machine / "work/inner/engine.toml").write_text(CASE.format("./disc.py"))
    monkeypatch.chdir(machine / "work")
    assert typed("simulate", "inner/engine.toml")[0] == 0 and ran(machine, "work/inner")


def test_what_the_program_wrote_is_the_users_own(machine, monkeypatch):
    assert typed("new", "mechanism", "toggle")[0] == 0
    monkeypatch.chdir(machine / "mail")
    Path("../work/toggle.py").write_text(DISC)  # he has changed it
    Path("../work/toggle.toml").write_text(CASE.format("./toggle.py"))
    assert typed("simulate", "../work/toggle.toml")[0] == 0 and ran(machine, "work")


def test_in_the_home_folder_what_lies_below_it_is_not_at_hand(machine, monkeypatch):
    monkeypatch.chdir(machine)
    assert typed("simulate", "mail/engine.toml")[0] == 2 and not ran(machine)
    for name in ("disc.py", "engine.toml"):
        (machine / name).write_text((machine / "mail" / name).read_text())
    assert typed("simulate", "engine.toml")[0] == 0 and ran(machine, ".")


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="rights of POSIX")
def test_a_list_that_others_may_write_says_nothing(machine, tmp_path):
    assert typed("simulate", "../mail/engine.toml", "--trust")[0] == 0 and ran(machine)
    (machine / "mail/disc.py").write_text(DISC.replace("A disc.", "Another."))
    (tmp_path / "cache/mechsym/trusted").chmod(0o666)
    assert typed("simulate", "../mail/engine.toml")[0] == 2 and not ran(machine)


def test_check_runs_nothing_and_from_python_one_says_himself_what_runs(machine):
    code, said = typed("check", "../mail/engine.toml", "--json")
    assert code == 0 and json.loads(said)["skipped"] == ["parameters"] and not ran(machine)
    assert cases.load("../mail/engine.toml").need("parameters").J == 2 and ran(machine)
