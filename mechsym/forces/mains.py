r"""Main bearings at their places: what each journal carries of the loads of all throws.

A throw hangs between its neighbours. With hinges at the journals each bay is a simple beam and its load goes to its two
ends by the lever; a continuous shaft lies on all its supports at once. Its deflection, with loads P at z and
reactions R at b,

.. math:: w(s) = a_0 + a_1 s + \sum_j P_j \frac{|s - z_j|^3}{12 EI} - \sum_i R_i \frac{|s - b_i|^3}{12 EI},

has free ends where force and moment are in balance, and each support gives way by R/k there. Rigid supports
(1/k = 0) and a rigid shaft (1/EI = 0) are values like any other.

The oil film of a main bearing under a load that goes round: orbit of the journal and least film.

A short bearing (Ocvirk 1953) whose film carries pressure on the half that is squeezed and none on the other:

.. math:: \mathbf W = \frac{\mu L^3 R}{c^3} \int_{\mathbf v_s\cdot\mathbf n > 0}
   \frac{(\mathbf v_s\cdot\mathbf n)\,\mathbf n}{(1 - \boldsymbol\varepsilon\cdot\mathbf n)^3}\,d\psi

The load on the journal is W, v_s its velocity as seen from a frame that turns with half the shaft's speed (Booker
1965), c times eps its eccentricity. With Sommerfeld's angle the integral is one of sines and cosines, so it is exact;
the velocity for a load is found from it, where published mobilities are fits. Good for a bearing at most half as wide
as its diameter and eccentricities up to 0.8; beyond, a finite bearing carries less, and `finite_velocity` has
Butenschoen's fits for it.
"""

import cmath
import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from mechsym.errors import BadInput
from mechsym.forces.turn import Turn, main_roles
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.roles import BearingRole
from mechsym.periodic.roots import root
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Array, Metre, Pascal, Pure, Radian, RadPerSecond
from mechsym.torsion.twist import ShaftLimits

STEEL = 206e9  #: Modulus of elasticity of crankshaft steel [Pa]


@record
class MainShaft(ShaftLimits):
    """Section `[shaft]`: what it can bear in torsion, where its main bearings stand and how it lies on them."""

    #: Places along the shaft; empty: one between all throws and one beyond each end, half a pitch away [m]
    bearings: tuple[float, ...] = quantity("m", default=(), about="places of the main bearings along the shaft")
    mains: str = choice(
        "determinate", "beam", default="determinate",
        about="bays that are simple beams, or one continuous shaft on elastic supports",
    )  # fmt: skip
    bending_stiffness: float = quantity(
        "N*m^2", default=0.0, low=0, about="EI of the continuous shaft; 0: of its sizes", only=("mains", "beam")
    )
    support_stiffness: float = quantity(
        "N/m", default=1e9, above=0, about="of one bearing: block and oil film", only=("mains", "beam")
    )
    journal_diameter: float = quantity("m", default=0.0, low=0, high=5, about="of a main bearing")
    bearing_width: float = quantity("m", default=0.0, low=0, high=5, about="of a main bearing along the shaft")
    clearance: float = quantity("m", default=0.0, low=0, high=0.01, about="radial, of a main bearing")
    oil_viscosity: float = quantity("Pa*s", default=0.0, low=0, high=10, about="of the oil in the film")
    film: str = choice(
        "short", "finite", default="short", about="law of the oil film: of a short bearing, or of one of finite width"
    )
    pin_diameter: float = quantity("m", default=0.0, low=0, high=5, about="of a crank pin", only=("mains", "beam"))
    web_width: float = quantity("m", default=0.0, low=0, high=10, about="of a web, across", only=("mains", "beam"))
    web_thickness: float = quantity(
        "m", default=0.0, low=0, high=5, about="of a web along the shaft", only=("mains", "beam")
    )

    @property
    def oiled(self) -> bool:
        """Whether the film of its bearings can be computed."""
        return min(self.journal_diameter, self.bearing_width, self.clearance, self.oil_viscosity) > 0


@record
class Journal:
    """A main bearing with what the shaft presses on it over a turn."""

    z: float  #: Place along the shaft [m]
    sense: float  #: Of its shaft, 1 or -1 [-]
    #: shape (n,): Force of the shaft on the bearing, in the frame [N]
    x: np.ndarray
    y: np.ndarray

    @property
    def load(self) -> np.ndarray:
        """Shape (n,) [N]."""
        return np.hypot(self.x, self.y)


