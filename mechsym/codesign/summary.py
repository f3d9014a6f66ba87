"""A co-design in numbers: the keys of `mechsym codesign --json`, and its text."""

from typing import Any

import numpy as np

from mechsym.codesign.front import CutForOne
from mechsym.codesign.hardware import rollers_at_rest
from mechsym.codesign.loss import KINDS, relaxation_time
from mechsym.codesign.peers import Rival
from mechsym.codesign.rank import Bound, flywheel_bound
from mechsym.codesign.result import CoDesignResult
from mechsym.codesign.task import CoDesign, CoDesignTask
from mechsym.codesign.verify import GuideLoads, Verified
from mechsym.quantities import RPM
from mechsym.quantities.display import figure, unit_for
from mechsym.quantities.units import scale


def summary(result: CoDesignResult) -> dict[str, Any]:
    """The result as `mechsym codesign --json` prints it."""
    return {
        **found(result.design, result.verified),
        **limits_of_any_guide(result.design.task, result.bound, result.bare, result.cut),
        **what_it_costs(result),
        "misfire_speed_share": list(result.misfire),
        "pareto": [row(design) for design in result.front],
        **({"peers": [peer(p) for p in result.peers]} if result.peers else {}),
        "doubts": [],
    }


def found(design: CoDesign, verified: Verified) -> dict[str, Any]:
    """What was found, and by which ways it was checked."""
    task = design.task
    return {
        "status": design.status,
        "reason": design.reason,
        "feasible": design.status == "optimal" and not verified.broken,
        "flywheel_inertia": design.flywheel,
        "speed_rpm": [p.omega / RPM for p in task.points],
        "load": [p.load for p in task.points],
        "load_torque": [p.load_torque for p in task.points],
        "speed_ripple": design.ripple.tolist(),
        "p0": [track.p0.tolist() for track in design.tracks],
        "active": [{"limit": a.limit, "multiplier": a.multiplier, "unit": a.unit} for a in design.active],
        "verified": {
            "steady_ripple": _numbers(verified.steady_ripple),
            "time_ripple": _numbers(verified.time_ripple),
            "energy_residual": _numbers(verified.energy_residual),
            "difference": verified.difference,
            "broken": list(verified.broken),
            "used": dict(verified.used),
        },
        "guides": [guide(c, design, s) for s, c in enumerate(verified.contacts)],
        "iterations": design.iterations,
        "wall_s": design.wall,
    }


def guide(contact: GuideLoads, design: CoDesign, s: int) -> dict[str, Any]:
    """Dimensions of one guide, and what it asks of its rollers at all points together."""
    h = design.tracks[s].hardware
    return {
        "A": h.A, "H": h.H, "rho0": h.rho0, "roller_radius": h.radius, "roller_width": h.width,
        "moving_mass": h.moving_mass, "rho_min": contact.rho_min, "rho_max": contact.rho_max, "z_min": contact.z_min,
        "z_max": contact.z_max, "pressure_angle_max": contact.pressure_angle_max,
        "spring_pressure_max": float(contact.pressure_max.max()),
        "roller_reaction_max": float(contact.reaction_max.max()),
        "roller_reaction_min": float(contact.reaction_min.min()),
        "hertz_stress_max": float(contact.hertz_max.max()), "side_force_max": float(contact.side_force_max.max()),
    }  # fmt: skip


def limits_of_any_guide(task: CoDesignTask, bound: Bound, bare: float, cut: CutForOne) -> dict[str, Any]:
    """The bound, and what stands beside a co-design: `bare` is the flywheel [kg*m^2] without a hinge."""
    return {
        "flywheel_inertia_bare": bare,
        "flywheel_inertia_cut_for_one": cut.flywheel,
        "bound": {
            "singular_values": bound.singular_values.tolist(),
            "swing": list(bound.swing),
            "swing_bare": bound.bare,
            "flywheel": flywheel_bound(task.points, bound, task.ripple, rollers_at_rest(task.hardware)),
            "springs_that_pay": bound.pays,
        },
    }


def what_it_costs(result: CoDesignResult) -> dict[str, Any]:
    """Losses at each point, as torques and as shares of the load's torque, with what was assumed for them."""
    design, lost, assumed = result.design, result.losses, result.assumed
    loads = np.array([abs(p.load_torque) for p in design.task.points])
    torques = {kind: np.array([getattr(at, kind) for at in lost]) for kind in KINDS}
    total = sum(torques.values())
    return {
        "losses": {
            **{kind: value.tolist() for kind, value in torques.items()},
            "share": (total / loads).tolist(),
            "shaft_efficiency": (1 - total / loads).tolist(),
            "extra_fuel": (total / np.maximum(loads - total, 1e-30)).tolist(),
            "in_programme": design.task.losses is not None,
            "speed_ripple": [at.ripple for at in result.lossy],
            "time_ripple": [at.time_ripple for at in result.lossy],
            "energy_residual": [at.energy_residual for at in result.lossy],
            "fill": [at.fill for at in result.lossy],
            "assumed": {
                "bearing_mu": assumed.bearing_mu,
                "bearing_radius": assumed.bearing_radius or design.tracks[0].hardware.radius / 2,
                "seal_mu": assumed.seal_mu, "guide_mu": assumed.guide_mu,
                "tau": [relaxation_time(design.tracks[0].hardware.n, p.omega, assumed) for p in design.task.points],
            },
        }
    }  # fmt: skip


def row(design: CoDesign) -> dict[str, Any]:
    """One point of a front."""
    return {
        "ripple": design.task.ripple, "flywheel_inertia": design.flywheel, "status": design.status,
        "reason": design.reason,
    }  # fmt: skip


def peer(found: Rival) -> dict[str, Any]:
    """Another machine at one ripple."""
    return {"name": found.name, "ripple": found.ripple, "flywheel_inertia": found.flywheel, "about": found.about}


def _numbers(values: np.ndarray) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]


def prices(numbers: dict[str, Any]) -> list[tuple[str, str]]:
    """Each limit that is met with a unit of it for people, and what one such unit more changes the flywheel by."""
    rows = []
    for active in numbers["active"]:
        unit = "%" if active["limit"] == "ripple" else unit_for(active["unit"], 1e3)
        worth = active["multiplier"] * (0.01 if unit == "%" else scale(unit) / scale(active["unit"]))
        rows.append((f"{active['limit'].replace('_', ' ')}, 1 {unit} more", f"{figure(worth, 4)} kg*m^2"))
    return rows
