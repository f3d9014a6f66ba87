"""Loads on the parts: from the forces of a mechanism to gears, pins and bearings, over the cycle and over the speeds.

Arrays have shape (k, n): k speeds, n equal steps over a four-stroke period of 4 pi. The hypocycloid's planet carries a
crankpin in the middle and, on each side, a pinion between two journals; the carrier turns in a main bearing around the
inner journal and in a small outboard bearing:

      middle   inner journal       gear       outer journal   outboard
        |   web   | z_inner          | z_gear    | z_outer       | z_outboard
    ----+---------+------------------+-----------+               |
        F       main bearing        tooth                    shaft end

Source: Nunes (2017), ch. 2.6.3 and 4.5 to 4.8. The distances are read from his sizes (86 mm between bearings, crankpin
34 mm, webs 15 mm, shaft 77 mm, needles 16 mm, pinion 39 mm), which close to the millimetre.
"""

from collections.abc import Callable, Sequence

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, Newton, Pascal, Pure, Radian
from mechsym.sizing.checks import require

SIDE = ("inner_journal", "outer_journal", "main", "outboard")  # places of the bearings of one side


@record
class Spans:
    """Axial places of one side of the crank, from the middle of the crankpin."""

    #: Inner journal and main bearing, middle of the pinion, outer journal, outboard bearing [m]
    inner: float = quantity("m", above=0, about="inner journal")
    gear: float = quantity("m", above=0, about="middle of the pinion")
    outer: float = quantity("m", above=0, about="outer journal")
    outboard: float = quantity("m", above=0, about="outboard bearing")

    def __post_init__(self) -> None:
        if not self.inner < self.gear < self.outer < self.outboard:
            raise BadInput(
                f"spans {self.inner:g}, {self.gear:g}, {self.outer:g}, {self.outboard:g} m must grow outwards"
            )


def over_period(theta: Radian[Array], phi: Radian[Array], p: Pascal[Array], rest: Pascal) -> Pascal[Array]:
    r"""Pressure over the four-stroke period from the closed part of the cycle.

    .. math:: p(\theta) = p_{closed}(\theta) \text{ for } |\theta| \le \pi, \quad p_{rest} \text{ else}

    theta: angles over a period, 0 at firing top dead centre; phi: angles of the closed period at each speed, rising,
    inside -pi .. pi, shape (k, m); p: pressure there, shape (k, m); rest: pressure during the gas exchange. Returns p:
    absolute pressure, shape (k, n).
    Source: Nunes (2017), ch. 3.4.1, which knows only the closed cycle; the exchange is ideal.

    >>> phi, p = np.array([[-np.pi, 0.0, np.pi]]), np.array([[1.0, 9.0, 3.0]])
    >>> [float(x) for x in over_period(np.array([0.0, 2 * np.pi]), phi, p, 1.0)[0]]
    [9.0, 1.0]
    """
    turn = np.mod(np.asarray(theta) + 2 * np.pi, 4 * np.pi) - 2 * np.pi
    return np.array([np.interp(turn, a, b, left=rest, right=rest) for a, b in zip(phi, p, strict=True)])


def tooth_load_printed(F: Newton[Array], theta: Radian[Array]) -> Newton[Array]:
    r"""Tangential tooth load of all gears on one crank, for a planet without mass.

    .. math:: W = F\sin\theta

    F: force on the piston, shape (k, n); theta: crank angle from top dead centre. Returns W: load, shape (k, n).
    Source: Nunes (2017), eq. 2.75; exact for a balanced moment on the planet at constant speed.

    >>> round(float(tooth_load_printed(np.array([27140.0]), np.radians([20.0]))[0]))
    9282
    """
    return np.asarray(F) * np.sin(theta)


def journal_load_massless(F: Newton[Array], theta: Radian[Array]) -> Newton[Array]:
    r"""Load of the planet's journals, both sides together, without mass and without separating force.

    .. math:: J = |F|\sqrt{1 + 3\sin^2\theta}

    F: force on the piston, shape (k, n); theta: crank angle from top dead centre. Returns J: load, shape (k, n).
    Source: balance of the planet (erratum E21). Print: Nunes (2017), ch. 4.8, assumes no more than F.

    >>> round(float(journal_load_massless(np.array([9000.0]), np.array([np.pi / 2]))[0]))
    18000
    """
    return np.abs(F) * np.sqrt(1 + 3 * np.sin(theta) ** 2)


def side_vectors(
    F: Newton[Array], tooth: Newton[Array], radial: Newton[Array], spin: Newton[Array], theta: Radian[Array]
) -> tuple[Newton[Array], Newton[Array], Newton[Array]]:
    r"""Forces on one side of the planet, as vectors along and across the cylinder.

    .. math:: \vec F = -\tfrac12 F\,\hat x, \qquad \vec T = \tfrac12 (W\,\hat t - N\,\hat r), \qquad
              \vec c = \tfrac12 m_2 e\omega^2\,\hat r

    F: net force on the crankpin with all reciprocating mass, positive away from the head, shape (k, n); tooth, radial:
    tangential tooth load (positive in the crank's sense) and separating force of both sides together, shape (k, n);
    spin: centrifugal force m_2 e omega^2 of both sides' shafts and pinions, shape (k,); theta: crank angle from top
    dead centre. Returns force, teeth, centrifugal: on the crankpin, at the gear from the teeth, at the gear from the
    masses, shape (2, k, n). Source: balance of the planet; x towards the head as in derivations/hypocycloid.py.

    >>> one = np.ones((1, 1))
    >>> force, teeth, _ = side_vectors(2 * one, 2 * one, 0 * one, np.zeros(1), np.array([np.pi / 2]))
    >>> [round(float(v), 9) + 0.0 for v in (force[0, 0, 0], teeth[0, 0, 0], teeth[1, 0, 0])]
    [-1.0, -1.0, 0.0]
    """
    s, c = np.sin(theta), np.cos(theta)
    F = np.asarray(F, dtype=float)
    force = np.array([-F / 2, np.zeros_like(F)])
    teeth = np.array([-tooth * s - radial * c, tooth * c - radial * s]) / 2
    return force, teeth, np.asarray(spin)[:, None] / 2 * np.array([c, s])[:, None, :]