def journals(turn: Turn, settings: MainShaft | None = None) -> tuple[Journal, ...]:
    """Loads of all main bearings; none where the throws do not say where they stand along the shaft."""
    settings = settings or MainShaft()
    return tuple(one for sense in (1.0, -1.0) for one in _of_shaft(turn, settings, sense))


def _of_shaft(turn: Turn, settings: MainShaft, sense: float) -> list[Journal]:
    throws = main_roles(turn, sense)
    places = supports([place(turn, role) for role in throws], settings.bearings)
    if len(places) < 2:
        return []
    z, x, y = _loads(turn, throws)
    share = influence(turn, settings, places, z)
    return [Journal(z=float(b), sense=sense, x=row @ x, y=row @ y) for b, row in zip(places, share, strict=True)]


def place(turn: Turn, role: BearingRole) -> float:
    """Where a bearing stands along the shaft [m]."""
    return float(amount(role.z, turn.drive.mechanism.parameters))


def _loads(turn: Turn, throws: list[BearingRole]) -> tuple[Array, Array, Array]:
    """Places and forces on the bearings of what loads a shaft: each rod at its own, the rest of a throw at its middle.

    Returns z, shape (m,) [m], and x, y, shape (m, n) [N].
    """
    R, rows = turn.reactions, []
    pins = [role for role in turn.drive.roles.bearings if role.main]
    for role in throws:
        own = [pin for pin in pins if pin.main == role.name]
        carried = [[-R[n] for n in pin.reactions] for pin in own]
        whole = [-R[n] for n in role.reactions]
        left = [total - sum((pair[i] for pair in carried), np.zeros_like(turn.phi)) for i, total in enumerate(whole)]
        rows.append((place(turn, role), *left))
        rows += [(place(turn, pin), *pair) for pin, pair in zip(own, carried, strict=True)]
    z, x, y = zip(*rows, strict=True)
    return np.array(z), np.array(x), np.array(y)


def supports(throws: Sequence[Metre], wanted: Sequence[Metre] = ()) -> Metre[Array]:
    """Places of the bearings of a shaft, ascending; by default one between all throws and one beyond each end.

    throws: places of its throws. Returns places: shape (m,); none where a single throw says no pitch.
    """
    if wanted:
        return np.array(sorted(wanted))
    z = np.array(sorted(throws))
    if len(z) < 2 or np.diff(z).min() <= 0:
        return np.zeros(0)
    between = (z[1:] + z[:-1]) / 2
    return np.array([1.5 * z[0] - 0.5 * z[1], *between, 1.5 * z[-1] - 0.5 * z[-2]])


def influence(turn: Turn, settings: MainShaft, places: Metre[Array], z: Metre[Array]) -> Pure[Array]:
    """What of a load at each place goes to each bearing: shape (bearings, loads)."""
    if settings.mains == "determinate":
        return determinate(places, z)
    stiffness = settings.bending_stiffness or _of_sizes(turn, settings, places)
    return beam(places, z, 1 / stiffness, 1 / settings.support_stiffness)


def determinate(places: Metre[Array], z: Metre[Array]) -> Pure[Array]:
    """Shares by the lever of each bay, the last one beyond its ends too: shape (bearings, loads)."""
    share = np.zeros((len(places), len(z)))
    for j, at in enumerate(z):
        i = int(np.clip(np.searchsorted(places, at) - 1, 0, len(places) - 2))
        right = (at - places[i]) / (places[i + 1] - places[i])
        share[i, j], share[i + 1, j] = 1 - right, right
    return share


