"""What chapter 6 of Nunes (2017) proposes and announces, as far as the models here touch it.

The thesis computes none of it, so a verdict is about the sign of what it expects; the note has what the number means.
Everything is the hypocycloid engine at 4000 rpm with the corrected model (errata E4, E23) unless the row says
otherwise; sizes that the thesis does not give are assumed. The study `nunes2017-chapter-6` has its sweeps.
"""

import dataclasses
import functools
import math
from collections.abc import Mapping, Sequence

import numpy as np

from mechsym.cases import load
from mechsym.cycle.breathing.engine import BreathingEngine
from mechsym.cycle.breathing.engine import figures as breathing_figures
from mechsym.cycle.breathing.engine import run as breathing_run
from mechsym.cycle.breathing.flow import Breathing, GasExchange
from mechsym.cycle.breathing.turbocharger import Boost, atmosphere, compressor_temperature, turbine_ratio
from mechsym.cycle.engine import columns, over_design
from mechsym.files import Json
from mechsym.jobs.cycle import engine
from mechsym.jobs.flywheel import flywheel
from mechsym.jobs.forces import forces
from mechsym.papers.nunes2017.numbers import MODELS
from mechsym.papers.rows import NOT_COMPUTABLE, REPRODUCED, Row, claim, row
from mechsym.quantities import RPM
from mechsym.sweep import columns as swept_columns
from mechsym.sweep import sweep
from mechsym.sweep.study import read

_CASE, _RPM, _FAST = "nunes-hypocycloid", 4000.0, 8000.0
_HEIGHT, _EXHAUST = 3000.0, 1000.0  # a usual height of flight [m], an exhaust before the turbine [K]
_RIPPLE = 0.02  # of the flywheel [-]


def rows() -> list[Row]:
    """Sentences of sections 6.1 and 6.2, and of 4.7 on the belt."""
    return [*_improvements(), _height(), _breathing(), _friction(), _flywheel(), _belt(), *_left()]


@functools.cache
def _figures(**changes: float) -> Json:
    """Figures of the engine with values of its design replaced; `section__key` names them [SI]."""
    design = {name.replace("__", "."): np.array([value]) for name, value in changes.items()}
    table = columns(over_design(engine(load(_CASE, MODELS["corrected"])), {"omega": np.array([_RPM * RPM]), **design}))
    return table | {"tooth": table["loads"]["tooth_force"]}


def _improvements() -> list[Row]:
    case, base = load(_CASE), _figures()
    bore, e = case.need("chamber").bore, case.need("parameters").e
    slim = _figures(chamber__bore=0.95 * bore, parameters__e=e / 0.95**2)
    tight = _figures(chamber__compression_ratio=12.0)
    tooth, share, gain = (
        float(new[key][0] / base[key][0] - 1)
        for new, key in ((slim, "tooth"), (slim, "efficiency"), (tight, "efficiency"))
    )
    peak = float(tight["p_max_mpa"][0]), float(base["p_max_mpa"][0])
    return [
        claim(
            "section 6.1: tooth load with the bore 5 % smaller at the same displacement, change [%]", "reduce",
            100 * tooth, tooth < 0, f"the efficiency changes by {100 * share:+.2f} %",
        ),
        claim(
            "section 6.1: efficiency with the compression ratio 12 in place of 10, change [%]", "increase", 100 * gain,
            gain > 0, f"the peak pressure goes from {peak[1]:.2f} to {peak[0]:.2f} MPa, and towards knock",
        ),
    ]  # fmt: skip


def _height() -> Row:
    p_1, T_1 = atmosphere(_HEIGHT)
    p_2, boost = atmosphere(0.0)[0], Boost()
    T_2 = compressor_temperature(T_1, p_2 / p_1, boost.compressor_efficiency)
    p_3 = p_1 * turbine_ratio(boost, T_1, _EXHAUST, p_2 / p_1)
    sea, thin, boosted = (
        _figures(cycle__intake_pressure=p, cycle__intake_temperature=T)["power_kw"][0]
        for p, T in ((p_2, atmosphere(0.0)[1]), (p_1, T_1), (p_2, T_2))
    )
    room = load(_CASE).need("chamber")
    swept = room.pistons * math.pi / 4 * room.bore**2 * 4 * load(_CASE).need("parameters").e
    # with the intake pressure at the sea's the exhaust pushes against the turbine
    pumping = (p_2 - p_3) * swept * _RPM / 60 / 2 / 1e3
    share = float((boosted + pumping) / sea)
    item = "section 6.1: turbocharged power at 3000 m by that at sea level [-]"
    note = (
        f"{float(thin / sea):.2f} without it; no intercooler, so the air comes in at {T_2:.0f} K; usual efficiencies "
        f"and an exhaust of {_EXHAUST:.0f} K assumed; the turbine dams up {p_3 / 1e5:.2f} bar"
    )
    return claim(item, "pressure ratio of 1", share, share > 1.1 * float(thin / sea), note)


