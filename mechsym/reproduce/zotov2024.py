"""Zotov et al. (2024): what its sections 2 and 3 report,
with a stated cycle in place of the force that it does not print.

The paper's F(phi) came from measured diagrams that are not printed, so that its torques and guides cannot be computed
again number by number. The built-in cases `zotov-89` and `zotov-142` carry a typical cycle of such an engine.
"""

import dataclasses
from functools import cache
from typing import Any

import numpy as np

from mechsym import balance, cases, guide, hinge, periodic, retune
from mechsym.arrangement import GuideParameters
from mechsym.assembly import Assembly, assemble
from mechsym.guide import Guide
from mechsym.guide_family import Member, family
from mechsym.hinge import Hinge
from mechsym.hinge_printed import hinge_torque_printed
from mechsym.reproduce.rows import row
from mechsym.retune import Retuning, at_setting
from mechsym.springs import AirGauge

SOURCE = "000_9f2b746dc1abd296"
CASES = ("zotov-89", "zotov-142")
_NO_FORCE = "F(phi) is not printed; with the cycle of the built-in cases"
PRESSURES = (5e6, 9.5e6)  # Fig. 6 [Pa]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Engines:
    """Both speeds of the paper.

    Parameters
    ----------
    assemblies : tuple of two Assembly
        Engine at 89 and at 142 rpm
    hinges : tuple of two Hinge
        Torque that keeps each speed constant
    cut : Guide
        Dependence 2 of Fig. 5 a: the guide of 89 rpm for the printed spring law at 5 MPa
    """

    assemblies: tuple[Assembly, Assembly]
    hinges: tuple[Hinge, Hinge]
    cut: Guide


@cache
def engines() -> Engines:
    """Both engines with their hinges and the paper's guide.

    Returns
    -------
    engines : Engines
        Made once
    """
    slow, fast = (assemble(cases.load(name)) for name in CASES)
    hinges = (hinge.build(slow.torques, slow.omega), hinge.build(fast.torques, fast.omega))
    return Engines(assemblies=(slow, fast), hinges=hinges, cut=_printed_guide(slow, hinges[0]))


def _printed_guide(engine: Assembly, wanted: Hinge) -> Guide:
    spring = engine.case.need("spring")
    printed = AirGauge(A=spring.A, H=spring.H, p0=spring.p0, n=spring.n)
    choices = dataclasses.replace(_choices(engine), start="as_printed", arrangement="two_tracks")
    return guide.build(balance.build(wanted, "whole_cycle"), printed, choices)


def _choices(engine: Assembly) -> GuideParameters:
    found: GuideParameters = engine.case.need("guide")
    return found


def peak(wanted: Hinge) -> float:
    """Largest size of a hinge torque.

    Parameters
    ----------
    wanted : Hinge
        Hinge

    Returns
    -------
    peak : float
        max |M_h| [N*m]
    """
    return max(abs(wanted.torque_min), abs(wanted.torque_max))


def retuned(pressure: float) -> Retuning:
    """The guide of 89 rpm with another pressure at 142 rpm.

    Parameters
    ----------
    pressure : float
        Excess pressure p0 [Pa]

    Returns
    -------
    retuned : Retuning
        What remains
    """
    found = engines()
    return at_setting(found.cut, found.hinges[1], pressure)


def best_pressure() -> Retuning:
    """The pressure with which that guide comes nearest to the torque needed at 142 rpm.

    Returns
    -------
    retuned : Retuning
        By least squares of the torque
    """
    found = engines()
    return retune.retune(found.cut, found.hinges[1], "least_squares_torque")


def printed_error(phi: np.ndarray) -> float:
    """What equation (8) as printed is wrong by at 89 rpm.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angles [rad]

    Returns
    -------
    error : float
        Largest difference of M_h as a share of its peak [-]
    """
    engine, wanted = engines().assemblies[0], engines().hinges[0]
    p, force = engine.case.need("parameters"), engine.force(phi)
    printed = hinge_torque_printed(p, engine.omega, force, wanted.load_torque, phi)
    return float(np.max(np.abs(printed - wanted.torque(phi))) / peak(wanted))


@cache
def guides() -> tuple[Member, ...]:
    """The twelve guides of Fig. 5, as printed and placed.

    Returns
    -------
    guides : tuple of Member
        24 members
    """
    found = engines()
    case = found.assemblies[0].case
    slow, fast = (balance.build(h, "whole_cycle") for h in found.hinges)
    settings = (case.need(k) for k in ("spring", "guide", "rollers", "limits"))
    return family((slow, fast), *settings)


def longest_stretch(cut: Guide) -> float:
    """By how much the spring in a guide is longer than its free height.

    Parameters
    ----------
    cut : Guide
        Guide

    Returns
    -------
    stretch : float
        0 when the guide presses it everywhere [m]
    """
    if cut.rho is None:
        return float("nan")
    _, _, rho, _ = periodic.extremes(cut.rho)
    return max(0.0, cut.rollers * (rho - cut.parameters.rho0))


def rows() -> list[dict[str, Any]]:
    """Every number that the paper reports of its computations.

    Returns
    -------
    rows : list of dict
        Keys source, item, published, computed, rel_error, verdict, note
    """
    found = engines()
    slow, fast = found.hinges
    paper, best = retuned(PRESSURES[1]), best_pressure()
    return [
        _row("mean of M_h over a turn, option a, as a share of its peak", 0.0, abs(slow.mean_torque) / peak(slow),
             "reproduced", "holds for every F: M_r is the mean by (5)"),
        _row("mean of M_h over a turn, option b, as a share of its peak", 0.0, abs(fast.mean_torque) / peak(fast),
             "reproduced", "as for option a"),
        _row("largest |M_h|, option b over option a (Fig. 4)", 2.0, peak(fast) / peak(slow), "not computable",
             f"{_NO_FORCE}; the same picture as the paper's 'approximately 2 times'"),
        _row("pressure that serves 142 rpm over 5 MPa (Fig. 6)", 1.9, best.setting / PRESSURES[0], "not computable",
             f"{_NO_FORCE}, least squares of the torque; {100 * best.torque_error:.0f} % of its rms remain"),
        _row("torque missing at 142 rpm with 9.5 MPa (Fig. 6), share of its rms", None, paper.torque_error,
             "not computable", f"{_NO_FORCE}; the paper says 'visually almost coincide'"),
        _row("speed ripple at 142 rpm with 9.5 MPa under a propeller load", None, paper.ripple_propeller_load,
             "not computable", f"{_NO_FORCE}; the paper says 'almost constant' and gives no number"),
        *[_guide_row(member) for member in guides() if member.start == "as_printed"],
    ]  # fmt: skip


def _guide_row(member: Member) -> dict[str, Any]:
    stretch = longest_stretch(member.guide)
    note = f"{_NO_FORCE}; the paper does not discuss that the spring is longer than its free height here"
    return _row(f"Fig. 5 {member.label}: stretch of the spring beyond H [m]", None, stretch, "not computable", note)


def _row(item: str, published: float | None, computed: float | None, verdict: str, note: str) -> dict[str, Any]:
    return row(SOURCE, item, published, computed, verdict, note)
