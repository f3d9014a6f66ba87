"""The numbers of a hinge design under the keys that scripts rely on, and its tables for files."""

import dataclasses
from collections.abc import Callable, Collection
from typing import Any

import numpy as np

from mechsym.hinge.contact import Contact, at_angles
from mechsym.hinge.result import AtLoad, Design, JudgedHinge
from mechsym.hinge.rollers import parallel
from mechsym.hinge.steady import RIPPLE
from mechsym.hinge.ways import Offer
from mechsym.machine.record import gas_of
from mechsym.quantities import RPM


def summary(design: Design | JudgedHinge, only: Collection[str] | None = None) -> dict[str, Any]:
    """Results of a design by name, in SI unless a key names another unit.

    Parameters
    ----------
    design : Design or JudgedHinge
        The second has what `QUICK` asks for
    only : collection of str, optional
        Keys that are wanted; what the others need is not computed

    Returns
    -------
    summary : dict
        Keys of the command `hinge`; what was not reached is None
    """
    return {key: value(design) for key, value in _VALUES.items() if only is None or key in only}


def _guide(design: Design | JudgedHinge) -> dict[str, Any]:
    verdict = design.verdict
    numbers = (
        "rho_min", "rho_max", "z_min", "z_max", "pressure_angle_max", "curvature_radius_min", "roller_reaction_max",
        "spring_force_max", "spring_pressure_max", "hertz_stress_max", "tilting_couple_max", "undercut_radius",
    )  # fmt: skip
    return {
        "feasible": verdict.feasible,
        "reason": verdict.reason,
        "margin": verdict.margin,
        **{key: getattr(verdict, key) for key in numbers},
    }


def _check(design: Design) -> dict[str, Any]:
    check = design.check
    return {
        "speed_ripple": check.speed_ripple if check else None,
        "energy_residual": check.result.energy.residual if check else None,
        "tolerance_difference": check.result.tolerance_difference if check else None,
        "losses": dict(check.losses) if check and check.losses else None,
    }


def offers(design: Design) -> list[dict[str, Any]]:
    """The ways to balance the torque, with the ripple that each leaves; two for a four-stroke engine."""
    chosen = Offer(balance=design.balance, guide=design.guide, verdict=design.verdict)
    return [
        {
            "balance": offer.balance.kind,
            "shaft_ratio": offer.guide.parameters.shaft_ratio,
            "feasible": offer.verdict.feasible,
            "reason": offer.verdict.reason,
            "work_left": offer.balance.rest_swing,
            "ripple_constant_load": offer.balance.ripple_constant_load,
            "ripple_propeller_load": offer.balance.ripple_propeller_load,
        }
        for offer in (chosen, *design.instead)
    ]


def _losses(design: Design) -> dict[str, Any] | None:
    """What the flywheel saved does not say: losses in N m and shares of the load."""
    price = design.price
    if price is None:
        return None
    kinds = ("bearing", "seal", "guide", "rolling", "gas")
    torques = {kind: getattr(price.losses, kind) for kind in kinds}
    load = abs(design.hinge.load_torque) or None  # no share of a load where there is none
    assumed = {f.name: getattr(price.assumed, f.name) for f in dataclasses.fields(price.assumed)}
    return {
        **torques,
        "total": price.losses.total,
        "shares": {kind: value / load if load else None for kind, value in torques.items()},
        "share": price.losses.total / load if load else None,
        "speed_ripple": price.speed_ripple,
        "fill": price.fill,
        "gas_index": price.gas_index,
        "assumed": assumed | {"bearing_radius": price.assumed.bearing_radius or design.rollers.radius / 2,
                              "tau": price.tau},
    }  # fmt: skip


def _run(trial: Any) -> dict[str, Any]:
    event = trial.result.event
    where = None if event is None else {"name": event.name, "t": event.t, "phi": event.state["phi"]}
    residual = trial.result.energy.residual
    return {"about": trial.about, "speed_ripple": trial.speed_ripple, "energy_residual": residual, "event": where}


def _retune(design: Design) -> dict[str, Any]:
    again = design.retuned
    if again is None:
        return {"speed_rpm": None, "p0": None, "speed_ripple": None}
    wanted, hinge = again.wanted, design.hinge
    peaks = [max(abs(h.torque_max), abs(h.torque_min)) for h in (wanted, hinge)]
    return {
        "speed_rpm": again.other.omega / RPM,
        "p0": again.setting,
        "p0_ratio": again.ratio,
        "speed_ripple": again.steady.speed_ripple,
        "speed_ripple_paper_factor": again.paper.speed_ripple,
        "torque_ratio_max": wanted.torque_max / hinge.torque_max,
        "torque_ratio_min": wanted.torque_min / hinge.torque_min,
        "torque_ratio_peak": peaks[0] / peaks[1],
    }


