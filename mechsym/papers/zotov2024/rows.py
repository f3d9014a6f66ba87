"""Numbers and claims of Zotov et al. (2024) beside the computation.

The paper does not print its gas force. What holds for every gas force gets a verdict; what depends on it is
`not computable` as printed, and is computed with the stated cycle of the cases zotov-89 and zotov-142 instead.
"""

from dataclasses import replace

import numpy as np

from mechsym.hinge import guide, trials
from mechsym.hinge.balance import balance
from mechsym.hinge.guide import Guide, fitted, setting_of, with_setting
from mechsym.hinge.steady import retune
from mechsym.machine.loads import ConstantLoad
from mechsym.papers.rows import ARITHMETIC, NOT_COMPUTABLE, Row, by_digits, claim, row
from mechsym.papers.zotov2024.computed import (
    PRESSURES,
    VARIANTS,
    Engines,
    best_pressure,
    departure,
    engines,
    guides,
    longest_stretch,
    peak,
    printed_torque,
    retuned,
)
from mechsym.periodic import even_angles
from mechsym.quantities.display import ratio_text

_NO_FORCE = "the gas force is not printed; computed with the cycle of zotov-89 and zotov-142"
_ZERO = 1e-9  # of the peak
_PRESSURES, _HEIGHTS = (3e6, 5e6, 8e6), (0.4, 1.0)  # caption of Fig. 5 [Pa], [m]
_STEADY = 1e-6  # a ripple below this is what the simulation's tolerance leaves


def rows() -> list[Row]:
    """Every number, claim and figure of the source."""
    both = engines()
    why = "a general statement of the source's reference [21], no datum of this engine"
    flywheel = row("flywheel inertia, up to this share of all moving parts [%]", "80", None, NOT_COMPUTABLE, why)
    return [*_torque_rows(both), *_guide_rows(both), *_retuning_rows(both), flywheel]


def _torque_rows(both: Engines) -> list[Row]:
    low, high = both.hinges
    square = (high.omega / low.omega) ** 2
    phi = even_angles(2 * np.pi)
    shares = [float(np.abs(h.inertia_part(phi)).max()) / peak(h) for h in both.hinges]
    ripple = _ripple_with_hinge(both)
    return [
        row("Fig. 3: force on the piston", None, None, NOT_COMPUTABLE, f"{_NO_FORCE}, drawn as figure_3"),
        row(
            "Fig. 4: largest |M_h| at 142 rpm over that at 89 rpm", "2", peak(high) / peak(low), NOT_COMPUTABLE,
            f"{_NO_FORCE}; largest |M_h| {peak(low) / 1e3:.1f} and {peak(high) / 1e3:.1f} kN m",
        ),
        row(
            "factor of (8) from 89 to 142 rpm, by the square of the speed", "2", square, by_digits("2", square),
            "the text gives the square as the reason for 'approximately 2 times'; it is (142/89)^2 for any gas force",
        ),
        claim(
            "M_h proportional to the square of the speed: share of the inertia part in its peak", "proportional",
            shares[1], abs(shares[1] - 1) < 0.05,
            f"{shares[0]:.2f} at 89 rpm, {shares[1]:.2f} at 142 rpm with the stated cycle; the rest is the gas force, "
            "which (8) does not square",
        ),
        *_integral_rows(both),
        claim(
            "speed ripple at 89 rpm with the hinge", "constant", ripple, ripple < _STEADY,
            "simulated with the guide a2 and constant load; holds for any gas force",
        ),
    ]  # fmt: skip


