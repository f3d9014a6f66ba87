"""Crank, rod, crosshead and elastic hinge: its numbers, and how it stands in a comparison (Zotov et al. 2024)."""

from mechsym import mechanisms
from mechsym.mechanisms.peers import Alike, Peer
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities.records import Record

NAME = "crosshead"
LABEL = "slider crank"  # in a comparison
#: r = r1 + r2 is the crank radius, l = l1 + l2 the rod's length
CrossheadParameters = mechanisms.parameters_class(NAME)


def build(parameters: Record) -> Mechanism:
    """The crosshead engine's mechanism. Returns mechanism: coordinate phi; inputs F, M_r, M_h."""
    return mechanisms.build(NAME, parameters)


def peers(alike: Alike) -> tuple[Peer, ...]:
    """A slider crank without masses but the piston's."""
    l = alike.stroke / 2 / alike.lam
    nothing = {"r1": 0.0, "l1": l / 2, "l2": l / 2, "m1": 0.0, "m2": 0.0, "m3": 0.0, "m4": 0.0, "IC2": 0.0, "g": 0.0}
    # at constant speed the crank's inertia is without effect
    parameters = CrossheadParameters(**nothing, r2=alike.stroke / 2, m5=alike.mass, I01=1.0)
    return (Peer(mechanism=NAME, label=LABEL, parameters=parameters),)
