"""The whole sizing job: case -> pressures -> forces -> parts and checks -> rows, with the headline restated."""

import dataclasses
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.jobs.compare import crossovers
from mechsym.jobs.size_loads import (
    Job,
    hypocycloid_forces,
    job,
    performance,
    pressures,
    printed,
    slider_crank_forces,
    speeds,
)
from mechsym.quantities import record
from mechsym.sizing.checks import Check, unsafe
from mechsym.sizing.hypocycloid import checks as hypocycloid_checks
from mechsym.sizing.hypocycloid import design as hypocycloid_design
from mechsym.sizing.hypocycloid import engine as hypocycloid_engine
from mechsym.sizing.hypocycloid import masses as hypocycloid_masses
from mechsym.sizing.hypocycloid.parts import PartForces, Parts, Stock
from mechsym.sizing.rows import check_rows, fact, size_rows
from mechsym.sizing.rules.masses import power_to_weight
from mechsym.sizing.rules.materials import get
from mechsym.sizing.rules.shaft_beam import inner_slope
from mechsym.sizing.slider_crank import design as slider_crank_design
from mechsym.sizing.slider_crank.parts import SliderDesign

RPM = np.pi / 30


@record
class Sizing:
    """What sizing an engine gave."""

    rows: list[dict[str, Any]]
    failing: list[Check]
    converged: bool
    rounds: int
    parts: Any
    forces: Any
    stock: Stock


def sized(name: str, overrides: dict[str, Any], as_printed: bool) -> Sizing:
    """Size the engine of a case, or check the parts that it prints.

    Parameters
    ----------
    as_printed : bool
        Check `[part_*]` instead of sizing

    Raises
    ------
    BadInput
        The mechanism is not one that can be sized, or the case prints no parts
    """
    found = job(name, overrides)
    if found.case.mechanism == "hypocycloid":
        return _printed_hypocycloid(found) if as_printed else _hypocycloid(found)
    if found.case.mechanism != "crosshead":
        raise BadInput(f"{found.case.file}: mechanism {found.case.mechanism!r} cannot be sized; crosshead and "
                       "hypocycloid can")  # fmt: skip
    if as_printed:
        raise BadInput(f"{found.case.file}: the case prints no parts; leave out --as-printed")
    return _slider_crank(found)


def _hypocycloid(found: Job) -> Sizing:
    reference = printed(found.case)
    forces_of = hypocycloid_forces(found, pressures(found, speeds(found)))
    start = hypocycloid_masses.moving_printed(reference, found.stock)
    design = hypocycloid_design.design(forces_of, reference, start, found.wants, found.stock)
    mass = hypocycloid_masses.total_mass(design.parts, reference, found.wants, found.stock)
    rows = _part_rows(design.parts, "sized") + check_rows(design.checks)
    masses = hypocycloid_masses.part_masses(design.parts, reference, found.wants, found.stock)
    rows += [
        fact(part, "mass of one", m, "kg", "mass model", note=f"{n} in the engine") for part, (m, n) in masses.items()
    ]
    rows += _engine_rows(found, mass, design.moving, design.parts, design.forces)
    failing = unsafe(design.checks)
    if failing:
        rows += _nearest(found, design.parts, design.forces)
    return Sizing(rows=rows, failing=failing, converged=design.converged, rounds=design.rounds, parts=design.parts,
                   forces=design.forces, stock=found.stock)  # fmt: skip


def _printed_hypocycloid(found: Job) -> Sizing:
    reference = printed(found.case)
    # the printed engine takes its torque off at the output shaft set only
    wants = dataclasses.replace(found.wants, take_off="one_end")
    moving = hypocycloid_masses.moving_printed(reference, found.stock)
    forces = hypocycloid_forces(found, pressures(found, speeds(found)))(moving)
    checks = hypocycloid_checks.check_all(reference.parts, forces, wants, found.stock)
    mass = hypocycloid_masses.total_mass_printed(reference, found.stock)
    rows = _part_rows(reference.parts, "as printed") + check_rows(checks)
    rows += _engine_rows(found, mass, moving, reference.parts, forces)
    return Sizing(
        rows=rows,
        failing=unsafe(checks),
        converged=True,
        rounds=1,
        parts=reference.parts,
        forces=forces,
        stock=found.stock,
    )


