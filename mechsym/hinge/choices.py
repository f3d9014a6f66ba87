"""How a track carries the spring, and where its turn starts: the choices of a guide, by name.

Arrangements
    two_tracks              two rollers half a turn apart on two tracks in offset planes, the second track turned by
                            half a turn, so that both rollers move in by the same amount; the planes' offset tilts
    one_roller              one roller against a fixed spring seat
    half_speed_pi_periodic  two rollers on one plane track that repeats every half turn of its shaft; the opposite
                            roller then moves alike, and the shaft turns at half the speed of the cycle

Starts
    as_printed              the spring has its free height at phi = 0, as in the source; where the torque has given
                            work since then, the spring would have to be longer than that
    placed                  the constant of the work is chosen so that the spring is never longer

Source: Zotov et al. (2024), section 3, draws two rollers on one track, which can only give a torque of period pi.
"""

import math

from mechsym.errors import BadInput
from mechsym.hinge.bounds.face import CLOSING, HERTZ_STRESS, PRESSURE_ANGLE, ROLLER_REACTION, SPRING_PRESSURE, UNDERCUT
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Pure, Radian

BALANCES = ("whole_cycle", "every_turn")  # part of the torque that is balanced
ROLLERS = {"two_tracks": 2, "one_roller": 1, "half_speed_pi_periodic": 2}
_PERIODS_MULTIPLE_OF = {"two_tracks": 1, "one_roller": 1, "half_speed_pi_periodic": 2}


@record
class GuideParameters:
    """What is chosen about the guide."""

    arrangement: str = choice(*ROLLERS, about="how the track carries the spring")
    start: str = choice("placed", "as_printed", default="placed", about="where the turn starts on the spring's curve")
    #: Shaft axis to roller centre where the spring has its free height [m]
    rho0: float = quantity("m", above=0, high=100, about="roller centre to shaft axis at free height")
    z_margin: float = quantity(
        "m", default=0.0, low=0, about="smallest closing of a placed start", only=("start", "placed")
    )
    shaft_ratio: float = quantity("-", default=1.0, above=0, about="turns of the guide's shaft per turn of the crank")
    #: Part of the torque to balance, `whole_cycle` or `every_turn`
    balance: str = choice(*BALANCES, default="whole_cycle", about="part of the torque to balance")


@record
class Limits:
    """What the spring, the track and the rollers may be asked; one row for each limit, see `bounds.face`."""

    spring_pressure: float = SPRING_PRESSURE.setting()
    closing_share: float = CLOSING.setting()
    pressure_angle: float = PRESSURE_ANGLE.setting()
    profile_radius: float = UNDERCUT.setting()
    roller_reaction: float = ROLLER_REACTION.setting()
    hertz_stress: float = HERTZ_STRESS.setting()


def closing_ratio(arrangement: str, period: Radian) -> Pure:
    """The fastest shaft on which a track closes after one turn.

    period: period of the torque over the crank angle. Returns shaft_ratio: turns of the guide's shaft per turn of the
    crank.
    """
    return 2 * math.pi / (period * _PERIODS_MULTIPLE_OF[arrangement])


def refuse_open_track(parameters: GuideParameters, period: Radian) -> None:
    """Refuse a shaft ratio with which the track would not close. period: period of the torque over the crank angle."""
    multiple = _PERIODS_MULTIPLE_OF[parameters.arrangement]
    periods = 2 * math.pi / (period * parameters.shaft_ratio)
    if round(periods) < 1 or abs(periods - round(periods)) > 1e-9 or round(periods) % multiple:
        raise BadInput(
            f"guide.shaft_ratio = {parameters.shaft_ratio:g}: the {parameters.arrangement} track does not close, since "
            f"the torque repeats every {period / (2 * math.pi):g} turns of the crank; "
            f"use {closing_ratio(parameters.arrangement, period):g}"
        )
