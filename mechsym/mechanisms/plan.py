"""What the name of a mechanism stands for: its declaration, or lists of which one is put together at run time.

The registry is the list of what was generated, and of the packages of this room that put a mechanism together, each
with its `PLAN`.
"""

import dataclasses
import functools
from collections.abc import Callable, Iterable, Mapping
from importlib import import_module, resources
from typing import TYPE_CHECKING, Generic, Protocol, TypeVar

from mechsym.errors import BadInput
from mechsym.mechanisms import own
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.drawn_parts import Circle, Line, sketched
from mechsym.mechanisms.loops import one_coordinate
from mechsym.mechanisms.proportions import Proportions, declared
from mechsym.mechanisms.record import Mechanism, bind, listing
from mechsym.quantities import record
from mechsym.quantities.records import Record

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing
    from mechsym.mechanisms.roles import PartRoles

P = TypeVar("P", bound=Record)


class MechanismPlan(Protocol):
    """What the name of a mechanism stands for."""

    @property
    def theory(self) -> str:
        """The derived mechanism whose equations are its own."""

    @property
    def parameters(self) -> type[Record]:
        """Class of its record of numbers."""

    @property
    def free(self) -> int:
        """Coordinates that no loop holds, on a shaft that does not twist where that is possible."""

    def build(self, parameters: Record) -> Mechanism:
        """With all of its coordinates."""

    def rigid(self, parameters: Record, guesses: Mapping[str, float]) -> Mechanism:
        """With one coordinate for the whole shaft; guesses are of coordinates that loops hold [rad] or [m]."""

    def listing(self, mechanism: Mechanism | None) -> "Listing":
        """Letters, units and source; of what was built, where they hang on its numbers."""

    def parts(self, parameters: Record) -> "PartRoles":
        """Roles of the rigid one."""

    def alone(self, parameters: Record) -> tuple[str, Record]:
        """Name and record of a mechanism as one cylinder of this one sees itself."""

    def proportions(self, parameters: Record) -> Proportions | None:
        """Its sizes, where it says them."""

    def require_firing(self, parameters: Record, period: float) -> None:
        """Refuse cylinders that fire far from their dead centres within a period [rad]."""

    def shapes(self, parameters: Record, angle: float, bore: float | None) -> Iterable[Line | Circle]:
        """Its drawing at a crank angle [rad], with a bore [m] or one in proportion; nothing where there is none."""


@record
class DeclaredMechanism:
    """A mechanism that is its declaration: generated code of the package, or a file of the user's own."""

    name: str

    @property
    def theory(self) -> str:
        """Itself."""
        return self.name

    @property
    def parameters(self) -> type[Record]:
        """Made from the letters, units and ranges of the declaration."""
        return own.load(self.name).parameters if own.is_file(self.name) else _packaged(self.name)

    @property
    def free(self) -> int:
        """Coordinates that no loop holds."""
        said = self.listing(None)
        return len(said["coordinates"]) - len(said.get("dependents", ()))

    def build(self, parameters: Record) -> Mechanism:
        """The generated functions with numbers bound."""
        return bind(self.name, vars(parameters))

    def rigid(self, parameters: Record, guesses: Mapping[str, float]) -> Mechanism:
        """The same on its first coordinate, loops closed along it."""
        mechanism = self.build(parameters)
        if mechanism.dependents:
            return one_coordinate(mechanism, guesses)
        if len(mechanism.coordinates) != 1:
            raise BadInput(f"{mechanism.name} has {len(mechanism.coordinates)} coordinates; this command takes one")
        return mechanism

    def listing(self, mechanism: Mechanism | None) -> "Listing":
        """As the derivation has stored it."""
        return listing(self.name)

    def parts(self, parameters: Record) -> "PartRoles":
        """Those of the declaration."""
        return roles_of(self.name)

    def alone(self, parameters: Record) -> tuple[str, Record]:
        """The mechanism that the declaration names as alike, or itself."""
        for other in self.parts(parameters).alike:
            letters = dataclasses.asdict(parameters)
            numbers = {letter: amount(text, letters) for letter, text in other.parameters.items()}
            return other.name, plan_of(other.name).parameters(**numbers)
        return self.name, parameters

    def proportions(self, parameters: Record) -> Proportions | None:
        """By the strokes, rods and inertias that the declaration names."""
        return declared(self.parts(parameters), self.listing(None)["parameters"], dataclasses.asdict(parameters))

    def require_firing(self, parameters: Record, period: float) -> None:
        """Pistons of a declaration fire at their own dead centres in any period [rad]."""

    def shapes(self, parameters: Record, angle: float, bore: float | None) -> Iterable[Line | Circle]:
        """The sketch of the declaration at an angle [rad], with a bore [m]."""
        return sketched(self.listing(None), dataclasses.asdict(parameters), angle, bore)


@record
class AssembledMechanism(Generic[P]):
    """A mechanism that is put together at run time from a derived part, by lists of its numbers."""

    theory: str  #: Name of the derived part
    parameters: type[P]
    build: Callable[[P], Mechanism]
    rigid: Callable[[P, Mapping[str, float]], Mechanism]
    listing: Callable[[Mechanism | None], "Listing"]
    parts: Callable[[P], "PartRoles"]
    alone: Callable[[P], tuple[str, Record]]
    proportions: Callable[[P], Proportions]
    require_firing: Callable[[P, float], None]
    shapes: Callable[[P, float, float | None], Iterable[Line | Circle]]
    free: int = 1  #: On a stiff shaft


@functools.lru_cache(maxsize=64)
def plan_of(name: str) -> MechanismPlan:
    """What a name stands for; the one place that tells the two ways apart."""
    if name in _assembled():
        plan: MechanismPlan = import_module(f"mechsym.mechanisms.{name}").PLAN
        return plan
    return DeclaredMechanism(name=name)


@functools.lru_cache(maxsize=1)
def _assembled() -> frozenset[str]:
    generated = resources.files("mechsym.generated")
    return frozenset(name for name in own.packaged() if not (generated / f"{name}.py").is_file())


@functools.lru_cache(maxsize=64)
def _packaged(name: str) -> type[Record]:
    return own.record_of(listing(name))


def roles_of(name: str) -> "PartRoles":
    """What the parts of a mechanism are for, as its declaration says."""
    return _roles(name) if own.is_file(name) else _packaged_roles(name)


def driving_inputs(name: str) -> list[str]:
    """The inputs by which a drive may turn a mechanism: those of its rotors, else every torque."""
    roles = roles_of(name)
    named = [rotor.drive for rotor in roles.rotors if rotor.drive]
    torques = [text for text, unit in plan_of(name).listing(None)["inputs"].items() if unit == "N*m"]
    return named or [text for text in torques if text not in roles.own_inputs]


def _roles(name: str) -> "PartRoles":
    from mechsym.mechanisms.roles import roles_in  # an evaluation asks for none

    return roles_in(plan_of(name).listing(None))


# the points of a sweep ask again and again; a file of the user's own may have changed since
_packaged_roles = functools.lru_cache(maxsize=16)(_roles)


@functools.lru_cache(maxsize=1)
def with_chain() -> tuple[str, ...]:
    """Names of the mechanisms of the package with a crank pin, where pistons push."""
    known = ((name, roles_of(plan_of(name).theory)) for name in own.packaged())
    return tuple(name for name, roles in known if any(b.throw is not None for b in roles.bearings))