def _slider_crank(found: Job) -> Sizing:
    forces_of = slider_crank_forces(found, pressures(found, speeds(found)))
    parameters = found.case.need("parameters")
    start = parameters.m3 + parameters.m4 + parameters.m5
    design: SliderDesign = slider_crank_design.design(forces_of, start, found.wants, found.stock)
    rows = [
        row for key in ("piston", "cylinder", "crank") for row in size_rows(key, getattr(design.parts, key), "sized")
    ]
    rows += check_rows(design.checks)
    rows.append(fact("engine", "moving mass of one piston", design.reciprocating, "kg", "mass model",
                     note=f"the case has {start:.3f} kg"))  # fmt: skip
    rows += _speed_rows(found)
    return Sizing(rows=rows, failing=unsafe(design.checks), converged=design.converged, rounds=design.rounds,
                   parts=design.parts, forces=design.forces, stock=found.stock)  # fmt: skip


def _part_rows(parts: Parts, rule: str) -> list[dict[str, Any]]:
    rows = []
    for field in dataclasses.fields(parts):
        rows += size_rows(field.name, getattr(parts, field.name), rule)
    return rows


def _engine_rows(
    found: Job, mass: float, moving: hypocycloid_masses.Moving, parts: Parts, forces: PartForces
) -> list[dict[str, Any]]:
    top = performance(found, np.array([forces.omega.max()]))
    power = float(top.power[0])
    steel = get(dict(found.stock.materials), found.wants.crankshaft)
    moment = hypocycloid_engine.bending_moment(parts, forces, found.stock)
    slope = inner_slope(hypocycloid_engine.shaft(parts, found.stock), steel.youngs_modulus, moment)
    case_mass = found.case.need("parameters").m3
    return [
        fact("engine", "moving mass on the cylinder axis", moving.axis, "kg", "mass model",
             note=f"the case has {case_mass:.3f} kg"),
        fact("engine", "largest force on a piston rod", float(np.abs(forces.rod).max()), "N", "force chain"),
        fact("engine", "largest tooth load of a crank", float(np.abs(forces.tooth).max()), "N", "force chain"),
        fact("engine", "slope at the inner journal", float(slope.max()), "rad", "beam, not rated",
             "Shigley table 7-2", "0.0008 to 0.0012 are usual for rollers under a steady load"),
        fact("engine", "mass without belt", mass, "kg", "mass roll-up", "ch. 5.1.2"),
        fact("engine", "power at the highest speed", power, "W", "cycle", "eq. 2.46"),
        fact("engine", "power to weight", power_to_weight(power, mass), "W/kg", "mass roll-up", "fig. 5.13"),
        *_speed_rows(found),
    ]  # fmt: skip


def _speed_rows(found: Job) -> list[dict[str, Any]]:
    if not found.wants.rival:
        return []
    omega = speeds(found)
    rival = job(found.wants.rival, {})
    crossing = crossovers(omega, performance(found, omega).torque_avg, performance(rival, omega).torque_avg)
    return [fact("engine", "crossover of the mean torque", value, "rad/s", "cycle", "fig. 5.14",
                 f"{value / RPM:.0f} rpm, against {rival.case.name}") for value in crossing]  # fmt: skip


def _nearest(found: Job, parts: Parts, forces: PartForces) -> list[dict[str, Any]]:
    """Speeds at which these parts may run at full load, when they may not at all."""
    held = hypocycloid_checks.holding(parts, forces, found.wants, found.stock)
    if not held.any():
        return []
    low, high = hypocycloid_checks.fastest_run(held)
    at = "full load only inside this range; the nearest engine that holds"
    power = performance(found, forces.omega[high : high + 1]).power[0]
    return [
        fact("engine", "lowest speed at full load", forces.omega[low], "rad/s", "all checks", note=at),
        fact("engine", "highest speed", forces.omega[high], "rad/s", "all checks", note=at),
        fact("engine", "power at that speed", float(power), "W", "cycle", note=at),
    ]
