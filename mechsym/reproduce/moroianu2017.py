"""Moroianu (2017) prints definitions and curves without any data: nothing in it can be checked against a number.

The curves of Figs. 1 to 12 need the engine's masses, lengths, speed and indicator diagram. Only the rule of Terskih,
eq. (3), has numbers of its own; its values are given for the speeds of slow and semi-fast engines that the paper names.
"""

from typing import Any

from mechsym.reproduce.record import NOT_COMPUTABLE, row

SOURCE = "001_a140ef4f7e005dde"
_FIGURES = {
    "1": "pressure force", "3": "inertia force", "4": "total force", "6": "longitudinal force", "7": "normal force",
    "9": "radial force", "10": "tangential force", "11": "total radial force", "12": "driving moment",
}  # fmt: skip
_SPEEDS_RPM = (100, 500, 1000)
_MISSING = "no mass, length, speed or pressure is printed, nor a scale that the text names"
_NO_VALUE = "an empirical rule without a printed value; a rod that is not yet drawn is put there"


def rows() -> list[dict[str, Any]]:
    """Every figure with curves, and the rule of Terskih.

    Returns
    -------
    rows : list of dict
        Keys as in `record.row`
    """
    curves = [
        row(SOURCE, f"Fig. {number}: {name} over the crank angle", None, None, NOT_COMPUTABLE, _MISSING)
        for number, name in _FIGURES.items()
    ]
    rule = [
        row(
            SOURCE, f"(3): centre of mass of the rod, L_m/L at {speed} rpm", None, centre_of_mass(speed),
            NOT_COMPUTABLE, _NO_VALUE,
        )
        for speed in _SPEEDS_RPM
    ]  # fmt: skip
    return curves + rule


def centre_of_mass(speed_rpm: float) -> float:
    r"""Place of the rod's centre of mass after Terskih.

    .. math:: \frac{L_m}{L} = 0.2\,\frac{(0.001\,n)^2 + 2}{(0.001\,n)^2 + 1}

    Parameters
    ----------
    speed_rpm : float
        Crank speed n [rpm]

    Returns
    -------
    share : float
        Distance from the crank pin over the rod's length [-]

    Notes
    -----
    Source: Moroianu (2017), eq. (3). Empirical: no rod's centre of mass moves with the speed.

    Examples
    --------
    >>> round(centre_of_mass(100), 3)
    0.398
    """
    square = (1e-3 * speed_rpm) ** 2
    return 0.2 * (square + 2) / (square + 1)
