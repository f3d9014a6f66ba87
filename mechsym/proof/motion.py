"""A motion enclosed from its start to a time: equations of a problem, phases of its inputs, digits that it needs, and
what is kept of it on the way, so that a proof that was broken off goes on.
"""

import dataclasses
import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.files import publish, write_text
from mechsym.mechanisms.record import Mechanism, acceleration_function
from mechsym.native.tape import read
from mechsym.proof import enclosure
from mechsym.proof.balls import ctx, decimal
from mechsym.proof.enclosure import Enclosure, EnclosureMethod, Set, TaylorMotion, kept, point, restored, weights
from mechsym.quantities import record
from mechsym.quantities.units import Pure, Second
from mechsym.simulate.equations import part_values, through_buffer
from mechsym.simulate.problem import FormulaForce, Problem, Steps

_USUAL, MOST = 25.0, 60.0  # digits of a run, and those that are still tried
_PER_SECOND = 2000.0  # steps, at most, for the forecast of digits
_ROUGH = 1e-7  # tolerance of the forecast


@record
class ClosedForm:
    """A motion to enclose."""

    function: ca.Function  #: (x, w, letters) -> x' and its derivative by x
    letters: tuple[float, ...]  #: Values of the parameters, taken as the decimals that they print as [SI]
    start: tuple[float, ...]  #: Coordinates and velocities, decimals too [SI]
    t_start: float  #: [s]
    steps: tuple[Steps, ...]  #: What gives w

    @property
    def coordinates(self) -> int:
        """How many there are."""
        return len(self.start) // 2

    def phases(self, until: Fraction) -> list[Fraction]:
        """Ends of the stretches in which all inputs stay [s]."""
        times = {_fraction(t) for one in self.steps for t in one.times}
        return [*sorted(t for t in times if _fraction(self.t_start) < t < until), until]

    def held(self, at: Fraction) -> list[float]:
        """The inputs from a time on [N*m or N]."""
        return [one.values[sum(_fraction(t) <= at for t in one.times)] for one in self.steps]


@record
class Passed:
    """A second of an enclosed motion."""

    at: Set  #: Its end
    steps: int  #: Since the start
    low: tuple[float, ...]  #: No state was below during it [SI]
    high: tuple[float, ...]  #: Nor above [SI]


def _fraction(value: float) -> Fraction:
    return Fraction(repr(float(value)))


def task_of(problem: Problem, mechanism: Mechanism, letters: Mapping[str, float]) -> ClosedForm:
    """The equations of a problem in closed form.

    mechanism: that of the problem, with symbols for the letters; letters: their values [SI]. Raises BadInput: a force
    that is no smooth closed form, or a motion that is held by more than its equations.
    """
    name = problem.mechanism.name
    others = [part.name for part in problem.parts if not isinstance(part.value, Steps | FormulaForce)]
    others += ["a loop closed by constraints"] * bool(mechanism.dependents)
    others += ["stops, curves or added inertia"] * bool(problem.curves or problem.inertia or problem.unilateral)
    if others:
        raise BadInput(f"{name}: {', '.join(others)}: no smooth closed form that can be enclosed; leave it out")
    n = len(mechanism.coordinates)
    steps = tuple(part.value for part in problem.parts if isinstance(part.value, Steps))
    t, x, w = ca.SX.sym("t"), ca.SX.sym("x", 2 * n), ca.SX.sym("w", len(steps))
    symbols = [v for v in mechanism.parameters.values() if isinstance(v, ca.SX)]
    q, u = ca.vertsplit(x[:n]), ca.vertsplit(x[n:])
    values = part_values(problem, t, q, u, w)
    inputs = [sum((v for p, v in values if p.input == name), ca.SX(0)) for name in mechanism.inputs]
    f = ca.vertcat(x[n:], acceleration_function(mechanism)(*q, *u, *inputs, *symbols))
    if ca.depends_on(f, t):
        raise BadInput(f"{name}: a force that follows the time itself is not enclosed; give it in steps")
    function = ca.Function("motion", [x, w, ca.vertcat(*symbols)], [f, ca.jacobian(f, x)])
    return ClosedForm(
        function=function, letters=tuple(letters[str(s)] for s in symbols), start=(*problem.q0, *problem.u0),
        t_start=problem.t_start, steps=steps,
    )  # fmt: skip


