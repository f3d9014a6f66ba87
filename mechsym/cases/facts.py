"""What of a case decides which commands run on it, and the sections that each reads (`Case.read` holds it)."""

import dataclasses
from pathlib import Path
from typing import Any

from mechsym import mechanisms
from mechsym.cases.laws import Records
from mechsym.cycle.kinds import KINDS, Kind, kind_of
from mechsym.mechanisms import own
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.roles import PartRoles
from mechsym.quantities import record


@record
class CaseFacts:
    """What of a case decides which commands run on it, and what they read."""

    mechanism: str
    sections: Records  #: By name; a section that cannot be read is None
    kind: Kind | None  #: Of its cycle
    roles: PartRoles | None  #: What its declaration says; None where its file was not run
    free: int = 1  #: Coordinates that no loop holds
    held: int = 0  #: Coordinates that loops hold by constraints

    @property
    def named(self) -> str:
        """Its mechanism for people; of a file the name without its folder."""
        return Path(self.mechanism).name

    @property
    def called(self) -> str:
        """What it is for people: gas drives an engine, or could."""
        return "engine" if self.roles is None or self.roles.pistons or self.roles.faces else "machine"

    @property
    def alone(self) -> bool:
        """Whether no shaft stands for it in a run, so that each coordinate is looked at by itself."""
        return not self.has("cycle", "operation") and not self.has("startup")

    @property
    def twists(self) -> bool:
        """Whether its shaft twists in a run in time."""
        return self.roles is not None and bool(self.roles.shafts)

    @property
    def vibrates(self) -> bool:
        """Whether its shaft, which may also be taken as stiff, has criticals at the speed of operation."""
        return self.twists and self.free == 1

    @property
    def undetermined(self) -> bool:
        """Whether a rule of `[closing]` has to share out its forces."""
        return self.roles is not None and bool(self.roles.closings)

    @property
    def rules(self) -> str:
        """The rules by which its parts are sized; empty where there are none, or its file was not run."""
        return "" if self.roles is None else self.roles.rules

    @property
    def in_loop(self) -> bool:
        """Whether the gas of a run follows its motion."""
        return self.closed and not self.has("drive") and not self.has("blowdown")

    def has(self, *names: str) -> bool:
        """Whether the case has all of these sections."""
        return all(name in self.sections for name in names)

    def value(self, section: str, key: str) -> Any:
        """A value of the case; None without the section."""
        return getattr(self.sections.get(section), key, None)

    @property
    def closed(self) -> bool:
        """Whether the closed period of its cycle is integrated."""
        return self.kind is not None and self.kind.closed

    @property
    def shared(self) -> bool:
        """Whether two pistons share its gas."""
        return self.kind is not None and self.kind.shared


def facts_of(mechanism: str, sections: Records, kind: str = "", trust: bool = True) -> CaseFacts:
    """What decides, of a case's mechanism and records.

    kind: of a cycle whose section cannot be read; trust: whether a mechanism file may be run to learn its roles.
    """
    cycle = dict(sections.items()).get("cycle")
    case = CaseFacts(
        mechanism=mechanism, sections=dict(sections.items()), kind=KINDS.get(kind) if cycle is None else kind_of(cycle),
        roles=None,
    )  # fmt: skip
    if own.is_file(mechanism) and not trust:
        return case
    plan, parameters = plan_of(mechanism), case.sections.get("parameters")
    roles = plan.parts(parameters) if parameters is not None else mechanisms.roles_of(mechanism)
    held = len(plan.listing(None).get("dependents", ()))
    return dataclasses.replace(case, roles=roles, held=held, free=plan.free)


GUIDE = ("spring", "guide", "rollers", "limits")
PARTS = ("part_piston", "part_cylinder", "part_gears", "part_crank", "part_bearings", "part_masses")


def of_gas(case: CaseFacts) -> set[str]:
    """Sections that the gas of a case is made of."""
    return {"cycle", *case.kind.needs, *case.kind.reads} if case.kind is not None else set()


def of_turn(case: CaseFacts) -> set[str]:
    """Sections that a turn at constant speed reads."""
    by_kind = {"closing", "faces"} if case.undetermined else set()
    return {"parameters", "operation", "inputs", "torque", *of_gas(case), *by_kind, "start"}


def of_friction(case: CaseFacts) -> set[str]:
    """Sections of the mean pressure of friction, which engines have."""
    if case.kind is None or case.kind.shared or case.kind.measured:
        return set()
    fitted = type(case.sections.get("friction_pressure")).__name__ == "MechanismFriction"
    return {"friction_pressure", *(("friction", "rings") if fitted else ())}


def cycle(case: CaseFacts) -> set[str]:
    """Sections that figures of the gas read, also of a record by `--diagram`."""
    measured = set() if case.shared else {"combustion", "measured"}  # also of a record by --diagram
    return of_turn(case) | of_friction(case) | measured | {"gas_limits"}


def forces(case: CaseFacts) -> set[str]:
    """Sections that forces over a turn read, or over time where `[motion]` says how a mechanism moves."""
    if case.has("motion"):
        return {"parameters", "inputs", "start", "flywheel", "motion"}
    shaft = {"simulation", "speeds"} if case.vibrates else set()
    rubs = of_friction(case) | {"friction", "rings"}
    return of_turn(case) | rubs | {"shaking", "shaft", "comparison", "gas_limits"} | shaft


def flywheel(case: CaseFacts) -> set[str]:
    """Sections that the motion of a loaded shaft reads."""
    return of_turn(case) | {"flywheel", "load", "drive"}


def guide(case: CaseFacts) -> set[str]:
    """Sections that a guide is cut and judged by."""
    return flywheel(case) | {*GUIDE}


def size(case: CaseFacts) -> set[str]:
    """Sections that sizes and safety factors read."""
    if not case.rules or not case.closed:
        given = case.rules == "slider crank" and case.has("part_crosshead")
        return of_turn(case) | ({"part_crosshead"} if given else set())
    parts = set() if case.rules == "slider crank" else set(PARTS)
    return of_turn(case) | of_friction(case) | parts | {"sizing", "speeds"}


def run(case: CaseFacts) -> set[str]:
    """Sections that a run in time reads whose gas hangs on the angle alone."""
    every = {"parameters", "simulation", "inputs", "start", "drive", "flywheel"}
    loaded = case.roles is None or bool(case.roles.load)
    hinge = {"spring", "guide"} if case.free == 1 and not case.twists else set()
    turned = of_turn(case) if case.has("cycle") or case.has("torque") or case.has(*hinge, "spring") else set()
    return every | turned | hinge | ({"load", "operation"} if loaded else set())


def page(case: CaseFacts) -> set[str]:
    """Sections that the page of a run reads: those of the run, and what its moving picture shows of a hinge."""
    every = run(case)
    return every | {"rollers"} if "guide" in every else every


def simulate(case: CaseFacts) -> set[str]:
    """Sections that `simulate` reads: those of a run, and of what explains it."""
    shaft = {"speeds", "shaft"} if case.vibrates else {"startup"} if case.twists else set()
    if case.in_loop:
        loop = of_turn(case) - {"closing"} | of_friction(case) | {"simulation", "load", "flywheel"}
        return loop | shaft | {"gas_limits"}
    return run(case) | shaft | ({"gas_limits"} if case.has("cycle") else set())
