"""Engine and guides of Zotov et al. (2024), with the stated cycle in place of the gas force that is not printed."""

import dataclasses
from collections.abc import Mapping

import numpy as np

from mechsym import balance, cases, guide, guide_family, hinge
from mechsym.assembly import Assembly, assemble
from mechsym.guide import Guide
from mechsym.guide_family import Member
from mechsym.hinge import Hinge
from mechsym.hinge_printed import hinge_torque_printed, load_torque_printed
from mechsym.ripple import even_angles
from mechsym.springs import AirGauge


@dataclasses.dataclass(frozen=True, kw_only=True)
class Study:
    """The paper's engine at both speeds, with the stated cycle.

    Parameters
    ----------
    engines : tuple of two Assembly
        At 89 and at 142 rpm
    hinges : tuple of two Hinge
        Torque that each needs
    printed : Guide
        Guide a2 of Fig. 5, the spring's law and start as printed
    placed : Guide
        The same with the absolute law, placed so that the spring is never longer than its free height
    """

    engines: tuple[Assembly, Assembly]
    hinges: tuple[Hinge, Hinge]
    printed: Guide
    placed: Guide


def study(overrides: Mapping[str, str] | None = None) -> Study:
    """Both speeds and the guide that the paper retunes.

    Parameters
    ----------
    overrides : mapping of str to str, optional
        Case values to change at both speeds

    Returns
    -------
    study : Study
        Engines, hinge torques, guides
    """
    case, other = (cases.load(name, overrides) for name in ("zotov-89", "zotov-142"))
    engines = assemble(case), assemble(other)
    hinges = tuple(hinge.build(e.torques, e.omega) for e in engines)
    part, spring, choices = balance.build(hinges[0], "whole_cycle"), case.need("spring"), case.need("guide")
    gauge = AirGauge(A=spring.A, H=spring.H, p0=spring.p0, n=spring.n)
    as_printed = dataclasses.replace(choices, start="as_printed")
    return Study(
        engines=engines,
        hinges=(hinges[0], hinges[1]),
        printed=guide.build(part, gauge, as_printed),
        placed=guide.build(part, spring, choices),
    )


def printed_torque(found: Study, index: int, phi: np.ndarray) -> np.ndarray:
    """Hinge torque exactly as equation (8) prints it, with M_r by (5).

    Parameters
    ----------
    found : Study
        Engines
    index : int
        0 for 89 rpm, 1 for 142 rpm
    phi : ndarray, shape (n,)
        Crank angles [rad]

    Returns
    -------
    M_h : ndarray, shape (n,)
        Torque on the crank [N*m]
    """
    engine = found.engines[index]
    p, even = engine.case.need("parameters"), even_angles(2 * np.pi)
    load = load_torque_printed(p, engine.force(even), even)
    return hinge_torque_printed(p, engine.omega, engine.force(phi), load, phi)


def members(found: Study) -> dict[str, Member]:
    """The twelve guides of Fig. 5 as printed.

    Parameters
    ----------
    found : Study
        Engines

    Returns
    -------
    members : dict of str to Member
        `a1` to `d3`
    """
    case = found.engines[0].case
    balances = tuple(balance.build(h, "whole_cycle") for h in found.hinges)
    family = guide_family.family(
        (balances[0], balances[1]), case.need("spring"), case.need("guide"), case.need("rollers"), case.need("limits")
    )
    return {m.label: m for m in family if m.start == "as_printed"}


def departure(cut: Guide) -> float:
    """How far a guide is from a circle: largest minus smallest distance over their mean.

    Parameters
    ----------
    cut : Guide
        A guide that could be cut

    Returns
    -------
    departure : float
        0 for a circle [-]
    """
    rho = distances(cut)
    return float(np.ptp(rho) / ((rho.max() + rho.min()) / 2))


def distances(cut: Guide) -> np.ndarray:
    """Distances of the roller centres from the axis around a turn.

    Parameters
    ----------
    cut : Guide
        A guide that could be cut

    Returns
    -------
    rho : ndarray, shape (n,)
        At even angles, both ends included [m]
    """
    return guide.path(cut)(np.linspace(0, 2 * np.pi, 1441))
