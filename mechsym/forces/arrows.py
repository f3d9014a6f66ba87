"""What acts on a machine that turns in a page: gas in its cylinders, and what presses in its joints, as arrows."""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from mechsym.cycle.motion import travel_of
from mechsym.files import Json
from mechsym.forces.turn import Acting, CrankDrive, Turn
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import listing
from mechsym.mechanisms.roles import BearingRole, GuideRole
from mechsym.mechanisms.turning import FRAMES, Load, Pushed, corners, filled, pushed

_ALIKE = 0.02  # of its radius: a crank that is drawn so near stands for a crank pin
_Role = BearingRole | GuideRole


def charged(shown: Json, drive: CrankDrive, acting: Sequence[Acting]) -> Json:
    """The scene of a drive with the gas of its cylinders."""
    if not acting:
        return shown
    phi = np.linspace(0, 2 * math.pi * shown["turns"], shown["count"], endpoint=False)[None, :]
    turns = max(round(one.gas.pressure.period / (2 * math.pi)) for one in acting)
    whole = np.linspace(0, 2 * math.pi * turns, turns * FRAMES, endpoint=False)
    charges = [
        Pushed(
            travel=one.face.sense * np.asarray(travel_of(drive.mechanism, one.face.travel)(phi)[0]).ravel(),
            force=one.face.sense * one.force(whole),
        )
        for one in acting
    ]
    return filled(shown, charges)


def pressed(shown: Json, turn: Turn) -> Json:
    """A scene with what presses in the joints that it draws: pins, slides, guides and main bearings."""
    phi = np.linspace(0, 2 * math.pi * shown["turns"], shown["count"], endpoint=False)
    R = {name: np.interp(phi, turn.phi, values, period=turn.period) for name, values in turn.reactions.items()}
    linked = listing(plan_of(turn.drive.name).theory).get("pins")
    return pushed(shown, [*(_of_links(turn.drive, phi, R) if linked else _of_sketch(shown, turn.drive, phi, R))])


def _of_links(drive: CrankDrive, phi: np.ndarray, R: Mapping[str, np.ndarray]) -> Iterator[Load]:
    """Joints of links, of which the derived code says where they are."""
    said, function = listing(plan_of(drive.name).theory), drive.mechanism.functions["drawing"]
    rows = [dict(zip(function.name_out(), map(float, function.call([at])), strict=True)) for at in phi]
    for name, names in said["pins"].items():
        held = [f"R_{axis}_{name}" for axis in ("xy" if len(names) == 2 else "n")]
        if R.keys() >= {*held}:
            pairs = zip(names[::2], names[1::2], strict=True)
            at, *ahead = (np.array([row[x] + 1j * row[y] for row in rows]) for x, y in pairs)
            along = (ahead[0] - at) / np.abs(ahead[0] - at) if ahead else None
            force = R[held[0]] + 1j * R[held[1]] if along is None else R[held[0]] * along
            yield Load(name=said["reactions"][held[0]], at=at, force=force)


def _of_sketch(shown: Json, drive: CrankDrive, phi: np.ndarray, R: Mapping[str, np.ndarray]) -> Iterator[Load]:
    """Pins on cranks, their main bearings, and what holds each piston, where formulas draw them."""
    bearings, ends, turned = {role.name: role for role in drive.roles.bearings}, list[np.ndarray](), 1 + 0j
    mains = dict(bearings)
    for role in bearings.values():
        radius = 0.0 if role.throw is None else float(amount(role.throw, drive.mechanism.parameters))
        arm = radius * np.exp(1j * role.sense * (phi + role.phase))
        for start, end in ((at[:, 0], at[:, -1]) for _, at in corners(shown, "crank") if radius):
            # upright engines are drawn a quarter turn on
            way = next((u for u in (1, 1j) if np.abs(end - start - u * arm).max() < _ALIKE * radius), None)
            if way is not None:
                turned = way
                ends.append(end)
                yield _load(role, end, turned * _force(role, R))
                if main := mains.pop(_main_of(role), None):
                    yield _load(main, start, turned * _force(main, R))
                break
    free = [(of, at[:, 0]) for of, at in corners(shown, "joint") if not any(np.allclose(at[:, 0], e) for e in ends)]
    rods = {of: at for of, at in corners(shown, "rod") if of and np.ptp(at[:, 0].real) == 0}  # beside their neighbours
    at_end = [(of, at) for of, at in free if of not in rods or not np.allclose(at.real, rods[of][0, 0].real)]
    numbered, pins = any(of for of, _ in at_end), [role for role in bearings.values() if role.at == "piston_pins"]
    guides = [role for role in drive.roles.guides if role.at and role.reaction]
    kinds: tuple[Sequence[_Role], ...] = (pins, guides)
    for held in kinds:
        for n in dict.fromkeys(_number(role) if numbered else 0 for role in held):
            own = [at for of, at in at_end if of == n]
            alike = [role for role in held if not numbered or _number(role) == n]
            # of a rod that hangs on another the pin of its piston is drawn last
            for one, at in zip(alike, reversed(own) if numbered else own, strict=False):
                yield _load(one, at, turned * _force(one, R))
    for n, rod in rods.items():
        yield from _beside(n, rod, bearings, R)


def _beside(
    n: int, rod: np.ndarray, bearings: Mapping[str, BearingRole], R: Mapping[str, np.ndarray]
) -> Iterator[Load]:
    """Of a cylinder that is drawn beside its neighbours, along the shaft: what acts along its own axis."""
    piston, crank = (bearings.get(f"{kind}_{n}") for kind in ("piston_pin", "crank_pin"))
    main = bearings.get(_main_of(crank)) if crank else None
    for role, at in ((piston, rod[:, -1]), (crank, rod[:, 0]), (main, rod[:, 0].real + 0j)):
        if role and piston:
            yield _load(role, at, 1j * (_force(role, R) * np.exp(-1j * piston.ways[0])).real)


def _main_of(crank: BearingRole) -> str:
    return crank.main or crank.name.replace("crank_pin", "main_bearing")


def _number(role: _Role) -> int:
    """Of its cylinder; 0 where there is one."""
    last = role.name.rpartition("_")[2]
    return int(last) if last.isdigit() else 0


def _force(role: _Role, R: Mapping[str, np.ndarray]) -> np.ndarray:
    """In the frame, x + i y: on a piston from its rod and guide, on a crank from its rod and its main bearing [N]."""
    if isinstance(role, GuideRole):
        return R[role.reaction or ""] * np.exp(1j * role.way)
    sign = 1.0 if role.throw is None else -1.0  # of a crank pin the reaction is that on the rod
    force: np.ndarray = sum(sign * R[n] * np.exp(1j * way) for n, way in zip(role.reactions, role.ways, strict=False))
    return force


def _load(role: _Role, at: np.ndarray, force: np.ndarray) -> Load:
    return Load(name=role.name.replace("_", " "), at=at, force=force)
