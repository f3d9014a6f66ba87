r"""Loops closed by constraint: dependent coordinates as functions of the independent ones.

.. math:: g(q) = 0,\quad u = T u_i,\quad \ddot q = T \ddot q_i + c,\quad T_d = -J_d^{-1} J_i,\quad
          c_d = -J_d^{-1} \gamma

J_d are the columns of the dependent coordinates. Newton's method on g closes the loop from a guess; three steps from
within a thousandth are exact to round-off. With the multipliers of the dependent rows,
:math:`J_d^T \mu = (M \ddot q + h - Q)_d`, reactions follow; what is missing in the independent rows is the driving
force that holds the motion.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import casadi as ca
import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.arrays import solved
from mechsym.mechanisms.record import Mechanism, accelerations, velocities
from mechsym.quantities.units import Metre, Radian

_STEPS = 3  # of Newton's method from a guess
_CLOSED = 1e-12  # relative to the size of the coordinates
_DYNAMICS = ["mass_matrix", "bias", "generalized_force"]  # results of that function
_STRIDE = 0.02  # of what is given, from pose to pose [rad] or [m]


def split(mechanism: Mechanism, dependents: Sequence[str]) -> tuple[list[int], list[int]]:
    """Indices of the independent and of the dependent coordinates."""
    index = {q: i for i, q in enumerate(mechanism.coordinates)}
    held = [index[d] for d in dependents]
    return [i for i in index.values() if i not in held], held


def scaled(mechanism: Mechanism, jacobian: np.ndarray) -> np.ndarray:
    """A Jacobian [SI] with columns alike in size, so that metres and radians compare, as pure numbers do."""
    sizes = np.abs(jacobian).max(axis=0)
    pure = np.array([mechanism.units.get(q) == "-" for q in mechanism.coordinates])
    return jacobian / np.where((sizes > 0) & ~pure, sizes, 1.0)


def closed(mechanism: Mechanism, q: ca.SX, dependents: Sequence[str], steps: int = _STEPS) -> ca.SX:
    """Coordinates with the dependent ones closed by Newton's method from where they are.

    q: coordinates near a closed pose [rad] or [m], shape (n, 1); dependents: as many as there are constraints.
    """
    _, held = split(mechanism, dependents)
    for _ in range(steps if held else 0):
        gap, jacobian, _ = mechanism.functions["constraints"](*ca.vertsplit(q), *([0] * q.numel()))
        moved = ca.SX(q)
        moved[held] = q[held] - solved(jacobian[:, held], gap)
        q = moved
    return q


def motion(mechanism: Mechanism, q: ca.SX, u: ca.SX, dependents: Sequence[str]) -> tuple[ca.SX, ca.SX]:
    r"""T and c of :math:`u = T u_i`, :math:`\ddot q = T \ddot q_i + c` at a closed pose.

    q: coordinates, closed [rad] or [m], shape (n, 1); u: velocities of the independent coordinates [rad/s] or [m/s],
    shape (k, 1).
    """
    free, held = split(mechanism, dependents)
    n = len(mechanism.coordinates)
    if not held:
        return ca.SX.eye(n), ca.SX(n, 1)
    _, jacobian, _ = mechanism.functions["constraints"](*ca.vertsplit(q), *([0] * n))
    T = ca.SX(n, len(free))
    T[free, :] = ca.SX.eye(len(free))
    T[held, :] = -solved(jacobian[:, held], jacobian[:, free])
    _, _, gamma = mechanism.functions["constraints"](*ca.vertsplit(q), *ca.vertsplit(ca.mtimes(T, u)))
    c = ca.SX(n, 1)
    c[held] = -solved(jacobian[:, held], gamma)
    return T, c


def close(mechanism: Mechanism, given: Mapping[str, Radian], guesses: Mapping[str, Metre]) -> np.ndarray | None:
    """Coordinates that close the loop with some given, from guesses; None where it does not close.

    given, guesses: coordinates that are kept, and near which the others are looked for or. Returns q: coordinates [rad]
    or [m].
    """
    names = mechanism.coordinates
    q = np.array([float(given.get(n, guesses.get(n, 0.0))) for n in names])
    held = [i for i, n in enumerate(names) if n not in given]
    constraints = mechanism.functions["constraints"]
    for _ in range(50):
        gap, jacobian, _ = (np.asarray(v) for v in constraints.call([*q, *([0.0] * len(q))]))
        if not (np.isfinite(gap).all() and np.isfinite(jacobian).all()):
            return None  # a loop in closed form within it is open there
        step = np.linalg.lstsq(jacobian[:, held], gap.ravel(), rcond=None)[0]
        # far from the pose a whole step may leap to another branch
        q[held] -= step * min(1.0, 0.5 / max(float(np.abs(step).max()), 1e-300))
        if np.abs(step).max() <= _CLOSED * max(1.0, np.abs(q).max()):
            break
    gap = np.asarray(constraints.call([*q, *([0.0] * len(q))])[0])
    return q if np.abs(gap).max() <= 1e-10 * max(1.0, np.abs(q).max()) else None


def followed(mechanism: Mechanism, given: Mapping[str, Radian], guesses: Mapping[str, Metre]) -> np.ndarray | None:
    """Coordinates that close the loop with some given, followed from where these are 0; None where it opens on the way.

    given, guesses: coordinates that are kept, and near which the others are looked for at the start or. Returns q:
    coordinates [rad] or [m].
    """
    steps = max(1, round(max(abs(v) for v in given.values()) / _STRIDE)) if given else 1
    near: Mapping[str, float] = guesses
    pose = close(mechanism, dict.fromkeys(given, 0.0), near)
    for k in range(1, steps + 1):
        if pose is None:
            return None
        near = dict(zip(mechanism.coordinates, pose, strict=True))
        pose = close(mechanism, {n: v * k / steps for n, v in given.items()}, near)
    return pose


def along_turn(mechanism: Mechanism, points: int = 720, most: int = 60) -> tuple[np.ndarray, int]:
    """Coordinates over the turns of the first coordinate, the rest following it from the guesses.

    Returns q: coordinates at even angles from 0 to where they repeat, both ends included [rad] or [m], shape (n, k +
    1); turns: after so many turns everything is as it was at the start. Raises BadInput: the loop does not close over
    the turn; says where.
    """
    driver, *rest = mechanism.coordinates
    guesses = dict(mechanism.dependents)
    poses: list[np.ndarray] = []
    for k in range(most * points + 1):
        phi = 2 * np.pi * k / points
        q = close(mechanism, {driver: phi}, guesses)
        if q is None:
            why = f"the loop opens at {driver} = {np.degrees(phi):.3f} deg"
            raise BadInput(f"{mechanism.name}: {why}; it locks there, or the guesses choose no branch")
        if poses and np.abs(q - poses[-1])[1:].max() > 1.0:
            raise BadInput(
                f"{mechanism.name}: the branch changes near {driver} = {np.degrees(phi):.3f} deg; it locks there"
            )
        poses.append(q)
        steps = [q, poses[-2] if len(poses) > 1 else q]
        guesses = dict(zip(rest, (2 * steps[0] - steps[1])[1:], strict=True))
        if k and k % points == 0 and _same(q, poses[0]):
            return np.array(poses).T, k // points
    way = "give its gears radii in the ratio of small whole numbers, as their teeth have"
    raise BadInput(f"{mechanism.name} does not repeat within {most} turns of {driver}; {way}")


def _same(q: np.ndarray, start: np.ndarray) -> bool:
    turned = (q - start)[1:] / (2 * np.pi)
    return bool(np.abs(turned - np.round(turned)).max() < 1e-9)


def _guess(mechanism: Mechanism, phi: ca.SX) -> tuple[ca.SX, int]:
    """A Fourier series through the poses of the turn, near enough for three steps of Newton's method."""
    table, turns = along_turn(mechanism)
    n = table.shape[1] - 1
    angle = 2 * np.pi * np.arange(n) / n
    rows = [phi]
    for values in table[1:]:
        rate = round(float(values[-1] - values[0]) / (2 * np.pi))  # turns of a link within the period
        series = np.fft.rfft(values[:-1] - rate * angle) / n
        size = np.abs(series)
        last = next(k for k in range(1, len(series)) if size[k:].sum() < 1e-5) if size[-1] < 1e-5 else len(series) - 1
        value = float(series[0].real) + rate * phi / turns
        for k in range(1, last):
            a, b = 2 * float(series[k].real), -2 * float(series[k].imag)
            value += a * ca.cos(k * phi / turns) + b * ca.sin(k * phi / turns)
        rows.append(value)
    return ca.vertcat(*rows), turns


