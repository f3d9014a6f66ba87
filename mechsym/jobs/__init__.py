"""Case -> result, one page a command. The only rooms besides that read a `Case`: cases, sweep, papers, app, cli.

machine     mechanism, gas, load and speed of a case, ready to turn
codesign    guide, pressures and flywheel for a range of speeds and loads
hinge       hinge, guide, verdict, trials by simulation
run         simulation in time; startup explains a start-up; problem and train say what runs
cycle       figures of the engine cycle; gas is its pressure on the pistons, loop the cycle in motion, measured a
            diagram taken apart
forces      the force chain over one turn
size        every part with load, limit and factor
optimise    the design that `[optimise]` declares
identify    parameters out of a measured run
compare     two engines side by side
report      all of these on one page; shown says what of a result is worth seeing
"""

from mechsym.jobs.codesign import codesign, codesign_task
from mechsym.jobs.compare import compare
from mechsym.jobs.cycle import cycle
from mechsym.jobs.forces import forces
from mechsym.jobs.gas import gas
from mechsym.jobs.hinge import hinge
from mechsym.jobs.loop import loop
from mechsym.jobs.machine import machine
from mechsym.jobs.optimise import optimise
from mechsym.jobs.run import run
from mechsym.jobs.size import size
from mechsym.jobs.startup import startup

__all__ = [
    "codesign", "codesign_task", "compare", "cycle", "forces", "gas", "hinge", "loop", "machine", "optimise", "run",
    "size", "startup",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__
