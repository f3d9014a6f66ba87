"""Crank trains for tests: an in-line six and a cross-plane V-8."""

import math

from mechsym.mechanisms.crank_train.firing import crank_phases, firing_angles
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters

DEG = math.pi / 180
FOUR_STROKE = 4 * math.pi


def in_line_six(**changes):
    firing = firing_angles((1, 5, 3, 6, 2, 4), FOUR_STROKE)
    values = {
        "throw": (1, 2, 3, 4, 5, 6),
        "phase": crank_phases(firing, (0.0,) * 6),
        "firing": firing,
        "z": (-0.25, -0.15, -0.05, 0.05, 0.15, 0.25),
        **{"r": 0.05, "l1": 0.05, "l2": 0.1, "m_rod": 0.6, "m_piston": 0.5, "I_rod": 2e-3},
        **{"I0": 0.01, "m0": 2.0, "u0": 0.0, "I_f": 0.3, "k": 5e5, "c": 10.0},
    }
    return CrankTrainParameters(**(values | changes))


def v_eight(**changes):
    bank = (45 * DEG, -45 * DEG) * 4
    firing = firing_angles((1, 8, 4, 3, 6, 5, 7, 2), FOUR_STROKE)
    values = {
        "throw": (1, 1, 2, 2, 3, 3, 4, 4),
        "phase": crank_phases(firing, bank),
        "bank": bank,
        "firing": firing,
        "z": (-0.15, -0.05, 0.05, 0.15),
    }
    six = in_line_six()
    same = {n: getattr(six, n) for n in ("r", "l1", "l2", "m_rod", "m_piston", "I_rod", "I0", "I_f", "k", "c")}
    return CrankTrainParameters(**(values | same | changes))
