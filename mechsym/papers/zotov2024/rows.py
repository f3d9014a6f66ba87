"""Numbers and claims of Zotov et al. (2024) beside the computation.

The paper does not print its gas force. What holds for every gas force gets a verdict; what depends on it is
`not computable` as printed, and is computed with the stated cycle of the cases zotov-89 and zotov-142 instead.
"""

from dataclasses import replace
from functools import cache, partial

import numpy as np

from mechsym import cases, periodic
from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.hinge import guide, trials
from mechsym.hinge.balance import Balance, balance
from mechsym.hinge.choices import GuideParameters, Limits
from mechsym.hinge.guide import Guide, cut, fitted, setting_of, with_setting
from mechsym.hinge.limits import Verdict, judge
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.air import AirGauge
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.steady import Retuning, at_setting, retune
from mechsym.hinge.torque import Hinge, torque
from mechsym.jobs.machine import machine
from mechsym.machine.loads import ConstantLoad
from mechsym.machine.record import Machine, gas_of
from mechsym.papers.rows import ARITHMETIC, NOT_COMPUTABLE, Row, by_digits, listed
from mechsym.papers.zotov2024.equations_printed import hinge_torque_printed, load_torque_printed
from mechsym.periodic import even_angles
from mechsym.quantities import record
from mechsym.quantities.display import ratio_text

_row = partial(listed, "zotov2024")
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
            placed = replace(parameters, start="placed", rho0=rho0)
            gauge = AirGauge(A=spring.A, H=H, p0=p0, n=spring.n)  # type: ignore[attr-defined]
            filled = replace(spring, H=H, p0=p0)  # type: ignore[call-arg]
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
    choices = replace(case.need("guide"), start="as_printed", arrangement="two_tracks")
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


_ZERO = 1e-9  # of the peak
_PRESSURES, _HEIGHTS = (3e6, 5e6, 8e6), (0.4, 1.0)  # caption of Fig. 5 [Pa], [m]
_STEADY = 1e-6  # a ripple below this is what the simulation's tolerance leaves


def rows() -> list[Row]:
    """Every number, claim and figure of the source."""
    both = engines()
    return [*_torque_rows(both), *_guide_rows(both), *_retuning_rows(both), _row("share", None, NOT_COMPUTABLE)]


def _torque_rows(both: Engines) -> list[Row]:
    low, high = both.hinges
    square = (high.omega / low.omega) ** 2
    phi = even_angles(2 * np.pi)
    shares = [float(np.abs(h.inertia_part(phi)).max()) / peak(h) for h in both.hinges]
    ripple = _ripple_with_hinge(both)
    return [
        _row("force", None, NOT_COMPUTABLE),
        _row("peaks", peak(high) / peak(low), NOT_COMPUTABLE, low=peak(low) / 1e3, high=peak(high) / 1e3),
        _row("square", square, by_digits("2", square)),
        _row("inertia_share", shares[1], abs(shares[1] - 1) < 0.05, shares=shares),
        *_integral_rows(both),
        _row("ripple", ripple, ripple < _STEADY),
    ]


def _integral_rows(both: Engines) -> list[Row]:
    lines, phi = [], even_angles(2 * np.pi)
    for index, (letter, wanted) in enumerate(zip("ab", both.hinges, strict=True)):
        torque = printed_torque(index, phi)
        exact, printed = abs(wanted.mean_torque) / peak(wanted), float(abs(torque.mean()) / np.abs(torque).max())
        zero = max(exact, printed) < _ZERO
        lines.append(_row("integral", exact, zero, letter=letter, printed=ratio_text(printed)))
    return lines


def _ripple_with_hinge(both: Engines) -> float:
    engine = fitted(replace(both.machines[0], load=ConstantLoad()), both.hinges[0], both.cut)
    ripple = trials.run("hinge", "guide a2", engine, both.hinges[0].omega, 3.0).speed_ripple
    return float("inf") if ripple is None else ripple


def _guide_rows(both: Engines) -> list[Row]:
    cut = {m.label: m.guide for m in guides() if m.start == "as_printed"}
    off = {label: departure(g) for label, g in cut.items()}
    worst = {letter: max(off[letter + n] for n in "123") for letter in "abcd"}
    pressed = [off[a + x] > off[a + y] for a in "abcd" for x, y in ("12", "23")]
    # for both speeds and the three pressures: is the guide for H = 1 m rounder than that for 0.4 m, at one rho0
    taller = []
    for wanted in both.hinges:
        part = balance(wanted, "whole_cycle")
        for p0 in _PRESSURES:
            springs = (replace(with_setting(both.cut.spring, p0), H=H) for H in _HEIGHTS)
            short, tall = (departure(guide.cut(part, spring, both.cut.parameters)) for spring in springs)
            taller.append(tall < short)
    stretch = [longest_stretch(g) for g in cut.values()]
    departures = ", ".join(f"{letter} {100 * value:.0f} %" for letter, value in worst.items())
    return [
        _row("roundest", worst["a"], min(worst, key=lambda k: worst[k]) == "a", listed=departures),
        _row("pressed", float(np.mean(pressed)), all(pressed)),
        _row("taller", float(np.mean(taller)), all(taller)),
        _row("stretch", 1e3 * max(stretch), NOT_COMPUTABLE, longer=sum(z > 0 for z in stretch)),
    ]


def _retuning_rows(both: Engines) -> list[Row]:
    p0, paper, best = PRESSURES[0], retuned(PRESSURES[1]), best_pressure()
    steadiest = {name: _least_ripple(engines(name)) for name in VARIANTS}
    ripples = ", ".join(f"{name} {100 * ripple:.1f} %" for name, ripple in steadiest.items())
    printed, absolute = (_departure_from_proportional(cut) for cut in (both.cut, both.placed))
    stopped = paper.ripple_propeller_load
    fate = "the engine stops" if stopped is None else f"{100 * stopped:.1f} %"
    return [
        _row("factor", PRESSURES[1] / p0, ARITHMETIC),
        _row("proportional", printed, printed < _ZERO, absolute=absolute),
        _row("pressure", best.setting / 1e6, NOT_COMPUTABLE, ratio=best.setting / p0),
        _row("curves", paper.torque_error, NOT_COMPUTABLE, best=best.torque_error),
        _row("retuned", next(iter(steadiest.values())), NOT_COMPUTABLE, ripples=ripples, fate=fate),
    ]


def _least_ripple(both: Engines) -> float:
    ripple = retune(both.placed, both.hinges[1], "least_ripple_propeller_load").ripple_propeller_load
    return float("nan") if ripple is None else ripple


def _departure_from_proportional(cut: Guide) -> float:
    phi, spring = even_angles(2 * np.pi), cut.spring
    doubled = with_setting(spring, 2 * setting_of(spring))
    once, twice = (guide.crank_torque(guide.refit(cut, s), phi) for s in (spring, doubled))
    return float(np.abs(twice - 2 * once).max() / np.abs(twice).max())
