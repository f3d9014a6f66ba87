r"""Values of a case by the laws of its machine: speeds, timing at speed, fire, load, shaft, firing order, run.

.. math:: c_m = S\omega/\pi, \qquad \varphi + \varphi'\omega, \qquad 1 - \mathrm{e}^{-a}, \qquad M/k, \qquad h/T
"""

import dataclasses
import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from mechsym.cycle.kinds import four_stroke, kind_of
from mechsym.machine.loads import Load, PropellerLoad, TableLoad
from mechsym.mechanisms.proportions import Proportions
from mechsym.mechanisms.shaft import ElasticShaft
from mechsym.plausible import Doubt, inputs, piston_speed, proportion, proportions
from mechsym.quantities.units import Metre, NewtonMetre

Records = Mapping[str, Any]  # of a case, by section
# charge pressure by the cycle's name for it, and how many times as much drives the piston at full load
_DRIVING = (("intake_pressure", 10.0), ("p_s", 10.0), ("mean_pressure", 1.0), ("p_delivery", 1.0))
_ALL_WAYS = 12  # firing orders of more cylinders are too many to try
_RPM = 30 / math.pi  # rpm of one rad/s
_DIGITS = 1e-3  # within which two numbers have the same digits, of the larger
_LEADS = math.pi / 4  # how far pistons of one chamber lead and lag at the most [rad]
_LATE = 0.9  # of a run, from when on a drive has no time to show what it does


def value(sections: Records, section: str, name: str) -> float:
    """A number of a section, 0 where it is not given [SI]."""
    return getattr(sections.get(section), name, None) or 0.0


def bore(sections: Records) -> Metre:
    """The bore of a piston, 0 where no section has it."""
    return value(sections, "chamber", "bore") or value(sections, "cycle", "bore")


def fired(sections: Records) -> bool:
    """Whether fuel burns in the machine of a case; one without a cycle is taken for an engine."""
    return "cycle" not in sections or kind_of(sections["cycle"]).fired


def driven(sections: Records) -> bool:
    """Whether the gas of a case takes work."""
    return "cycle" in sections and kind_of(sections["cycle"]).driven


def by_law(sections: Records) -> tuple[Doubt, ...]:
    """Doubts that need no size of the mechanism."""
    return (*_timing(sections), *_burning(sections), *_power(sections), *_run(sections))


def by_speed(sections: Records, sizes: Proportions) -> tuple[Doubt, ...]:
    """Mean piston speeds at the speeds of a case; the rod of an engine, since presses and pumps have longer ones."""
    burns, engine = fired(sections), "cycle" in sections
    omega = getattr(sections.get("operation"), "speed", None)
    doubts = proportions(sizes.stroke, sizes.rod_ratio if engine else None, omega, burns)
    for section, name in (("speeds", "highest"), ("codesign", "full_speed"), ("codesign", "speeds")):
        given = value(sections, section, name)
        fastest = max(given) if isinstance(given, tuple) else given
        if fastest:
            doubts += piston_speed(f"mean piston speed at {section}.{name}", sizes.stroke, fastest, burns)
    return doubts


def by_twist(sections: Records, shaft: ElasticShaft, stroke: float, area: float | None) -> tuple[Doubt, ...]:
    """Twist of the softest section under the torque that drives, and the stiffest by a solid shaft of steel.

    stroke, area: of a piston; the area is None where it is not known [m, m^2].
    """
    stiffness = [k for k in shaft.k if k > 0]
    if not stiffness:
        return ()
    given = ((share * value(sections, "cycle", name), name) for name, share in _DRIVING)
    pressure = next((p for p, _ in given if p), 0.0)
    torque = max(abs(value(sections, "drive", "torque")), pressure * (area or 0.0) * stroke / 2)
    what = f"twist of the softest section under {torque:.3g} N*m"
    doubts = proportion("shaft_twist", what, torque / min(stiffness))
    if area:
        solid = 80e9 * math.pi / 32 * (4 * area / math.pi) ** 1.5  # G pi d^4 / (32 l), both the bore
        doubts += proportion("shaft_stiffness", "stiffest section / solid shaft of the bore", max(stiffness) / solid)
    return doubts


