"""Case -> cycle: figures over the speeds, of one cylinder and of the whole engine with pistons alike or not."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.cases.needs import require
from mechsym.cases.settings import Speeds
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.columns import CycleFigures
from mechsym.cycle.friction import Friction, MechanismFriction, NoFriction
from mechsym.cycle.kinds import KINDS, four_stroke, kind_of
from mechsym.cycle.motion import from_top, slopes
from mechsym.cycle.source import Progress, unseen
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.jobs.gas import charged, engine_with, of, one_cylinder, source
from mechsym.jobs.machine import fitted_law, one_coordinate, torque, turn
from mechsym.mechanisms.plan import plan_of
from mechsym.quantities import record
from mechsym.quantities.units import Array, RadPerSecond

_ADD = ("torque_avg", "power_kw", "brake_torque", "brake_power_kw")
_NOT_LARGER = "torque_max"
_ALIKE = 1e-9  # of the stroke: pistons whose travels differ by less move alike
_NEARLY = 0.03  # of the stroke: rods that hang on others change it by up to 1 %


@record
class CylinderCount:
    """The cylinders of an engine as its cycle counts them."""

    count: int  #: Chambers of a crank train, working faces of a rodless engine
    share: float  #: What one cylinder's figures are multiplied with for the engine [-]
    each: str = "cylinder"  #: What is counted: a cylinder, or a piston where two share one
    apart: float = 0.0  #: By how much strokes differ from that of the first, all taken as that one [-]


def cylinders(case: Case) -> CylinderCount:
    """The cylinders of a case.

    Raises BadInput: They fire off their dead centres, strokes differ, or the pistons of a chamber do not divide them.
    """
    parameters, plan = case.need("parameters"), plan_of(case.mechanism)
    roles = plan.parts(parameters)
    if "faces" in case.sections and roles.chosen:
        areas = case.need("faces").areas
        bore = getattr(case.sections.get("chamber"), "bore", None) or case.need("cycle").bore
        return CylinderCount(count=len(areas), share=sum(areas) / (math.pi / 4 * float(bore) ** 2))
    with of(case):
        plan.require_firing(parameters, 4 * math.pi if four_stroke(case.need("cycle")) else 2 * math.pi)
    other, strokes, apart = other_piston(case), np.ones(len(roles.heads)), 0.0
    if other:
        strokes = np.array([np.ptp(travel) for travel in piston_travels(case, 1441).values()])
        apart = float(np.abs(strokes / strokes[0] - 1).max())
    if other and not 0 < apart < _NEARLY:
        alone = "'mechsym cycle' without --over, "
        raise BadInput(
            f"{case.file}: piston {other} moves otherwise than {roles.heads[0].name}: this is computed for one of them "
            f"and holds for equal cylinders; use {'' if roles.faces else alone}'mechsym forces' or 'mechsym simulate'"
        )
    all_of, sharing = len(roles.heads), _sharing(case)
    if all_of % sharing and roles.faces:
        raise BadInput(
            f"{case.file}: [chamber] pistons = {sharing} does not divide the {all_of} cylinders; give 1 or a divisor"
        )
    count = max(1, all_of // sharing)
    each = "piston" if roles.opposed else "cylinder"
    share = count * float(strokes.mean() / strokes[0])
    return CylinderCount(count=count, share=share, each=each, apart=apart)


def _sharing(case: Case) -> int:
    """Pistons that share a chamber."""
    return int(getattr(case.sections.get("chamber"), "pistons", 1))


def piston_travels(case: Case, points: int = 73) -> dict[str, np.ndarray]:
    """Travel of each piston over a turn, from its own top dead centre on [m]; none where a case chooses its faces."""
    roles = plan_of(case.mechanism).parts(case.need("parameters"))
    heads = {head.name: head.travel for head in roles.heads}
    with of(case):
        mechanism = one_coordinate(case)
        moved = {name: from_top(slopes(mechanism, travel, {})) for name, travel in heads.items()}
    phi = np.linspace(0, 2 * math.pi, points)[None, :]
    return {name: np.asarray(travel.call([phi])[0]).ravel() for name, travel in moved.items()}


def other_piston(case: Case) -> str:
    """The first piston that moves otherwise than the first one; empty where all move alike."""
    if len(plan_of(case.mechanism).parts(case.need("parameters")).heads) < 2:
        return ""
    travels = piston_travels(case)
    first = next(iter(travels.values()))
    far = (n for n, travel in travels.items() if np.abs(travel - first).max() > _ALIKE * np.ptp(first))
    return next(far, "")


def of_engine(case: Case, figures: Json, omega: Sequence[RadPerSecond] | RadPerSecond[Array] | None) -> Json:
    """Figures of the whole engine from those of one cylinder (`cycle.columns`), which stand beside them.

    omega: crank speeds; None leaves the largest torque of several cylinders open. Returns figures: the same columns for
    the engine, `cylinders`, and `per_cylinder` with those that differ.
    """
    counted = cylinders(case)
    own = {name: figures[name] for name in (*_ADD, _NOT_LARGER) if name in figures}
    if counted.count == 1:
        # what stands in for one cylinder has not the mass of all that moves
        stands_in = one_cylinder(case).mechanism != case.mechanism
        known = "faces" in case.sections or not mechanisms.roles_of(case.mechanism).chosen
        if stands_in and known and omega is not None and _NOT_LARGER in figures:
            figures = {**figures, _NOT_LARGER: largest_torque(case, omega)}
        return {**figures, "cylinders": 1, "each": counted.each, "per_cylinder": own}
    whole = {name: np.asarray(figures[name]) * counted.share for name in _ADD if name in figures}
    whole[_NOT_LARGER] = (
        np.full(np.shape(figures[_NOT_LARGER]), np.nan) if omega is None else largest_torque(case, omega)
    )
    return {**figures, **whole, "cylinders": counted.count, "each": counted.each, "per_cylinder": own}


def largest_torque(case: Case, omega: Sequence[float] | np.ndarray) -> np.ndarray:
    """Largest torque of the whole mechanism on the shaft at each of some speeds [rad/s]: [N*m]."""
    return np.array([float(torque(_at(case, float(speed))).max()) for speed in omega])


def _at(case: Case, speed: float) -> Case:
    operation = replace(case.need("operation"), speed=speed)
    return replace(case, sections={**case.sections, "operation": operation})


_SUMMED = ("torque_avg", "power_kw", "brake_torque", "brake_power_kw", "air_kg_h")
_BY_VOLUME = ("mep_kpa", "gross_mep_kpa", "brake_mep_kpa", "friction_mep_kpa", "pumping_mep_kpa",
              "volumetric_efficiency")  # fmt: skip
_BY_HEAT = ("efficiency", "brake_efficiency")
_BY_POWER = {"sfc_g_kwh": "power_kw", "brake_sfc_g_kwh": "brake_power_kw", "trapping_efficiency": "air_kg_h",
             "mechanical_efficiency": "power_kw"}  # fmt: skip
_RESIDUALS = ("energy_residual", "mass_residual")
_AT_PEAK = ("p_max_angle_deg", "ca10_deg", "ca50_deg", "ca90_deg")  # of the piston with the largest pressure
_ONLY = ("speed_rpm", "fractions", "loads")  # of every piston the same, or put together by itself


def unlike_pistons(case: Case, omega: RadPerSecond[Array], friction: Friction) -> Json:
    """Figures of an engine from a file whose pistons do not move alike.

    Returns figures: as `mechsym.jobs.cycle`, with `pistons`: the figures of each by its name in the declaration. Raises
    BadInput: Pistons that share a chamber, or gas that a turbocharger changes.
    """
    if _sharing(case) != 1 or charged(case):
        raise BadInput(
            f"{case.file}: the pistons move differently: the figures of each hold with a chamber and an inlet of its "
            "own; set chamber.pistons = 1 and leave out [scavenging], or use 'mechsym simulate'"
        )
    travels = piston_travels(case)
    with of(case):
        rows = {name: source(case, friction, number).figures(omega) for number, name in enumerate(travels)}
    swept = np.array([np.ptp(travel) for travel in travels.values()])
    together = {"speed_rpm": next(iter(rows.values()))["speed_rpm"], **_together(list(rows.values()), swept)}
    together["torque_max"] = largest_torque(case, omega)
    alone = {name: {k: v for k, v in row.items() if k not in _ONLY} for name, row in rows.items()}
    return together | {"loads": {}, "cylinders": len(rows), "per_cylinder": {}, "pistons": alone}


def _together(rows: list[Json], swept: np.ndarray) -> Json:
    """Figures of the engine from those of its pistons and what each sweeps [m]."""
    stacked = {k: np.array([row[k] for row in rows]) for k in rows[0] if k not in _ONLY}
    power = stacked["power_kw"]
    with np.errstate(divide="ignore", invalid="ignore"):
        heat = power / stacked["efficiency"]  # nan without fuel
    weights = dict.fromkeys(_BY_VOLUME, np.broadcast_to(swept[:, None], power.shape))
    weights |= dict.fromkeys(_BY_HEAT, heat) | {k: stacked[by] for k, by in _BY_POWER.items() if by in stacked}
    highest = np.argmax(stacked["p_max_mpa"], axis=0)
    joined: Json = {}
    for name, values in stacked.items():
        if name in _SUMMED:
            joined[name] = values.sum(axis=0)
        elif name in weights:
            joined[name] = _mean(values, weights[name])
        elif name in _AT_PEAK or name in _RESIDUALS:
            place = highest if name in _AT_PEAK else np.argmax(np.abs(values), axis=0)
            joined[name] = np.take_along_axis(values, place[None, :], axis=0)[0]
        else:
            joined[name] = values.max(axis=0)
    shares = rows[0]["fractions"]
    joined["fractions"] = {k: _mean(np.array([row["fractions"][k] for row in rows]), heat) for k in shares}
    return joined


def _mean(values: np.ndarray, weights: np.ndarray) -> np.ndarray:
    return (values * weights).sum(axis=0) / weights.sum(axis=0)


_FRICTION_SPEEDS = (0.25, 0.5, 0.75, 1.0)  # of the speed of operation, where a mechanism's friction is looked up
_BEHIND = ("fractions", "loads", "losses")  # what stands behind the columns


def cycle(case: Case, omega: RadPerSecond[Array] | None = None, progress: Progress = unseen) -> CycleFigures:
    """Figures of the engine cycle of a case, at its speed of operation or over several.

    case: with `[cycle]` of any kind that follows no measured diagram; progress: called with the number of points done
    after each block of them.
    Returns columns: arrays under the names of `mechsym cycle`, `speed_rpm`, `torque_avg`, `power_kw`, `efficiency` and
    so on, of the engine; `per_cylinder` of one cylinder, or `pistons` of each where they move differently.

    >>> from mechsym import cases
    >>> result = cycle(cases.load("zotov-89"))
    >>> round(float(result["power_kw"][0]), 2), result.view.cards[1].value
    (83.88, '83.88 kW')
    """
    require(case, "cycle")
    speeds = np.array([case.need("operation").speed]) if omega is None else omega
    kind = kind_of(case.need("cycle"))
    if kind.measured:
        known = ", ".join(sorted(name for name, row in KINDS.items() if not row.measured))
        why = f"[cycle] is of no kind with figures over the speed; kinds are {known} and, with --diagram, diagram"
        raise BadInput(f"{case.file}: {why}")
    friction = NoFriction() if kind.shared else _friction(case)
    if kind.shared:
        gas = source(case, friction)
        with of(case):
            figures = CycleFigures(_with_extremes(case, speeds, gas.figures(speeds, progress)))
    elif mechanisms.roles_of(case.mechanism).pistons and other_piston(case):
        return CycleFigures(unlike_pistons(case, speeds, friction))
    else:
        counted = cylinders(case)  # what is wrong with them is said before the work begins
        gas = source(one_cylinder(case), friction)
        with of(case):
            alone = gas.figures(speeds, progress)
        figures = CycleFigures(of_engine(case, alone, speeds))
        figures.apart = counted.apart
    figures.source = gas
    return figures


def engine(case: Case) -> ClosedEngine:
    """The engine that a case describes.

    case: as for `engine_with`; `[friction_pressure]` defaults to no friction, its law `mechanism` is fitted to the
    case's `[friction]`. Raises BadInput: a section is missing, or the cycle is of another kind.
    """
    return engine_with(case, _friction(case))


def _friction(case: Case) -> Friction:
    law = case.sections.get("friction_pressure", NoFriction())
    if not isinstance(law, MechanismFriction):
        return law
    # the friction hangs on the gas forces, and those not on the friction
    plain = replace(case, sections={**case.sections, "friction_pressure": NoFriction()})
    return fitted_law(plain, case.need("operation").speed * np.array(_FRICTION_SPEEDS)).law


def _with_extremes(case: Case, omega: np.ndarray, figures: Json) -> Json:
    """Figures of pistons that share a gas with the largest torque and force on a piston."""
    turns = [turn(_at(case, speed)) for speed in map(float, omega)]
    forces = [max(float(np.abs(one.inputs[a.face.input]).max()) for a in one.acting) for one in turns]
    behind = {name: figures.pop(name) for name in _BEHIND}
    largest = {"torque_max": np.array([float(one.torque.max()) for one in turns]), "force_max": np.array(forces)}
    return figures | largest | behind


def speed_range(speeds: Speeds) -> RadPerSecond[Array]:
    """Speeds of a performance map from section `[speeds]`: lowest, lowest + step.. up to highest."""
    count = int((speeds.highest - speeds.lowest) / speeds.step + 1e-9) + 1
    return speeds.lowest + speeds.step * np.arange(count)