def beam(places: Metre[Array], z: Metre[Array], flexibility: float, compliance: float) -> Pure[Array]:
    """Shares of a continuous shaft on elastic supports: shape (bearings, loads).

    flexibility: 1/EI [1/(N m^2)], 0 for a rigid shaft; compliance: of a support, 1/k [m/N], 0 for a rigid one.
    """
    n, span = len(places), float(np.ptp(places))
    b, s = places / span, z / span
    bend = flexibility * span**3 / 12
    size = max(bend, compliance)  # both flexibilities by the larger one, so that their ratio counts alone
    cubes = bend / size * np.abs(b[:, None] - b) ** 3 + compliance / size * np.eye(n)
    balance = np.stack([np.ones(n), b])
    matrix = np.block([[cubes, -balance.T], [balance, np.zeros((2, 2))]])
    right = np.vstack([bend / size * np.abs(b[:, None] - s) ** 3, np.ones(len(s)), s])
    return np.asarray(np.linalg.solve(matrix, right)[:n])


def _of_sizes(turn: Turn, settings: MainShaft, places: Metre[Array]) -> float:
    """EI of a uniform shaft that bends as much as journals, webs and pins of a bay one behind the other [N*m^2].

    A web bends over the crank radius about its thickness, as a beam that is clamped at both ends' angles.
    """
    needs = {
        name: getattr(settings, name) for name in ("journal_diameter", "pin_diameter", "web_width", "web_thickness")
    }
    if lacking := [f"shaft.{name}" for name, value in needs.items() if value <= 0]:
        raise BadInput(f"a continuous shaft needs shaft.bending_stiffness, or its sizes: {', '.join(lacking)}")
    throw = max(float(amount(r.throw, turn.drive.mechanism.parameters)) for r in turn.drive.roles.bearings if r.throw)
    bay, thick = float(np.diff(places).mean()), settings.web_thickness
    round_part = (bay - 2 * thick) / 2
    if round_part <= 0:
        raise BadInput(f"shaft.web_thickness = {thick:g} m leaves no room in a bay of {bay:.4g} m; give less")
    bends = [
        round_part / (math.pi * settings.journal_diameter**4 / 64),
        round_part / (math.pi * settings.pin_diameter**4 / 64),
        2 * throw / (settings.web_width * thick**3 / 12),
    ]
    return STEEL * bay / sum(bends)


def specific_load(journal: Journal, settings: MainShaft) -> Pascal | None:
    """Largest load over width times diameter; None where the case does not give both."""
    area = settings.bearing_width * settings.journal_diameter
    return float(journal.load.max()) / area if area > 0 else None


WIDE, FAR = 0.5, 0.8  #: Width over diameter and eccentricity up to which a short bearing is good [-]
FINITE, FINITE_FAR = (0.25, 1.0), 0.95  #: The same of the fits for a finite one, from and to [-]
_TOUCHING = 1 - 1e-9  # a step of the integrator may try more
_CYCLES = 12
_CLOSED = 1e-4  # change of the eccentricity from one cycle to the next


@record
class Orbit:
    """Where a journal is in its bearing over a cycle that repeats."""

    eccentricity: np.ndarray  #: shape (n,): x + iy in the block, over the clearance [-]
    thinnest: float  #: Least film over the cycle [m]
    power: float  #: Mean power that squeezing and shearing a full film take: an upper estimate of the heat [W]
    settled: bool  #: Whether two cycles agree


def impedance(eccentricity: Pure, direction: Radian) -> complex:
    """The integral above for an eccentricity along x and a velocity of 1 in a direction, x + iy [-]."""
    e, root = eccentricity, 1 - eccentricity * eccentricity
    low, high = (_sommerfeld(e, direction + side * math.pi / 2) for side in (-1, 1))
    sin_l, cos_l, sin_h, cos_h = math.sin(low), math.cos(low), math.sin(high), math.cos(high)
    doubled = sin_h * cos_h - sin_l * cos_l  # half of what sin(2 g) grows by
    cc = ((e * e + 0.5) * (high - low) + 2 * e * (sin_h - sin_l) + doubled / 2) / root**2.5
    cs = (e * (cos_l - cos_h) + (cos_l * cos_l - cos_h * cos_h) / 2) / root**2
    ss = (high - low - doubled) / 2 / root**1.5
    c, s = math.cos(direction), math.sin(direction)
    return complex(cc * c + cs * s, cs * c + ss * s)


def _sommerfeld(e: float, psi: float) -> float:
    """Sommerfeld's angle for 1 - e cos(psi), continuous for psi from -2 pi to 2 pi."""
    return 2 * math.atan2(math.sqrt((1 + e) / (1 - e)) * math.sin(psi / 2), math.cos(psi / 2))


