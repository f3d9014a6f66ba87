r"""The path of the roller centres and the walls of its groove as cubic curves with exact tangents.

    P = rho(theta) e_r                      centre path; wall at the distance d along the outward normal n
    W = P + d n,   W' = P' (1 + d kappa)    exact, so a cubic Hermite piece between two angles needs nothing else

Pieces are halved until the curve is nowhere farther from the truth than the tolerance, along the normal; kinks of the
torque are ends of pieces. Written as a clamped NURBS: interior knots double, ends fourfold.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge.guide import Guide, path
from mechsym.hinge.rollers import RollerParameters, curvature, parallel
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import Array, Metre, Radian

_TURN = 2 * math.pi
_FIRST = 12  # pieces at least, in a turn
_LEVELS = 24  # halvings at most
_NONE = np.empty(0)
_NODES = 16  # of Gauss in a piece
_INSIDE = np.linspace(0, 1, 19)[1:-1]  # where a piece is compared with the truth

Point = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


@record
class CubicPath:
    """A closed curve as cubic pieces: points (n + 1, 2) [m] and tangents by the angle [m/rad] at angles [rad]."""

    name: str
    theta: np.ndarray  #: shape (n + 1,) [rad]
    points: np.ndarray  #: shape (n + 1, 2) [m]
    tangents: np.ndarray  #: shape (n + 1, 2) [m/rad]
    deviation: float  #: largest distance from the truth that was seen [m]
    length: float  #: of the true curve [m]
    area: float  #: inside the true curve [m^2]


@record
class Groove:
    """A groove: centre path and both walls, of one guide."""

    centre: CubicPath
    inner: CubicPath
    outer: CubicPath
    roller_radius: float  #: [m]
    tolerance: float  #: largest distance from the true profile [m]
    turned: tuple[float, ...]  #: angles by which the track of each roller is turned about the axis [rad]


@result
class GrooveChecks:
    """How near the drawn curves of a groove come to the exact ones."""

    feasible: bool = part()
    tolerance: float = quantity("m")  #: Largest distance from the exact curves that was asked for
    deviation_centre: float = quantity("m")  #: Largest distance of the centre path that was seen
    deviation_inner: float = quantity("m")  #: The same of the inner wall
    deviation_outer: float = quantity("m")  #: The same of the outer wall
    points_centre: int = quantity("-")  #: Ends of the pieces of the centre path
    points_inner: int = quantity("-")  #: The same of the inner wall
    points_outer: int = quantity("-")  #: The same of the outer wall


@result
class GrooveDrawings:
    """What `mechsym guide` tells."""

    written: list[str] = part()
    checks: GrooveChecks = part()


def track(guide: Guide, rollers: RollerParameters, tolerance: Metre, kinks: Sequence[Radian] = ()) -> Groove:
    """Centre path and walls of a guide within a tolerance.

    tolerance: largest distance from the true curve; kinks: angles of the guide's shaft where the curvature jumps.
    Raises BadInput: no path, a wall that crosses itself, or a tolerance that rounding does not allow.
    """
    rho = path(guide)
    if not 1e-10 <= tolerance <= 1e-3:
        raise BadInput(f"tolerance = {tolerance:g} m is not allowed; it is a length from 1e-10 m to 1e-3 m")
    _refuse_crossing(rho, rollers.radius)
    edges = np.unique([*np.linspace(0, _TURN, _FIRST + 1), *(k % _TURN for k in kinks)])
    turns = round(_TURN / float(rho.x[-1]))
    breaks = np.concatenate([rho.x + k * rho.x[-1] for k in range(turns)])
    curves = [
        cubic(name, offset(rho, d), edges, tolerance, breaks)
        for name, d in (("centre", 0.0), ("inner", -rollers.radius), ("outer", rollers.radius))
    ]
    centre, inner, outer = curves
    centre, inner, outer = curves
    return Groove(centre=centre, inner=inner, outer=outer, roller_radius=rollers.radius, tolerance=tolerance,
                  turned=tracks_of(guide))  # fmt: skip


def rotation(angle: float) -> np.ndarray:
    """What turns rows of points about the axis by an angle [rad], shape (2, 2)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, s], [-s, c]])


def tracks_of(guide: Guide) -> tuple[float, ...]:
    """Angles by which the tracks of a guide are turned about its axis, one for each track [rad]."""
    return (0.0, math.pi) if guide.parameters.arrangement == "two_tracks" else (0.0,)