def _breathing() -> Row:
    case = load(_CASE, MODELS["corrected"])
    machine = engine(case)
    cycle = machine.cycle
    # the thesis gives no valve: sizes usual for a bore of 60 mm
    valves = Breathing(
        inlet_diameter=0.028, inlet_lift=0.008, exhaust_diameter=0.024, exhaust_lift=0.008, throttle_diameter=0.03,
        plenum_volume=1e-3, tailpipe_diameter=0.03, manifold_volume=1e-3,
    )  # fmt: skip
    breathing = BreathingEngine(
        chamber=machine.chamber, motion=machine.motion, breathing=valves, heat_transfer=machine.heat_transfer,
        cycle=GasExchange(
            air_fuel_ratio=cycle.air_fuel_ratio, heating_value=cycle.heating_value, combustion_efficiency=0.9,
            ignition=cycle.ignition + cycle.ignition_slope * _FAST * RPM,
            duration=cycle.duration + cycle.duration_slope * _FAST * RPM,
        ),
    )  # fmt: skip
    filling = breathing_figures(breathing_run(breathing, [_FAST * RPM]))
    filled, lost = float(filling["volumetric_efficiency"][0]), float(filling["pumping_mep_kpa"][0])
    item = "section 6.2: filling of the cylinder at 8000 rpm with intake and exhaust modelled [-]"
    note = (
        f"the thesis assumes 1; gas exchange costs a mean pressure of {-lost:.0f} kPa, which it leaves out; valves "
        "of 28 and 24 mm assumed, the text gives none"
    )
    return claim(item, "more accurately", filled, abs(filled - 1) > 0.05, note)


def _friction() -> Row:
    lost = []
    for name in ("nunes-slider-crank", _CASE):
        losses = forces(load(name)).losses
        assert losses is not None and losses.mechanical_efficiency is not None
        lost.append(1 - losses.mechanical_efficiency)
    item = "section 6.2: loss by friction of the hypocycloid mechanism by that of the slider crank [-]"
    note = "coefficients of friction and rings assumed, the same for both"
    return claim(item, "one of the greatest advantages", lost[1] / lost[0], lost[1] < lost[0], note)


def _flywheel() -> Row:
    wheel = flywheel(load(_CASE), _RIPPLE)
    item = "section 6.2: flywheel for a ripple of 2 % at the speed of operation [kg*m^2]"
    note = f"the text gives no ripple; work of {wheel.work_swing:.0f} J swings about the mean"
    return row(item, "considered", wheel.inertia, NOT_COMPUTABLE if wheel.inertia is None else REPRODUCED, note)


def _belt() -> Row:
    figures = _figures()
    largest, mean = (float(figures[name][0]) for name in ("torque_max", "torque_avg"))
    item = "section 4.7: largest torque that the belt carries from one shaft to the other [N*m]"
    note = (
        f"that of one crank, in the mean {mean / 2:.1f} N*m; no pulley, tension or belt is printed, so its pull is not "
        "computable"
    )
    return row(item, "no study was done regarding the appropriate belt", largest, NOT_COMPUTABLE, note)


def _left() -> list[Row]:
    missing = "the text names it and gives no dimension, load or speed ratio"
    valves = "the text gives ideal angles of opening and closing, and neither size, lift, mass nor spring"
    return [
        row(f"section 6.2: {item}", words, None, NOT_COMPUTABLE, note)
        for item, words, note in (
            ("valve system and camshaft", "needs to be studied and designed", valves),
            ("timing belt between pistons and valve system", "must be designed", missing),
            ("fuel and ignition systems", "would have to be chosen and designed", missing),
        )
    ]


_STUDY, _ENDLESS = "nunes2017-chapter-6", "500 m"
_FRICTION = "friction.friction_mean_pressure"


def studied_rows(engine: Sequence[Row]) -> list[Row]:
    """Rows of sections 6 and 6.1, each from one or two sweeps; `engine` has those of chapter 3, corrected too."""
    rows = [*_performance(), *_losses(), _balance(), _rod(), _impact(), _load(engine), *_gears()]
    return [*rows, *_bore(), _compression(), _boost()]


@functools.cache
def swept(name: str, over: str = "") -> Mapping[str, np.ndarray]:
    """Axis [its unit] and table of one sweep of the study, over its own points or over others."""
    plan = next(one.plan for one in read(_STUDY).sweeps if one.name == name)
    table = sweep(dataclasses.replace(plan, over=(over,)) if over else plan)
    return swept_columns(table) | {
        axis.key: np.array([p[k] for p in table.points]) for k, axis in enumerate(table.axes)
    }