def velocity(eccentricity: complex, load: complex) -> complex:
    """Velocity of the journal for a load, both over their units: (mu L^3 R/c^3) v = W.

    The load drives the motion, so the velocity stands within a quarter turn of it, and the direction of the impedance
    grows with that of the velocity.
    """

    e, turned = min(abs(eccentricity), _TOUCHING), (eccentricity / abs(eccentricity) if eccentricity else 1.0)
    seen = load / turned  # with the eccentricity along x
    across = (seen / abs(seen)).conjugate()
    beta = cmath.phase(seen)
    alpha = root(lambda alpha: (impedance(e, alpha) * across).imag, beta - math.pi / 2, beta + math.pi / 2, xtol=1e-12)
    return complex(turned * abs(seen) / abs(impedance(e, alpha)) * cmath.rect(1.0, alpha))


def rotation(eccentricity: Pure, width: Pure) -> tuple[Pure, Radian]:
    r"""Sommerfeld number over the eccentricity, and attitude, of a finite bearing in which the shaft turns.

    .. math:: \frac{So}{\varepsilon} = \frac{b^2}{2 (1 - \varepsilon^2)^2}
              \sqrt{\pi^2 (1 - \varepsilon^2) + 16 \varepsilon^2}\; \frac{a_1 (\varepsilon - 1)}{a_2 + \varepsilon},
              \qquad So = \frac{F \psi^2}{B D \eta\, \omega}

    eccentricity: over the clearance; width: b = B/D. Returns both: So over eps, and the angle from the load to the
    narrowest gap. Source: H.-J. Butenschoen, thesis, Karlsruhe (1976); coefficients as in the multibody code MBDyn.
    Valid: full bearing, film that ends where its pressure and slope are 0. Against a solution of Reynolds' equation,
    eccentricity 0.1 to 0.95: So within 6 % at B/D of 0.25, 0.5 and 1, 10 % at 0.75; the angle within 5 degrees.

    >>> so, angle = rotation(0.8, 0.5)
    >>> round(0.8 * so, 3), round(math.degrees(angle), 1)
    (1.784, 31.2)
    """
    e, b = eccentricity, width
    a1 = 1.1642 - 1.9456 * b + 7.1161 * b**2 - 10.1073 * b**3 + 5.0141 * b**4
    a2 = -1.000026 - 0.023634 * b - 0.4215 * b**2 - 0.038817 * b**3 - 0.090551 * b**4
    so = b**2 / (2 * (1 - e * e) ** 2) * math.sqrt(math.pi**2 * (1 - e * e) + 16 * e * e) * a1 * (e - 1) / (a2 + e)
    fit = (
        (1.152624 - 0.104565 * b)
        + (-2.5905 + 0.798745 * b) * e
        + (8.73393 - 2.3291 * b) * e**2
        + (-13.3414 + 3.424337 * b) * e**3
        + (6.6294 - 1.591732 * b) * e**4
    )
    return so, math.atan2(math.pi * math.sqrt(1 - e * e), 2 * e) * fit


def squeeze(eccentricity: Pure, width: Pure) -> Pure:
    r"""Sommerfeld number of a finite bearing whose gap is squeezed.

    .. math:: So_v = \frac{4 b^2}{(1 - \varepsilon^2)^{5/2}} \left[\left(\tfrac\pi2 - \tfrac12 \arccos\varepsilon\right)
              (1 + 2\varepsilon^2) + \tfrac32 \varepsilon \sqrt{1 - \varepsilon^2}\right]
              \frac{a_8 (1 - \varepsilon)}{-a_9 - \varepsilon}, \qquad
              So_v = \frac{F \psi^2}{B D \eta\, \dot\varepsilon}

    eccentricity: over the clearance, negative where it shrinks; width: b = B/D. Source and validity: as `rotation`;
    within 5 % at B/D of 0.25, 0.5 and 1, 19 % too large at 0.75.

    >>> round(squeeze(0.8, 0.5), 2)
    27.33
    """
    e, b = eccentricity, width
    a8 = 0.70038 + 3.2415 * b - 12.2486 * b**2 + 18.895 * b**3 - 9.3561 * b**4
    a9 = -0.999935 + 0.0157434 * b - 0.74224 * b**2 + 0.42278 * b**3 - 0.368928 * b**4
    half = (math.pi / 2 - math.acos(e) / 2) * (1 + 2 * e * e) + 1.5 * e * math.sqrt(1 - e * e)
    return 4 * b**2 * (1 - e * e) ** -2.5 * half * a8 * (1 - e) / (-a9 - e)