def by_firing(sections: Records, parameters: object) -> tuple[Doubt, ...]:
    """Largest angle without a firing, by the least that cylinders reach which may fire a turn later."""
    section, angles = "parameters", getattr(parameters, "firing", ())
    if "faces" in sections:
        section, angles = "faces", sections["faces"].firing
    cycle = sections.get("cycle")
    if cycle is None or not isinstance(angles, tuple) or not 1 < len(angles) <= _ALL_WAYS or not four_stroke(cycle):
        return ()
    later = itertools.product((0.0, 2 * math.pi), repeat=len(angles) - 1)
    best = min(_gap([angles[0], *(a + b for a, b in zip(angles[1:], turns, strict=True))]) for turns in later)
    what = f"{section}.firing: largest angle without a firing / the least with these cranks"
    return proportion("firing_gap", what, _gap(angles) / best)


def by_throws(parameters: Any) -> Iterator[Doubt]:
    """Cylinders that fire beside their dead centre, and throws of a bank that do not follow one another."""
    if not hasattr(parameters, "throw"):
        return
    from mechsym.mechanisms.crank_train.firing import lateness  # not every command needs a train
    from mechsym.mechanisms.crank_train.parameters import each

    angles = each(parameters, "firing") if parameters.firing else ()
    # two pistons of one chamber fire together, one of them a little before its dead centre and the other behind
    late = tuple(zip(angles, lateness(parameters), strict=True)) if angles else ()
    alone = [beside for angle, beside in late if angles.count(angle) == 1]
    together = [abs(beside) for angle, beside in late if angles.count(angle) > 1]
    what = "parameters.firing from the dead centre of the piston, rad"
    yield from proportion("firing_off", what, max(alone, key=abs, default=0.0))
    yield from proportion("firing_off", f"{what}, of pistons that fire together", max(together, default=0.0), _LEADS)
    places, banks = each(parameters, "z"), each(parameters, "bank")
    for bank in sorted(set(banks)):
        throws = sorted({t for t, b in zip(parameters.throw, banks, strict=True) if b == bank})
        steps = [places[b - 1] - places[a - 1] for a, b in itertools.pairwise(throws)]
        back = sum(a * b < 0 for a, b in itertools.pairwise(steps))
        yield from proportion("throw_order", "turns back of parameters.z along the throws of a bank", back)


def _gap(angles: Sequence[float]) -> float:
    period = 4 * math.pi
    ranked = sorted(a % period for a in angles)
    return max(b - a for a, b in itertools.pairwise([*ranked, ranked[0] + period]))


def load_torques(sections: Records) -> Iterator[tuple[str, NewtonMetre]]:
    """Torques that a load takes at the speed of operation, or of its table the one that tells most."""
    load: Load | None = sections.get("load")
    if isinstance(load, TableLoad):
        yield "load.torques", min(load.torques) if min(load.torques) < 0 else max(load.torques)
    elif load is not None and load.torque is not None:
        there = value(sections, "operation", "speed")
        share = (there / load.speed) ** 2 if isinstance(load, PropellerLoad) and load.speed and there else 1.0
        yield "load.torque" + " at operation.speed" * (share != 1.0), load.torque * share


def _timing(sections: Records) -> Iterator[Doubt]:
    """Angles that are straight lines over the speed, at the speeds of the case."""
    cycle = sections.get("cycle")
    keys = ("speeds.highest", "operation.speed")  # of two that are alike the last is told
    at = {value(sections, *key.split(".")): key for key in keys}
    for name in ("ignition", "duration"):
        slope = getattr(cycle, f"{name}_slope", 0.0)
        for omega, key in at.items() if slope else ():
            angle = getattr(cycle, name) + slope * omega
            for doubt in inputs({f"cycle.{name}": angle}, refusing=False):
                yield replace(doubt, quantity=f"cycle.{name} + {name}_slope * {key}, rad")