def _change(new: float, old: float) -> float:
    return 100 * (float(new) / float(old) - 1)


def _performance() -> list[Row]:
    speed = swept("hypocycloid-speeds")["speed_rpm"]
    ratio = swept("hypocycloid-speeds")["torque_avg"] / swept("slider-crank-speeds")["torque_avg"]
    behind = speed[ratio < 1]
    words, what = "not falling behind", "average torque of the hypocycloid engine by that of the slider crank"
    return [
        claim(
            f"section 6: {what}, smallest over 500 to 8000 rpm [-]", words, ratio.min(), ratio.min() >= 1,
            f"it falls behind up to {behind.max():.0f} rpm, the more the lower the speed: its piston stays near the "
            "top for longer and the gas loses more heat there",
        ),
        claim(
            f"section 6: {what} at 8000 rpm [-]", words, ratio[-1], ratio[-1] >= 1,
            "without mechanical losses, as the sentence says",
        ),
    ]  # fmt: skip


def _losses() -> list[Row]:
    own, rival = (swept(f"{name}-losses") for name in ("hypocycloid", "slider-crank"))
    change = {
        round(float(rpm)): _change(a, b)
        for rpm, a, b in zip(own["speed_rpm"], own[_FRICTION], rival[_FRICTION], strict=True)
    }
    told = ", ".join(f"{value:+.1f} % at {rpm} rpm" for rpm, value in change.items())
    item = (
        "section 6: friction mean pressure of the hypocycloid engine at {} rpm against the slider crank's, change [%]"
    )
    note = (
        f"{told}: no side force on the piston, but the teeth slide under the whole load of the gas; coefficients "
        "and rings assumed, the same for both"
    )
    return [
        claim(item.format(rpm), "significantly reduced", change[rpm], change[rpm] < 0, note) for rpm in (4000, 8000)
    ]


def _balance() -> Row:
    own, rival = (
        swept(f"{name}-losses")["shaking.counterweight.rms_after"] for name in ("hypocycloid", "slider-crank")
    )
    left = own[-1] / rival[-1]
    item = (
        "section 6: shaking force beside a counterweight on the crank, one mechanism of the hypocycloid engine by one "
        "of the slider crank [-]"
    )
    note = (
        "only in one mechanism taken alone; the two pistons run against each other, so that their forces cancel in "
        "either engine, sinusoidal or not"
    )
    return claim(item, "the balance achieved due to sinusoidal motion", left, left < 1, note)


def _rod() -> Row:
    rod, endless = swept("rod"), swept("rod", f"parameters.l1={_ENDLESS}")
    ratio = endless["efficiency"][0] / _at_4000("efficiency")
    average, largest = (_change(rod[name][-1], rod[name][0]) for name in ("torque_avg", "torque_max"))
    item = "section 6: efficiency of the slider crank engine with a rod of 500 m by that of the hypocycloid engine [-]"
    note = (
        "the hypocycloid's piston moves as on an endless rod, whatever the length of its own; from 30 to 100 mm of rod "
        f"the slider crank's average torque changes by {average:.1f} %, its largest by {largest:.1f} %"
    )
    return claim(item, "longer rods which don't affect the kinematics", ratio, abs(ratio - 1) < 1e-5, note)


def _at_4000(name: str, engine: str = "hypocycloid") -> float:
    """A figure of one of the thesis's engines."""
    table = swept(f"{engine}-speeds")
    return float(table[name][np.argmin(np.abs(table["speed_rpm"] - 4000))])


def _impact() -> Row:
    mechanism = abs(_at_4000("power_kw") - _at_4000("power_kw", "slider-crank"))
    others = {name: float(np.ptp(swept(name)["power_kw"])) for name in ("bore-to-stroke", "compression", "boost")}
    told = ", ".join(f"{name} {value:.2f}" for name, value in others.items())
    item = (
        "section 6.1: power that the hypocycloid costs against the slider crank, by what the compression ratio of 8 to "
        "14 changes [-]"
    )
    note = (
        f"{mechanism:.2f} kW at 4000 rpm; over the ranges of the study: {told} kW. What the mechanism decides is load, "
        "size and life of its gears"
    )
    share, holds = mechanism / others["compression"], mechanism > min(others.values())
    return claim(item, "the most impact on the engine performance", share, holds, note)


