"""Everything about the forces of one turn, in one record."""

import dataclasses
from typing import Any

import numpy as np

from mechsym.forces import textbook
from mechsym.forces.friction import Friction, Losses, losses
from mechsym.forces.harmonics import Harmonics, orders
from mechsym.forces.loads import loads
from mechsym.forces.rings import NoRings, Rings
from mechsym.forces.shaking import BalanceWanted, Shaking, shaking, verdict
from mechsym.forces.table import columns
from mechsym.forces.turn import Turn, chain_of
from mechsym.mechanisms.chain import Loads
from mechsym.page import Shown
from mechsym.quantities import record


@record
class Forces(Shown):
    """Everything that `mechsym forces` reports."""

    turn: Turn
    loads: Loads
    columns: dict[str, np.ndarray]  #: shape (n,): The table `forces.csv`
    torque_orders: Harmonics
    shaking: Shaking  #: Forces and moments on the frame
    losses: Losses | None  #: Friction, where the case has coefficients
    chains: dict[str, textbook.Chain]  #: For a slider crank: rod as two masses, and Terskih's rule
    unbalanced: list[str]  #: Why balance that was asked for is not reached
    comparison: list[dict[str, Any]] | None


def forces(
    turn: Turn, friction: Friction | None = None, rings: Rings | None = None, wanted: BalanceWanted | None = None
) -> Forces:
    """Forces of a turn, friction where coefficients are given; the mechanisms are not compared."""
    found, shake, chains = loads(turn), shaking(turn), _chains(turn)
    table = columns(turn, found)
    for name, chain in chains.items():
        table |= {f"{name}_{f.name}": getattr(chain, f.name) for f in dataclasses.fields(chain)}
    return Forces(
        turn=turn,
        loads=found,
        columns=table,
        torque_orders=orders(turn.torque, turn.period),
        shaking=shake,
        losses=losses(turn, found, friction, rings or NoRings()) if friction else None,
        chains=chains,
        unbalanced=verdict(turn, shake, wanted) if wanted else [],
        comparison=None,
    )


def _chains(one: Turn) -> dict[str, textbook.Chain]:
    if chain_of(one.drive).letters is None:
        return {}
    rod = textbook.slider_crank(one)
    ratios = {"two_mass": rod.L_m / rod.L, "terskih": textbook.terskih(one.omega)}
    return {name: textbook.chain(one, ratio) for name, ratio in ratios.items()}
