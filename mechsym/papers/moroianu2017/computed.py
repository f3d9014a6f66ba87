"""The chain (2) to (13) of Moroianu (2017) for the case `moroianu`, a marine drive whose data are assumed."""

from functools import cache

from mechsym.cases import load
from mechsym.forces.textbook import Chain, chain, terskih
from mechsym.forces.turn import Turn
from mechsym.jobs.turn import turn

CASE = "moroianu"
# number of the figure: (field of the chain, its name in the source, unit)
FIGURES = {
    "1": ("F_p", "pressure force", "N"), "3": ("F_it", "inertia force", "N"), "4": ("F", "total force", "N"),
    "6": ("B", "longitudinal force", "N"), "7": ("N", "normal force", "N"), "9": ("Z_B", "radial force", "N"),
    "10": ("T", "tangential force", "N"), "11": ("Z", "total radial force", "N"), "12": ("M", "driving moment", "N*m"),
}  # fmt: skip


@cache
def curves() -> tuple[Turn, Chain]:
    """The source's chain over a turn, with the assumed data.

    Returns
    -------
    turn, chain : Turn, Chain
        Rod as two masses with its centre of mass after Terskih
    """
    one = turn(load(CASE))
    return one, chain(one, terskih(one.omega))
