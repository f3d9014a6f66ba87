"""What a command loads before it does anything: modules counted, which is the same on every machine, idle or not."""

import json
import subprocess
import sys

import pytest

# prints the modules that a command has loaded when it ends
_RUN = """
import contextlib, io, json, sys
from mechsym.cli import mechsym
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    mechsym.main(sys.argv[1:], "mechsym", standalone_mode=False)
print(json.dumps(sorted(sys.modules)))
"""
HEAVY = {"matplotlib", "sympy", "xarray", "pandas", "jinja2", "scipy.stats", "mechsym.audit", "mechsym.papers"}
# of the rooms that a command does not work in it reads the records of their sections, and no more
COMMANDS = {
    "eval crosshead --case zotov-89 --set phi=1": (
        {"scipy.optimize", "scipy.interpolate", "mechsym.jobs", "mechsym.cycle.gas", "mechsym.native.evaluate"},
        390,
    ),
    "cases zotov-89": ({"scipy.optimize", "scipy.interpolate", "mechsym.jobs"}, 390),
    "hinge zotov-89": ({"mechsym.codesign.programme", "mechsym.sizing"}, 1010),
    "simulate zotov-89": ({"mechsym.codesign.programme", "mechsym.sizing"}, 1010),
    "cycle nunes-hypocycloid": ({"scipy.interpolate", "mechsym.hinge.contact", "mechsym.codesign"}, 920),
    "forces zotov-89": ({"mechsym.codesign.programme", "mechsym.sizing"}, 960),
    "size nunes-slider-crank": ({"mechsym.codesign", "mechsym.hinge.contact"}, 970),
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
