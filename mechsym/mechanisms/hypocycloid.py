"""Geared hypocycloid: its numbers, and how it stands in a comparison (Nunes 2017).

The planar mechanism is overconstrained by one; the reactions hold under the assumption of no side force on the piston
(its rod is not guided).
"""

from mechsym import mechanisms
from mechsym.mechanisms.peers import Alike, Peer
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities.records import Record

NAME = LABEL = "hypocycloid"  # also in a comparison
#: The crank throw e is the planet's pitch radius; the stroke is 4 e
HypocycloidParameters = mechanisms.parameters_class(NAME)


def build(parameters: Record) -> Mechanism:
    """The hypocycloid mechanism, with no side force on the piston."""
    return mechanisms.build(NAME, parameters)


def peers(alike: Alike) -> tuple[Peer, ...]:
    """A planet without mass; at constant speed the crank's inertia is without effect."""
    parameters = HypocycloidParameters(e=alike.stroke / 4, I1=1.0, m2=0, I2=0, m3=alike.mass, alpha_n=alike.alpha_n)
    return (Peer(mechanism=NAME, label=LABEL, parameters=parameters),)
