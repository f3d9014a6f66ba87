"""Vectors of three expressions and matrices of three rows, for mechanisms in space."""

from sympy import Expr, Integer, Rational, simplify, sqrt

from mechsym.derive.refuse import refuse

Vector = tuple[Expr, Expr, Expr]
Matrix = tuple[Vector, Vector, Vector]

O = Integer(0)
NONE: Vector = (O, O, O)
EYE: Matrix = ((Integer(1), O, O), (O, Integer(1), O), (O, O, Integer(1)))
AXES = {f"{sign}{'xyz'[k]}": tuple(s * e for e in EYE[k]) for k in range(3) for sign, s in (("", 1), ("-", -1))}


def add(*vectors: Vector) -> Vector:
    """Sum of vectors."""
    x, y, z = (sum(parts, O) for parts in zip(*vectors, strict=True))
    return x, y, z


def scaled(factor: Expr | int, v: Vector) -> Vector:
    """A number times a vector."""
    return factor * v[0], factor * v[1], factor * v[2]


def less(a: Vector, b: Vector) -> Vector:
    """Difference of two vectors."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a: Vector, b: Vector) -> Expr:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def transposed(A: Matrix) -> Matrix:
    """Rows and columns exchanged."""
    first, second, third = zip(*A, strict=True)
    return first, second, third


def times(A: Matrix, v: Vector) -> Vector:
    """Matrix times vector."""
    return dot(A[0], v), dot(A[1], v), dot(A[2], v)


def back(A: Matrix, v: Vector) -> Vector:
    """Transposed matrix times vector: a vector in the axes of what a rotation has turned."""
    return times(transposed(A), v)


def product(A: Matrix, B: Matrix) -> Matrix:
    """Matrix times matrix."""
    columns = transposed(B)
    first, second, third = ((dot(row, columns[0]), dot(row, columns[1]), dot(row, columns[2])) for row in A)
    return first, second, third


def summed(*matrices: Matrix) -> Matrix:
    """Sum of matrices."""
    first, second, third = (add(*rows) for rows in zip(*matrices, strict=True))
    return first, second, third


def outer(a: Vector, b: Vector) -> Matrix:
    """Dyadic product."""
    return scaled(a[0], b), scaled(a[1], b), scaled(a[2], b)


def crossing(a: Vector) -> Matrix:
    """The matrix that takes the vector product with a."""
    return (O, -a[2], a[1]), (a[2], O, -a[0]), (-a[1], a[0], O)


def apart(m: Expr, h: Vector, p: Vector) -> Matrix:
    """What an inertia gains when its point of reference moves by -p: mass m, first moment h about the old one."""
    both = summed(outer(h, p), outer(p, h), outer(scaled(m, p), p))
    inner = 2 * dot(h, p) + m * dot(p, p)
    first, second, third = (less(scaled(inner, EYE[i]), both[i]) for i in range(3))
    return first, second, third


def turned(axis: Vector, c: Expr, s: Expr) -> Matrix:
    """Rotation about a unit vector by an angle of that cosine and sine."""
    along = outer(axis, axis)
    across = [less(EYE[i], along[i]) for i in range(3)]
    sines = crossing(axis)
    first, second, third = (add(along[i], scaled(c, across[i]), scaled(s, sines[i])) for i in range(3))
    return first, second, third


def unit(v: Vector, what: str) -> Vector:
    """The vector with the length 1."""
    square = simplify(dot(v, v))
    if square == 0:
        refuse(f"{what} has no direction; write 'x', 'y', 'z', or three values that are not all 0")
    return v if square == 1 else scaled(1 / sqrt(square), v)


def onto(one: Vector, other: Vector, what: str) -> Matrix:
    """The shortest rotation that takes one unit vector to another."""
    if one == other:
        return EYE
    c = simplify(dot(one, other))
    if c == -1:
        refuse(f"{what}: the axes point against one another, which leaves a turn open; turn one of them round")
    v = cross(one, other)
    hat = crossing(v)
    square = product(hat, hat)
    first, second, third = (add(EYE[i], hat[i], scaled(1 / (1 + c), square[i])) for i in range(3))
    return first, second, third


def normals(axis: Vector) -> tuple[Vector, Vector]:
    """Two unit vectors that make a right-handed frame before a third."""
    for k in range(3):
        if axis == EYE[k] or axis == scaled(-1, EYE[k]):
            one = EYE[(k + 1) % 3]
            return one, cross(axis, one)
    for k in range(3):
        if axis[k] == 0:
            return EYE[k], cross(axis, EYE[k])
    flat = (-axis[1], axis[0], O)
    one = unit(flat, "the normal")
    return one, cross(axis, one)


def of_quaternion(e: tuple[Expr, Expr, Expr, Expr]) -> Matrix:
    """Rotation by a quaternion of length 1, from the axes of what it turns."""
    a, b, c, d = e
    return (
        (1 - 2 * (c**2 + d**2), 2 * (b * c - a * d), 2 * (b * d + a * c)),
        (2 * (b * c + a * d), 1 - 2 * (b**2 + d**2), 2 * (c * d - a * b)),
        (2 * (b * d - a * c), 2 * (c * d + a * b), 1 - 2 * (b**2 + c**2)),
    )


def rates_of_quaternion(e: tuple[Expr, Expr, Expr, Expr]) -> tuple[tuple[Expr, ...], ...]:
    """What the rates of a quaternion have to do with the angular velocity in turned axes, three rows of four."""
    a, b, c, d = (2 * x for x in e)
    return (-b, a, d, -c), (-c, -d, a, b), (-d, c, -b, a)


HALF = Rational(1, 2)
