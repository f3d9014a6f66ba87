"""What the gas does: pressure on the pistons over the crank angle, and what an engine makes of it.

chamber     volume over the travel of a piston        pressure    pressure over the angle, peak, work
gas         travel and moving mass out of a mechanism; pressure in its chamber: the force on a piston
kinds       one table: every kind of cycle, and what each needs
source      what every kind of gas answers, and where a cylinder is enough to answer it
heat, wiebe, friction    properties and heat to the walls, combustion, friction mean pressure
breathing   gas exchange by filling and emptying, turbocharger
closed      the closed period integrated, its figures, its derivatives
measured    measured diagrams: read, aligned, taken apart
engine      figures over the speeds of a closed cycle        columns     every figure with its unit        plots

Names are imported on first use, so that a case file is read without any of the physics.
"""

from mechsym.quantities import lazily

_NAMES = {
    "ChamberParameters": "mechsym.cycle.chamber:ChamberParameters",
    "ClosedEngine": "mechsym.cycle.closed.model:ClosedEngine",
    "Gas": "mechsym.cycle.gas:Gas",
    "KINDS": "mechsym.cycle.kinds:KINDS",
    "Pressure": "mechsym.cycle.pressure:Pressure",
    "columns": "mechsym.cycle.engine:columns",
    "curves": "mechsym.cycle.engine:curves",
    "gas_in_cylinder": "mechsym.cycle.kinds:gas_in_cylinder",
    "gas_of_engine": "mechsym.cycle.engine:gas_of_engine",
    "over_speeds": "mechsym.cycle.engine:over_speeds",
    "piston_motion": "mechsym.cycle.motion:piston_motion",
    "piston_travel": "mechsym.cycle.motion:piston_travel",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)
