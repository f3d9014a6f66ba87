"""Case -> cycle: the engine of a case and its figures over the speeds."""

from dataclasses import replace
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cases.settings import Speeds
from mechsym.cycle.breathing import engine as breathing_engine
from mechsym.cycle.breathing.engine import BreathingRun
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.engine import columns, over_design
from mechsym.cycle.figures import cylinder_columns
from mechsym.cycle.friction import Friction, MechanismFriction, NoFriction
from mechsym.cycle.gas_of_train import engine_of_train, gas_of_engine_on
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.kinds.stirling import StirlingEngine, stirling_columns
from mechsym.forces.turn import turn
from mechsym.jobs import own, own_gas, own_turn
from mechsym.jobs.gas import breathing_with, engine_with, of, one_cylinder
from mechsym.jobs.own import is_own
from mechsym.jobs.scavenge import columns as scavenge_columns
from mechsym.jobs.scavenge import follows, scavenged
from mechsym.jobs.starts import guesses
from mechsym.jobs.turn import drive_of, fitted_law
from mechsym.jobs.unlike import unlike_pistons
from mechsym.jobs.whole_engine import of_engine, other_piston
from mechsym.page import ShownFigures
from mechsym.quantities import RPM

_FRICTION_SPEEDS = (0.25, 0.5, 0.75, 1.0)  # of the speed of operation, where a mechanism's friction is looked up


class CycleFigures(ShownFigures):
    """Figures of an engine over the speeds, under the names of `mechsym cycle`."""


def cycle(case: Case, omega: np.ndarray | None = None) -> CycleFigures:
    """Figures of the engine cycle of a case, at its speed of operation or over several.

    Parameters
    ----------
    case : Case
        With `[cycle]` of any kind that follows no measured diagram
    omega : ndarray, shape (n,), optional
        Crank speeds [rad/s]

    Returns
    -------
    columns : CycleFigures
        Arrays under the names of `mechsym cycle`: `speed_rpm`, `torque_avg`, `power_kw`, `efficiency` and so on, of the
        engine; `per_cylinder` of one cylinder, or `pistons` of each where they move differently

    Examples
    --------
    >>> from mechsym import cases
    >>> found = cycle(cases.load("zotov-89"))
    >>> round(float(found["power_kw"][0]), 2), found.view.cards[1].value
    (83.88, '83.88 kW')
    """
    speeds = np.array([case.need("operation").speed]) if omega is None else omega
    given = kind_of(case.need("cycle")).given
    if given == "train":
        return CycleFigures(columns_of_stirling(case, speeds))
    if other_piston(case):
        return CycleFigures(unlike_pistons(case, speeds, _friction(case)))
    if given == "engine":
        found = columns(over_design(engine(one_cylinder(case)), {"omega": speeds}))
    elif given == "breathing":
        found = columns_of_breathing(case, speeds)
    else:
        found = columns_of_cylinder(case, speeds)
    return CycleFigures(of_engine(case, found, speeds))


def engine(case: Case) -> ClosedEngine:
    """The engine that a case describes.

    Parameters
    ----------
    case : Case
        As for `engine_with`; `[friction_pressure]` defaults to no friction, its law `mechanism` is fitted to the
        case's `[friction]`

    Raises
    ------
    BadInput
        A section is missing, or the cycle is of another kind
    """
    return engine_with(case, _friction(case))


def _friction(case: Case) -> Friction:
    law = case.sections.get("friction_pressure", NoFriction())
    if not isinstance(law, MechanismFriction):
        return law
    # the friction hangs on the gas forces, and those not on the friction
    plain = replace(case, sections={**case.sections, "friction_pressure": NoFriction()})
    return fitted_law(plain, case.need("operation").speed * np.array(_FRICTION_SPEEDS)).law


def columns_of_cylinder(case: Case, omega: np.ndarray) -> dict[str, Any]:
    """Figures of a case whose cycle is no engine's but one cylinder's, over the speeds.

    Parameters
    ----------
    case : Case
        With a cycle of kind `two-stroke-marine` or `two-stroke-zone`
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]
    """
    if follows(case):
        return _columns_of_scavenged(case, omega)
    seen = one_cylinder(case)
    with of(case):
        return cylinder_columns(case.need("cycle"), seen.mechanism, seen.need("parameters"), omega, guesses(case))


def _columns_of_scavenged(case: Case, omega: np.ndarray) -> dict[str, Any]:
    states, rows = [], []
    given = replace(case, sections={name: s for name, s in case.sections.items() if name != "scavenging"})
    for speed in omega:
        at, state = scavenged(case, float(speed))
        assert state is not None
        states.append(state)
        there = replace(given, sections={**given.sections, "cycle": at.need("cycle")})
        rows.append(columns_of_cylinder(there, np.array([speed])))
    plain = {
        name: np.concatenate([row[name] for row in rows]) for name in rows[0] if name not in ("fractions", "loads")
    }
    return plain | scavenge_columns(states, omega) | {"loads": {}}


