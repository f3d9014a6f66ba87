"""Case and results -> doubts that no single number tells: gas of a run, forces by its force, bound of efficiency."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds import kind_of
from mechsym.cycle.mixture import ConstantGamma
from mechsym.forces.result import Forces
from mechsym.jobs.gas import gas
from mechsym.jobs.own import is_own
from mechsym.mechanisms.traits import traits_of
from mechsym.plausible import PROPORTIONS, Doubt, proportion, results

# what commands tell of the gas, the key of its limit, and the unit it is told in [SI]
_LIMITED = (("p_max_mpa", "peak_pressure", 1e6), ("p_max_bar", "peak_pressure", 1e5),
            ("t_max_k", "peak_temperature", 1.0), ("knock", "knock", 1.0))  # fmt: skip
PISTON_SPEED = next(kind.highest for kind in PROPORTIONS if kind.code == "piston_speed")  # what is refused [m/s]
_COLD_AIR = 1.4  # no mixture of air, fuel and products has more


def of_gas(case: Case, found: Gas | None) -> tuple[Doubt, ...]:
    """Peak pressure, mean pressure and temperature of the gas that drives a machine; none without gas."""
    if found is None or not found.has_pressure:
        return ()
    pressure = found.pressure
    told = {"p_max_bar": pressure.p_max / 1e5, "mep_bar": pressure.mean_indicated / 1e5}
    told |= {} if pressure.t_max is None else {"t_max_k": pressure.t_max}
    return results(told) + of_limits(case, told)


def of_limits(case: Case, columns: Mapping[str, Any]) -> tuple[Doubt, ...]:
    """Where the gas goes beyond what `[gas_limits]` of the case allows.

    Parameters
    ----------
    columns : mapping of str to float or ndarray
        Any of `p_max_mpa`, `p_max_bar`, `t_max_k` and `knock`, and rows of cycles in `cycles` [MPa, bar, K, -]
    """
    limits, doubts = case.sections.get("gas_limits"), []
    for name, key, unit in _LIMITED if limits is not None else ():
        rows = [row[name] for row in columns.get("cycles", ()) if name in row]
        values = np.asarray(np.append(columns.get(name, ()), rows), float)
        limit = getattr(limits, key)
        if limit is None or not np.any(values[np.isfinite(values)] > limit / unit):
            continue
        why = f"gas_limits.{key} of the case; change the design, or the limit"
        worst = float(np.nanmax(values))
        doubts.append(
            Doubt(code=f"limit_{key}", quantity=name, value=worst, usual=f"at most {limit / unit:g}", why=why)
        )
    return tuple(doubts)


def of_run(case: Case, length: float, fastest: float = 0.0) -> tuple[Doubt, ...]:
    """Doubts of a run in time.

    Parameters
    ----------
    length : float
        How long it ran [s]
    fastest : float
        Highest speed of the crank in it [rad/s]
    """
    wanted, engine = case.sections.get("simulation"), "cycle" in case.sections and not is_own(case.mechanism)
    found = of_gas(case, gas(case)) if engine else ()
    known = traits_of(case.mechanism)
    travel = known.proportions(case.need("parameters")).stroke if known and known.proportions else 0.0
    # refused before a run, doubted as the outcome of one
    speed = min(travel * abs(fastest) / math.pi, PISTON_SPEED)
    found += proportion("piston_speed", "highest mean piston speed of the run", speed)
    if wanted is None or wanted.window is None or not length > 0:
        return found
    return found + proportion("window", "simulation.window / length of the run", wanted.window / length)


def of_forces(case: Case, found: Forces) -> tuple[Doubt, ...]:
    """Doubts of the forces of a turn: its gas, and pins, bearings and guides by the largest gas force."""
    pushes = [float(np.abs(push).max()) for push in found.turn.inputs.values()]
    largest = max((float(np.hypot(x, y).max()) for x, y in _vectors(found)), default=0.0)
    largest = max([largest, *(float(np.abs(side).max()) for side in found.loads.guides.values())])
    doubts = of_gas(case, found.turn.gas) + _driven(case, found)
    if found.turn.gas is None or not max(pushes, default=0.0) > 0:
        return doubts
    return doubts + proportion("force_ratio", "largest bearing force / gas force", largest / max(pushes))


def _driven(case: Case, found: Forces) -> tuple[Doubt, ...]:
    """Whether the gas of a Stirling engine takes work: then its cold piston leads."""
    travel = {f"F{i}": f"dx_{i}_dphi" for i in range(1, len(found.turn.inputs) + 1)}
    if "cycle" not in case.sections or kind_of(case.need("cycle")).given != "train":
        return ()
    turn = found.turn
    work = sum(float(np.mean(turn.inputs[name] * turn.kinematics[dx])) for name, dx in travel.items())
    return proportion("driven", "work of the gas in a turn", work * turn.period)


def _vectors(found: Forces) -> list[tuple[np.ndarray, np.ndarray]]:
    return [*((pin.x, pin.y) for pin in found.loads.pins), *found.loads.bearings.values()]


def of_cycle(case: Case, columns: dict[str, Any]) -> tuple[Doubt, ...]:
    r"""Efficiency by the bound of its cycle.

    .. math:: \eta \le 1 - \varepsilon^{1 - \gamma} \text{ (Otto)}, \qquad \eta \le 1 - T_c/T_e \text{ (Carnot)}

    Parameters
    ----------
    columns : dict
        With `efficiency`; nan where no fuel is known [-]
    """
    best, bound = float(np.nanmax(np.append(columns["efficiency"], -np.inf))), _bound(case)
    beyond = of_limits(case, columns)
    if "work_j" in columns:  # a Stirling engine whose cold piston leads is none
        beyond += proportion("driven", "work of the gas in a turn", float(np.min(columns["work_j"])))
    return beyond + (
        proportion("efficiency_bound", "efficiency / its bound", best / bound) if best > 0 and bound else ()
    )


def _bound(case: Case) -> float | None:
    cycle, given = case.need("cycle"), kind_of(case.need("cycle")).given
    if given == "train":
        return 1 - cycle.T_c / cycle.T_e if cycle.T_e > cycle.T_c else None
    mixture = case.sections.get("gas", ConstantGamma())
    gamma = mixture.gamma if isinstance(mixture, ConstantGamma) and given == "engine" else _COLD_AIR
    ratio = case.need("chamber").compression_ratio if given in ("engine", "breathing") else cycle.compression_ratio
    return float(1 - ratio ** (1 - gamma))
