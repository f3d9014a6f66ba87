"""Putting derived throws on a shaft: every function of the crank train is a sum over instances of one throw."""

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import casadi as ca

from mechsym.mechanisms.crank_train import throws as summed
from mechsym.mechanisms.crank_train.articulated import LETTERS, OUTPUTS, STATE, hung
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, Numbers, each
from mechsym.mechanisms.crank_train.throws import Instances, Outputs, ThrowPart, parts
from mechsym.mechanisms.record import LazyFunctions, Mechanism, generated
from mechsym.quantities import record
from mechsym.quantities.units import Scalar

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing

# the dynamics, and the torque of each section of the shaft
_Joined = tuple[Outputs, ca.SX]


@record
class _Symbols:
    # q, u, a: one symbol a throw and one of the flywheel; in the rigid train all are the same
    names: tuple[str, ...]
    q: list[ca.SX]
    u: list[ca.SX]
    a: list[ca.SX]
    forces: list[ca.SX]  #: On the pistons, and the load at the end


def build(p: CrankTrainParameters) -> Mechanism:
    """The mechanism with one coordinate a throw and one of the flywheel."""
    names = (*(f"phi{k + 1}" for k in range(max(p.throw))), "phi_f")
    return _mechanism(p, _symbols(names, len(names), len(p.throw)), _elastic)


def build_rigid(p: CrankTrainParameters) -> Mechanism:
    """The mechanism with one coordinate for the whole shaft; shaft torques from the balance of the throws before."""
    return _mechanism(p, _symbols(("phi",), max(p.throw) + 1, len(p.throw)), _rigid)


def _elastic(p: CrankTrainParameters, s: _Symbols, rows: list[ca.SX]) -> _Joined:
    mass, bias, force = rows
    torques = ca.vertcat(*each(p, "k")) * _sections(s.q) + ca.vertcat(*each(p, "c")) * _sections(s.u)
    ends = ca.vertcat(0, torques, 0)
    joined = force - ends[1:] + ends[:-1]
    return {"mass_matrix": ca.diag(mass), "bias": bias, "generalized_force": joined}, torques


def _rigid(p: CrankTrainParameters, s: _Symbols, rows: list[ca.SX]) -> _Joined:
    mass, bias, force = rows
    torques = ca.cumsum((force - bias - mass * s.a[0])[:-1])
    totals = (ca.sum1(row) for row in rows)
    return dict(zip(("mass_matrix", "bias", "generalized_force"), totals, strict=True)), torques


def _sections(values: list[ca.SX]) -> ca.SX:
    column = ca.vertcat(*values)
    return column[:-1] - column[1:]


def _symbols(names: tuple[str, ...], discs: int, cylinders: int) -> _Symbols:
    repeated = discs // len(names)
    q, u, a = ([ca.SX.sym(f"{n}{dots}") for n in names] * repeated for dots in ("", "d", "dd"))
    forces = [*(ca.SX.sym(f"F{i + 1}") for i in range(cylinders)), ca.SX.sym("M")]
    return _Symbols(names=names, q=q, u=u, a=a, forces=forces)


# the same for all trains
@functools.cache
def _throw(group: str) -> ca.Function:
    """A function of the derived throw, from its state and its letters, no torque on it, to all outputs."""
    module = generated("crank_throw")
    state, letters = ca.SX.sym("state", len(STATE)), ca.SX.sym("letters", len(module.PARAMETERS) + 1)
    symbols = [*ca.vertsplit(state), *ca.vertsplit(letters)]
    given = dict(zip((*STATE, *module.PARAMETERS, "shift"), symbols, strict=True)) | {"M": ca.SX(0)}
    given["phi"] += given["shift"]
    arguments, _ = module.FUNCTIONS[group]
    values: list[ca.SX] = list(getattr(module, group)(**{n: given[n] for n in arguments}))
    return ca.Function(group, [state, letters], [ca.vertcat(*values)])