def _load(engine: Sequence[Row]) -> Row:
    tooth = next(one for one in engine if one.item == "OPGHE largest tooth load [N]")
    before, after = float(tooth.computed or 0), float(tooth.corrected or 0)
    change = _change(after, before)
    item = "section 6.1: largest tooth load of the corrected and converged cycle against the thesis's, change [%]"
    note = (
        f"{before:.0f} and {after:.0f} N: the atmosphere behind the piston takes 1 %, vapour "
        "that brings its energy gives part of it back"
    )
    return claim(item, "will probably reduce the gear tooth load", change, change < 0, note)


def _gears() -> list[Row]:
    single = swept("gear-sets")
    holds = float(single["gears:_ring,_bending.face_width.safety_factor"][1] / 2)
    old, new = (_of_gears("materials", k) for k in (0, 1))
    return [
        claim(
            "section 6.1: load that a single gear pair of the widest usual face, two pitch diameters, bears by that it "
            "gets [-]", "not enough", holds, holds < 1, "Nitralloy N by AGMA 2101; bending of the ring governs",
        ),
        claim(
            "section 6.1: maraging 350: face width over Nitralloy's, engine sized anew [-]", "0.5",
            new["face"] / old["face"], new["face"] <= 0.5 * old["face"],
            "sized with all limits, contact of the internal pair and losses of load sharing left out; "
            f"{1e3 * old['face']:.1f} and {1e3 * new['face']:.1f} mm in steps of 0.5 mm",
        ),
        claim(
            "section 6.1: maraging 350: mass of gears and crankshaft, change [%]", "lighter",
            _change(new["mass"], old["mass"]), new["mass"] < old["mass"],
            "pinion, ring and crankshaft of one side; Nitralloy N with the density of table 4.1, which is low for "
            "steel. The loss in the mesh does not know the face width",
        ),
    ]  # fmt: skip


def _of_gears(name: str, point: int) -> dict[str, float]:
    table = swept(name)
    masses = (table[f"{part}.mass_of_one"][point] for part in ("pinion", "ring", "crankshaft"))
    return {"face": float(table["gears.face_width"][point]), "mass": float(sum(masses))}


def _bore() -> list[Row]:
    table, gears = swept("bore-to-stroke"), swept("narrow-gears")
    slim, thesis = (int(np.argmin(np.abs(table["chamber.bore"] - mm))) for mm in (55, 60))
    outside = gears["gears.outside_diameter_of_the_ring"]
    volume = np.pi / 4 * outside**2 * gears["gears.face_width"]
    return [
        claim(
            "section 6.1: volume of a gear pair with 4 % more stroke and 2 % less bore, change [%]",
            "reducing the overall dimensions of the gearset",
            _change(volume[1], volume[0]),
            volume[1] < volume[0],
            f"ring of {1e3 * outside[0]:.1f} and {1e3 * outside[1]:.1f} mm outside: the stroke is twice its pitch "
            f"radius, so it grows while the face goes from {1e3 * gears['gears.face_width'][0]:.1f} to "
            f"{1e3 * gears['gears.face_width'][1]:.1f} mm; {gears['failing'][1]:.0f} other checks of that engine fail",
        ),
        claim(
            "section 6.1: efficiency with a bore of 55 mm in place of 60 mm at the same displacement, change [%]",
            "would have to be considered",
            _change(table["efficiency"][slim], table["efficiency"][thesis]),
            True,
            f"tooth load {_change(table['loads.tooth_force'][slim], table['loads.tooth_force'][thesis]):+.1f} %, peak "
            f"pressure {_change(table['p_max_mpa'][slim], table['p_max_mpa'][thesis]):+.2f} %: cheap in performance",
        ),
    ]


def _compression() -> Row:
    table = swept("compression")
    steps = np.diff(table["efficiency"])
    item = "section 6.1: efficiency over the compression ratio of 8 to 14, least gain of a step of 0.5 [%]"
    note = (
        f"points of efficiency; the first step gains {100 * steps[0]:.2f}, the tooth load grows by "
        f"{_change(table['loads.tooth_force'][-1], table['loads.tooth_force'][0]):.0f} %, and there is knock"
    )
    return claim(item, "further increase efficiency", 100 * steps.min(), bool(steps.min() > 0), note)


def _boost() -> Row:
    table = swept("boost")
    usual = float(np.interp(1.01325, table["cycle.intake_pressure"], table["torque_avg"]))
    ratio = float(table["torque_avg"][-1]) / usual
    item = "section 6.1: average torque at an intake pressure of 2 bar by that at one atmosphere [-]"
    note = (
        f"charge as cold as at sea level, so with an intercooler; the peak is {table['p_max_mpa'][-1]:.1f} MPa "
        f"and the load of the teeth {table['loads.tooth_force'][-1] / 1e3:.1f} kN, for which they are not sized"
    )
    return claim(item, "increase the torque and power", ratio, ratio > 1, note)
