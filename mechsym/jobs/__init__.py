"""Case -> result, one page a command. The only rooms besides that read a `Case`: cases, report, sweep, papers, app,
cli.

machine     mechanism, gas, load and speed of a case, ready to turn
codesign    guide, pressures and flywheel for a range of speeds and loads
hinge       hinge, guide, verdict, trials by simulation
run         simulation in time, with its start-ups and criticals, and the cycle in motion; problem says what runs
cycle       figures of the engine cycle, of one cylinder and of the whole engine; gas is its pressure on the pistons,
            measured a diagram taken apart, indicated the pressure out of a measured torque
forces      the force chain over one turn, and the counterweights and shafts that balance it
size        every part with load, limit and factor
optimise    the design that `[optimise]` declares
identify    parameters out of a measured run
flywheel    the flywheel for a wanted ripple
export      what leaves the tool, and the machine in motion
"""

from mechsym.quantities import lazily

_NAMES = {
    "balance": "mechsym.jobs.forces:balance",
    "codesign": "mechsym.jobs.codesign:codesign",
    "codesign_task": "mechsym.jobs.codesign:codesign_task",
    "compare": "mechsym.cycle.columns:compare",
    "cycle": "mechsym.jobs.cycle:cycle",
    "forces": "mechsym.jobs.forces:forces",
    "gas": "mechsym.jobs.gas:gas",
    "hinge": "mechsym.jobs.hinge:hinge",
    "loop": "mechsym.jobs.run:loop",
    "machine": "mechsym.jobs.machine:machine",
    "optimise": "mechsym.jobs.optimise:optimise",
    "run": "mechsym.jobs.run:run",
    "size": "mechsym.jobs.size:size",
    "startup": "mechsym.jobs.run:startup",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)
