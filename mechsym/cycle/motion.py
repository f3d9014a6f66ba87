"""From a mechanism to the motion that the engine cycle needs: the one place where the two meet.

The engine knows the travel of a piston and nothing else; a mechanism with a crank angle and a travel x has all of it.
Mechanisms whose pistons move alike share a view of it: the rodless slider moves as the piston of a hypocycloid with
e = r, and a crank train's cylinder as that of a single throw.
"""

from collections.abc import Mapping
from typing import Any

import casadi as ca

from mechsym import mechanisms
from mechsym.cycle.chamber import Motion, check_motion
from mechsym.errors import BadInput
from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.hypocycloid import HypocycloidParameters
from mechsym.mechanisms.record import Mechanism, bind
from mechsym.mechanisms.rodless import RodlessParameters

# mechanism: parameters whose masses go up and down with the piston, outputs of `reactions` that limit a design
_PISTONS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "crank_throw": (("m_piston",), ()),
    "crosshead": (("m3", "m4", "m5"), ()),
    "hypocycloid": (("m3",), ("tooth_force",)),
}


def piston_motion(name: str, parameters: Mapping[str, float]) -> Motion:
    """The motion of a mechanism's piston, with the mechanism's parameters still free.

    Parameters
    ----------
    name : str
        Name of a mechanism with one coordinate and a piston

    Returns
    -------
    motion : Motion
        Travel and its derivatives, and the loads that limit a design
    """
    if name not in _PISTONS:
        raise BadInput(f"mechanism {name!r} has no piston for an engine cycle; use {', '.join(sorted(_PISTONS))}")
    masses, loads = _PISTONS[name]
    symbols = {key: ca.SX.sym(key) for key in parameters}
    mechanism = bind(name, symbols)
    found = Motion(
        name=name,
        function=_travel(mechanism, symbols),
        parameters=dict(parameters),
        masses=masses,
        loads=_loads(mechanism, symbols, loads) if loads else None,
    )
    check_motion(found)
    return found


def one_cylinder(name: str, parameters: Any) -> tuple[str, Any]:
    """A mechanism as one cylinder of it sees itself.

    Parameters
    ----------
    parameters : record
        Of the mechanism of that name

    Returns
    -------
    name, parameters : str, record
        A mechanism that has one piston and its travel as `x`
    """
    if isinstance(parameters, RodlessParameters):
        p = parameters
        return "hypocycloid", HypocycloidParameters(e=p.r, I1=p.I1, m2=0, I2=0, m3=p.m_a, alpha_n=0)
    if isinstance(parameters, CrankTrainParameters):
        letters = {n: each(parameters, n)[0] for n in ("r", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston")}
        name, parameters = "crank_throw", CrankThrowParameters(**letters, I0=each(parameters, "I0")[0])
    if isinstance(parameters, CrankThrowParameters) and parameters.offset != 0:
        raise BadInput(
            f"offset = {parameters.offset:g} m: the cycles know dead centres half a turn apart; "
            "set offset = 0 or leave [cycle] out"
        )
    return name, parameters


def piston_travel(name: str, parameters: Any) -> ca.Function:
    """Travel of the piston of a mechanism with one coordinate.

    Parameters
    ----------
    parameters : record
        Of the mechanism of that name

    Returns
    -------
    function : casadi.Function
        phi to `x` [m] and `dx_dphi` [m/rad]
    """
    mechanism = mechanisms.build(name, parameters)
    kinematics, phi = mechanism.functions["kinematics"], ca.SX.sym("phi")
    if len(mechanism.coordinates) != 1 or "x" not in kinematics.name_out():
        raise BadInput(f"mechanism {name} has no piston that a cycle could drive")
    found = kinematics(phi)
    values = dict(zip(kinematics.name_out(), found, strict=True))
    outputs = [values["x"], values[f"dx_d{mechanism.coordinates[0]}"]]
    return ca.Function("travel", [phi], outputs, ["phi"], ["x", "dx_dphi"])


def _travel(mechanism: Mechanism, symbols: Mapping[str, ca.SX]) -> ca.Function:
    q, phi = mechanism.coordinates[0], ca.SX.sym("phi")
    values = mechanism.functions["kinematics"](**{q: phi}, **symbols)
    outputs = [values[name] for name in ("x", f"dx_d{q}", f"d2x_d{q}2")]
    return ca.Function("travel", [phi, ca.vertcat(*symbols.values())], outputs)


def _loads(mechanism: Mechanism, symbols: Mapping[str, ca.SX], names: tuple[str, ...]) -> ca.Function:
    q, phi, omega, force = mechanism.coordinates[0], *(ca.SX.sym(n) for n in ("phi", "omega", "F"))
    reactions = mechanism.functions["reactions"]
    state: dict[str, Any] = {q: phi, f"{q}d": omega, "F": force}
    values = reactions(**{n: state.get(n, symbols.get(n, 0)) for n in reactions.name_in()})
    outputs = [values[n] for n in names]
    return ca.Function("loads", [phi, ca.vertcat(*symbols.values()), omega, force], outputs,
                       ["phi", "parameters", "omega", "F"], list(names))  # fmt: skip