def _burning(sections: Records) -> Iterator[Doubt]:
    """Share of the fuel that has burnt when the duration ends, and what a kilogram of air burns."""
    cycle: Any = sections.get("cycle")
    burnt = "share of the fuel burnt after cycle.duration"
    if hasattr(cycle, "wiebe_a"):
        yield from proportion("burnt_fraction", burnt, 1 - math.exp(-cycle.wiebe_a))
    elif hasattr(cycle, "a_p"):
        left = (1 - cycle.b) * math.exp(-cycle.a_p) + cycle.b * math.exp(-cycle.a_d)
        yield from proportion("burnt_fraction", burnt, 1 - left)
    duration, omega = getattr(cycle, "duration", 0.0), abs(value(sections, "operation", "speed"))
    if hasattr(cycle, "octane") and omega and duration > 0 and (bore := value(sections, "chamber", "bore")):
        lasts = (duration + getattr(cycle, "duration_slope", 0.0) * omega) / omega
        yield from proportion("flame_speed", "chamber.bore / 2 / (cycle.duration at operation.speed)", bore / 2 / lasts)
    if hasattr(cycle, "octane") and (ratio := value(sections, "chamber", "compression_ratio")):
        yield from proportion("spark_compression", "chamber.compression_ratio of an engine with a spark", ratio)
    if shares := getattr(sections.get("rings"), "gas_shares", ()):
        yield from proportion("ring_shares", "sum of rings.gas_shares", sum(shares))
    if hasattr(cycle, "c_v") and hasattr(cycle, "R"):
        yield from proportion(
            "gas_gamma", "1 + cycle.R / cycle.c_v, the ratio of specific heats", 1 + cycle.R / cycle.c_v
        )
    if hasattr(cycle, "stoichiometric_ratio"):
        what = "cycle.heating_value / cycle.stoichiometric_ratio"
        yield from proportion("fuel_heat", what, cycle.heating_value / cycle.stoichiometric_ratio)


def _power(sections: Records) -> Iterator[Doubt]:
    """How far a compressor compresses, and whether a load takes what the gas gives, or gives what it takes."""
    if suction := value(sections, "cycle", "p_suction"):
        what = "cycle.p_delivery / cycle.p_suction"
        yield from proportion("pressure_ratio", what, value(sections, "cycle", "p_delivery") / suction)
    cycle = sections.get("cycle")
    if cycle is not None and kind_of(cycle).measured:  # of an engine, or motored
        return
    for name, torque in load_torques(sections):
        yield from proportion("driven_load" if driven(sections) else "braking_load", name, torque)


def _run(sections: Records) -> Iterator[Doubt]:
    """Spacing of the results, claims and drives by the length of a run."""
    simulation, drive = sections.get("simulation"), sections.get("drive")
    start, usual = value(sections, "simulation", "speed_start"), value(sections, "operation", "speed")
    if start and usual:
        ratio = abs(start / usual)
        yield from proportion("start_speed", "simulation.speed_start / operation.speed", ratio)
        if min(abs(ratio * _RPM - 1), abs(ratio / _RPM - 1)) < _DIGITS:
            why = "one is the other with rpm taken for rad/s: a number without a unit is in rad/s"
            what = "simulation.speed_start / operation.speed, the digits of one speed in two units"
            yield Doubt(code="speed_unit", quantity=what, value=ratio, usual="another ratio", why=why)
    speeds = sections.get("speeds")
    if speeds is not None and (step := value(sections, "sizing", "speed_step")):
        steps = (speeds.highest - speeds.lowest) / step
        yield from proportion("few_speeds", "(speeds.highest - lowest) / sizing.speed_step", steps)
    first = sections.get("start")
    for field in dataclasses.fields(first) if first is not None else ():
        angle = getattr(first, field.name)
        if field.metadata.get("unit") == "rad" and isinstance(angle, float):  # as that of any machine
            for doubt in inputs({"simulation.phi_start": angle}, refusing=False):
                yield replace(doubt, quantity=f"start.{field.name}")
    end = getattr(simulation, "t_end", None)
    if simulation is None or not end:
        return
    if turning := abs(start or usual):
        yield from proportion("short_run", "turns of the run at the speed of its start", end * turning / math.tau)
    if simulation.output_step:
        what = "simulation.output_step / simulation.t_end"
        yield from proportion("sampling", what, simulation.output_step / end)
    if claim := value(sections, "startup", "claim_time"):
        yield from proportion("window", "startup.claim_time / simulation.t_end", claim / end)
    if drive is not None and drive.time >= _LATE * end:
        why = "the run ends before the drive is switched on, or right behind: next to nothing happens in it"
        yield Doubt(code="drive_start", quantity="drive.time", value=drive.time, usual=f"below {end:g} s", why=why)
