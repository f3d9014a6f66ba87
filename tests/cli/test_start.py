"""What a command loads before it does anything: modules counted, which is the same on every machine, idle or not."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

# prints the modules that a command has loaded when it ends
_RUN = """
import contextlib, io, json, sys
from mechsym.cli import mechsym
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    mechsym.main(sys.argv[1:], "mechsym", standalone_mode=False)
print(json.dumps(sorted(sys.modules)))
"""
# prints the threads of the process when a command ends
_THREADS = """
import contextlib, io, pathlib, sys, time
from mechsym.cli import main
sys.argv[1:] = ["cases"]
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    main()
tasks = lambda: len(list(pathlib.Path("/proc/self/task").iterdir()))
for _ in range(40):  # a thread that has ended may be listed for a moment; one of BLAS waits for ever
    if tasks() > 1:
        time.sleep(0.05)
print("numpy" in sys.modules, tasks())
"""
HEAVY = {"matplotlib", "sympy", "xarray", "pandas", "jinja2", "scipy.stats", "mechsym.audit", "mechsym.papers"}
# of the rooms that a command does not work in it reads the records of their sections, and no more
COMMANDS = {
    "eval crosshead --case zotov-89 --set phi=1": (
        {
            "scipy.optimize",
            "scipy.interpolate",
            "mechsym.jobs",
            "mechsym.cycle.gas",
            "mechsym.native.evaluate",
            "importlib.metadata",
        },
        361,
    ),
    "cases zotov-89": ({"scipy.optimize", "scipy.interpolate", "mechsym.jobs", "importlib.metadata"}, 360),
    "hinge zotov-89": ({"mechsym.codesign.programme", "mechsym.sizing"}, 1010),
    "simulate zotov-89": ({"mechsym.codesign.programme", "mechsym.sizing"}, 1010),
    "cycle nunes-hypocycloid": ({"scipy.interpolate", "mechsym.hinge.limits", "mechsym.codesign"}, 920),
    "cycle generator": ({"mechsym.codesign", "mechsym.hinge.limits"}, 1010),
    "forces zotov-89": ({"mechsym.codesign.programme", "mechsym.sizing"}, 960),
    "size nunes-slider-crank": ({"mechsym.codesign", "mechsym.hinge.limits"}, 970),
}


def loaded(command):
    done = subprocess.run(
        [sys.executable, "-c", _RUN, *command.split()], check=True, capture_output=True, text=True, timeout=120
    )
    return json.loads(done.stdout)


def budget(command):
    without, most = COMMANDS[command]
    found = loaded(command)
    assert not (HEAVY | without) & set(found)
    assert len(found) <= most, f"{len(found)} modules"


def test_eval_loads_neither_scipy_nor_a_job():
    budget("eval crosshead --case zotov-89 --set phi=1")


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="threads are counted where Linux shows them")
def test_no_thread_of_blas_waits_beside_a_command():
    free = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    done = subprocess.run([sys.executable, "-c", _THREADS], check=True, capture_output=True, text=True, env=free)
    assert done.stdout.split() == ["True", "1"]


@pytest.mark.slow
@pytest.mark.parametrize(
    "command", [pytest.param(c, marks=[] if c.startswith("hinge") else pytest.mark.heavy) for c in list(COMMANDS)[1:]]
)
def test_a_command_loads_what_it_works_with(command):
    budget(command)


def test_a_module_too_many_is_seen(monkeypatch):
    monkeypatch.setitem(COMMANDS, "mechanisms", ({"casadi"}, 10**6))
    with pytest.raises(AssertionError):
        budget("mechanisms")
