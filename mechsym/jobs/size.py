"""Sizing: case -> cycle over the speeds -> forces of the mechanism -> parts and checks -> rows."""

import dataclasses
from collections.abc import Callable

import numpy as np

from mechsym import cases, mechanisms
from mechsym.cases import Case
from mechsym.cases.needs import require
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.columns import crossovers
from mechsym.cycle.engine import over_speeds
from mechsym.cycle.kinds import kind_of
from mechsym.errors import BadInput
from mechsym.forces.loads import loads as loads_of
from mechsym.forces.loads import with_resultants
from mechsym.forces.result import columns
from mechsym.jobs.cycle import engine, speed_range
from mechsym.jobs.machine import turn
from mechsym.mechanisms import listing
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.roles import resultants
from mechsym.quantities import RPM, record
from mechsym.quantities.units import Array, RadPerSecond
from mechsym.sizing.checks import unsafe
from mechsym.sizing.crank_design import Pressures, pressures_over
from mechsym.sizing.hypocycloid import checks as rules
from mechsym.sizing.hypocycloid import engine as hypocycloid
from mechsym.sizing.hypocycloid.engine import Parts, PlanetDrive, Stock, hypocycloid_forces
from mechsym.sizing.rows import SizeRow, Sizing, check_rows, fact, size_rows
from mechsym.sizing.rules import bearings, materials
from mechsym.sizing.slider_crank import CrossheadLoads, CrossheadPart, size_slider_crank, slider_crank_forces, wear
from mechsym.sizing.slider_crank import checks as crosshead_checks
from mechsym.sizing.wants import Wants


@record
class Task:
    """An engine ready for sizing."""

    case: Case  #: With the cycle settings that its section `[sizing]` asks for
    machine: ClosedEngine
    wants: Wants
    stock: Stock


def size(case: Case) -> Sizing:
    """Size the engine of a case for the loads of its cycle. Raises BadInput: its mechanism cannot be sized."""
    require(case, "size")
    by_spark = "cycle" in case.sections and kind_of(case.need("cycle")).closed
    if _given_drive(case) and not by_spark:
        return _crosshead(case)  # no rule sizes such an engine: the sizes that it has are checked
    sizings = {"planet": _hypocycloid, "slider crank": _slider_crank}
    sized = sizings.get(mechanisms.roles_of(case.mechanism).rules) if by_spark else None
    return _joints(case) if sized is None else sized(task(case))


def _given_drive(case: Case) -> bool:
    return mechanisms.roles_of(case.mechanism).rules == "slider crank" and "part_crosshead" in case.sections


_SIZES: dict[str, Callable[[np.ndarray], float]] = {
    "largest": lambda v: np.abs(v).max(),
    "root mean square": lambda v: np.sqrt(np.mean(v**2)),
}


def _joints(case: Case) -> Sizing:
    """Loads of every joint of a mechanism that no rule sizes: what its parts are chosen by."""
    result, listed = turn(case), listing(case.mechanism)
    units = columns(result, loads_of(result)).units
    loads = {**with_resultants(result.reactions), "driving_torque": result.driving}
    about = dict(listed.get("reactions", {}))
    if result.drive.roles.closings or not about:
        about = dict.fromkeys(result.reactions, "") | about
    for name, parts in resultants(result.reactions).items():
        units, about = units | {name: units[parts[0]]}, about | {name: about.get(parts[0], "")}
    about["driving_torque"] = "turns the shaft at the speed of operation"
    rows = [
        fact(name, f"load, {what}", float(size_of(loads[name])), units[name],
             "reaction over one cycle", source="equations of motion", note=about[name])
        for name in about if name in loads for what, size_of in _SIZES.items()
    ]  # fmt: skip
    return Sizing(checked=rows, failing=[], converged=True, rounds=0, parts=None, forces=None, stock=None)


