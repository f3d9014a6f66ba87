"""What the gas does, in the scene of a machine that turns: its pressure as a colour, its forces as arrows."""

import math
from collections.abc import Sequence

import numpy as np

from mechsym.cycle.motion import travel_of
from mechsym.files import Json
from mechsym.forces.turn import Acting, CrankDrive
from mechsym.mechanisms.turning import FRAMES, Pushed, filled


def charged(shown: Json, drive: CrankDrive, acting: Sequence[Acting]) -> Json:
    """The scene of a drive with the gas of its cylinders."""
    if not acting:
        return shown
    phi = np.linspace(0, 2 * math.pi * shown["turns"], shown["count"], endpoint=False)[None, :]
    turns = max(round(one.gas.pressure.period / (2 * math.pi)) for one in acting)
    whole = np.linspace(0, 2 * math.pi * turns, turns * FRAMES, endpoint=False)
    charges = [
        Pushed(
            travel=one.face.sense * np.asarray(travel_of(drive.mechanism, one.face.travel)(phi)[0]).ravel(),
            force=one.face.sense * one.force(whole),
        )
        for one in acting
    ]
    return filled(shown, charges)
