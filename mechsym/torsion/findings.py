"""A start-up in sentences and in numbers: what held it, whether the model bears it, and what the source says."""

import math
from typing import Any

from mechsym.quantities.display import figure, quantity_text
from mechsym.torsion.startup import StartUp

_HIGHEST = 4  # orders above are too weak to speak of


def findings(found: StartUp) -> tuple[str, ...]:
    """What happens and whether the model bears it."""
    end = float(found.result.t[-1])
    return (
        f"natural frequency {_hertz(found.natural_bare)} bare, {_hertz(found.natural)} with the mean reciprocating "
        "inertia",
        f"a rigid shaft would gain {_speed(found.rigid_rate)} each second and reach {_speed(_rigid(found, end))} at "
        f"{end:g} s at most",
        *_passages(found),
        *_validity(found),
        *_claim(found),
    )


def numbers(found: StartUp) -> dict[str, Any]:
    """The numbers of a start-up, for files and scripts."""
    pairs = zip(found.criticals, found.holding_damping, strict=True)
    return {
        "c1": found.c1,
        "natural_bare": found.natural_bare,
        "natural": found.natural,
        "rigid_speed_end": _rigid(found, float(found.result.t[-1])),
        "criticals": [{"order": c.order, "speed": c.speed, "held_below_c1": d} for c, d in pairs],
        "captures": [
            {"order": c.critical.order, "t_start": c.t_start, "t_end": c.t_end, "released": c.released}
            for c in found.captures
        ],
        "speed_mean_end": float(found.speed_mean[-1]),
        "speed_min": found.speed_min,
        "speed_max": found.speed_max,
        "twist_peak": found.twist_peak,
        "torque_peak": found.torque_peak,
        "model_holds": found.twist_peak <= found.claim.twist_limit,
        "energy_residual": found.result.energy.residual,
        "tolerance_difference": found.result.tolerance_difference,
        "status": found.result.status,
    }


def _speed(value: float) -> str:
    return quantity_text(value, "rad/s", 4)


def _hertz(value: float) -> str:
    return f"{figure(value / math.tau, 4)} Hz"


def _rigid(found: StartUp, t: float) -> float:
    return found.rigid_rate * max(t - found.drive.time, 0.0)


def _passages(found: StartUp) -> list[str]:
    lines, held = [], {c.critical.order for c in found.captures}
    reached = float(found.speed_mean.max())
    for critical, damping in zip(found.criticals, found.holding_damping, strict=True):
        if critical.order in held:
            lines.append(
                f"order {critical.order:g} can hold a drive of {found.drive.torque:g} N*m at "
                f"{_speed(critical.speed)} while c1 < {damping:.3f} N*m*s/rad (c1 = {found.c1:g})"
            )
        elif critical.speed < reached and critical.order <= _HIGHEST:
            lines.append(f"order {critical.order:g} at {_speed(critical.speed)} is passed")
    for c in found.captures:
        left = "then leaves it" if c.released else "and is still held at the end"
        lines.append(
            f"from {c.t_start:.1f} s to {c.t_end:.1f} s the shaft is held at order {c.critical.order:g}, "
            f"{_speed(c.critical.speed)}: the drive feeds the vibration, not the speed; {left}"
        )
    return lines or ["no resonance is reached"]


def _validity(found: StartUp) -> list[str]:
    times = found.torque_peak / abs(found.drive.torque) if found.drive.torque else float("inf")
    lines = [
        f"largest twist {quantity_text(found.twist_peak, 'rad', 3)}, shaft torque "
        f"{quantity_text(found.torque_peak, 'N*m', 4)}, {figure(times, 3)} times the drive's"
    ]
    limit = found.claim.twist_limit
    if found.twist_peak > limit:
        lines.append(
            f"the model does not hold: the twist is beyond {quantity_text(limit, 'rad', 3)}, no linear spring nor a "
            "whole shaft"
        )
    if found.speed_min < -1e-3 * found.speed_max:
        lines.append(f"the crank runs backwards within a turn (down to {_speed(found.speed_min)})")
    return lines


def _claim(found: StartUp) -> list[str]:
    speed, since, end = found.claim.claim_speed, found.claim.claim_time, float(found.result.t[-1])
    if speed is None or since is None:
        return []
    allowed = _rigid(found, max(since, end))
    line = (
        f"the source's {speed:g} rad/s ({_speed(speed)}) from {since:g} s on is "
        f"{'beyond' if speed > allowed else 'within'} what the drive's work allows ({_speed(_rigid(found, since))} "
        f"then, {_speed(allowed)} at {max(since, end):g} s)"
    )
    after = found.t >= since
    if after.any():
        low, high = found.speed_mean[after].min(), found.speed_mean[after].max()
        line += (
            f"; the mean speed found there is {_speed(float(low))} to {_speed(float(high))}, and the crank peaks at "
            f"{_speed(found.speed_max)} in the whole run"
        )
    return [line]
