"""What the study `nunes2017-chapter-6` says of the sentences of chapter 6.

The thesis computes none of it, so a verdict is about the sign of what it expects; the note has what the number means.
Everything is the corrected model (errata E4, E23), at 4000 rpm unless the row says otherwise.
"""

import dataclasses
import functools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mechsym.papers.nunes2017 import SOURCE
from mechsym.papers.rows import NOT_REPRODUCED, REPRODUCED, row
from mechsym.sweep import columns, sweep
from mechsym.sweep.study import read

_STUDY, _ENDLESS = "nunes2017-chapter-6", "500 m"
_FRICTION = "friction.friction_mean_pressure"


def rows(engine: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of sections 6 and 6.1, each from one or two sweeps.

    Parameters
    ----------
    engine : sequence of dict
        Rows of chapter 3, for what the corrected model changes there
    """
    found = [*_performance(), *_losses(), _balance(), _rod(), _impact(), _load(engine), *_gears()]
    return [*found, *_bore(), _compression(), _boost()]


@functools.cache
def swept(name: str, over: str = "") -> Mapping[str, np.ndarray]:
    """Axis [its unit] and results of one sweep of the study, over its own points or over others."""
    plan = next(one.plan for one in read(_STUDY).sweeps if one.name == name)
    found = sweep(dataclasses.replace(plan, over=(over,)) if over else plan)
    return columns(found) | {axis.key: np.array([p[k] for p in found.points]) for k, axis in enumerate(found.axes)}


def _claim(item: str, published: str, computed: float, holds: bool, note: str) -> dict[str, Any]:
    return row(SOURCE.stem, item, published, float(computed), REPRODUCED if holds else NOT_REPRODUCED, note)


def _change(new: float, old: float) -> float:
    return 100 * (float(new) / float(old) - 1)


def _performance() -> list[dict[str, Any]]:
    speed = swept("hypocycloid-speeds")["speed_rpm"]
    ratio = swept("hypocycloid-speeds")["torque_avg"] / swept("slider-crank-speeds")["torque_avg"]
    behind = speed[ratio < 1]
    words, what = "not falling behind", "average torque of the hypocycloid engine by that of the slider crank"
    return [
        _claim(
            f"section 6: {what}, smallest over 500 to 8000 rpm [-]", words, ratio.min(), ratio.min() >= 1,
            f"it falls behind up to {behind.max():.0f} rpm, the more the lower the speed: its piston stays near the "
            "top for longer and the gas loses more heat there",
        ),
        _claim(
            f"section 6: {what} at 8000 rpm [-]", words, ratio[-1], ratio[-1] >= 1,
            "without mechanical losses, as the sentence says",
        ),
    ]  # fmt: skip


def _losses() -> list[dict[str, Any]]:
    own, rival = (swept(f"{name}-losses") for name in ("hypocycloid", "slider-crank"))
    change = {
        round(float(rpm)): _change(a, b)
        for rpm, a, b in zip(own["speed_rpm"], own[_FRICTION], rival[_FRICTION], strict=True)
    }
    told = ", ".join(f"{value:+.1f} % at {rpm} rpm" for rpm, value in change.items())
    return [
        _claim(
            f"section 6: friction mean pressure of the hypocycloid engine at {rpm} rpm against the slider crank's, "
            "change [%]", "significantly reduced", change[rpm], change[rpm] < 0,
            f"{told}: no side force on the piston, but the teeth slide under the whole load of the gas; coefficients "
            "and rings assumed, the same for both",
        )
        for rpm in (4000, 8000)
    ]  # fmt: skip


def _balance() -> dict[str, Any]:
    own, rival = (
        swept(f"{name}-losses")["shaking.counterweight.rms_after"] for name in ("hypocycloid", "slider-crank")
    )
    left = own[-1] / rival[-1]
    return _claim(
        "section 6: shaking force beside a counterweight on the crank, one mechanism of the hypocycloid engine by one "
        "of the slider crank [-]", "the balance achieved due to sinusoidal motion", left, left < 1,
        "only in one mechanism taken alone; the two pistons run against each other, so that their forces cancel in "
        "either engine, sinusoidal or not",
    )  # fmt: skip


def _rod() -> dict[str, Any]:
    rod, endless = swept("rod"), swept("rod", f"parameters.l1={_ENDLESS}")
    ratio = endless["efficiency"][0] / _at_4000("efficiency")
    average, largest = (_change(rod[name][-1], rod[name][0]) for name in ("torque_avg", "torque_max"))
    return _claim(
        "section 6: efficiency of the slider crank engine with a rod of 500 m by that of the hypocycloid engine [-]",
        "longer rods which don't affect the kinematics", ratio, abs(ratio - 1) < 1e-5,
        "the hypocycloid's piston moves as on an endless rod, whatever the length of its own; from 30 to 100 mm of rod "
        f"the slider crank's average torque changes by {average:.1f} %, its largest by {largest:.1f} %",
    )  # fmt: skip


def _at_4000(name: str) -> float:
    """A figure of the hypocycloid engine as the thesis has it."""
    found = swept("hypocycloid-speeds")
    return float(found[name][np.argmin(np.abs(found["speed_rpm"] - 4000))])


def _impact() -> dict[str, Any]:
    at = swept("slider-crank-speeds")
    rival = float(at["power_kw"][np.argmin(np.abs(at["speed_rpm"] - 4000))])
    mechanism = abs(_at_4000("power_kw") - rival)
    others = {name: float(np.ptp(swept(name)["power_kw"])) for name in ("bore-to-stroke", "compression", "boost")}
    told = ", ".join(f"{name} {value:.2f}" for name, value in others.items())
    return _claim(
        "section 6.1: power that the hypocycloid costs against the slider crank, by what the compression ratio of 8 to "
        "14 changes [-]", "the most impact on the engine performance", mechanism / others["compression"],
        mechanism > min(others.values()),
        f"{mechanism:.2f} kW at 4000 rpm; over the ranges of the study: {told} kW. What the mechanism decides is load, "
        "size and life of its gears",
    )  # fmt: skip


def _load(engine: Sequence[dict[str, Any]]) -> dict[str, Any]:
    tooth = next(one for one in engine if one["item"] == "OPGHE largest tooth load [N]")
    change = _change(tooth["corrected"], tooth["computed"])
    return _claim(
        "section 6.1: largest tooth load of the corrected and converged cycle against the thesis's, change [%]",
        "will probably reduce the gear tooth load", change, change < 0,
        f"{tooth['computed']:.0f} and {tooth['corrected']:.0f} N: the atmosphere behind the piston takes 1 %, vapour "
        "that brings its energy gives part of it back",
    )  # fmt: skip


def _gears() -> list[dict[str, Any]]:
    single = swept("gear-sets")
    holds = float(single["gears:_ring,_bending.face_width.safety_factor"][1] / 2)
    old, new = (_of_gears("materials", k) for k in (0, 1))
    return [
        _claim(
            "section 6.1: load that a single gear pair of the widest usual face, two pitch diameters, bears by that it "
            "gets [-]", "not enough", holds, holds < 1, "Nitralloy N by AGMA 2101; bending of the ring governs",
        ),
        _claim(
            "section 6.1: maraging 350: face width over Nitralloy's, engine sized anew [-]", "0.5",
            new["face"] / old["face"], new["face"] <= 0.5 * old["face"],
            "sized with all limits, contact of the internal pair and losses of load sharing left out; "
            f"{1e3 * old['face']:.1f} and {1e3 * new['face']:.1f} mm in steps of 0.5 mm",
        ),
        _claim(
            "section 6.1: maraging 350: mass of gears and crankshaft, change [%]", "lighter",
            _change(new["mass"], old["mass"]), new["mass"] < old["mass"],
            "pinion, ring and crankshaft of one side; Nitralloy N with the density of table 4.1, which is low for "
            "steel. The loss in the mesh does not know the face width",
        ),
    ]  # fmt: skip


def _of_gears(name: str, point: int) -> dict[str, float]:
    found = swept(name)
    masses = (found[f"{part}.mass_of_one"][point] for part in ("pinion", "ring", "crankshaft"))
    return {"face": float(found["gears.face_width"][point]), "mass": float(sum(masses))}


def _bore() -> list[dict[str, Any]]:
    found, gears = swept("bore-to-stroke"), swept("narrow-gears")
    slim, thesis = (int(np.argmin(np.abs(found["chamber.bore"] - mm))) for mm in (55, 60))
    outside = gears["gears.outside_diameter_of_the_ring"]
    volume = np.pi / 4 * outside**2 * gears["gears.face_width"]
    return [
        _claim(
            "section 6.1: volume of a gear pair with 4 % more stroke and 2 % less bore, change [%]",
            "reducing the overall dimensions of the gearset", _change(volume[1], volume[0]), volume[1] < volume[0],
            f"ring of {1e3 * outside[0]:.1f} and {1e3 * outside[1]:.1f} mm outside: the stroke is twice its pitch "
            f"radius, so it grows while the face goes from {1e3 * gears['gears.face_width'][0]:.1f} to "
            f"{1e3 * gears['gears.face_width'][1]:.1f} mm; {gears['failing'][1]:.0f} other checks of that engine fail",
        ),
        _claim(
            "section 6.1: efficiency with a bore of 55 mm in place of 60 mm at the same displacement, change [%]",
            "would have to be considered", _change(found["efficiency"][slim], found["efficiency"][thesis]), True,
            f"tooth load {_change(found['loads.tooth_force'][slim], found['loads.tooth_force'][thesis]):+.1f} %, peak "
            f"pressure {_change(found['p_max_mpa'][slim], found['p_max_mpa'][thesis]):+.2f} %: cheap in performance",
        ),
    ]  # fmt: skip


def _compression() -> dict[str, Any]:
    found = swept("compression")
    steps = np.diff(found["efficiency"])
    return _claim(
        "section 6.1: efficiency over the compression ratio of 8 to 14, least gain of a step of 0.5 [%]",
        "further increase efficiency", 100 * steps.min(), bool(steps.min() > 0),
        f"points of efficiency; the first step gains {100 * steps[0]:.2f}, the tooth load grows by "
        f"{_change(found['loads.tooth_force'][-1], found['loads.tooth_force'][0]):.0f} %, and there is knock",
    )  # fmt: skip


def _boost() -> dict[str, Any]:
    found = swept("boost")
    usual = float(np.interp(1.01325, found["cycle.intake_pressure"], found["torque_avg"]))
    ratio = float(found["torque_avg"][-1]) / usual
    return _claim(
        "section 6.1: average torque at an intake pressure of 2 bar by that at one atmosphere [-]",
        "increase the torque and power", ratio, ratio > 1,
        f"charge as cold as at sea level, so with an intercooler; the peak is {found['p_max_mpa'][-1]:.1f} MPa "
        f"and the load of the teeth {found['loads.tooth_force'][-1] / 1e3:.1f} kN, for which they are not sized",
    )  # fmt: skip
