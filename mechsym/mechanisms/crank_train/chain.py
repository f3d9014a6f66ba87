"""What a crank train says of its forces: a pin and a guide a cylinder, a main bearing a throw."""

import math
from typing import Any

import numpy as np

from mechsym.mechanisms.chain import CrankChain, DriveSeen, GasFace, Loads, Pin, Pressures, Rubbing, TurnSeen
from mechsym.mechanisms.crank_throw import TRAITS as THROW
from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_train.assembly import build, build_driven, build_rigid, listing
from mechsym.mechanisms.crank_train.firing import gas_forces, refuse_wrong_firing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.crank_train.spacing import pitch, span, unequal
from mechsym.mechanisms.proportions import Proportions, Reciprocating
from mechsym.mechanisms.proportions import slider_crank as crank_and_rod
from mechsym.mechanisms.train_drawing import crank_train
from mechsym.mechanisms.traits import Assembled, ElasticShaft, Traits


def _loads(turn: TurnSeen) -> Loads:
    p, R = turn.drive.parameters, turn.reactions
    return Loads(
        pins=tuple(_pin(turn, i) for i in range(len(p.throw))),
        bearings={
            f"main_bearing_{k}": (R[f"main_bearing_force_x_{k}"], R[f"main_bearing_force_y_{k}"])
            for k in sorted(set(p.throw))
        },
        guides={f"side_force_{i + 1}": R[f"side_force_{i + 1}"] for i in range(len(p.throw))},
        weight_torque=_weight(p, turn.phi),
    )


def _pin(turn: TurnSeen, i: int) -> Pin:
    p, R = turn.drive.parameters, turn.reactions
    sense = each(p, "sense")[p.throw[i] - 1]
    return Pin(
        name=f"crank_pin_{i + 1}",
        angle=sense * (turn.phi + each(p, "phase")[i]),
        radius=each(p, "r")[i],
        sense=sense,
        x=-R[f"pin_force_x_{i + 1}"],
        y=-R[f"pin_force_y_{i + 1}"],
    )


def _weight(p: CrankTrainParameters, phi: np.ndarray) -> np.ndarray:
    total = np.zeros_like(phi)
    for u, phase, sense in zip(*(each(p, n) for n in ("u0", "u_phase", "sense")), strict=True):
        total += -p.g * u * sense * np.cos(sense * (phi + phase) + p.axis_tilt)
    return total


def _rubbing(turn: TurnSeen, found: Loads) -> tuple[Rubbing, ...]:
    R, K, w = turn.reactions, turn.kinematics, turn.omega
    rows = []
    for i, pin in enumerate(found.pins, 1):
        swing = K[f"dpsi_{i}_dphi"] * w
        piston_pin = np.hypot(R[f"piston_pin_force_along_{i}"], R[f"piston_pin_force_across_{i}"])
        rows += [
            Rubbing(place="guides", force=found.guides[f"side_force_{i}"], speed=K[f"dx_{i}_dphi"] * w),
            Rubbing(place="piston_pins", force=piston_pin, speed=swing),
            Rubbing(place="crank_pins", force=np.hypot(pin.x, pin.y), speed=w + swing),
        ]
    return tuple(rows)


def _pushes(drive: DriveSeen, net: Pressures, area: float, phi: np.ndarray, period: float) -> dict[str, np.ndarray]:
    return {f"F{i + 1}": force for i, force in enumerate(gas_forces(drive.parameters, net, area, phi, period))}


def _faces(turn: TurnSeen) -> list[tuple[np.ndarray, np.ndarray]]:
    p, w = turn.drive.parameters, turn.omega
    firing = each(p, "firing") or (0.0,) * len(p.throw)
    return [(turn.phi - f, turn.kinematics[f"dx_{i}_dphi"] * w) for i, f in enumerate(firing, 1)]


def _cylinders(p: CrankTrainParameters, faces: Any) -> tuple[GasFace, ...]:
    refuse_wrong_firing(p, 4 * math.pi)
    firing = p.firing if isinstance(p.firing, tuple) else (p.firing,) * len(p.throw)
    rows = enumerate(zip(p.throw, firing, strict=True), 1)
    return tuple(GasFace(input=f"F{i}", throw=throw - 1, fires=float(angle)) for i, (throw, angle) in rows)


def _ends(p: CrankTrainParameters) -> tuple[float, float] | None:
    first, last = min(each(p, "z")), max(each(p, "z"))
    return None if first == last or set(each(p, "sense")) != {1.0} else (first, last)


def _inertia(turn: TurnSeen) -> float:
    p = turn.drive.parameters
    return max(m * r for m, r in zip(each(p, "m_piston"), each(p, "r"), strict=True)) * turn.omega**2


def _advice(turn: TurnSeen, name: str, order: int) -> str:
    p = turn.drive.parameters
    names = ", ".join(f"{math.degrees(a) % 360:g}" for a in each(p, "phase"))
    n = len(set(p.throw))
    if name.startswith("rocking"):
        return f"cranks at {names} deg are no mirror image about the middle of the shaft; order them symmetrically"
    return (
        f"cranks at {names} deg: the arrows exp(i {order} phase) do not add up to zero; {n} equal throws "
        f"{360 / n:g} deg apart cancel every order that is no multiple of {n}"
    )


def _alone(p: CrankTrainParameters) -> tuple[str, CrankThrowParameters]:
    """The first cylinder on a shaft of its own."""
    letters = {n: each(p, n)[0] for n in ("r", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston")}
    assert THROW.alone is not None
    return THROW.alone(CrankThrowParameters(**letters, I0=each(p, "I0")[0]))


def _proportions(p: CrankTrainParameters) -> Proportions:
    masses = p.m_piston if isinstance(p.m_piston, tuple) else (p.m_piston,)
    named = ("m_piston",) if not masses[1:] else tuple(f"m_piston[{i}]" for i in range(len(masses)))
    moving = tuple(Reciprocating(letters=letters, mass=mass) for letters, mass in zip(named, masses, strict=True))
    r, l1, l2, m0, m_rod, piston = (max(each(p, letter)) for letter in ("r", "l1", "l2", "m0", "m_rod", "m_piston"))
    return crank_and_rod(
        r, l1 + l2, moving, mass=m0 + m_rod + piston, shafts={"I0": max(each(p, "I0")), "I_f": p.I_f},
        parts={"I_rod": (max(each(p, "I_rod")), m_rod * (l1 + l2) ** 2)},
        unbalances={"u0": max(each(p, "u0"), key=abs)}, pistons=len(p.throw), pitch=pitch(p), span=span(p),
        unequal=unequal(p),
    )  # fmt: skip


TRAITS = Traits(
    parameters=CrankTrainParameters,
    drawing=crank_train,
    proportions=_proportions,
    chain=CrankChain(
        loads=_loads, rubbing=_rubbing, mass=lambda drive: float(each(drive.parameters, "m_piston")[0]),
        rigid=lambda parameters, closing: build_rigid(parameters), pushes=_pushes, faces=_faces, cylinders=_cylinders,
        fires=lambda drive: each(drive.parameters, "firing"), sense=lambda p: each(p, "sense")[-1], ends=_ends,
        inertia=_inertia, lever=lambda p: float(np.ptp(each(p, "z"))), advice=_advice,
    ),
    assembled=Assembled(part="crank_throw", build=build, build_driven=build_driven, listing=listing),
    shaft=ElasticShaft(
        discs=lambda p: (*each(p, "I0"), p.I_f), springs=lambda p: (each(p, "k"), each(p, "c"))
    ),
    alone=_alone,
)  # fmt: skip
