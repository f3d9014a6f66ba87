"""Compilers that hang, fail or make what is no library: exports and co-designs go on without them, and say so."""

import json
import os
import time
from pathlib import Path

import casadi as ca
import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.errors import MissingExtra
from mechsym.native import compiler, evaluate
from mechsym.out.web import build

pytestmark = pytest.mark.skipif(os.name != "posix", reason="a compiler in the shell")
TEXT = 'for a; do [ "$before" = "-o" ] && echo text > "$a"; before="$a"; done'
BROKEN = {
    "exit 0": "made nothing",
    TEXT: "made no library",
    "exec sleep 60": "did not end in 0.5 s",
    "exit 1": "failed",
}


@pytest.fixture(params=BROKEN)
def words(request, monkeypatch, tmp_path):
    script = tmp_path / "broken"
    script.write_text(f"#!/bin/sh\n{request.param}\n")
    script.chmod(0o755)
    monkeypatch.setenv("CC", str(script))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(compiler, "PATIENCE", 0.5)
    return BROKEN[request.param]


def test_an_fmu_has_its_sources_and_tells_why_no_binary(words, tmp_path):
    line = ["fmu", "chmielewski", "--platforms", "linux64", "--out", str(tmp_path / "drive.fmu"), "--json"]
    result = CliRunner().invoke(mechsym, line)
    checks = json.loads(result.stdout)["checks"]
    assert result.exit_code == 0 and checks["binaries"] == [] and words in checks["missing"]["linux64"]


def test_a_function_for_the_solver_is_interpreted(words, caplog):
    x = ca.SX.sym("x", 2)
    function = ca.Function("node", [x], [x[0] * ca.sin(x[1])])
    assert evaluate.external(function) is function
    assert words.replace("made no library", "made what cannot be loaded") in caplog.text


def test_a_page_is_refused_in_one_line(monkeypatch):
    pytest.importorskip("ziglang")

    def made(command, what, target, folder):
        target.write_bytes(b"text")

    monkeypatch.setattr(build, "call", made)
    result = CliRunner().invoke(mechsym, ["page", "chmielewski", "--out", "none.html"])
    assert isinstance(result.exception, MissingExtra) and "makes no WebAssembly" in str(result.exception)
    monkeypatch.undo()
    monkeypatch.setattr(compiler, "PATIENCE", 0.01)
    result = CliRunner().invoke(mechsym, ["page", "chmielewski", "--out", "none.html"])
    assert isinstance(result.exception, MissingExtra) and "did not end in 0.01 s" in str(result.exception)


def test_what_a_compiler_started_ends_with_it(monkeypatch, tmp_path):
    script = tmp_path / "slow"
    script.write_text(f"#!/bin/sh\nsleep 60 &\necho $! > {tmp_path}/child\nwait\n")
    script.chmod(0o755)
    monkeypatch.setattr(compiler, "PATIENCE", 0.5)
    with pytest.raises(compiler.NoCompiler, match="did not end"):
        compiler.call([str(script)], "a source", tmp_path / "none")
    stat = Path(f"/proc/{int((tmp_path / 'child').read_text())}/stat")
    until = time.monotonic() + 5
    while time.monotonic() < until and stat.exists() and stat.read_text().rpartition(")")[2].split()[0] not in "ZX":
        time.sleep(0.01)  # a signal takes its time
    assert not stat.exists() or stat.read_text().rpartition(")")[2].split()[0] in "ZX"
