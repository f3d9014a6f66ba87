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
from mechsym.papers.rows import NOT_COMPUTABLE, REPRODUCED, Row, listed
from mechsym.quantities import RPM
from mechsym.sweep import columns as swept_columns
from mechsym.sweep import sweep
from mechsym.sweep.study import read

_row = functools.partial(listed, "nunes2017")
_CASE, _RPM, _FAST = "nunes-hypocycloid", 4000.0, 8000.0
_HEIGHT, _EXHAUST = 3000.0, 1000.0  # a usual height of flight [m], an exhaust before the turbine [K]
_RIPPLE = 0.02  # of the flywheel [-]


def rows() -> list[Row]:
    """Sentences of sections 6.1 and 6.2, and of 4.7 on the belt."""
    left = [_row(name, None, NOT_COMPUTABLE) for name in ("valves", "timing_belt", "fuel")]
    return [*_improvements(), _height(), _breathing(), _friction(), _flywheel(), _belt(), *left]


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
    after, before = float(tight["p_max_mpa"][0]), float(base["p_max_mpa"][0])
    return [
        _row("slim", 100 * tooth, tooth < 0, share=100 * share),
        _row("tight", 100 * gain, gain > 0, before=before, after=after),
    ]


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
    alone = float(thin / sea)
    return _row("height", share, share > 1.1 * alone, thin=alone, T_2=T_2, p_3=p_3 / 1e5)


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
    return _row("breathing", filled, abs(filled - 1) > 0.05, lost=-lost)


def _friction() -> Row:
    lost = []
    for name in ("nunes-slider-crank", _CASE):
        losses = forces(load(name)).losses
        assert losses is not None and losses.mechanical_efficiency is not None
        lost.append(1 - losses.mechanical_efficiency)
    return _row("friction", lost[1] / lost[0], lost[1] < lost[0])


def _flywheel() -> Row:
    wheel = flywheel(load(_CASE), _RIPPLE)
    verdict = NOT_COMPUTABLE if wheel.inertia is None else REPRODUCED
    return _row("flywheel", wheel.inertia, verdict, work=wheel.work_swing)


def _belt() -> Row:
    figures = _figures()
    largest, mean = (float(figures[name][0]) for name in ("torque_max", "torque_avg"))
    return _row("belt", largest, NOT_COMPUTABLE, mean=mean / 2)


_STUDY, _ENDLESS = "nunes2017-chapter-6", "500 m"
_FRICTION = "friction.friction_mean_pressure"


def studied_rows(engine: Sequence[Row]) -> list[Row]:
    """Rows of sections 6 and 6.1, each from one or two sweeps; `engine` has those of chapter 3, corrected too."""
    own, rival = (
        swept(f"{name}-losses")["shaking.counterweight.rms_after"] for name in ("hypocycloid", "slider-crank")
    )
    left = own[-1] / rival[-1]
    rows = [*_performance(), *_losses(), _row("balance", left, left < 1), _rod(), _impact(), _load(engine), *_gears()]
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
    return [
        _row("behind", ratio.min(), ratio.min() >= 1, until=behind.max()),
        _row("fast", ratio[-1], ratio[-1] >= 1),
    ]


def _losses() -> list[Row]:
    own, rival = (swept(f"{name}-losses") for name in ("hypocycloid", "slider-crank"))
    change = {
        round(float(rpm)): _change(a, b)
        for rpm, a, b in zip(own["speed_rpm"], own[_FRICTION], rival[_FRICTION], strict=True)
    }
    changes = ", ".join(f"{value:+.1f} % at {rpm} rpm" for rpm, value in change.items())
    return [_row("losses", change[rpm], change[rpm] < 0, rpm=rpm, changes=changes) for rpm in (4000, 8000)]


def _rod() -> Row:
    rod, endless = swept("rod"), swept("rod", f"parameters.l1={_ENDLESS}")
    ratio = endless["efficiency"][0] / _at_4000("efficiency")
    average, largest = (_change(rod[name][-1], rod[name][0]) for name in ("torque_avg", "torque_max"))
    return _row("rod", ratio, abs(ratio - 1) < 1e-5, average=average, largest=largest)


def _at_4000(name: str, engine: str = "hypocycloid") -> float:
    """A figure of one of the thesis's engines."""
    table = swept(f"{engine}-speeds")
    return float(table[name][np.argmin(np.abs(table["speed_rpm"] - 4000))])


def _impact() -> Row:
    mechanism = abs(_at_4000("power_kw") - _at_4000("power_kw", "slider-crank"))
    others = {name: float(np.ptp(swept(name)["power_kw"])) for name in ("bore-to-stroke", "compression", "boost")}
    ranges = ", ".join(f"{name} {value:.2f}" for name, value in others.items())
    share, holds = mechanism / others["compression"], mechanism > min(others.values())
    return _row("impact", share, holds, mechanism=mechanism, listed=ranges)


def _load(engine: Sequence[Row]) -> Row:
    tooth = next(one for one in engine if one.item == "OPGHE largest tooth load [N]")
    before, after = float(tooth.computed or 0), float(tooth.corrected or 0)
    change = _change(after, before)
    return _row("load", change, change < 0, before=before, after=after)


def _gears() -> list[Row]:
    single = swept("gear-sets")
    holds = float(single["gears:_ring,_bending.face_width.safety_factor"][1] / 2)
    old, new = (_of_gears("materials", k) for k in (0, 1))
    face, mass = (tuple(part[key] for part in (old, new)) for key in ("face", "mass"))
    return [
        _row("single", holds, holds < 1),
        _row("maraging", face[1] / face[0], face[1] <= 0.5 * face[0], old=1e3 * face[0], new=1e3 * face[1]),
        _row("lighter", _change(mass[1], mass[0]), mass[1] < mass[0]),
    ]


def _of_gears(name: str, point: int) -> dict[str, float]:
    table = swept(name)
    masses = (table[f"{part}.mass_of_one"][point] for part in ("pinion", "ring", "crankshaft"))
    return {"face": float(table["gears.face_width"][point]), "mass": float(sum(masses))}


def _bore() -> list[Row]:
    table, gears = swept("bore-to-stroke"), swept("narrow-gears")
    slim, thesis = (int(np.argmin(np.abs(table["chamber.bore"] - mm))) for mm in (55, 60))
    outside, face = (gears[f"gears.{key}"] for key in ("outside_diameter_of_the_ring", "face_width"))
    volume = np.pi / 4 * outside**2 * face
    sizes = {"outside": 1e3 * outside, "face": 1e3 * face, "failing": gears["failing"][1]}
    gain, tooth, peak = (
        _change(table[key][slim], table[key][thesis]) for key in ("efficiency", "loads.tooth_force", "p_max_mpa")
    )
    return [
        _row("gear_volume", _change(volume[1], volume[0]), volume[1] < volume[0], **sizes),
        _row("slim_engine", gain, True, tooth=tooth, peak=peak),
    ]


def _compression() -> Row:
    table = swept("compression")
    steps = np.diff(table["efficiency"])
    tooth = _change(table["loads.tooth_force"][-1], table["loads.tooth_force"][0])
    return _row("compression", 100 * steps.min(), steps.min() > 0, first=100 * steps[0], tooth=tooth)


def _boost() -> Row:
    table = swept("boost")
    usual = float(np.interp(1.01325, table["cycle.intake_pressure"], table["torque_avg"]))
    ratio = float(table["torque_avg"][-1]) / usual
    peak, tooth = table["p_max_mpa"][-1], table["loads.tooth_force"][-1] / 1e3
    return _row("boost", ratio, ratio > 1, peak=peak, tooth=tooth)
