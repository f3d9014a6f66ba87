"""`make nearby`: every number of a case is moved, and what its commands then say more than before is told."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1]))

from fuzz import nearby  # noqa: E402
from fuzz.judge import Answer  # noqa: E402
from mechsym import cases  # noqa: E402

TEXT = 'mechanism = "m"\n[a]\nr = "0.2 m"\nn = 3\nx = 1.5\nz = 0.0\nfile = "two words"\n[doubts]\nc = { up_to = 1.0 }\n'


def test_every_number_is_moved_with_its_unit():
    assert list(nearby._changed(TEXT)) == [
        ("a.r", "0.19 m"), ("a.r", "0.21 m"), ("a.x", "1.425"), ("a.x", "1.575")
    ]  # fmt: skip


def test_every_built_in_case_is_tried():
    assert sorted(nearby.COMMANDS) == sorted(cases.names())


def test_what_the_case_as_shipped_does_not_say_is_told(monkeypatch, capsys):
    def answered(made):
        changed = any("r2=" in word for word in made["argv"])
        doubts = [{"code": "size", "quantity": "r2", "value": 1.0, "usual": "at most 0.5"}] if changed else []
        return Answer(0, f'{{"doubts": {doubts}}}'.replace("'", '"'), "", 0.0)

    monkeypatch.setattr(nearby, "answer", answered)
    monkeypatch.setattr(nearby, "WARM", ())
    assert nearby.main(["moroianu"]) == 0
    *lines, last = capsys.readouterr().out.splitlines()
    assert len(lines) == 2 * len(nearby.COMMANDS["moroianu"])
    assert all("parameters.r2=" in line and "size: r2 = 1, usual is at most 0.5" in line for line in lines)
    assert last.endswith(f"{len(lines)} say what the case as shipped does not")
