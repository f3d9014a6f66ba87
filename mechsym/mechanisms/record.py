"""The runtime record of a mechanism: named CasADi functions with the parameters bound.

Conventions of the package: crank angles are 0 at top dead centre and positive in the sense of rotation; piston travel
x is 0 at top dead centre and positive away from the head; F is the net force on the piston, F = (p - p_back) A,
positive away from the head; mass_matrix * qdd + bias = generalized_force, with gravity, springs, dampers and inputs on
the right; a reaction R_j is the force of the first body on the second along the joint displacement j.
"""

import dataclasses
import functools
import json
import re
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from importlib import import_module, resources
from types import ModuleType
from typing import TYPE_CHECKING, Protocol

import casadi as ca
import numpy as np

from mechsym.errors import BadInput, suggest
from mechsym.mechanisms import own
from mechsym.mechanisms.arrays import along, with_multipliers
from mechsym.quantities import record
from mechsym.quantities.units import Array, Radian, Scalar

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing


@record
class Mechanism:
    """A mechanism with values for its parameters."""

    name: str
    coordinates: tuple[str, ...]
    inputs: tuple[str, ...]
    parameters: Mapping[str, float]  #: Values that are bound into the functions
    #: `kinematics(q..)`, `dynamics(q.., u.., inputs..)` giving mass_matrix, bias, generalized_force, `energy(q..,
    #: u..)`, `reactions(q.., u.., a.., inputs..)`, `momentum(q.., u.., a..)`, `constraints(q.., u..)` giving closure,
    #: jacobian, bias, `joints` the reactions with what the constraints carry as inputs; only those that exist
    functions: Mapping[str, ca.Function]
    dependents: Mapping[str, float] = dataclasses.field(
        default_factory=dict
    )  #: Held by constraints, with their guesses

    units: Mapping[str, str] = dataclasses.field(default_factory=dict)  #: Of coordinates that are no angles [rad]
    #: How outputs of watched points are told, with a dot where the code has an identifier
    shown: Mapping[str, str] = dataclasses.field(default_factory=dict)
    undetermined: tuple[str, ...] = ()  #: Reactions that redundant joints hold against one another

    @property
    def state_units(self) -> tuple[str, ...]:
        """Units of the coordinates, then of the velocities."""
        units = tuple(self.units.get(q, "rad") for q in self.coordinates)
        return (*units, *(f"{unit}/s" for unit in units))

    # a mechanism is itself: what is computed of it is kept by identity
    __hash__ = object.__hash__


class MechanismForm(Protocol):
    """What mechanisms share that differ in numbers only: hashable, and equal for those."""

    @property
    def pushed(self) -> Hashable:
        """The numbers that work of gas on it hangs on; None where these may be all."""

    def bound(self, parameters: Mapping[str, Scalar]) -> Mechanism:
        """The mechanism with a number or a symbol for each of its parameters."""

    def __hash__(self) -> int:
        """The same for those that are equal."""


class LazyFunctions(Mapping[str, ca.Function]):
    """Named functions, each built when it is first asked for, and the form of their mechanism, where it has one."""

    def __init__(self, makers: Mapping[str, Callable[[], ca.Function]], form: MechanismForm | None = None) -> None:
        self.form = form
        self._makers = makers
        self._built: dict[str, ca.Function] = {}

    def __getitem__(self, name: str) -> ca.Function:
        if name not in self._built:
            self._built[name] = self._makers[name]()
        return self._built[name]

    def __contains__(self, name: object) -> bool:
        return name in self._makers  # without building it

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)


def form_of(mechanism: Mechanism) -> MechanismForm | None:
    """What a mechanism shares with those that differ in numbers only; None where that is not known."""
    return mechanism.functions.form if isinstance(mechanism.functions, LazyFunctions) else None


@record
class GeneratedForm:
    """Mechanisms of one generated module."""

    module: ModuleType
    pushed: None = None  #: See `MechanismForm`

    def bound(self, parameters: Mapping[str, Scalar]) -> Mechanism:
        """See `MechanismForm`."""
        return bind_module(self.module, parameters)


def velocities(mechanism: Mechanism | ModuleType) -> tuple[str, ...]:
    """Names of the velocities."""
    return tuple(f"{q}d" for q in _coordinates(mechanism))


def accelerations(mechanism: Mechanism | ModuleType) -> tuple[str, ...]:
    """Names of the accelerations."""
    return tuple(f"{q}dd" for q in _coordinates(mechanism))


