"""Numbers by letter from a case, for whoever needs values of a mechanism and no case."""

import dataclasses
import tomllib

from mechsym import cases
from mechsym.errors import BadInput


def usual(mechanism: str) -> str:
    """The first built-in case of a mechanism, empty where there is none."""
    return next((c for c in cases.names() if tomllib.loads(cases.text(c)).get("mechanism") == mechanism), "")


def numbers(case: str, mechanism: str = "") -> dict[str, float]:
    """Values of the parameters of a case, and its speed of operation.

    Parameters
    ----------
    mechanism : str
        Mechanism that the case must be of; empty takes any

    Returns
    -------
    values : dict of str to float
        By letter, and `speed` [SI]
    """
    found = cases.load(case)
    if mechanism and found.mechanism != mechanism:
        raise BadInput(
            f"case {case} is of the mechanism {found.mechanism}, not of {mechanism}; name another with --case"
        )
    values = {k: v for k, v in dataclasses.asdict(found.need("parameters")).items() if isinstance(v, float)}
    operation = found.sections.get("operation")
    return values | ({"speed": operation.speed} if operation else {})