def _integral_rows(both: Engines) -> list[Row]:
    lines, phi = [], even_angles(2 * np.pi)
    for index, (letter, wanted) in enumerate(zip("ab", both.hinges, strict=True)):
        torque = printed_torque(index, phi)
        exact, printed = abs(wanted.mean_torque) / peak(wanted), float(abs(torque.mean()) / np.abs(torque).max())
        lines.append(
            claim(
                f"integral of M_h over a turn, option {letter}, over 2 pi times its peak",
                "0",
                exact,
                max(exact, printed) < _ZERO,
                f"{ratio_text(printed)} with (8) as printed; 0 by (4) and (5) for any gas force",
            )
        )
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
    taller = _rounder_when_taller(both)
    stretch = [longest_stretch(g) for g in cut.values()]
    listed = ", ".join(f"{letter} {100 * value:.0f} %" for letter, value in worst.items())
    return [
        claim(
            "Fig. 5: option closest to a circle, largest departure of its guides",
            "a",
            worst["a"],
            min(worst, key=lambda k: worst[k]) == "a",
            f"(rho_max - rho_min) / mean rho: {listed}, with the stated cycle",
        ),
        claim(
            "Fig. 5: a larger p0 makes the guide rounder, share of the pairs",
            "maximum",
            float(np.mean(pressed)),
            all(pressed),
            "with the stated cycle; by (11) the closing falls with A p0 for any torque",
        ),
        claim(
            "Fig. 5: a larger H makes the guide rounder, share of the pairs",
            "maximum",
            float(np.mean(taller)),
            all(taller),
            "H = 0.4 and 1 m at the same rho0 = 0.8 m, with the stated cycle: the shorter spring is stiffer and closes "
            "less; a and b are rounder than c and d by their larger rho0",
        ),
        row(
            "Fig. 5: twelve guides, largest stretch of the spring beyond its height H [mm]",
            None,
            1e3 * max(stretch),
            NOT_COMPUTABLE,
            f"{_NO_FORCE}, drawn as figure_5; {sum(z > 0 for z in stretch)} of 12 guides let the spring be longer than "
            "that somewhere, which the paper does not discuss",
        ),
    ]


def _rounder_when_taller(both: Engines) -> list[bool]:
    """For both speeds and the three pressures: is the guide for H = 1 m rounder than that for 0.4 m, at one rho0."""
    lines = []
    for wanted in both.hinges:
        part = balance(wanted, "whole_cycle")
        for p0 in _PRESSURES:
            springs = (replace(with_setting(both.cut.spring, p0), H=H) for H in _HEIGHTS)
            short, tall = (departure(guide.cut(part, spring, both.cut.parameters)) for spring in springs)
            lines.append(tall < short)
    return lines


def _retuning_rows(both: Engines) -> list[Row]:
    p0, paper, best = PRESSURES[0], retuned(PRESSURES[1]), best_pressure()
    steadiest = {name: _least_ripple(engines(name)) for name in VARIANTS}
    ripples = ", ".join(f"{name} {100 * ripple:.1f} %" for name, ripple in steadiest.items())
    proportional = _departure_from_proportional(both.cut)
    return [
        row("factor of p0 from 5 to 9.5 MPa", "1.9", PRESSURES[1] / p0, ARITHMETIC, "the caption's own two pressures"),
        claim(
            "(14): M_h* proportional to p0, largest relative departure",
            "proportional",
            proportional,
            proportional < _ZERO,
            f"with the law of (9); with absolute pressure {_departure_from_proportional(both.placed):.1e}",
        ),
        row(
            "Fig. 6: p0 for 142 rpm with guide a2 [MPa]",
            "9.5",
            best.setting / 1e6,
            NOT_COMPUTABLE,
            f"{_NO_FORCE}; least squares of the torque, {best.setting / p0:.2f} times 5 MPa",
        ),
        row(
            "Fig. 6: curves 2 and 3, rms of their difference",
            "visually almost coincide",
            paper.torque_error,
            NOT_COMPUTABLE,
            f"{_NO_FORCE}; with the factor 1.9, over the rms of curve 3; {best.torque_error:.3f} with the best p0",
        ),
        row(
            "speed ripple at 142 rpm with guide a2 retuned",
            "almost constant",
            next(iter(steadiest.values())),
            NOT_COMPUTABLE,
            f"{_NO_FORCE}; least ripple over p0, propeller load, absolute law: {ripples}; a flywheel of the usual size "
            f"leaves 2 %; with the factor 1.9 {_fate(paper.ripple_propeller_load)}",
        ),
    ]


def _least_ripple(both: Engines) -> float:
    ripple = retune(both.placed, both.hinges[1], "least_ripple_propeller_load").ripple_propeller_load
    return float("nan") if ripple is None else ripple


def _fate(ripple: float | None) -> str:
    return "the engine stops" if ripple is None else f"{100 * ripple:.1f} %"


def _departure_from_proportional(cut: Guide) -> float:
    phi, spring = even_angles(2 * np.pi), cut.spring
    doubled = with_setting(spring, 2 * setting_of(spring))
    once, twice = (guide.crank_torque(guide.refit(cut, s), phi) for s in (spring, doubled))
    return float(np.abs(twice - 2 * once).max() / np.abs(twice).max())
