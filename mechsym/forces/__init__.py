"""Forces of a crank train over one cycle at constant speed, and what follows from them.

turn.py         mechanism, gas, speed -> gas forces and exact reactions over the angle, the power they must balance
loads.py        reactions under common names: side force, crank pin radial and tangential, main bearing; what shakes
                the frame by orders, the counterweight that shakes it least, balance that was asked for
textbook.py     the chains of Moroianu (2017) and Prymak: two-mass rod, Terskih's rule, their errors; and the chain
                backwards: cylinder pressure out of a measured torque on the shaft
mains.py        main bearings at their places, and the film of oil in them
friction.py     first-order losses from the frictionless reactions, of rings, and as a law of the engine cycle
result.py       all of it in one record, with the table forces.csv and its extremes; slider crank, hypocycloid and
                rodless at equal stroke, mass and gas force, the sources' claims judged
summary.py      the record in numbers; shown.py its pictures, its moving scene, its files
driven.py       how coordinates are driven: evenly, by a word, through points; the forces over time
"""

from mechsym.quantities import lazily

_NAMES = {
    "BalanceWanted": "mechsym.forces.loads:BalanceWanted",
    "compare": "mechsym.forces.result:compare",
    "crank_drive": "mechsym.forces.turn:crank_drive",
    "CrankDrive": "mechsym.forces.turn:CrankDrive",
    "fit": "mechsym.forces.friction:fit",
    "Forces": "mechsym.forces.result:Forces",
    "forces": "mechsym.forces.result:forces",
    "Friction": "mechsym.forces.friction:Friction",
    "losses": "mechsym.forces.friction:losses",
    "pressure_from_torque": "mechsym.forces.textbook:pressure_from_torque",
    "Turn": "mechsym.forces.turn:Turn",
    "turn": "mechsym.forces.turn:turn",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)
