"""Case -> balance: what shakes the frame, and the counterweights and balancer shafts that leave the least of it."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from mechsym.cases import Case
from mechsym.cases.needs import require
from mechsym.files import write_quantities, write_text
from mechsym.forces import balance as physics
from mechsym.forces.balance import BalancedEngine, Shaken, Weight, amplitudes, length
from mechsym.forces.loads import orders
from mechsym.forces.mains import MainShaft
from mechsym.jobs.machine import turn
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import KilogramMetre, Metre

_NO_ANGLE = 1e-6  # deg
_ROUNDING = 1e-9  # of the largest value of a curve: an amplitude that is not larger is 0


@result
class ShakenNumbers:
    """What shakes the frame, and what its main bearings carry."""

    force: Mapping[str, float] = quantity("N")  #: Largest value of each whole order
    couple: Mapping[str, float] = quantity("N*m")  #: The same of the couple about the shaft's middle
    #: The same of the moment about the shaft; empty where the mechanism does not tell it
    roll: Mapping[str, float] = quantity("N*m")
    force_max: float = quantity("N")  #: Of all orders together
    couple_max: float = quantity("N*m")  #: Likewise
    roll_max: float | None = quantity("N*m")  #: Likewise, half orders too; null where the mechanism does not tell it
    #: Largest load of a main bearing; null where the places of the bearings are not known
    main_bearing_max: float | None = quantity("N")


@result
class WeightNumbers:
    """A weight on the crankshaft or on a balancer shaft."""

    order: int = quantity("-")  #: Its speed over the crank's, negative against it
    z: float = quantity("m")  #: Place along the shaft
    x: float = quantity("m")  #: Of a balancer shaft, along the reference axis from the middle of its pair
    unbalance: float = quantity("kg*m")  #: Mass times radius
    angle_deg: float = quantity("deg")  #: Where it stands at crank angle 0, from the reference axis


@result
class BalanceOfEngine:
    """Forces and couples on the frame before and after."""

    case: str = part()
    speed_rpm: float = quantity("rpm")  #: Of the crank
    before: ShakenNumbers = part()
    after: ShakenNumbers = part()
    counterweights: tuple[WeightNumbers, ...] = part()
    shafts: tuple[WeightNumbers, ...] = part()  #: Weights of the balancer shafts, two a shaft


def balance(
    case: Case,
    weights: str = "ends",
    shafts: Sequence[int] = (),
    least: str = "frame",
    largest: KilogramMetre | None = None,
    apart: Metre = 0.0,
) -> BalancedEngine:
    """Counterweights and balancer shafts of a case at its speed of operation; arguments as in `forces.balance`.

    >>> from mechsym import cases
    >>> one = balance(cases.load("zotov-89"))
    >>> round(one.counterweights[0].unbalance, 1)
    186.6
    """
    require(case, "balance")
    settings = case.sections.get("shaft") or MainShaft()
    return physics.balance(turn(case), weights, shafts, least, largest, settings, apart)


def numbers(case: Case, one: BalancedEngine) -> BalanceOfEngine:
    """A balance in numbers."""
    return BalanceOfEngine(
        case=case.name,
        speed_rpm=one.turn.omega * 30 / math.pi,
        before=_shaken(one, one.before),
        after=_shaken(one, one.after),
        counterweights=tuple(map(_weight, one.counterweights)),
        shafts=tuple(map(_weight, one.shafts)),
    )


def _shaken(one: BalancedEngine, shaken: Shaken) -> ShakenNumbers:
    least = shaken.rounding * one.turn.omega**2
    force = amplitudes(shaken.force, one.turn, least)
    couple = amplitudes(shaken.couple, one.turn, least * length(one.turn))
    return ShakenNumbers(
        force={str(k): value for k, value in force.items()},
        couple={str(k): value for k, value in couple.items()},
        roll=_roll(shaken, one, least),
        force_max=_largest(shaken.force, least),
        couple_max=_largest(shaken.couple, least * length(one.turn)),
        roll_max=None if shaken.roll is None else _largest(shaken.roll, least * length(one.turn)),
        main_bearing_max=max((float(journal.load.max()) for journal in shaken.journals), default=None),
    )


def _roll(shaken: Shaken, one: BalancedEngine, least: float) -> dict[str, float]:
    if shaken.roll is None:
        return {}
    size = max(least * length(one.turn), _ROUNDING * float(np.abs(shaken.roll).max()))
    return {str(k): value for k, value in amplitudes(shaken.roll, one.turn, size).items()}


def _largest(values: np.ndarray, least: float) -> float:
    size = float(np.abs(values).max())
    return size if size > least else 0.0


def _weight(one: Weight) -> WeightNumbers:
    angle = math.degrees(one.angle) % 360.0
    angle = 0.0 if 360.0 - angle < _NO_ANGLE else angle  # just below a whole turn by rounding
    return WeightNumbers(order=one.order, z=one.z, x=one.x, unbalance=one.unbalance, angle_deg=angle)


def write(one: BalancedEngine, told: BalanceOfEngine, folder: Path, about: str) -> list[Path]:
    """Write the page, its picture, and the spectra that an engine's mounts feel, by order."""
    from mechsym.forces.plots import balance_orders
    from mechsym.page import page
    from mechsym.style import svg

    curves = {
        f"{name}_{axis}_{when}": values
        for when, shaken in (("before", one.before), ("after", one.after))
        for name, both in (("force", shaken.force), ("couple", shaken.couple))
        for axis, values in (("x", both.real), ("y", both.imag))
    }
    curves |= {
        f"roll_{when}": shaken.roll
        for when, shaken in (("before", one.before), ("after", one.after))
        if shaken.roll is not None
    }
    spectra = {name: orders(values, one.turn.period) for name, values in curves.items()}
    columns = {"order": next(iter(spectra.values())).order}
    for name, spectrum in spectra.items():
        least = _ROUNDING * float(np.abs(curves[name.replace("_after", "_before")]).max())
        columns[name] = np.where(np.abs(spectrum.amplitude) > least, spectrum.amplitude, 0.0)
    units = {name: "N" if name.startswith("force") else "N*m" for name in curves} | {"order": "-"}
    picture = svg(balance_orders(one))
    return [
        write_text(folder / "report.html", page("balance.html", numbers=told, picture=picture, about=about)),
        write_quantities(folder / "mounts.csv", columns, units),
        write_text(folder / "orders.svg", picture),
    ]