def finite_velocity(eccentricity: complex, load: complex, width: Pure) -> complex:
    """The same as `velocity`, for the same unit of the load, of a bearing of finite width B/D.

    The load across the line of centres says how fast the film turns, what is left along it how fast it is squeezed.
    """
    e = min(abs(eccentricity), _TOUCHING)
    turned = eccentricity / abs(eccentricity) if eccentricity else 1.0
    seen = 2 * width**2 * load / turned  # over B D eta omega / psi^2
    so, attitude = rotation(e, width)
    across = seen.imag / (2 * so * math.sin(attitude))
    left = seen.real - abs(seen.imag) / math.tan(attitude)
    return turned * complex(left / squeeze(math.copysign(e, left), width), across)


def orbit(journal: Journal, film: MainShaft, omega: RadPerSecond, phi: Radian[Array], period: Radian) -> Orbit:
    """Motion of a journal under its load, run until it repeats. phi: crank angles of the loads, evenly spaced."""
    from scipy.integrate import solve_ivp

    load = journal.x + 1j * journal.y
    unit = film.oil_viscosity * film.bearing_width**3 * film.journal_diameter / 2 * omega / film.clearance**2
    closed = np.append(load, load[0]) / unit
    angles = np.append(phi, period)
    half = 0.5j * journal.sense  # the frame of the squeeze turns with half the speed
    width = film.bearing_width / film.journal_diameter
    law = velocity if film.film == "short" else partial(finite_velocity, width=width)

    def slope(at: float, e: Array) -> list[float]:
        pull = np.interp(at % period, angles, closed)
        eps = complex(e[0], e[1])
        v = law(eps, complex(pull)) + half * eps if pull else half * eps
        return [v.real, v.imag]

    start, before = [0.3, 0.0], np.zeros(len(phi), dtype=complex)
    for cycle in range(_CYCLES):
        run = solve_ivp(slope, (0.0, period), start, "LSODA", angles, rtol=1e-6, atol=1e-8, max_step=period / 60)
        now = run.y[0, :-1] + 1j * run.y[1, :-1]
        settled = bool(cycle and np.abs(now - before).max() < _CLOSED)
        if settled:
            break
        start, before = run.y[:, -1].tolist(), now
    radius = film.journal_diameter / 2
    shear = 2 * math.pi * film.oil_viscosity * omega**2 * radius**3 * film.bearing_width / film.clearance
    slopes = np.gradient(np.append(now, now[0]), np.linspace(0, period, len(now) + 1))[:-1]
    squeezed = (slopes - 0.5j * journal.sense * now) * omega * film.clearance
    work = load.real * squeezed.real + load.imag * squeezed.imag
    return Orbit(
        eccentricity=now,
        thinnest=film.clearance * (1 - float(np.abs(now).max())),
        power=float(np.mean(shear / np.sqrt(1 - np.abs(now) ** 2) + work)),
        settled=settled,
    )


def beyond(film: MainShaft, orbit: Orbit) -> str:
    """What a short bearing is no longer good for; empty within its range."""
    wide, far = film.bearing_width / film.journal_diameter, float(np.abs(orbit.eccentricity).max())
    if film.film == "finite":
        low, high = FINITE
        if not low <= wide <= high:
            return f"a width of {wide:.2g} diameters: the law of a finite bearing is fitted from {low} to {high:g}"
        if far > FINITE_FAR:
            return f"an eccentricity of {far:.3g}: the law of a finite bearing is good up to {FINITE_FAR}"
    elif wide > WIDE:
        return (
            f"a width of {wide:.2g} diameters: a short bearing is good up to {WIDE}, a wider one carries less; take "
            "shaft.film = 'finite'"
        )
    elif far > FAR:
        return f"an eccentricity of {far:.3g}: a short bearing is good up to {FAR}"
    return "" if orbit.settled else f"its orbit does not repeat within {_CYCLES} cycles"
