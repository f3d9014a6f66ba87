"""What of a case decides which commands run on it, and what they read."""

import dataclasses
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