def one_coordinate(mechanism: Mechanism, guesses: Mapping[str, float]) -> Mechanism:
    """A mechanism whose loops leave one coordinate, as a function of that one; guesses: of the others [rad] or [m]."""
    held = {name: float(guesses.get(name, guess)) for name, guess in mechanism.dependents.items()}
    return reduced(replace(mechanism, dependents=held))[0]


def reduced(mechanism: Mechanism) -> tuple[Mechanism, int]:
    """The mechanism with its first coordinate alone, the others closed at every angle.

    Returns mechanism: one coordinate; kinematic outputs also the dependent coordinates, with derivatives, and the
    inertia. turns: after so many turns everything is as it was at the start. Raises BadInput: more than one independent
    coordinate, or the loop does not close over the turn.
    """
    free, _ = split(mechanism, tuple(mechanism.dependents))
    if free != [0]:
        raise BadInput(f"{mechanism.name} has {len(free)} independent coordinates; one is needed, and declared first")
    driver = mechanism.coordinates[0]
    phi, u, a = ca.SX.sym(driver), ca.SX.sym(f"{driver}d"), ca.SX.sym(f"{driver}dd")
    guess, turns = _guess(mechanism, phi)
    n = len(mechanism.coordinates)
    q = ca.SX.sym("q", n)
    pose = ca.Function("pose", [phi], [closed(mechanism, guess, tuple(mechanism.dependents))])(phi)
    functions = {"kinematics": _kinematics(mechanism, q, phi, pose)}
    inputs = [ca.SX.sym(i) for i in mechanism.inputs]
    parts, known = _along(mechanism, q, u, a, inputs)
    wanted = {"dynamics": ([phi, u, *inputs], parts, _DYNAMICS)}
    for group, letters in (("energy", [phi, u]), ("reactions", [phi, u, a, *inputs]), ("momentum", [phi, u, a])):
        if group in mechanism.functions:
            wanted[group] = (letters, _call(mechanism, group, known), mechanism.functions[group].name_out())
    if "drawing" in mechanism.functions:
        wanted["drawing"] = ([phi], _call(mechanism, "drawing", known), mechanism.functions["drawing"].name_out())
    for group, (letters, outputs, names) in wanted.items():
        at_pose = ca.Function(group, [*letters, q], outputs)
        functions[group] = ca.Function(
            group, letters, list(at_pose.call([*letters, pose])), [x.name() for x in letters], names
        )
    return replace(mechanism, coordinates=(driver,), functions=functions, dependents={}), turns


