"""Rodless (Balandin) mechanism: parameters, drawing, closing rules. Drawing of the letters: derivations/rodless.py.

The rigid plane mechanism is overconstrained by one (`mechsym.constraints.solve` of `rodless_constraints`: rank 3 of
4). `build` gives what it determines; the guide reactions X_a, X_b and the pin force come only from `closed` with a
closing rule by name, which says how the parts give way.
"""

import dataclasses

from mechsym import mechanisms
from mechsym.mechanisms import closing
from mechsym.mechanisms.closing import ClosingRule, CrankFreeRadially, RodlessFaces, Stiffnesses, four_faces
from mechsym.mechanisms.peers import Alike, Peer
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities.records import Record

NAME = "rodless"
#: Crank, link A-C-B, two sliders at right angles; these move with amplitude 2 r, stroke 4 r
RodlessParameters = mechanisms.parameters_class(NAME)


def build(parameters: Record) -> Mechanism:
    """The rodless mechanism with its determined reactions: coordinate alpha; inputs F_a, F_b, M."""
    return mechanisms.build(NAME, parameters)


def closed(mechanism: Mechanism, rule: ClosingRule) -> Mechanism:
    """The mechanism with all reactions, by a closing rule."""
    return closing.closed(mechanism, mechanisms.roles_of(NAME).closings[0], rule)


def peers(alike: Alike) -> tuple[Peer, ...]:
    """One piston, and four on both axes, each under two closing rules; links and crank without mass."""
    one = RodlessParameters(r=alike.stroke / 4, I1=1.0, m_link=0, I_link=0, m_a=alike.mass, m_b=0)
    four = dataclasses.replace(one, m_a=2 * alike.mass, m_b=2 * alike.mass)
    single = RodlessFaces(sides=("a+",), areas=(alike.area,), firing=(0.0,))
    equal = Stiffnesses(k_a=1.0, k_b=1.0, k_c=1.0)  # only their ratios matter
    rules: dict[str, ClosingRule] = {"crank free radially": CrankFreeRadially(), "equal stiffnesses": equal}
    rows = {"one piston": (one, single), "four pistons": (four, four_faces(alike.area, alike.period))}
    return tuple(
        Peer(mechanism=NAME, label=f"rodless, {count}, {name}", parameters=parameters, faces=faces, closing=rule)
        for name, rule in rules.items()
        for count, (parameters, faces) in rows.items()
    )
