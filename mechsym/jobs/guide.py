"""Case -> guide for the workshop: engine -> guide -> verdict -> contact -> what errors of spring and track cost."""

from dataclasses import replace

import numpy as np
import scipy

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.hinge.contact import Contact, at_pieces
from mechsym.hinge.guide import Guide, path
from mechsym.hinge.limits import Verdict, judge
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.steady import sensitivities, with_guide
from mechsym.jobs.export import guide_of
from mechsym.machine.record import Machine, kinks_of
from mechsym.quantities import record
from mechsym.simulate.steady import Steady

ERROR = 1e-4  # of the track, that is tried [m]


@record
class Workshop:
    """A guide with what a workshop has to know of it."""

    name: str
    about: str
    machine: Machine
    guide: Guide
    rollers: RollerParameters
    verdict: Verdict
    contact: Contact
    kinks: tuple[float, ...]  #: angles of the guide's shaft where the curvature jumps [rad]
    #: what is off, and the speed ripple of the steady motion low and high; None where there is none [-]
    tolerances: tuple[tuple[str, float | None, float | None], ...]


def workshop(case: Case, diagram: str | None = None) -> Workshop:
    """The guide of a case for the workshop.

    Raises
    ------
    BadInput
        No guide can be cut, or a section is missing
    """
    rollers, limits = case.need("rollers"), case.need("limits")
    engine, wanted, guide = guide_of(case, diagram)
    if guide is None:
        raise BadInput(f"{case.file}: sections [spring] and [guide] are missing; a guide needs both")
    rows = [(f"{s.name} 1 % low, high", _ripple(s.low), _ripple(s.high)) for s in sensitivities(engine, wanted, guide)]
    inwards, outwards = (_ripple(with_guide(engine, wanted, _shifted(guide, d))) for d in (-ERROR, ERROR))
    ratio = guide.parameters.shaft_ratio
    return Workshop(
        name=case.name, about=case.about, machine=engine, guide=guide, rollers=rollers,
        verdict=judge(guide, rollers, limits), contact=at_pieces(guide, rollers),
        kinks=_around(guide, tuple(k * ratio for k in kinks_of(engine))),
        tolerances=(*rows, (f"track {1e3 * ERROR:g} mm in, out", inwards, outwards)),
    )  # fmt: skip


def _ripple(steady: Steady) -> float | None:
    return steady.speed_ripple


def _shifted(guide: Guide, distance: float) -> Guide:
    """The track cut too near to the axis or too far from it by a distance [m]."""
    rho = path(guide)
    rows = rho.c.copy()
    rows[-1] += distance
    return replace(guide, rho=scipy.interpolate.PPoly(rows, rho.x, extrapolate="periodic"))


def _around(guide: Guide, angles: tuple[float, ...]) -> tuple[float, ...]:
    """Angles of one period of the track, repeated over its whole turn [rad]."""
    period = float(path(guide).x[-1])
    turns = round(2 * np.pi / period)
    return tuple(sorted({float(a % period + k * period) for a in angles for k in range(turns)}))