def _along(
    mechanism: Mechanism, q: ca.SX, u: ca.SX, a: ca.SX, inputs: Sequence[ca.SX]
) -> tuple[list[ca.SX], dict[str, ca.SX]]:
    """Mass, bias and force on the first coordinate, and all rates and accelerations by its own."""
    T, c = motion(mechanism, q, u, tuple(mechanism.dependents))
    rates, accelerated = ca.mtimes(T, u), ca.mtimes(T, a) + c
    known = {"q": q, "u": rates, "a": accelerated, "inputs": ca.vertcat(*inputs) if inputs else ca.SX(0, 1)}
    mass, bias, force = _call(mechanism, "dynamics", known)
    parts = [ca.mtimes(T.T, ca.mtimes(mass, T)), ca.mtimes(T.T, ca.mtimes(mass, c) + bias), ca.mtimes(T.T, force)]
    return parts, known


def with_letters(mechanism: Mechanism, near: Mechanism, letters: Sequence[ca.SX]) -> Mechanism:
    """A mechanism whose functions end with letters of parameters, by its first coordinate alone: its dynamics.

    near: the same with numbers, from whose poses over a turn the loops are closed. Raises BadInput: see `reduced`.
    """
    driver, *_ = mechanism.coordinates
    phi, u, *inputs = (ca.SX.sym(name) for name in (driver, f"{driver}d", *mechanism.inputs))
    functions = {name: _with_free(mechanism.functions[name], letters) for name in ("constraints", "dynamics")}
    inner = replace(mechanism, functions=functions)
    q = closed(inner, _guess(near, phi)[0], tuple(mechanism.dependents))
    parts, _ = _along(inner, q, u, ca.SX(1, 1), inputs)
    everything = [phi, u, *inputs, *letters]
    names = [x.name() for x in everything]
    dynamics = ca.Function("dynamics", everything, parts, names, _DYNAMICS, {"cse": True})
    return replace(mechanism, coordinates=(driver,), functions={"dynamics": dynamics}, dependents={})