def columns_of_breathing(case: Case, omega: np.ndarray) -> dict[str, Any]:
    """Figures of an engine whose gas exchange is followed, over the speeds, of one cylinder.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]
    """
    return breathing_engine.figures(breathing(case, omega))


def breathing(case: Case, omega: np.ndarray) -> BreathingRun:
    """The cycles of an engine whose gas exchange is followed, for its curves.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]
    """
    with of(case):
        return breathing_engine.run(breathing_with(one_cylinder(case), _friction(case)), omega.tolist())


def columns_of_stirling(case: Case, omega: np.ndarray) -> dict[str, Any]:
    """Figures of a Stirling engine over the speeds, of the whole engine.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Shaft speeds [rad/s]

    Returns
    -------
    columns : dict
        As `engine.columns`, without fuel; works and heats of a turn, temperatures, and under `losses` what is lost [W]
    """
    extremes = _own_extremes if is_own(case.mechanism) else _extremes
    rows = []
    for speed in omega:
        engine = _stirling(case, float(speed))
        rows.append(stirling_columns(engine, float(speed)) | extremes(case, engine, float(speed)))
    columns: dict[str, Any] = {key: np.array([row[key] for row in rows]) for key in rows[0] if key != "losses"}
    shares = {"heat": 1 - columns["efficiency"], "work": columns["efficiency"]}
    none = dict.fromkeys(("exhaust", "unburnt"), np.full(len(rows), np.nan))
    losses = {name: np.array([row["losses"][name] for row in rows]) for name in rows[0]["losses"]}
    return {"speed_rpm": omega / RPM} | columns | {"fractions": shares | none, "loads": {}, "losses": losses}


def _stirling(case: Case, omega: float) -> StirlingEngine:
    if is_own(case.mechanism):
        return own_gas.stirling(case, own.one_coordinate(case), omega)
    with of(case):
        return engine_of_train(case.need("cycle"), case.need("parameters"), omega, case.sections.get("stirling"))


def _extremes(case: Case, engine: StirlingEngine, omega: float) -> dict[str, float]:
    """Largest torque and force on a piston of a train."""
    with of(case):
        found = turn(drive_of(case), gas_of_engine_on(engine, case.need("cycle"), case.need("parameters")), omega)
    force = max(float(np.abs(push).max()) for push in found.inputs.values())
    return {"torque_max": float(found.torque.max()), "force_max": force}


def _own_extremes(case: Case, engine: StirlingEngine, omega: float) -> dict[str, float]:
    """The same of a mechanism from a file."""
    operation = replace(case.need("operation"), speed=omega)
    found = own_turn.turn(replace(case, sections={**case.sections, "operation": operation})).columns
    forces = (np.abs(found[role["force"]]).max() for role in own.roles(case, "piston"))
    return {"torque_max": float(-found["driving_torque"].min()), "force_max": float(max(forces))}


def stirling_curves(case: Case, omega: float) -> dict[str, np.ndarray]:
    """One turn of a Stirling engine, curve by curve, from the first dead centre on.

    Parameters
    ----------
    omega : float
        Shaft speed [rad/s]

    Returns
    -------
    curves : dict of str to ndarray, shape (n,)
        `phi_deg`, `p_pa`, `v_e_m3`, `v_c_m3`, `t_e_k`, `t_c_k`, and `flow_e_kg_s`, `flow_c_kg_s` into the spaces
    """
    found = _stirling(case, omega).turn
    order = np.argsort(np.remainder(found.phi, 2 * np.pi), kind="stable")
    curves = {
        "phi_deg": np.degrees(np.remainder(found.phi, 2 * np.pi)), "p_pa": found.p, "v_e_m3": found.V_e,
        "v_c_m3": found.V_c, "t_e_k": found.T_e, "t_c_k": found.T_c, "flow_e_kg_s": found.flow_e * omega,
        "flow_c_kg_s": found.flow_c * omega,
    }  # fmt: skip
    return {name: values[order] for name, values in curves.items()}


def speed_range(speeds: Speeds) -> np.ndarray:
    """The speeds of a performance map.

    Parameters
    ----------
    speeds : Speeds
        Section `[speeds]` of a case

    Returns
    -------
    omega : ndarray, shape (n,)
        lowest, lowest + step, .. up to highest [rad/s]
    """
    count = int((speeds.highest - speeds.lowest) / speeds.step + 1e-9) + 1
    return speeds.lowest + speeds.step * np.arange(count)
