"""What the sources claim about friction and loads, judged by the comparison of the mechanisms.

A claim holds only as far as the coefficients of the case do; each verdict names the numbers it rests on.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from mechsym.mechanisms import crosshead, hypocycloid

_PRYMAK, _NUNES, _MOROIANU = "003_8746f5f4ad51b1d1", "004_e00ef50339108dab", "001_a140ef4f7e005dde"
_ROD, _PLANET = crosshead.LABEL, hypocycloid.LABEL
_SMALL = 0.1  # "much smaller" is read as below a tenth

Row = Mapping[str, Any]


def claims(rows: Sequence[Row]) -> list[dict[str, str]]:
    """Claims on friction and loads that the comparison can judge.

    Returns
    -------
    claims : list of dict
        Keys source, claim, verdict (`supported claim` or `unsupported claim`), note; those on friction only where the
        case has coefficients
    """
    by_name = {row["mechanism"]: row for row in rows}
    rod, planet = by_name[_ROD], by_name[_PLANET]
    links = [row for name, row in by_name.items() if name.startswith("rodless, four")]
    found = [_side_force(rod, links), _pin_load(rod, links)]
    if "friction_per_piston" in rod:
        found += [_less_friction(rod, links), _planet_friction(rod, planet)]
    return found


def left_out(weight: Mapping[str, float], efficiency: float | None) -> dict[str, str]:
    """Whether a chain of forces may leave weights and friction out, as Moroianu (2017) does.

    Parameters
    ----------
    weight : mapping of str to float
        Of `textbook.weight_shares` [-]
    efficiency : float or None
        Mechanical efficiency; None where the case has no coefficients [-]
    """
    worst = max(weight, key=lambda name: weight[name])
    friction = 0.0 if efficiency is None else 1 - efficiency
    note = f"weights change {worst} most, by {100 * weight[worst]:.2g} % of its peak"
    if efficiency is not None:
        note += f"; friction takes {100 * friction:.2g} % of the indicated power"
    claim = "weight and friction are much smaller than pressure and inertia forces"
    return _row(_MOROIANU, claim, max(weight[worst], friction) < _SMALL, note)


def equal_loss_coefficient(rod: Row, other: Row, mu_guide: float) -> float | None:
    r"""Friction coefficient of the guides with which a mechanism loses as little as the slider crank.

    .. math:: \mu = \mu_\mathrm{guide}\,\frac{P_\mathrm{rod} - (P - P_\mathrm{guide})}{P_\mathrm{guide}}

    Parameters
    ----------
    rod, other : mapping
        Rows of the comparison with friction: the slider crank, and a mechanism with guides
    mu_guide : float
        Coefficient of all guides in the comparison [-]

    Returns
    -------
    mu : float or None
        None where it loses more without any friction of its guides [-]
    """
    guides = other["friction_places"]["guides"]
    spare = rod["friction_per_piston"] - (other["friction_per_piston"] - guides)
    return float(mu_guide * spare / guides) if guides > 0 and spare >= 0 else None


def _row(source: str, claim: str, supported: bool, note: str) -> dict[str, str]:
    verdict = "supported claim" if supported else "unsupported claim"
    return {"source": source, "claim": claim, "verdict": verdict, "note": note}


def _side_force(rod: Row, links: Sequence[Row]) -> dict[str, str]:
    ratios = [row["side_force_max"] / rod["side_force_max"] for row in links]
    note = f"the guides of the rods take it, {min(ratios):.2g} to {max(ratios):.2g} times that of a slider crank"
    return _row(_PRYMAK, "no side force presses the piston of a rodless engine on its cylinder", True, note)


def _pin_load(rod: Row, links: Sequence[Row]) -> dict[str, str]:
    ratios = [row["crank_pin_mean"] / row["pistons"] / rod["crank_pin_mean"] for row in links]
    note = f"of the crank pin: mean load per piston {_range(ratios)} of the slider crank's, at twice the rubbing speed"
    return _row(_PRYMAK, "a rodless engine loads its joints less for the same power", max(ratios) < 1, note)


def _less_friction(rod: Row, links: Sequence[Row]) -> dict[str, str]:
    ratios = [row["friction_per_piston"] / rod["friction_per_piston"] for row in links]
    equal = [equal_loss_coefficient(rod, row, 1.0) for row in links]
    note = f"with equal coefficients it loses {_range(ratios)} of what a slider crank loses, by closing rule; "
    if None in equal:
        note += "more even with guides free of friction"
    else:
        note += f"as little with guides at {_range([share for share in equal if share is not None])} of the coefficient"
    return _row(_PRYMAK, "a rodless engine loses less by friction than one with rods", max(ratios) < 1, note)


def _planet_friction(rod: Row, planet: Row) -> dict[str, str]:
    ratio = planet["friction_per_piston"] / rod["friction_per_piston"]
    note = (
        f"its journal and teeth cost more than the side force saves: {100 * ratio:.3g} % of the slider crank's loss"
        if ratio >= 1
        else f"it loses {100 * ratio:.3g} % of what a slider crank loses"
    )
    return _row(_NUNES, "a hypocycloid engine without side force loses less by friction", ratio < 1, note)


def _range(ratios: Sequence[float]) -> str:
    return f"{100 * min(ratios):.3g} to {100 * max(ratios):.3g} %"