def _tables(
    s: _Symbols, all_parts: list[ThrowPart], names: Sequence[str], function: Callable[[str], ca.Function]
) -> Callable[[str], ca.SX]:
    """What gives the outputs of a group, a row each, for all parts, a column each."""
    n = len(s.q)
    letters = ca.horzcat(*(ca.vertcat(*(part.letters[name] for name in names), part.shift) for part in all_parts))
    # nothing pushes a crank that is alone
    every, nothing = ca.vertcat(*s.q, *s.u, *s.a, *s.forces, 0), 3 * n + len(s.forces)
    rows = [
        (p.throw, n + p.throw, 2 * n + p.throw, 3 * n + p.cylinder - 1 if p.cylinder else nothing) for p in all_parts
    ]
    state = ca.reshape(every[[place for row in rows for place in row]], len(STATE), len(rows))
    return lambda group: function(group).map(len(rows))(state, letters)


def _rows(p: CrankTrainParameters, s: _Symbols, all_parts: list[ThrowPart], table: ca.SX) -> list[ca.SX]:
    """Inertia, bias and force of every throw and of the flywheel, of the table of the dynamics."""
    throw = [*(part.throw for part in all_parts), max(p.throw)]
    joining = ca.DM.triplet(throw, list(range(len(throw))), ca.DM.ones(len(throw)), throw[-1] + 1, len(throw))
    return ca.horzsplit(ca.mtimes(joining, ca.horzcat(table, ca.vertcat(p.I_f, 0, -s.forces[-1])).T))


def _mechanism(
    p: CrankTrainParameters, s: _Symbols, join: Callable[[CrankTrainParameters, _Symbols, list[ca.SX]], _Joined]
) -> Mechanism:
    all_parts, derived = parts(p), generated("crank_throw")
    # what stands on a crank pin is the derived throw, what hangs on another's rod is added to it
    own, hanging = ([part for part in all_parts if bool(part.master) == hangs] for hangs in (False, True))
    names: dict[bool, Callable[[str], tuple[str, ...]]] = {
        False: lambda group: derived.FUNCTIONS[group][1],
        True: lambda group: OUTPUTS[group],
    }
    tables = [(own, names[False], _tables(s, own, derived.PARAMETERS, _throw))]
    if hanging:
        tables.append((hanging, names[True], _tables(s, hanging, LETTERS, hung)))

    def throws(group: str) -> Instances:
        return [
            (part, dict(zip(outputs(group), ca.vertsplit(column), strict=True)))
            for some, outputs, table in tables
            for part, column in zip(some, ca.horzsplit(table(group)), strict=True)
        ]

    def joined() -> _Joined:
        return join(p, s, _rows(p, s, all_parts, ca.horzcat(*(table("dynamics") for _, _, table in tables))))

    def energy() -> Outputs:
        energy, strain = throws("energy"), ca.sum1(ca.vertcat(*each(p, "k")) * _sections(s.q) ** 2 / 2)
        of_shaft = {"kinetic_energy": p.I_f * s.u[-1] ** 2 / 2, "potential_energy": strain}
        return {name: sum((outputs[name] for _, outputs in energy), start) for name, start in of_shaft.items()}

    def reactions() -> Outputs:
        sections = {f"shaft_torque_{k}": torque for k, torque in enumerate(ca.vertsplit(joined()[1]), 1)}
        return summed.reactions(throws("reactions")) | sections

    def momentum() -> Outputs:
        rates, flywheel = summed.momentum(throws("momentum")), each(p, "sense")[-1] * p.I_f * s.a[-1]
        return rates | {"angular_momentum_rate": rates["angular_momentum_rate"] + flywheel}

    q, u, a = (values[: len(s.names)] for values in (s.q, s.u, s.a))
    groups: dict[str, tuple[list[ca.SX], Callable[[], Outputs]]] = {
        "kinematics": (q, lambda: summed.kinematics(throws("kinematics"), s.names)),
        "dynamics": ([*q, *u, *s.forces], lambda: joined()[0]),
        "energy": ([*q, *u], energy),
        "reactions": ([*q, *u, *a, *s.forces], reactions),
        "momentum": ([*q, *u, *a], momentum),
    }
    makers = {name: functools.partial(_made, p, name, *group) for name, group in groups.items()}
    return Mechanism(
        name="crank_train",
        coordinates=s.names,
        inputs=tuple(map(str, s.forces)),
        parameters=vars(p),
        functions=LazyFunctions(makers, None if join is _rigid else _form(p)),
    )


