"""Ctrl-C: obeyed within a second where Python is not asked, put off while files move, seen where it is swallowed."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import interrupts as times
import pytest

from mechsym import files, interrupts

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals are POSIX")
# the command line with some work in the place of its commands
_RUN = """
import ctypes, signal, sys, threading, time
from pathlib import Path
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell lets what runs in the background ignore it
from mechsym import cli, files
def in_a_compiler():
    from mechsym.native import compiler
    made = Path(sys.argv[1]).with_name("process")
    sleep = f"import ctypes, os, signal, time; open({str(made)!r}, 'w').write(str(os.getpid())); time.sleep(60)"
    libc, lock = ctypes.CDLL(None), ctypes.create_string_buffer(256)
    thread = threading.Thread(target=compiler.call, args=([sys.executable, "-c", sleep], "it", made), daemon=True)
    thread.start()
    for _ in range(2):
        libc.pthread_mutex_lock(lock)
def swallowed():
    try:
        time.sleep(60)
    except KeyboardInterrupt:
        pass
def renamed():
    try:
        time.sleep(60)
    except KeyboardInterrupt:
        raise OSError("Non_Ipopt_Exception_Thrown")
def in_c():
    libc, lock = ctypes.CDLL(None), ctypes.create_string_buffer(256)
    for _ in range(2):
        libc.pthread_mutex_lock(lock)  # the second waits for ever, and for no signal
def in_python():
    while True:
        pass
def work(*_, **__):
    with files.together(Path(sys.argv[1])):
        files.write_text(Path(sys.argv[1]) / "a.txt", "1")
        print("ready", flush=True)
        globals()[sys.argv[2]]()
cli.mechsym.main = work
cli.main()
"""


@pytest.mark.parametrize("work", ["in_python", "in_c", "swallowed", "renamed"])
def test_an_interrupt_ends_a_command_whatever_it_is_at(tmp_path, work):
    process = subprocess.Popen([sys.executable, "-c", _RUN, str(tmp_path), work], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)  # fmt: skip
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=20)  # how soon is for the slow test, which knows what else the machine does
    assert (process.returncode, said) == (interrupts.STATUS, f"{interrupts.WORDS}\n")
    assert list(tmp_path.iterdir()) == []


def test_a_compiler_ends_with_the_command_that_waits_for_it(tmp_path):
    folder, noted = tmp_path / "run", tmp_path / "process"
    process = subprocess.Popen([sys.executable, "-c", _RUN, str(folder), "in_a_compiler"], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)  # fmt: skip
    while not noted.exists() or not noted.read_text():
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=20)
    assert process.returncode == interrupts.STATUS
    for _ in range(100):
        if _ended(int(noted.read_text())):
            return
        time.sleep(0.05)
    raise AssertionError("the compiler runs on")


def _ended(number):
    try:
        os.kill(number, 0)
    except ProcessLookupError:
        return True
    stat = Path(f"/proc/{number}/stat")
    return stat.exists() and stat.read_text().rpartition(")")[2].split()[0] == "Z"


def test_files_that_move_into_place_do_so_to_the_end(tmp_path, monkeypatch):
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    replace, moved = type(tmp_path).replace, []

    def interrupted(self, target):
        signal.raise_signal(signal.SIGINT)
        moved.append(target)
        return replace(self, target)

    try:
        with pytest.raises(KeyboardInterrupt), files.together(tmp_path):
            for name in ("a.txt", "b.txt", "summary.json"):
                files.write_text(tmp_path / name, "1")
            monkeypatch.setattr(type(tmp_path), "replace", interrupted)
    finally:
        signal.signal(signal.SIGINT, usual)
    assert len(moved) == 3 and sorted(p.name for p in tmp_path.iterdir()) == ["a.txt", "b.txt", "summary.json"]


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["hinge", "sweep-jobs", "study", *(pytest.param(k, marks=pytest.mark.heavy) for k in ("derive", "fmu"))]
)
def test_a_command_ends_soon_and_keeps_what_is_finished(tmp_path, monkeypatch, name):
    monkeypatch.setattr(times, "LATEST", 3.0)  # other tests keep the machine busy; `make interrupts` asks for one
    times.prepare(tmp_path)
    _, ends, wrong = times.times(name, tmp_path, 2)
    assert wrong == [] and ends