def check_printed(case: Case) -> Sizing:
    """Check the parts that a case prints, in its sections `[part_*]`. Raises BadInput: the case prints no parts."""
    if _given_drive(case):
        return _crosshead(case)
    one = task(case)
    if mechanisms.roles_of(case.mechanism).rules != "planet":
        raise BadInput(f"{case.file}: the case prints no parts; leave out --as-printed")
    reference = printed_parts(one.case)
    # the printed engine takes its torque off at the output shaft set only
    wants = dataclasses.replace(one.wants, take_off="one_end")
    moving = hypocycloid.moving_printed(reference, one.stock)
    drive = planet_of(one.case)
    forces = hypocycloid_forces(gas_of(one), drive)(moving)
    checks = rules.check_all(reference.parts, forces, wants, one.stock)
    mass = hypocycloid.total_mass_printed(reference, one.stock)
    rows = rules.part_rows(reference.parts, "as printed") + check_rows(checks)
    power = _power(one, forces.omega.max())
    rows += rules.engine_rows(reference.parts, forces, moving, mass, power, one.wants, one.stock, drive.moving)
    return Sizing(checked=rows + _crossing_rows(one), failing=unsafe(checks), converged=True, rounds=1,
                  parts=reference.parts, forces=forces, stock=one.stock)  # fmt: skip


def _hypocycloid(one: Task) -> Sizing:
    reference, wants, stock = printed_parts(one.case), one.wants, one.stock
    drive = planet_of(one.case)
    forces_of = hypocycloid_forces(gas_of(one), drive)
    sizes = rules.size_hypocycloid(forces_of, reference, hypocycloid.moving_printed(reference, stock), wants, stock)
    mass, power = hypocycloid.total_mass(sizes.parts, reference, wants, stock), _power(one, sizes.forces.omega.max())
    rows = rules.part_rows(sizes.parts, "sized") + check_rows(sizes.checks)
    rows += rules.mass_rows(sizes.parts, reference, wants, stock)
    rows += rules.engine_rows(sizes.parts, sizes.forces, sizes.moving, mass, power, wants, stock, drive.moving)
    rows += _crossing_rows(one)
    failing = unsafe(sizes.checks)
    if failing:
        rows += rules.nearest_rows(sizes.parts, sizes.forces, wants, stock, lambda omega: _power(one, omega))
    return Sizing(checked=rows, failing=failing, converged=sizes.converged, rounds=sizes.rounds, parts=sizes.parts,
                  forces=sizes.forces, stock=stock)  # fmt: skip


def _slider_crank(one: Task) -> Sizing:
    parameters, roles = one.case.need("parameters"), mechanisms.roles_of(one.case.mechanism)
    start = float(amount(roles.rods[0].moving, dataclasses.asdict(parameters)))
    forces_of = slider_crank_forces(gas_of(one), mechanisms.build(one.case.mechanism, parameters), roles)
    sizes = size_slider_crank(forces_of, start, one.wants, one.stock)
    rows = []
    for key in ("piston", "cylinder", "crank"):
        rows += size_rows(key, getattr(sizes.parts, key), "sized")
    rows += check_rows(sizes.checks)
    rows.append(fact("engine", "moving mass of one piston", sizes.reciprocating, "kg", "mass model",
                     note=f"the case has {start:.3f} kg"))  # fmt: skip
    return Sizing(checked=rows + _crossing_rows(one), failing=unsafe(sizes.checks), converged=sizes.converged,
                  rounds=sizes.rounds, parts=sizes.parts, forces=sizes.forces, stock=one.stock)  # fmt: skip


def task(case: Case) -> Task:
    """A case with the cycle settings that its section `[sizing]` asks for, and the stock to choose from.

    Raises BadInput: a section is missing or a setting is no KEY=VALUE.
    """
    wants = case.sections.get("sizing", Wants())
    settings = {}
    for text in wants.settings:
        key, _, value = text.partition("=")
        if not key.strip() or not value.strip():
            raise BadInput(f"{case.file}: sizing.settings {text!r} is not KEY=VALUE")
        settings[key.strip()] = value.strip()
    stock = Stock(
        materials=materials.load(wants.materials_file or None), bearings=bearings.catalogue(wants.bearings_file or None)
    )
    set_up = cases.underlaid(case, settings) if settings else case
    return Task(case=set_up, machine=engine(set_up), wants=wants, stock=stock)


