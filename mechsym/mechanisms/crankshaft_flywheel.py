"""Crankshaft and flywheel on a torsional spring: parameters and runtime mechanisms (Chmielewski et al. 2015)."""

from collections.abc import Iterable
from typing import Any

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.drawn_parts import Circle, Line, slider_crank
from mechsym.mechanisms.proportions import Reciprocating
from mechsym.mechanisms.proportions import slider_crank as crank_and_rod
from mechsym.mechanisms.record import Mechanism
from mechsym.mechanisms.traits import ElasticShaft, Traits
from mechsym.quantities import quantity, record


@record
class CrankshaftFlywheelParameters:
    """Two discs, one slider crank."""

    I0: float = quantity("kg*m^2", above=0, about="inertia of the crankshaft")
    I2: float = quantity("kg*m^2", above=0, about="inertia of the flywheel")
    r: float = quantity("m", above=0, about="crank radius")
    l: float = quantity("m", above=0, about="rod length")
    m0: float = quantity("kg", low=0, about="reciprocating mass")
    #: Torsional stiffness of the shaft [N*m/rad]
    k1: float = quantity("N*m/rad", low=0, about="torsional stiffness")
    #: Torsional damping of the shaft, 0 in the paper [N*m*s/rad]
    c1: float = quantity("N*m*s/rad", default=0.0, low=0, about="torsional damping")

    def __post_init__(self) -> None:
        if self.l <= self.r:
            raise BadInput(f"rod too short: l = {self.l:g} m, needs more than r = {self.r:g} m; lengthen l")


def build(parameters: CrankshaftFlywheelParameters) -> Mechanism:
    """The exact mechanism.

    Returns
    -------
    mechanism : Mechanism
        Coordinates phi0, phi2; inputs M, F
    """
    return mechanisms.build("crankshaft_flywheel", parameters)


def build_printed(parameters: CrankshaftFlywheelParameters) -> Mechanism:
    """The model exactly as equation (6) with (11) prints it, for comparison only.

    Returns
    -------
    mechanism : Mechanism
        Coordinates phi0, phi2; input M; no energies
    """
    return mechanisms.build("crankshaft_flywheel_printed", parameters)


def _drawing(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    yield Circle(role="flywheel", centre=(0.0, 0.0), radius=1.5 * p.r)
    yield from slider_crank(p.r, p.l, 0.0, angle, bore)


TRAITS = Traits(
    parameters=CrankshaftFlywheelParameters,
    drawing=_drawing,
    proportions=lambda p: crank_and_rod(
        p.r, p.l, (Reciprocating(letters="m0", mass=p.m0),), mass=p.m0, shafts={"I0": p.I0, "I2": p.I2}
    ),
    shaft=ElasticShaft(discs=lambda p: (p.I0, p.I2), springs=lambda p: ((p.k1,), (p.c1,)), start_up=True),
)