def _at_load(row: AtLoad) -> dict[str, Any]:
    return {
        "share": row.share,
        "mep_bar": row.mean_indicated_pressure / 1e5,
        "speed_ripple": row.as_cut.speed_ripple,
        "reason": row.as_cut.reason,
        "p0": row.setting,
        "p0_ratio": row.ratio,
        "speed_ripple_reset": row.reset.speed_ripple,
        "reason_reset": row.reset.reason,
    }


def guide_turn(design: Design, points: int = 721) -> Contact:
    """The guide in numbers over a whole turn of its shaft.

    Parameters
    ----------
    points : int
        Number of angles, both ends included
    """
    theta = np.linspace(0, 2 * np.pi, points)
    return at_angles(design.guide, design.rollers, theta)


def hinge_columns(design: Design, points: int = 721) -> dict[str, np.ndarray]:
    """Table of the hinge over a period of the crank.

    Parameters
    ----------
    points : int
        Number of angles, both ends included
    """
    hinge = design.hinge
    phi = np.linspace(0, hinge.period, points)
    gas = gas_of(design.machine)
    pressed = {"pressure": gas.pressure.absolute(phi), "piston_force": gas.force(phi)} if gas.has_pressure else {}
    return {
        "phi": phi,
        **pressed,
        "hinge_torque": hinge.torque(phi),
        "inertia_part": hinge.inertia_part(phi),
        "gas_part": hinge.gas_part(phi),
        "gravity_part": hinge.gravity_part(phi),
        "hinge_work": hinge.work(phi),
        "inertia": hinge.inertia(phi),
    }


def guide_columns(design: Design, contact: Contact) -> dict[str, np.ndarray]:
    """Table of the guide over a turn of its shaft: path, cut profile, contact.

    Returns
    -------
    columns : dict of str to ndarray
        SI units; the profile is in the frame of the track
    """
    x, y = parallel(contact.rho, contact.drho, contact.theta, design.rollers.radius)
    columns = {
        "theta": contact.theta, "phi": contact.phi, "rho": contact.rho, "drho_dtheta": contact.drho,
        "profile_x": x, "profile_y": y, "z": contact.z, "spring_force": contact.force,
        "pressure_angle": contact.pressure_angle, "curvature": contact.curvature,
        "roller_reaction_1": contact.reaction_1, "roller_reaction_2": contact.reaction_2,
        "hertz_stress": contact.hertz_stress, "torque": contact.torque,
    }  # fmt: skip
    return columns | ({} if contact.pressure is None else {"spring_excess_pressure": contact.pressure})


_VALUES: dict[str, Callable[[Any], Any]] = {
    "speed_rpm": lambda d: d.machine.omega / RPM,
    "p_max_bar": lambda d: gas_of(d.machine).pressure.p_max / 1e5 if gas_of(d.machine).has_pressure else None,
    "mep_bar": lambda d: gas_of(d.machine).pressure.mean_indicated / 1e5 if gas_of(d.machine).has_pressure else None,
    "load_torque": lambda d: d.hinge.load_torque,
    "hinge_torque_max": lambda d: d.hinge.torque_max,
    "hinge_torque_min": lambda d: d.hinge.torque_min,
    "hinge_torque_mean": lambda d: d.hinge.mean_torque,
    "hinge_work_max": lambda d: d.hinge.work_max,
    "hinge_work_min": lambda d: d.hinge.work_min,
    "guide": _guide,
    "check": _check,
    "offers": offers,
    "runs": lambda d: {t.name: _run(t) for t in d.trials},
    "retune": _retune,
    "sensitivity": lambda d: {s.name: [s.low.speed_ripple, s.high.speed_ripple] for s in d.sensitivities},
    "loads": lambda d: [_at_load(row) for row in d.loads],
    # the engine already carries the flywheel that is kept, so what is missing without hinge comes on top of it
    "flywheel_inertia_saved": lambda d: d.flywheels.steady.inertia,
    "losses": _losses,
    "misfire_speed_share": lambda d: getattr(d.price, "misfire_speed_share", None),
    "flywheel_inertia_to_turn": lambda d: d.flywheels.turns.inertia,
    "flywheel_inertia_beside_faulty": lambda d: getattr(d.beside_faulty, "inertia", None),
    "ripple_wanted": lambda d: RIPPLE,
}
KEYS = tuple(_VALUES)
#: Keys that need no run besides what all guides of one engine share: a hundredth of the time of all
QUICK = (
    "speed_rpm", "p_max_bar", "mep_bar", "load_torque", "hinge_torque_max", "hinge_torque_min", "hinge_torque_mean",
    "hinge_work_max", "hinge_work_min", "guide", "flywheel_inertia_saved", "flywheel_inertia_to_turn", "ripple_wanted",
)  # fmt: skip