# given once for all throws, these are neither places nor angles: a train is put together the same for any of them
_OPEN = ("m_rod", "m_piston", "I_rod", "I0", "m0", "u0", "I_f", "k", "c")


@record
class TrainForm:
    """Crank trains with an elastic shaft that are put together in the same way."""

    fixed: tuple[tuple[str, Numbers], ...]  #: What decides how [unit of the letter]

    @property
    def pushed(self) -> tuple[tuple[str, Numbers], ...]:
        """See `MechanismForm`; no open letter moves a piston."""
        return self.fixed

    def bound(self, parameters: Mapping[str, Scalar]) -> Mechanism:
        """See `MechanismForm`."""
        p = object.__new__(CrankTrainParameters)  # no range holds a symbol
        for name, value in (*self.fixed, *parameters.items()):
            object.__setattr__(p, name, value)
        return build(p)


def _form(p: CrankTrainParameters) -> TrainForm:
    return TrainForm(fixed=tuple((n, v) for n, v in vars(p).items() if n not in _OPEN or isinstance(v, tuple)))


def _made(p: CrankTrainParameters, name: str, inputs: list[ca.SX], outputs: Callable[[], Outputs]) -> ca.Function:
    values, free = outputs(), [v for v in vars(p).values() if isinstance(v, ca.SX)]
    letters = [*inputs, *free]
    return ca.Function(name, letters, list(values.values()), [str(v) for v in letters], list(values))


def listing(mechanism: Mechanism | None = None) -> "Listing":
    """Letters and units, like the stored listing of a generated mechanism.

    mechanism: of `build`; without it the letters stand for any number of throws. Returns listing: keys name, about,
    source, coordinates, parameters, inputs, outputs, equations.
    """
    coordinates = mechanism.coordinates if mechanism else ("phi1..phiN", "phi_f")
    inputs = mechanism.inputs if mechanism else ("F1..", "M")
    names: Sequence[str] = (
        "x_1",
        "psi_1",
        "pin_force_x_1",
        "side_force_1",
        "main_bearing_force_x_1",
        "shaft_torque_1",
        "..",
    )
    if mechanism is not None:
        names = [n for group in ("kinematics", "reactions") for n in mechanism.functions[group].name_out()]
    fields = dataclasses.fields(CrankTrainParameters)
    return {
        "name": "crank_train",
        "about": "N throws on an elastic shaft with a flywheel.",
        "source": "002_d7297926d6c52225",
        "coordinates": dict.fromkeys(coordinates, "rad"),
        "parameters": {f.name: f.metadata.get("unit", "-") for f in fields},
        "inputs": {n: "N*m" if n == "M" else "N" for n in inputs},
        "outputs": {name: _unit(name) for name in names},
        "roles": {
            "rotor": [{"name": "flywheel", "angle": "phi_f", "load": "M", "drive": "M_drive", "inertia": "I_f"}],
            "face": [{"name": "1", "travel": "x_1", "force": "F1", "fires": 0.0}],
            "shaft": [{"name": "shaft", "discs": [], "stiffness": [], "damping": []}],
        },
        "equations": [],
    }


def _unit(output: str) -> str:
    """Unit of an output, which is that of the throw's quantity behind it."""
    kinds = {
        "x_": "m",
        "dx_": "m/rad",
        "d2x_": "m/(rad*rad)",
        "psi_": "rad",
        "dpsi_": "rad/rad",
        "knuckle_force_": "N",
        "knuckle_": "rad",
        "dknuckle_": "rad/rad",
        "shaft_torque_": "N*m",
    }
    return next((unit for start, unit in kinds.items() if output.startswith(start)), "" if output == ".." else "N")
