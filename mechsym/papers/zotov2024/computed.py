"""Zotov et al. (2024): its sections 2 and 3, with a stated cycle in place of the force that it does not print.

The paper's F(phi) came from measured diagrams that are not printed, so that its torques and guides cannot be computed
again number by number. The built-in cases `zotov-89` and `zotov-142` carry a typical cycle of such an engine.
"""

import dataclasses
from functools import cache

import numpy as np

from mechsym import cases, periodic
from mechsym.cases import Case
from mechsym.hinge import guide
from mechsym.hinge.balance import balance
from mechsym.hinge.guide import Guide
from mechsym.hinge.retune import Retuning, at_setting, retune
from mechsym.hinge.springs import AirGauge
from mechsym.hinge.torque import Hinge, torque
from mechsym.jobs.machine import machine
from mechsym.machine.record import Machine, gas_of
from mechsym.papers.zotov2024.family import Member, family
from mechsym.papers.zotov2024.hinge_printed import hinge_torque_printed, load_torque_printed
from mechsym.periodic import even_angles
from mechsym.quantities import record

CASES = ("zotov-89", "zotov-142")
PRESSURES = (5e6, 9.5e6)  # Fig. 6 [Pa]
# what the source leaves open and what changes the ripple of the retuned guide
VARIANTS: dict[str, dict[str, str]] = {
    "atmosphere under the piston": {},
    "scavenge pressure under the piston": {"cycle.crank_side": "scavenge"},
    "atmosphere, engine upright": {"axis_tilt": "90 deg"},
}


@record
class Engines:
    """Both speeds of the paper."""

    cases: tuple[Case, Case]  #: Of 89 and of 142 rpm
    machines: tuple[Machine, Machine]
    hinges: tuple[Hinge, Hinge]  #: Torque that keeps each speed constant
    cut: Guide  #: Dependence 2 of Fig. 5 a: the guide of 89 rpm for the printed spring law at 5 MPa
    #: The same for a spring that obeys the absolute pressure, placed so that it is never longer than its free height
    placed: Guide


@cache
def engines(variant: str = "atmosphere under the piston") -> Engines:
    """Both engines with their hinges and the paper's guide."""
    slow, fast = (cases.load(name, VARIANTS[variant]) for name in CASES)
    machines = (machine(slow), machine(fast))
    hinges = (torque(machines[0]), torque(machines[1]))
    placed = guide.cut(balance(hinges[0], "whole_cycle"), slow.need("spring"), slow.need("guide"))
    printed = _printed_guide(slow, hinges[0])
    return Engines(cases=(slow, fast), machines=machines, hinges=hinges, cut=printed, placed=placed)


def _printed_guide(case: Case, wanted: Hinge) -> Guide:
    spring = case.need("spring")
    printed = AirGauge(A=spring.A, H=spring.H, p0=spring.p0, n=spring.n)
    choices = dataclasses.replace(case.need("guide"), start="as_printed", arrangement="two_tracks")
    return guide.cut(balance(wanted, "whole_cycle"), printed, choices)


def peak(wanted: Hinge) -> float:
    """Largest size of a hinge torque.

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
    return retune(found.cut, found.hinges[1], "least_squares_torque")


def printed_torque(index: int, phi: np.ndarray) -> np.ndarray:
    """Hinge torque exactly as equation (8) prints it, with M_r by (5).

    Parameters
    ----------
    index : int
        0 for 89 rpm, 1 for 142 rpm
    phi : ndarray, shape (n,)
        Crank angles [rad]

    Returns
    -------
    M_h : ndarray, shape (n,)
        Torque on the crank [N*m]
    """
    found = engines()
    engine, p, even = found.machines[index], found.cases[index].need("parameters"), even_angles(2 * np.pi)
    force = gas_of(engine).force
    return hinge_torque_printed(p, engine.omega, force(phi), load_torque_printed(p, force(even), even), phi)


@cache
def guides() -> tuple[Member, ...]:
    """The twelve guides of Fig. 5, as printed and placed."""
    found = engines()
    case = found.cases[0]
    slow, fast = (balance(h, "whole_cycle") for h in found.hinges)
    settings = (case.need(k) for k in ("spring", "guide", "rollers", "limits"))
    return family((slow, fast), *settings)


def longest_stretch(cut: Guide) -> float:
    """By how much the spring in a guide is longer than its free height.

    Returns
    -------
    stretch : float
        0 when the guide presses it everywhere [m]
    """
    if cut.rho is None:
        return float("nan")
    _, _, rho, _ = periodic.extremes(cut.rho)
    return max(0.0, cut.rollers * (rho - cut.parameters.rho0))


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
