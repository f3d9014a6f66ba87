"""Case -> result, one page a command. The only rooms besides that read a `Case`: cases, sweep, papers, app, cli.

machine     mechanism, gas, load and speed of a case, ready to turn
codesign    guide, pressures and flywheel for a range of speeds and loads
hinge       hinge, guide, verdict, trials by simulation
run         simulation in time; startup explains a start-up
"""

from mechsym.jobs.codesign import codesign
from mechsym.jobs.hinge import hinge
from mechsym.jobs.machine import machine
from mechsym.jobs.run import run
from mechsym.jobs.startup import startup

__all__ = ["codesign", "hinge", "machine", "run", "startup"]


def __dir__() -> list[str]:
    return __all__