def digits(task: ClosedForm, until: Second, width: Pure) -> float:
    r"""Digits that an enclosure needs, by a run in doubles with its variational equations.

    .. math:: \log_{10} \frac{|M|\,|M^{-1}|\,N}{\mathrm{width}}, \qquad M = \partial x(t) / \partial x(0)

    width: wanted at the end, in the norm. Returns digits: given up where they are beyond what is tried [-].
    """
    n, c = len(task.start), task.coordinates
    y, w, p = ca.SX.sym("y", n + n * n), ca.SX.sym("w", len(task.steps)), ca.SX.sym("p", len(task.letters))
    f, A = task.function(y[:n], w, p)
    both = ca.vertcat(f, ca.vec(A @ ca.reshape(y[n:], n, n)))
    y_now, w_now, p_now = np.zeros(n + n * n), np.zeros(len(task.steps)), np.array(task.letters)
    rates = through_buffer(ca.Function("forecast", [y, w, p], [both]), y_now, w_now, p_now)

    def slope(_: float, values: np.ndarray) -> np.ndarray:
        y_now[:] = values
        return rates()

    x, t, needed = np.array(task.start), task.t_start, math.log10(_PER_SECOND * until / width)
    ahead, back = np.eye(n), np.eye(n)
    rate = max(1.0, np.abs(np.asarray(task.function(x, w_now, p_now)[1])[c:, :c]).max())
    scale = np.repeat([1.0, math.sqrt(rate)], c)
    first = needed
    while t < until and needed < 2 * MOST:
        w_now[:] = task.held(_fraction(t))
        end = min([float(e) for e in task.phases(_fraction(until)) if e > t] + [math.floor(t + 1e-9) + 1.0, until])
        rough = {"method": "DOP853", "rtol": _ROUGH, "atol": _ROUGH}
        values = scipy.integrate.solve_ivp(slope, (t, end), np.concatenate([x, np.eye(n).ravel()]), **rough).y[:, -1]
        x, M, t = values[:n], values[n:].reshape(n, n, order="F"), end
        ahead, back = M @ ahead, back @ np.linalg.inv(M)
        sizes = [float(np.abs(m * scale / scale[:, None]).sum(axis=1).max()) for m in (ahead, back)]
        needed = max(needed, first + math.log10(min(sizes[0], 1e150) * min(sizes[1], 1e150)))
    return needed


def method_for(needed: float) -> EnclosureMethod:
    """Bits, order and noise for so many digits [-]."""
    wanted = max(needed, _USUAL)
    share = wanted / _USUAL
    return EnclosureMethod(
        bits=math.ceil(110 * share), order=math.ceil(32 * share), order_of_W=math.ceil(20 * share), noise=10.0**-wanted,
        skew=10.0 ** (-15 * share),
    )  # fmt: skip


def enclose(
    task: ClosedForm,
    method: EnclosureMethod,
    until: Fraction,
    folder: Path | None = None,
    progress: Callable[[int], object] = lambda _: None,
) -> list[Passed]:
    """The motion second by second; what a folder keeps of the same proof is not made again."""
    with ctx.workprec(method.bits):
        kept = _kept_of(folder, identity(task, method))
        # what was kept of a longer proof, or of one that ended within a second, is no part of this one
        passed = [p for p in kept if p.at.t <= until and (p.at.t.denominator == 1 or p.at.t in task.phases(until))]
        letters = [decimal(v) for v in task.letters]
        start = point(_fraction(task.t_start), [decimal(v) for v in task.start])
        at, begun = (passed[-1].at, passed[-1].steps) if passed else (start, 0)
        progress(len(passed))
        w = None
        for end in task.phases(until):
            while at.t < end:
                motion = TaylorMotion(read(task.function), len(task.start), [*map(decimal, task.held(at.t)), *letters])
                w = weights(motion, start, task.coordinates) if w is None else w
                stop = min(end, Fraction(math.floor(at.t) + 1))
                low, high, steps = np.full(len(w), np.inf), np.full(len(w), -np.inf), begun
                for step in Enclosure(motion, method, w).steps(at, stop):
                    low, high, steps = np.minimum(low, step.low), np.maximum(high, step.high), steps + 1
                    at = step.end
                begun = steps
                passed.append(Passed(at=at, steps=steps, low=tuple(low.tolist()), high=tuple(high.tolist())))
                _keep(folder, identity(task, method), passed)
                progress(1)
    return passed


def identity(task: ClosedForm, method: EnclosureMethod) -> str:
    """What a kept proof hangs on: equations, numbers, method, and the code that encloses."""
    code = [Path(str(file)).read_bytes() for file in (enclosure.__file__, __file__) if file]
    said = repr((task.function.serialize(), task.letters, task.start, task.steps, dataclasses.astuple(method)))
    return hashlib.sha256(b"".join([*code, said.encode()])).hexdigest()


def _keep(folder: Path | None, name: str, passed: Sequence[Passed]) -> None:
    if folder is not None:
        rows = [{"steps": p.steps, "low": p.low, "high": p.high, **kept(p.at)} for p in passed]
        write_text(folder / "proof.json", json.dumps({"identity": name, "seconds": rows}))
        publish()  # a proof that is broken off goes on from here


def _kept_of(folder: Path | None, name: str) -> list[Passed]:
    file = None if folder is None else folder / "proof.json"
    if file is None or not file.is_file():
        return []
    content: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    if content["identity"] != name:
        return []
    rows = content["seconds"]
    return [Passed(at=restored(r), steps=r["steps"], low=tuple(r["low"]), high=tuple(r["high"])) for r in rows]
