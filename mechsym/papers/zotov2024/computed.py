"""Zotov et al. (2024): its sections 2 and 3, with a stated cycle in place of the force that it does not print.

The paper's F(phi) came from measured diagrams that are not printed, so that its torques and guides cannot be computed
again number by number. The built-in cases `zotov-89` and `zotov-142` carry a typical cycle of such an engine.
"""

import dataclasses
from functools import cache

import numpy as np

from mechsym import cases, periodic
from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.hinge import guide
from mechsym.hinge.balance import Balance, balance
from mechsym.hinge.choices import GuideParameters, Limits
from mechsym.hinge.guide import Guide, cut
from mechsym.hinge.limits import Verdict, judge
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.air import AirGauge
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.steady import Retuning, at_setting, retune
from mechsym.hinge.torque import Hinge, torque
from mechsym.jobs.machine import machine
from mechsym.machine.record import Machine, gas_of
from mechsym.papers.zotov2024.equations_printed import hinge_torque_printed, load_torque_printed
from mechsym.periodic import even_angles
from mechsym.quantities import record

# letter: (speed index, H [m], rho0 [m])
_CURVES = {"a": (0, 1.0, 0.8), "b": (1, 1.0, 0.8), "c": (0, 0.4, 0.3), "d": (1, 0.4, 0.3)}
_LEVELS = {"1": 3e6, "2": 5e6, "3": 8e6}  # [Pa]


@record
class Member:
    """One guide of the family."""

    label: str  #: Letter and number in Fig. 5, `a1` to `d3`
    start: str  #: `as_printed` with the paper's law, or `placed` with the case's law
    guide: Guide
    verdict: Verdict  #: Spring pressure, pressure angle, roller reaction, and whether it can be built


def family(
    balances: tuple[Balance, Balance],
    spring: Spring,
    parameters: GuideParameters,
    rollers: RollerParameters,
    limits: Limits,
) -> tuple[Member, ...]:
    """All twelve guides, as printed and placed.

    balances: torque at the lower and at the higher speed; spring: area, polytropic index and law of the placed guides;
    parameters: arrangement and z_margin of the placed guides. Returns members: 24 members, by label, as printed before
    placed.
    """
    if not spring.gas:
        raise BadInput("spring.law = coil has no p0; the guides of Fig. 5 need air_absolute or air_gauge")
    members = []
    for letter, (speed, H, rho0) in _CURVES.items():
        for number, p0 in _LEVELS.items():
            printed = GuideParameters(arrangement="two_tracks", start="as_printed", rho0=rho0)
            placed = dataclasses.replace(parameters, start="placed", rho0=rho0)
            gauge = AirGauge(A=spring.A, H=H, p0=p0, n=spring.n)  # type: ignore[attr-defined]
            filled = dataclasses.replace(spring, H=H, p0=p0)  # type: ignore[call-arg]
            for chosen, air in ((printed, gauge), (placed, filled)):
                guide = cut(balances[speed], air, chosen)
                verdict = judge(guide, rollers, limits)
                members.append(Member(label=letter + number, start=chosen.start, guide=guide, verdict=verdict))
    return tuple(members)


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
    """Largest size of a hinge torque [N*m]."""
    return max(abs(wanted.torque_min), abs(wanted.torque_max))


def retuned(pressure: float) -> Retuning:
    """The guide of 89 rpm with another pressure at 142 rpm. pressure: excess pressure p0 [Pa]."""
    both = engines()
    return at_setting(both.cut, both.hinges[1], pressure)


def best_pressure() -> Retuning:
    """The pressure with which that guide comes nearest to the torque needed at 142 rpm, by least squares."""
    both = engines()
    return retune(both.cut, both.hinges[1], "least_squares_torque")


def printed_torque(index: int, phi: np.ndarray) -> np.ndarray:
    """Hinge torque exactly as equation (8) prints it, with M_r by (5) [N*m].

    index: 0 for 89 rpm, 1 for 142 rpm; phi: crank angles [rad].
    """
    both = engines()
    engine, p, even = both.machines[index], both.cases[index].need("parameters"), even_angles(2 * np.pi)
    force = gas_of(engine).force
    return hinge_torque_printed(p, engine.omega, force(phi), load_torque_printed(p, force(even), even), phi)


@cache
def guides() -> tuple[Member, ...]:
    """The twelve guides of Fig. 5, as printed and placed."""
    both = engines()
    case = both.cases[0]
    slow, fast = (balance(h, "whole_cycle") for h in both.hinges)
    settings = (case.need(k) for k in ("spring", "guide", "rollers", "limits"))
    return family((slow, fast), *settings)


def longest_stretch(cut: Guide) -> float:
    """By how much the spring in a guide is longer than its free height; 0 when pressed everywhere [m]."""
    if cut.rho is None:
        return float("nan")
    _, _, rho, _ = periodic.extremes(cut.rho)
    return max(0.0, cut.rollers * (rho - cut.parameters.rho0))


def departure(cut: Guide) -> float:
    """How far a guide that could be cut is from a circle: largest minus smallest distance by their mean [-]."""
    rho = distances(cut)
    return float(np.ptp(rho) / ((rho.max() + rho.min()) / 2))


def distances(cut: Guide) -> np.ndarray:
    """Distances of the roller centres from the axis around a turn [m]. cut: a guide that could be cut."""
    return guide.path(cut)(np.linspace(0, 2 * np.pi, 1441))