def _coordinates(mechanism: Mechanism | ModuleType) -> tuple[str, ...]:
    return mechanism.coordinates if isinstance(mechanism, Mechanism) else mechanism.COORDINATES


def generated(name: str) -> ModuleType:
    """The generated module: tables of names and plain functions for floats or CasADi symbols."""
    if own.is_file(name):
        return own.load(name).module
    if not (resources.files("mechsym.generated") / f"{name}.py").is_file():
        if name in own.packaged():
            raise BadInput(f"{name} is put together from its data; export a case of it, for example alpha-stirling")
        raise BadInput(f"{name!r} is no mechanism; {suggest(name, own.packaged())}")
    return import_module(f"mechsym.generated.{name}")


def listing(name: str) -> "Listing":
    """Letters, units, source and equations of a mechanism, as stored by the derivation."""
    if own.is_file(name):
        return own.load(name).listing.copy()
    return _stored(name).copy()


@functools.lru_cache(maxsize=16)
def _stored(name: str) -> "Listing":
    stored = resources.files("mechsym.generated") / "equations" / f"{name}.json"
    if not stored.is_file():
        raise BadInput(f"mechanism {name!r} is not known; {suggest(name, own.packaged())}")
    return json.loads(stored.read_text(encoding="utf-8"))


def _named(name: str, bound: Mechanism) -> Mechanism:
    """A mechanism with what its listing says beside the code: units, and names as they are told."""
    known, shown = listing(name), dict[str, str]()
    for point in known.get("watched", ()):
        of_point = re.compile(rf"(d\d*)?{point}_([xyz])((?:_d.*)?)")
        matches = ((n, of_point.fullmatch(n)) for n in known["outputs"])
        shown |= {n: f"{point}.{m[1] or ''}{m[2]}{m[3]}" for n, m in matches if m}
    undetermined = tuple(known.get("undetermined", ()))
    return dataclasses.replace(bound, name=name, units=known["coordinates"], shown=shown, undetermined=undetermined)


def bind(name: str, parameters: Mapping[str, Scalar]) -> Mechanism:
    """Build the named CasADi functions of a generated module for given parameters.

    parameters: mapping of str to float or casadi.SX, a value for every parameter; symbols make functions that can be
    differentiated by them. Returns mechanism: functions with scalar inputs; a row vector (1, n) maps over its columns.
    """
    module = generated(name)
    values = tuple((p, parameters[p]) for p in module.PARAMETERS if p in parameters)
    if len(values) == len(module.PARAMETERS) and all(isinstance(v, float) for _, v in values):
        return _bound(module, name, values, repr(values))
    return _named(name, bind_module(module, parameters))


# points of a sweep, and trials of one engine, ask for the same mechanism again; the text tells 0 from -0
@functools.lru_cache(maxsize=64)
def _bound(module: ModuleType, name: str, values: tuple[tuple[str, float], ...], text: str) -> Mechanism:
    return _named(name, bind_module(module, dict(values)))


def bind_module(module: ModuleType, parameters: Mapping[str, Scalar]) -> Mechanism:
    """The named CasADi functions of a generated module for given parameters, see `bind`."""
    name = module.NAME
    missing = [p for p in module.PARAMETERS if p not in parameters]
    if missing:
        raise BadInput(f"{name}: no value for {', '.join(missing)}; parameters are {', '.join(module.PARAMETERS)}")
    values = {p: parameters[p] for p in module.PARAMETERS}
    q, u, a = module.COORDINATES, velocities(module), accelerations(module)
    letters = {
        "kinematics": q,
        "dynamics": (*q, *u, *module.INPUTS),
        "energy": (*q, *u),
        "reactions": (*q, *u, *a, *module.INPUTS, *getattr(module, "MULTIPLIERS", ())),
        "momentum": (*q, *u, *a),
        "constraints": (*q, *u),
        "sides": q,
        "drawing": q,
    }
    makers = {n: functools.partial(casadi_function, module, n, letters[n], values) for n in module.FUNCTIONS}
    functions: Mapping[str, ca.Function] = LazyFunctions(makers, GeneratedForm(module=module))
    dependents = getattr(module, "DEPENDENTS", {})
    if dependents and "reactions" in functions:
        functions = {**functions, "joints": functions["reactions"]}
        functions = {**functions, "reactions": with_multipliers(functions, tuple(dependents))}
    return Mechanism(
        name=name, coordinates=q, inputs=module.INPUTS, parameters=values, functions=functions, dependents=dependents
    )