def side_loads(
    vectors: tuple[Newton[Array], ...], spans: Spans, shares: tuple[Pure, Pure], places: Sequence[str] = SIDE
) -> dict[str, Newton[Array]]:
    r"""Loads of the bearings of one side, as magnitudes.

    .. math::
        J_{outer} &= s_F\vec F - s_T(\vec T + \vec c), \quad
        J_{inner} = (1 + s_F)\vec F + (1 - s_T)(\vec T + \vec c) \\
        B_{outboard} &= (s_T\vec T - s_F\vec F)\,\frac{z_o - z_i}{z_b - z_i}, \quad
        B_{main} = \vec F + \vec T - B_{outboard}

    vectors: from `side_vectors`, shape (2, k, n); shares: shares s_F, s_T of the outer journal, from
    `turning_shaft.outer_shares`; places: those that are wanted of `SIDE`. Returns loads: `inner_journal`,
    `outer_journal`, `main`, `outboard`, shape (k, n).
    Source: statics. The carrier's counterweight takes the centrifugal force in its own plane. Valid: torque taken off
    at both ends alike (`tooth_share_one_end` says what a single end does), rigid journals without play.

    >>> spans = Spans(inner=0.043, gear=0.0715, outer=0.1, outboard=0.114)
    >>> one, none = np.ones((1, 1)), np.zeros((1, 1))
    >>> vectors = side_vectors(27140.0 * one, none, none, np.zeros(1), np.zeros(1))
    >>> {name: round(float(load[0, 0])) for name, load in side_loads(vectors, spans, (0.1, 0.4)).items()}
    {'inner_journal': 14927, 'outer_journal': 1357, 'main': 14659, 'outboard': 1089}
    """
    force, teeth, centrifugal = vectors
    s_F, s_T = shares
    lever = (spans.outer - spans.inner) / (spans.outboard - spans.inner)

    def outboard() -> np.ndarray:
        return lever * (s_T * teeth - s_F * force)

    of: dict[str, Callable[[], np.ndarray]] = {
        "inner_journal": lambda: (1 + s_F) * force + (1 - s_T) * (teeth + centrifugal),
        "outer_journal": lambda: s_F * force - s_T * (teeth + centrifugal),
        "main": lambda: force + teeth - outboard(),
        "outboard": outboard,
    }
    return {name: np.hypot(*of[name]()) for name in places}


def tooth_share_one_end(spans: Spans, stiffness_ratio: Pure) -> Pure:
    r"""Share of the tooth load that the driving side's gear takes when the torque leaves at that end only.

    .. math:: \frac{W_1}{W} = \frac12 + \left[1 + \frac{k_j}{k_g}\frac{(z_o - z_i)^2}{2 z_g^2}\right]^{-1}

    stiffness_ratio: stiffness of a journal over that of a gear mesh. Returns share: share of one gear; 0.5 would be an
    equal share, above 1 the other gear works against it.
    Source: balance of a rigid planet on springs, inner and outer journals alike and the pinion midway: the carrier that
    gives no torque can take no tangential force but only a couple, so the gears are left to balance the driving
    journals. Print: Nunes (2017), ch. 4.4.3, halves the load. Valid: z_gear midway between the journals.

    >>> spans = Spans(inner=0.043, gear=0.0715, outer=0.1, outboard=0.114)
    >>> [f"{tooth_share_one_end(spans, k):.2f}" for k in (1.0, 5.0)]
    ['1.26', '0.89']
    """
    require("stiffness ratio", stiffness_ratio, "-", low=0)
    lever = (spans.outer - spans.inner) ** 2 / (2 * spans.gear**2)
    return 0.5 + 1 / (1 + stiffness_ratio * lever)


def reversed_tooth_load(W: Newton[Array], returns: int) -> Newton[Array]:
    r"""Load on a tooth root that bends it as much as its own load history, loads of the other flank included.

    .. math:: W_{eq} = \max_\theta\left(A + \tfrac37 B\right)

    W: tooth load over the period; n divisible by `returns`, shape (k, n). returns: how often the same tooth comes into
    mesh in a period: 4 for the planet, 2 for the ring. Returns W_eq: equivalent one-sided load; A is the larger load on
    one tooth in one sense, B the largest in the other, shape (k,). Source: Y_M = 1/(1 - 3/7 F_min/F_max), 0.7 for fully
    reversed load: AGMA 2001-D04, clause 16.2; the line between: ISO 6336-3, annex B with M = 0.4; solved for the load.
    The teeth numbers are in a whole ratio, so each tooth always meets the same crank angles.

    >>> float(reversed_tooth_load(np.array([[9.0, 1.0, -7.0, 0.0]]), 2)[0])
    12.0
    """
    W = np.asarray(W)
    visits = W.reshape(W.shape[0], returns, -1)
    high, low = np.maximum(visits.max(axis=1), 0), np.maximum(-visits.min(axis=1), 0)
    larger, smaller = np.maximum(high, low), np.minimum(high, low)
    return (larger + 3 / 7 * smaller).max(axis=1)
