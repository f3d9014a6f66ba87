r"""A tree of bodies in space, each velocity and force worked out once and kept by its own name.

Vectors stand in the axes of their body, rates about its origin (omega, v); `turn` takes them to the axes of the body
before, whose origin lies `offset` behind. With the columns S of a joint, constant in the axes of what it moves,

.. math:: \omega = E^T \omega_p + S_\omega \eta, \quad v = E^T (v_p + \omega_p \times p) + S_v \eta, \quad
          \eta = B \dot q

forces go back from the tips (Newton-Euler), the mass matrix comes from the inertia of all that a joint carries
(composite bodies). Source: Featherstone (2008), tables 5.1 and 6.2.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from sympy import Expr, Symbol

from mechsym.derive import vectors as vec
from mechsym.derive.tape import Intermediates
from mechsym.derive.vectors import EYE, NONE, Matrix, O, Vector

Wrench = tuple[Vector, Vector]  # moment about the origin, force


class SharedSteps(Intermediates):
    """A tape on which equal steps have one name, so that nothing is worked out twice."""

    def __init__(self, taken: Callable[[str], bool]) -> None:
        super().__init__()
        self._taken, self._names = taken, dict[Expr, Expr]()
        self._count: dict[str, int] = {}

    def step(self, name: str, value: Expr) -> Expr:
        """A name for a value; what is a number or a single letter stays as it is."""
        if value.is_Atom or (-value).is_Symbol:
            return value
        if value not in self._names:
            at = self._count[name] = self._count.get(name, -1) + 1
            text = f"{name}_{at}" if at else name
            while self._taken(text) or Symbol(text, real=True) in self.entries:
                text += "_"
            symbol = Symbol(text, real=True)
            self.entries[symbol] = value
            self._names[value], self._names[-value] = symbol, -symbol
        return self._names[value]

    def vector(self, name: str, v: Vector) -> Vector:
        """Names for the components of a vector."""
        x, y, z = (self.step(f"{name}_{axis}", e) for axis, e in zip("xyz", v, strict=True))
        return x, y, z

    def matrix(self, name: str, A: Matrix) -> Matrix:
        """Names for the components of a matrix."""
        first, second, third = (self.vector(f"{name}_{axis}", row) for axis, row in zip("xyz", A, strict=True))
        return first, second, third

    def common(self, expressions: list[Expr]) -> tuple[list[tuple[Symbol, Expr]], list[Expr]]:
        """Steps are shared where they are made."""
        return [], expressions


@dataclass(eq=False)
class Column:
    """One freedom of a joint: a turn about an axis through a point, or a way along it, in axes of what it moves."""

    turns: bool
    axis: Vector
    at: Vector
    by: dict[Symbol, Expr]  #: What the rate of each coordinate has to do with its own
    curved: Expr = O  #: Its acceleration where no coordinate accelerates

    @property
    def spin(self) -> Vector:
        """Angular velocity at the rate 1."""
        return self.axis if self.turns else NONE

    @property
    def way(self) -> Vector:
        """Velocity of the origin at the rate 1."""
        return vec.cross(self.at, self.axis) if self.turns else self.axis


@dataclass(eq=False)
class TreeBody:
    """A body of the tree, or a massless one between two freedoms of a joint."""

    name: str
    before: Any = None  #: A part
    turn: Matrix = EYE
    offset: Vector = NONE
    columns: tuple[Column, ...] = ()
    joint: str = ""  #: By which it hangs
    mass: Expr = O
    moment: Vector = NONE  #: Mass times centre
    inertia: Matrix = (NONE, NONE, NONE)  #: About the origin
    world: Matrix = EYE
    origin: Vector = NONE
    path: "tuple[TreeBody, ...]" = ()  #: From the first moving body to itself
    points: dict[Vector, Vector] = field(default_factory=dict)


class Tree:
    """Recursions over a tree of bodies.

    q, u, a: coordinates with their rates and accelerations, which grow with the declaration.
    """

    def __init__(self, tape: SharedSteps, rate: Callable[[Symbol], Symbol], acceleration: Callable[[Symbol], Symbol]):
        self.tape, self._rate, self._acceleration = tape, rate, acceleration
        self.frame = TreeBody("frame")
        self.parts: list[TreeBody] = []
        self._moving: dict[tuple[TreeBody, bool], tuple[Vector, Vector]] = {}
        self._rates: dict[TreeBody, tuple[Vector, Vector]] = {}

    def hang(self, part: TreeBody) -> TreeBody:
        """Take a part whose joint is known."""
        before = part.before or self.frame
        part.before, name = before, part.name
        part.turn = self.tape.matrix(f"E_{name}", part.turn)
        part.offset = self.tape.vector(f"p_{name}", part.offset)
        part.world = self.tape.matrix(f"R_{name}", vec.product(before.world, part.turn))
        part.origin = self.tape.vector(f"r_{name}", vec.add(before.origin, vec.times(before.world, part.offset)))
        part.path = (*before.path, part)
        self.parts.append(part)
        return part

    def place(self, part: TreeBody, at: Vector) -> Vector:
        """Where a point of a body is in the frame."""
        if at not in part.points:
            here = vec.add(part.origin, vec.times(part.world, at))
            part.points[at] = self.tape.vector(f"p_of_{part.name}", here)
        return part.points[at]

    def out(self, part: TreeBody, v: Vector) -> Vector:
        """A vector of a body in the axes of the frame."""
        return self.tape.vector(f"of_{part.name}", vec.times(part.world, v))

    def rates(self, part: TreeBody) -> tuple[Vector, Vector]:
        """Angular velocity and velocity of the origin."""
        if not part.path:
            return NONE, NONE
        if part not in self._rates:
            w, v = self.rates(part.before)
            spin, way = self._moved(part)
            v = vec.add(v, vec.cross(w, part.offset))
            w_, v_ = (vec.back(part.turn, x) for x in (w, v))
            self._rates[part] = (
                self.tape.vector(f"w_{part.name}", vec.add(w_, spin)),
                self.tape.vector(f"v_{part.name}", vec.add(v_, way)),
            )
        return self._rates[part]

    def _moved(self, part: TreeBody) -> tuple[Vector, Vector]:
        """Spin and way of a joint at its own rates."""
        spin = way = NONE
        for column in part.columns:
            eta = self.rate_of(part, column)
            spin, way = vec.add(spin, vec.scaled(eta, column.spin)), vec.add(way, vec.scaled(eta, column.way))
        return self.tape.vector(f"ws_{part.name}", spin), self.tape.vector(f"vs_{part.name}", way)

    def rate_of(self, part: TreeBody, column: Column) -> Expr:
        """The rate of one freedom of a joint."""
        return self.tape.step(f"eta_{part.name}", sum((c * self._rate(q) for q, c in column.by.items()), O))

    def accelerated(self, part: TreeBody, driven: bool) -> tuple[Vector, Vector]:
        """Angular acceleration and that of the origin; with no acceleration of a coordinate unless driven."""
        if not part.path:
            return NONE, NONE
        key = part, driven
        if key not in self._moving:
            (w, _), (alpha, a) = self.rates(part.before), self.accelerated(part.before, driven)
            p, (spin, way) = part.offset, self._moved(part)
            a = vec.add(a, vec.cross(alpha, p), vec.cross(w, self._swept(part.before, w, p)))
            w_, alpha_, a_ = (vec.back(part.turn, x) for x in (w, alpha, a))
            w_ = self.tape.vector(f"wb_{part.name}", w_)
            more_w, more_v = vec.cross(w_, spin), vec.cross(vec.add(vec.scaled(2, w_), spin), way)
            for column in part.columns:
                rate = column.curved
                if driven:
                    rate += sum((c * self._acceleration(q) for q, c in column.by.items()), O)
                more_w = vec.add(more_w, vec.scaled(rate, column.spin))
                more_v = vec.add(more_v, vec.scaled(rate, column.way))
            stem = "d" if driven else "b"
            self._moving[key] = (
                self.tape.vector(f"{stem}w_{part.name}", vec.add(alpha_, more_w)),
                self.tape.vector(f"{stem}v_{part.name}", vec.add(a_, more_v)),
            )
        return self._moving[key]

    def _swept(self, part: TreeBody, w: Vector, p: Vector) -> Vector:
        return self.tape.vector(f"sw_{part.name}", vec.cross(w, p))

    def velocity(self, part: TreeBody, at: Vector) -> Vector:
        """Velocity of a point of a body in the frame."""
        w, v = self.rates(part)
        return self.tape.vector(f"vp_{part.name}", vec.times(part.world, vec.add(v, self._swept(part, w, at))))

    def acceleration(self, part: TreeBody, at: Vector, driven: bool) -> Vector:
        """Acceleration of a point of a body in the frame."""
        (w, _), (alpha, a) = self.rates(part), self.accelerated(part, driven)
        local = vec.add(a, vec.cross(alpha, at), vec.cross(w, self._swept(part, w, at)))
        return self.tape.vector(f"{'d' if driven else 'b'}vp_{part.name}", vec.times(part.world, local))

    def spinning(self, part: TreeBody) -> Vector:
        """Angular velocity in the axes of the frame."""
        return self.out(part, self.rates(part)[0])

    def column(self, part: TreeBody, column: Column, at: Vector) -> tuple[Vector, Vector]:
        """Angular velocity, and velocity of a place of the frame, at the rate 1 of a freedom; in the frame's axes."""
        axis = self.out(part, column.axis)
        if not column.turns:
            return NONE, axis
        return axis, vec.cross(axis, vec.less(at, self.place(part, column.at)))

    def inertial(self, part: TreeBody, driven: bool) -> Wrench:
        """Moment about the origin and force that a body's own acceleration takes."""
        if part.mass == 0 and part.inertia == (NONE, NONE, NONE):
            return NONE, NONE
        (w, _), (alpha, a) = self.rates(part), self.accelerated(part, driven)
        h, name, tape = part.moment, part.name, self.tape
        force = vec.add(vec.scaled(part.mass, a), vec.cross(alpha, h), vec.cross(w, self._swept(part, w, h)))
        spin = tape.vector(f"H_{name}", vec.times(part.inertia, w))
        moment = vec.add(vec.times(part.inertia, alpha), vec.cross(w, spin), vec.cross(h, a))
        stem = "d" if driven else "b"
        return tape.vector(f"{stem}M_{name}", moment), tape.vector(f"{stem}F_{name}", force)

    def carried(self, wrenches: dict[TreeBody, Wrench], stem: str) -> dict[TreeBody, Wrench]:
        """What each joint takes of the wrenches on all bodies behind it, in axes of what it moves; the frame all."""
        total = dict(wrenches)
        for part in reversed(self.parts):
            n, f = total.get(part, (NONE, NONE))
            n, f = self.tape.vector(f"n{stem}_{part.name}", n), self.tape.vector(f"f{stem}_{part.name}", f)
            total[part] = n, f
            f = self.tape.vector(f"fb{stem}_{part.name}", vec.times(part.turn, f))
            n = vec.add(vec.times(part.turn, n), vec.cross(part.offset, f))
            before = total.get(part.before, (NONE, NONE))
            total[part.before] = vec.add(before[0], n), vec.add(before[1], f)
        return total

    def generalized(self, wrenches: dict[TreeBody, Wrench], q: Sequence[Symbol], stem: str) -> list[Expr]:
        """Generalised forces of wrenches on the bodies, one a coordinate."""
        total, forces = self.carried(wrenches, stem), dict.fromkeys(q, O)
        for part in self.parts:
            n, f = total[part]
            for column in part.columns:
                tau = self.tape.step(f"tau{stem}_{part.name}", vec.dot(column.spin, n) + vec.dot(column.way, f))
                for letter, c in column.by.items():
                    forces[letter] += c * tau
        return [forces[letter] for letter in q]

    def mass_matrix(self, q: Sequence[Symbol]) -> list[list[Expr]]:
        """Mass matrix of the coordinates, of the composite bodies behind each joint."""
        tape, index = self.tape, {letter: i for i, letter in enumerate(q)}
        whole = {part: (part.mass, part.moment, part.inertia) for part in self.parts}
        rows: list[list[Expr]] = [[O] * len(q) for _ in q]

        def put(one: Column, other: Column, value: Expr, twice: bool) -> None:
            for a, c in one.by.items():
                for b, d in other.by.items():
                    rows[index[a]][index[b]] += c * d * value
                    if twice:
                        rows[index[b]][index[a]] += c * d * value

        for part in reversed(self.parts):
            m, h, inertia = whole[part]
            m, h = tape.step(f"m_{part.name}", m), tape.vector(f"h_{part.name}", h)
            inertia = tape.matrix(f"I_{part.name}", inertia)
            if part.before is not self.frame:
                E, p = part.turn, part.offset
                h_ = tape.vector(f"hb_{part.name}", vec.times(E, h))
                half = tape.matrix(f"EI_{part.name}", vec.product(E, inertia))
                turned = vec.product(half, vec.transposed(E))
                m0, h0, i0 = whole[part.before]
                shifted = vec.add(h0, h_, vec.scaled(m, p))
                whole[part.before] = m0 + m, shifted, vec.summed(i0, _even(vec.summed(turned, vec.apart(m, h_, p))))
            forces = []
            for column in part.columns:
                spin, way = column.spin, column.way
                f = tape.vector(f"fc_{part.name}", vec.add(vec.scaled(m, way), vec.cross(spin, h)))
                n = tape.vector(f"nc_{part.name}", vec.add(vec.times(inertia, spin), vec.cross(h, way)))
                forces.append((n, f))
            for i, one in enumerate(part.columns):
                for j in range(i, len(part.columns)):
                    n, f = forces[j]
                    put(one, part.columns[j], vec.dot(one.spin, n) + vec.dot(one.way, f), i != j)
            for column, (n, f) in zip(part.columns, forces, strict=True):
                self._coupled(part, column, (n, f), put)
        return [[self.tape.step(f"mass_{a}_{b}_", rows[i][j]) for j, b in enumerate(q)] for i, a in enumerate(q)]

    def _coupled(
        self, part: TreeBody, column: Column, wrench: Wrench, put: Callable[[Column, Column, Expr, bool], None]
    ) -> None:
        """What a composite body has to do with the freedoms of all joints before it."""
        (n, f), at, tape = wrench, part, self.tape
        while at.before is not self.frame:
            f = tape.vector(f"fm_{part.name}", vec.times(at.turn, f))
            n = tape.vector(f"nm_{part.name}", vec.add(vec.times(at.turn, n), vec.cross(at.offset, f)))
            at = at.before
            for other in at.columns:
                put(other, column, vec.dot(other.spin, n) + vec.dot(other.way, f), True)

    def energy(self) -> Expr:
        """Twice the kinetic energy."""
        total = O
        for part in self.parts:
            if part.mass == 0 and part.inertia == (NONE, NONE, NONE):
                continue
            w, v = self.rates(part)
            spin = self.tape.vector(f"H_{part.name}", vec.times(part.inertia, w))
            total += part.mass * vec.dot(v, v) + vec.dot(w, spin)
            total += 2 * vec.dot(v, self._swept(part, w, part.moment))
        return total


def _even(A: Matrix) -> Matrix:
    """A symmetric matrix by its upper half, so that equal entries are equal expressions."""
    return A[0], (A[0][1], A[1][1], A[1][2]), (A[0][2], A[1][2], A[2][2])


def about_origin(mass: Expr, centre: Vector, inertia: Matrix) -> tuple[Vector, Matrix]:
    """First moment and inertia about the origin of a body by those about its centre of mass."""
    return vec.scaled(mass, centre), vec.summed(inertia, vec.apart(mass, NONE, centre))