def casadi_function(
    module: ModuleType, function: str, letters: Sequence[str], parameters: Mapping[str, Scalar]
) -> ca.Function:
    """One generated function as a casadi.Function with named inputs and outputs.

    letters: names of the inputs, in order; parameters: mapping of str to value, values or symbols for the other
    arguments. Returns function: scalar outputs; for `dynamics` the matrix and the two vectors.
    """
    symbols = {name: ca.SX.sym(name) for name in letters}
    arguments, outputs = module.FUNCTIONS[function]
    values = getattr(module, function)(**{n: symbols.get(n, parameters.get(n)) for n in arguments})
    results = dict(zip(outputs, (ca.SX(v) for v in values), strict=True))
    if function == "dynamics":
        q = module.COORDINATES
        mass = ca.vertcat(*(ca.horzcat(*(results[f"mass_{a}_{b}"] for b in q)) for a in q))
        bias = ca.vertcat(*(results[f"bias_{a}"] for a in q))
        force = ca.vertcat(*(results[f"force_{a}"] for a in q))
        results = {"mass_matrix": mass, "bias": bias, "generalized_force": force}
    if function == "constraints":
        results = _constraint_matrices(results, module.COORDINATES)
    free = [p for p in parameters.values() if isinstance(p, ca.SX)]
    inputs = [*symbols.values(), *free]
    names = [*symbols, *(p.name() for p in free)]
    # a dependent coordinate may be asked for as an output
    options = {"allow_duplicate_io_names": True} if set(names) & set(results) else {}
    return ca.Function(function, inputs, list(results.values()), names, list(results), options)


def _constraint_matrices(results: Mapping[str, ca.SX], q: Sequence[str]) -> dict[str, ca.SX]:
    names = [n.removeprefix("closure_") for n in results if n.startswith("closure_")]
    jacobian = ca.vertcat(*(ca.horzcat(*(results[f"jacobian_{c}_{a}"] for a in q)) for c in names))
    stacked = {group: ca.vertcat(*(results[f"{group}_{c}"] for c in names)) for group in ("closure", "bias")}
    return {"closure": stacked["closure"], "jacobian": jacobian, "bias": stacked["bias"]}


def acceleration_function(mechanism: Mechanism) -> ca.Function:
    r"""Accelerations :math:`\ddot q = M^{-1}(Q - h)` of a mechanism without constraints.

    Returns function: same inputs as `dynamics`; one output `acceleration`, shape (n, 1).
    """
    dynamics = mechanism.functions["dynamics"]
    inputs = [ca.SX.sym(dynamics.name_in(i)) for i in range(dynamics.n_in())]
    mass, bias, force = dynamics(*inputs)
    apart = mass.sparsity().is_diag()
    solved = (force - bias) / ca.diag(mass) if apart else ca.solve(mass, force - bias)
    return ca.Function("acceleration", inputs, [solved], dynamics.name_in(), ["acceleration"])


def evaluate(mechanism: Mechanism, group: str, **letters: Scalar) -> dict[str, np.ndarray]:
    """A group of functions of a mechanism along arrays of its letters.

    group: `kinematics`, `dynamics`, `energy`, `reactions`, `momentum`: one that the mechanism has. **letters:
    coordinates, velocities, accelerations and inputs, SI; what is not named is 0 [SI]. Returns values: by output name;
    vectors and matrices of several coordinates have their own axes before that of the points [SI].

    Raises BadInput: no such group, or a letter that it does not take.

    >>> from mechsym import cases, mechanisms
    >>> built = mechanisms.build("crosshead", cases.load("zotov-89").need("parameters"))
    >>> evaluate(built, "kinematics", phi=3.141592653589793)["x"].round(6).tolist()  # 2 r
    [1.0]
    """
    if group not in mechanism.functions:
        raise BadInput(f"{mechanism.name} has no {group!r}; it has {', '.join(mechanism.functions)}")
    return along(mechanism.functions[group], letters)


def curves(mechanism: Mechanism, phi: Radian[Array]) -> dict[str, np.ndarray]:
    """Kinematic outputs of a one-coordinate mechanism along an array of angles."""
    (q,) = mechanism.coordinates
    return evaluate(mechanism, "kinematics", **{q: phi})