def offset(rho: PPoly, distance: float) -> Point:
    """The parallel curve at a distance [m]: points and tangents, shape (n, 2) each, by the angle [rad]."""
    first, second = rho.derivative(), rho.derivative(2)

    def at(theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        r, dr, d2r = rho(theta), first(theta), second(theta)
        x, y = parallel(r, dr, theta, distance)
        along = (dr + 1j * r) * np.exp(1j * theta) * (1 + distance * curvature(r, dr, d2r))
        return np.stack([x, y], axis=-1), np.stack([along.real, along.imag], axis=-1)

    return at


def cubic(name: str, curve: Point, edges: Radian[Array], tolerance: float, breaks: Radian[Array] = _NONE) -> CubicPath:
    """A closed curve as cubic pieces within a tolerance [m].

    edges: angles that must be ends of pieces; breaks: angles where the formula of the curve changes, for its length and
    area.
    """
    done, largest = [], 0.0
    left, right = edges[:-1], edges[1:]
    for _ in range(_LEVELS):
        error = _error(curve, left, right)
        good = error <= tolerance
        largest = max(largest, float(np.max(error[good], initial=0.0)))
        done.append(left[good])
        if good.all():
            theta = np.append(np.sort(np.concatenate(done)), edges[-1])
            points, tangents = curve(theta)
            points[-1] = points[0]  # closed to the last digit
            # length, and area inside, by Gauss points between angles
            places = np.unique([*theta, *(b for b in breaks if 0 < b < theta[-1])])
            nodes, weights = np.polynomial.legendre.leggauss(_NODES)
            half = np.diff(places)[:, None] / 2
            (x, y), (dx, dy) = (v.T for v in curve((places[:-1, None] + half * (nodes + 1)).ravel()))
            weight = (half * weights).ravel()
            length, area = float(weight @ np.hypot(dx, dy)), float(weight @ (x * dy - y * dx)) / 2
            return CubicPath(
                name=name, theta=theta, points=points, tangents=tangents, deviation=largest, length=length, area=area
            )
        middle = (left[~good] + right[~good]) / 2
        left, right = np.concatenate([left[~good], middle]), np.concatenate([middle, right[~good]])
    raise BadInput(f"{name}: {tolerance:g} m cannot be kept near {np.degrees(left[0]):.6g} deg; allow more")


def _error(curve: Point, left: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Largest distance along the normal in each piece, shape (pieces,) [m]."""
    (a, ta), (b, tb) = curve(left), curve(right)
    width = (right - left)[:, None]
    largest = np.zeros(len(left))
    for u in _INSIDE:
        truth, tangent = curve(left + u * (right - left))
        gap = hermite(a, b, ta * width, tb * width, u) - truth
        across = gap[:, 0] * tangent[:, 1] - gap[:, 1] * tangent[:, 0]
        largest = np.maximum(largest, np.abs(across) / np.hypot(*tangent.T))
    return largest


def hermite(a: np.ndarray, b: np.ndarray, ta: np.ndarray, tb: np.ndarray, u: float) -> np.ndarray:
    """The cubic from a to b [m] with slopes ta, tb by the share u [-] of the piece."""
    v = 1 - u
    return v * v * (1 + 2 * u) * a + u * u * (1 + 2 * v) * b + u * v * (v * ta - u * tb)


def nurbs(path: CubicPath) -> tuple[np.ndarray, np.ndarray]:
    """Control points, shape (2 n + 2, 2) [m], and knots, shape (2 n + 6,) [rad], of a cubic B-spline."""
    thirds = np.diff(path.theta)[:, None] / 3
    pairs = np.stack([path.points[:-1] + thirds * path.tangents[:-1], path.points[1:] - thirds * path.tangents[1:]], 1)
    knots = [path.theta[0]] * 4, np.repeat(path.theta[1:-1], 2), [path.theta[-1]] * 4
    return np.concatenate([path.points[:1], pairs.reshape(-1, 2), path.points[-1:]]), np.concatenate(knots)


def _refuse_crossing(rho: PPoly, radius: float) -> None:
    """The wall that the roller rests on must not cross itself: 1 + r kappa > 0 outside, 1 - r kappa > 0 inside."""
    theta = periodic.piece_points(rho, 65)
    values = [periodic.piece_values(p, theta).ravel() for p in (rho, rho.derivative(), rho.derivative(2))]
    kappa, angles = curvature(*values), theta.ravel()
    for wall, bend in (("outer", 1 + radius * kappa), ("inner", 1 - radius * kappa)):
        worst = int(np.argmin(bend))
        if bend[worst] <= 0:
            raise BadInput(
                f"the {wall} wall crosses itself at theta = {np.degrees(angles[worst]):.4g} deg: the path bends with a "
                f"radius of {1e3 / abs(kappa[worst]):.4g} mm there and the roller has {1e3 * radius:.4g} mm; "
                "take a smaller roller or a larger rho0"
            )