def speeds(one: Task) -> RadPerSecond[Array]:
    """Crank speeds of sizing: `[speeds]` in steps of `sizing.speed_step`, the highest included, shape (k,)."""
    given = one.case.need("speeds")
    coarse = dataclasses.replace(given, step=max(given.step, one.wants.speed_step))
    return np.unique(np.append(speed_range(coarse), given.highest))


def gas_of(one: Task) -> Pressures:
    """The cycle at every speed."""
    return pressures_over(one.machine, speeds(one), one.wants.heat_share)


def printed_parts(case: Case) -> hypocycloid.PrintedMasses:
    """Parts that a case prints, with their masses, for the mass model. Raises BadInput: a section is missing."""
    parts = Parts(piston=case.need("part_piston"), cylinder=case.need("part_cylinder"), gears=case.need("part_gears"),
                  crank=case.need("part_crank"), bearings=case.need("part_bearings"))  # fmt: skip
    return hypocycloid.PrintedMasses(
        parts=parts, masses=case.need("part_masses"), bore=case.need("chamber").bore, e=planet_of(case).e
    )


def planet_of(case: Case) -> PlanetDrive:
    """The mechanism of a case with the letters by which an engine with a planet is sized."""
    roles = mechanisms.roles_of(case.mechanism)
    return PlanetDrive(name=case.mechanism, parameters=case.need("parameters"), roles=roles)


def _power(one: Task, omega: float) -> float:
    return float(over_speeds(one.machine, np.array([omega])).power[0])


def _crossing_rows(one: Task) -> list[SizeRow]:
    """Where the mean torque crosses that of the rival."""
    if not one.wants.rival:
        return []
    omega, rival = speeds(one), task(cases.load(one.wants.rival))
    own, other = (over_speeds(machine, omega).torque_avg for machine in (one.machine, rival.machine))
    return [fact("engine", "crossover of the mean torque", value, "rad/s", "cycle", "fig. 5.14",
                 f"{value / RPM:.0f} rpm, against {rival.case.name}")
            for value in crossovers(omega, own, other)]  # fmt: skip


def _crosshead(case: Case) -> Sizing:
    part: CrossheadPart = case.need("part_crosshead")
    loads = crosshead_loads(case)
    checks = crosshead_checks(part, loads)
    rows = size_rows("crosshead drive", part, "as printed") + check_rows(checks)
    rows += [
        fact(name, "pressure times sliding speed", value, "Pa*m/s", "Archard", note="mean over a turn")
        for name, value in wear(part, loads).items()
    ]
    return Sizing(checked=rows, failing=unsafe(checks), converged=True, rounds=1, parts=part, forces=loads, stock=None)


def crosshead_loads(case: Case) -> CrossheadLoads:
    """Loads of a crosshead drive over one cycle of its case."""
    loads = turn(case)
    roles, q = loads.drive.roles, loads.drive.mechanism.coordinates[0]
    rod, x = roles.rods[0], roles.pistons[0].travel
    beyond = float(amount(rod.moving if rod.beyond is None else rod.beyond, loads.drive.mechanism.parameters))
    inertia = beyond * loads.kinematics[f"d2{x}_d{q}2"] * loads.omega**2

    def whole(values: np.ndarray) -> np.ndarray:
        return np.append(values, values[0])

    def borne(place: str) -> np.ndarray:
        role = next(bearing for bearing in roles.bearings if bearing.at == place)
        return whole(np.hypot(*(loads.reactions[name] for name in role.reactions)))

    k, side = loads.kinematics, next(guide.reaction for guide in roles.guides if guide.reaction)
    return CrossheadLoads(
        phi=np.append(loads.phi, loads.phi[0] + loads.period), omega=loads.omega,
        rod=whole(loads.inputs[roles.pistons[0].force] - inertia), pin=borne("piston_pins"),
        crank_pin=borne("crank_pins"), side=whole(loads.reactions[side]), dx_dphi=whole(k[f"d{x}_d{q}"]),
        dpsi_dphi=whole(k[f"d{rod.swing}_d{q}"]),
    )  # fmt: skip