def _with_free(function: ca.Function, letters: Sequence[ca.SX]) -> ca.Function:
    """A function whose last inputs are letters that stay free."""
    names = function.name_in()[: function.n_in() - len(letters)]
    own = [ca.SX.sym(name) for name in names]
    values = function.call([*own, *letters])
    return ca.Function(function.name(), own, values, names, function.name_out(), {"allow_free": True})


def _call(mechanism: Mechanism, group: str, known: Mapping[str, ca.SX]) -> list[ca.SX]:
    function = mechanism.functions[group]
    letters = dict(zip(mechanism.coordinates, ca.vertsplit(known["q"]), strict=True))
    letters |= dict(zip(velocities(mechanism), ca.vertsplit(known["u"]), strict=True))
    letters |= dict(zip(accelerations(mechanism), ca.vertsplit(known["a"]), strict=True))
    letters |= dict(zip(mechanism.inputs, ca.vertsplit(known["inputs"]), strict=True))
    values = function.call([letters[n] for n in function.name_in()])
    return list(values)


def _kinematics(mechanism: Mechanism, q: ca.SX, phi: ca.SX, pose: ca.SX) -> ca.Function:
    driver, *rest = mechanism.coordinates
    T, _ = motion(mechanism, q, ca.SX(1, 1), tuple(mechanism.dependents))
    kinematics = mechanism.functions["kinematics"]
    values = dict(zip(kinematics.name_out(), kinematics.call(ca.vertsplit(q)), strict=True))
    partial = {f"d{s}_d{v}" for s in values for v in mechanism.coordinates}
    base = {s: v for s, v in values.items() if not s.startswith("d") or not (s in partial or "_d" in s)}
    outputs = dict(zip(rest, ca.vertsplit(q)[1:], strict=True)) | base
    mass = _call(
        mechanism,
        "dynamics",
        dict.fromkeys(("u", "a"), ca.SX(q.numel(), 1)) | {"q": q, "inputs": ca.SX(len(mechanism.inputs), 1)},
    )[0]
    inertia = ca.mtimes(T.T, ca.mtimes(mass, T))
    results: dict[str, ca.SX] = {}
    for name, value in outputs.items():
        first = ca.jtimes(ca.SX(value), q, T)
        results |= {name: value, f"d{name}_d{driver}": first, f"d2{name}_d{driver}2": ca.jtimes(first, q, T)}
    results |= {"inertia": inertia, f"dinertia_d{driver}": ca.jtimes(inertia, q, T)}
    at_pose = ca.Function("kinematics", [q], list(results.values()))
    options = {"allow_duplicate_io_names": True}  # the coordinate may be asked for as an output
    return ca.Function("kinematics", [phi], list(at_pose.call([pose])), [driver], list(results), options)
