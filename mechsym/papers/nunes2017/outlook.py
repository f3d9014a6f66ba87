"""What chapter 6 of Nunes (2017) proposes and announces, as far as the models here touch it.

The thesis computes none of it, so a verdict is about the sign of what it expects. Everything is the hypocycloid engine
at 4000 rpm with the corrected model unless the row says otherwise; sizes that the thesis does not give are assumed.
"""

import functools
import math
from typing import Any

import numpy as np

from mechsym.cases import load
from mechsym.cycle.breathing.engine import BreathingEngine
from mechsym.cycle.breathing.engine import figures as breathing_figures
from mechsym.cycle.breathing.engine import run as breathing_run
from mechsym.cycle.breathing.records import Breathing
from mechsym.cycle.breathing.turbocharger import Boost, atmosphere, compressor_temperature, turbine_ratio
from mechsym.cycle.engine import columns, over_design
from mechsym.cycle.kinds.gas_exchange import GasExchange
from mechsym.jobs.cycle import engine
from mechsym.jobs.flywheel import flywheel
from mechsym.jobs.forces import forces
from mechsym.papers.nunes2017 import SOURCE
from mechsym.papers.nunes2017.computed import MODELS
from mechsym.papers.rows import NOT_COMPUTABLE, NOT_REPRODUCED, REPRODUCED, row
from mechsym.quantities import RPM

_CASE, _RPM, _FAST = "nunes-hypocycloid", 4000.0, 8000.0
_HEIGHT, _EXHAUST = 3000.0, 1000.0  # a usual height of flight [m], an exhaust before the turbine [K]
_RIPPLE = 0.02  # of the flywheel [-]


def rows() -> list[dict[str, Any]]:
    """Sentences of sections 6.1 and 6.2, and of 4.7 on the belt."""
    return [*_improvements(), _height(), _breathing(), _friction(), _flywheel(), _belt(), *_left()]


def _claim(item: str, published: str, computed: float | None, holds: bool, note: str) -> dict[str, Any]:
    return row(SOURCE.stem, item, published, computed, REPRODUCED if holds else NOT_REPRODUCED, note)


@functools.cache
def _figures(**changes: float) -> dict[str, Any]:
    """Figures of the engine with values of its design replaced; `section__key` names them [SI]."""
    design = {name.replace("__", "."): np.array([value]) for name, value in changes.items()}
    found = columns(over_design(engine(load(_CASE, MODELS["corrected"])), {"omega": np.array([_RPM * RPM]), **design}))
    return found | {"tooth": found["loads"]["tooth_force"]}


def _improvements() -> list[dict[str, Any]]:
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
        _claim(
            "section 6.1: tooth load with the bore 5 % smaller at the same displacement, change [%]", "reduce",
            100 * tooth, tooth < 0, f"the efficiency changes by {100 * share:+.2f} %",
        ),
        _claim(
            "section 6.1: efficiency with the compression ratio 12 in place of 10, change [%]", "increase", 100 * gain,
            gain > 0, f"the peak pressure goes from {peak[1]:.2f} to {peak[0]:.2f} MPa, and towards knock",
        ),
    ]  # fmt: skip


def _height() -> dict[str, Any]:
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
    return _claim(
        "section 6.1: turbocharged power at 3000 m by that at sea level [-]", "pressure ratio of 1", share,
        share > 1.1 * float(thin / sea),
        f"{float(thin / sea):.2f} without it; no intercooler, so the air comes in at {T_2:.0f} K; usual efficiencies "
        f"and an exhaust of {_EXHAUST:.0f} K assumed; the turbine dams up {p_3 / 1e5:.2f} bar",
    )  # fmt: skip


def _breathing() -> dict[str, Any]:
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
    found = breathing_figures(breathing_run(breathing, [_FAST * RPM]))
    filled, lost = float(found["volumetric_efficiency"][0]), float(found["pumping_mep_kpa"][0])
    return _claim(
        "section 6.2: filling of the cylinder at 8000 rpm with intake and exhaust modelled [-]",
        "more accurately", filled, abs(filled - 1) > 0.05,
        f"the thesis assumes 1; gas exchange costs a mean pressure of {-lost:.0f} kPa, which it leaves out; valves "
        "of 28 and 24 mm assumed, the text gives none",
    )  # fmt: skip


def _friction() -> dict[str, Any]:
    lost = [1 - _losses(name) for name in ("nunes-slider-crank", _CASE)]
    return _claim(
        "section 6.2: loss by friction of the hypocycloid mechanism by that of the slider crank [-]",
        "one of the greatest advantages", lost[1] / lost[0], lost[1] < lost[0],
        "coefficients of friction and rings assumed, the same for both",
    )  # fmt: skip


def _losses(name: str) -> float:
    found = forces(load(name)).losses
    assert found is not None and found.mechanical_efficiency is not None
    return found.mechanical_efficiency


def _flywheel() -> dict[str, Any]:
    found = flywheel(load(_CASE), _RIPPLE)
    return row(
        SOURCE.stem, "section 6.2: flywheel for a ripple of 2 % at the speed of operation [kg*m^2]", "considered",
        found.inertia, NOT_COMPUTABLE if found.inertia is None else REPRODUCED,
        f"the text gives no ripple; work of {found.work_swing:.0f} J swings about the mean",
    )  # fmt: skip


def _belt() -> dict[str, Any]:
    found = _figures()
    return row(
        SOURCE.stem, "section 4.7: largest torque that the belt carries from one shaft to the other [N*m]",
        "no study was done regarding the appropriate belt", float(found["torque_max"][0]), NOT_COMPUTABLE,
        f"that of one crank, in the mean {float(found['torque_avg'][0]) / 2:.1f} N*m; no pulley, tension or belt is "
        "printed, so its pull is not computable",
    )  # fmt: skip


def _left() -> list[dict[str, Any]]:
    missing = "the text names it and gives no dimension, load or speed ratio"
    valves = "the text gives ideal angles of opening and closing, and neither size, lift, mass nor spring"
    return [
        row(SOURCE.stem, f"section 6.2: {item}", words, None, NOT_COMPUTABLE, note)
        for item, words, note in (
            ("valve system and camshaft", "needs to be studied and designed", valves),
            ("timing belt between pistons and valve system", "must be designed", missing),
            ("fuel and ignition systems", "would have to be chosen and designed", missing),
        )
    ]
