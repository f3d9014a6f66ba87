"""Case -> result, one page a command. The only rooms besides that read a `Case`: cases, sweep, papers, app, cli.

machine     mechanism, gas, load and speed of a case, ready to turn
codesign    guide, pressures and flywheel for a range of speeds and loads
hinge       hinge, guide, verdict, trials by simulation
run         simulation in time; startup explains a start-up; problem and train say what runs
cycle       figures of the engine cycle; gas is its pressure on the pistons, loop the cycle in motion, measured a
            diagram taken apart, indicated the pressure out of a measured torque
forces      the force chain over one turn
size        every part with load, limit and factor
optimise    the design that `[optimise]` declares
identify    parameters out of a measured run
compare     two engines side by side
report      all of these on one page; shown says what of a result is worth seeing
"""

from mechsym.quantities import lazily

_NAMES = {
    "codesign": "mechsym.jobs.codesign:codesign",
    "codesign_task": "mechsym.jobs.codesign:codesign_task",
    "compare": "mechsym.jobs.compare:compare",
    "cycle": "mechsym.jobs.cycle:cycle",
    "forces": "mechsym.jobs.forces:forces",
    "gas": "mechsym.jobs.gas:gas",
    "hinge": "mechsym.jobs.hinge:hinge",
    "loop": "mechsym.jobs.loop:loop",
    "machine": "mechsym.jobs.machine:machine",
    "optimise": "mechsym.jobs.optimise:optimise",
    "run": "mechsym.jobs.run:run",
    "size": "mechsym.jobs.size:size",
    "startup": "mechsym.jobs.startup:startup",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)


def __dir__() -> list[str]:
    return __all__
