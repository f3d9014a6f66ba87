"""Forces of a crank train over one cycle at constant speed, and what follows from them.

turn.py         mechanism, gas, speed -> gas forces and exact reactions over the angle, the power they must balance
loads.py        reactions under common names: side force, crank pin radial and tangential, main bearing
table.py        forces.csv and its extremes
textbook.py     the chains of Moroianu (2017) and Prymak: two-mass rod, Terskih's rule, their errors
harmonics.py    orders of torque and shaking forces
shaking.py      what shakes the frame, the counterweight that shakes it least, balance that was asked for
friction.py     first-order losses from the frictionless reactions
comparison.py   slider crank, hypocycloid and rodless at equal stroke, mass and gas force
friction_law.py the mechanism's friction as a law of the engine cycle
claims.py       what the sources claim about friction and loads, judged by the comparison
result.py       all of it in one record
summary.py      the record in numbers
"""

from mechsym.forces.comparison import compare
from mechsym.forces.friction import Friction, losses
from mechsym.forces.friction_law import fit
from mechsym.forces.loads import loads
from mechsym.forces.result import Forces, forces
from mechsym.forces.shaking import BalanceWanted
from mechsym.forces.turn import CrankDrive, Turn, crank_drive, turn

__all__ = [
    "BalanceWanted", "CrankDrive", "Forces", "Friction", "Turn", "compare", "crank_drive", "fit", "forces", "loads",
    "losses", "turn",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__
