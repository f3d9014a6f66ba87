"""What `make fuzz` once found is answered as the interface says, and the judge of the answers can fail."""

import json
import signal
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2]))

import fuzz.__main__ as fuzzing  # noqa: E402
from fuzz.judge import Answer, answer, judged  # noqa: E402
from fuzz.mutators import make  # noqa: E402
from mechsym import cases  # noqa: E402

FOUND = sorted((Path(__file__).parents[1] / "corpus").glob("*.json"))
LINE = "mechsym: no\n"


@pytest.mark.parametrize("file", FOUND, ids=lambda file: file.stem)
def test_found_once(file):
    made = json.loads(file.read_text(encoding="utf-8"))
    assert judged(made["argv"], answer(made)) is None, made["fault"]


@pytest.mark.parametrize(
    ("argv", "got", "fault"),
    [
        (["cycle"], Answer(0, "text", "", 1.0), None),
        (["cycle", "--json"], Answer(0, '{"a": null}', "", 1.0), None),
        (["cycle"], Answer(2, "", LINE, 1.0), None),
        (["hinge"], Answer(1, "text", "", 1.0), None),
        (["hinge"], Answer(3, "text", "", 1.0), None),
        (["cycle"], Answer(None, "", "", 31.0), "30 s"),
        (["cycle"], Answer(-signal.SIGXCPU, "", "", 31.0), "30 s"),
        (["cycle"], Answer(-11, "", "", 1.0), "exit -11"),
        (["cycle"], Answer(74, "", LINE, 1.0), "exit 74"),
        (["cycle"], Answer(1, "text", "", 1.0), "exit 1 of cycle"),
        (["sweep"], Answer(1, "text", "", 1.0), None),
        (["sweep", "--json"], Answer(0, '{"failed": [{"at": {"speed_rpm": 2e5}}], "doubts": []}', "", 1.0), None),
        (["sweep", "--json"], Answer(0, '{"data": {"speed_rpm": [2e5]}, "doubts": []}', "", 1.0), "speed_rpm"),
        (["hinge"], Answer(1, "", "Traceback (most recent call last):\nKeyError", 1.0), "KeyError"),
        (["cycle"], Answer(0, "text", "x.py:1: RuntimeWarning: divide\n", 1.0), "warning"),
        (["cycle"], Answer(2, "", 2 * LINE, 1.0), "2 lines"),
        (["cycle"], Answer(2, "", "", 1.0), "0 lines"),
        (["cycle"], Answer(2, "text", LINE, 1.0), "beside"),
        (["cycle", "--json"], Answer(0, '{"a": NaN}', "", 1.0), "NaN"),
        (["cycle", "--json"], Answer(0, '{"a": 1', "", 1.0), "delimiter"),
    ],
)
def test_judge(argv, got, fault):
    found = judged(argv, got)
    assert found is None if fault is None else fault in found


def test_a_crash_and_a_hang_are_seen(monkeypatch):
    import os
    import time

    asked = {"argv": ["cases"], "files": {}}
    monkeypatch.setattr("mechsym.cli.main", lambda: os.kill(os.getpid(), signal.SIGKILL))
    assert "exit -9" in judged(["cases"], answer(asked))
    monkeypatch.setattr("mechsym.cli.main", lambda: time.sleep(9))
    assert answer(asked, limit=0.2).code is None


def test_inputs_are_the_same_at_every_run():
    texts = {name: cases.text(name) for name in cases.names()}
    assert [make(1, i, texts) for i in range(50)] == [make(1, i, texts) for i in range(50)]
    assert len({json.dumps(make(1, i, texts)) for i in range(50)}) == 50
    assert {make(1, i, texts)["argv"][0] for i in range(200)} >= {"cycle", "forces", "hinge", "simulate", "audit"}


def test_inputs_come_by_the_command(capsys, monkeypatch, tmp_path):
    """A handful of inputs of every kind, and of formulas of texts alone."""
    monkeypatch.setattr(fuzzing, "CORPUS", tmp_path)
    assert fuzzing.main(["4", "7"]) == 0
    assert fuzzing.main(["4", "7", "printed"]) == 0
    assert capsys.readouterr().out.count("4 inputs of seed 7") == 2
    assert make(7, 0, {}, "printed") == make(7, 0, {}, "printed") != make(7, 1, {}, "printed")
