r"""Main bearings at their places: what each journal carries of the loads of all throws.

A throw hangs between its neighbours. With hinges at the journals each bay is a simple beam and its load goes to its two
ends by the lever; a continuous shaft lies on all its supports at once. Its deflection, with loads P at z and
reactions R at b,

.. math:: w(s) = a_0 + a_1 s + \sum_j P_j \frac{|s - z_j|^3}{12 EI} - \sum_i R_i \frac{|s - b_i|^3}{12 EI},

has free ends where force and moment are in balance, and each support gives way by R/k there. Rigid supports
(1/k = 0) and a rigid shaft (1/EI = 0) are values like any other.
"""

import math
from collections.abc import Sequence

import numpy as np

from mechsym.errors import BadInput
from mechsym.forces.turn import Turn, main_roles
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.roles import BearingRole
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Array, Metre, Pascal, Pure
from mechsym.torsion.train import ShaftLimits

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
