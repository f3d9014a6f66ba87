"""What track and rollers of a guide may be asked: pressure angle, bulges of the profile, contact force and pressure."""

import math

import casadi as ca
import numpy as np

from mechsym.hinge import rollers as contact
from mechsym.hinge.bounds.face import GuideLimit, Rows, Station
from mechsym.quantities.units import Scalar


def _slope(at: Station, setting: Scalar) -> Rows:
    slope, steepest = at.drho / at.rho, ca.tan(setting)
    return (slope / steepest, -math.inf, 1.0), (-slope / steepest, -math.inf, 1.0)


PRESSURE_ANGLE = GuideLimit(
    name="pressure_angle", words="pressure angle", shown="deg",
    unit="rad", about="pressure angle", allowed={"above": 0, "below": math.pi / 2},
    value=lambda at, setting: np.abs(at.pressure_angle), smooth=_slope,
    rising=lambda at, setting: np.abs(at.drho / at.rho), of_rising=lambda top, setting: np.arctan(top) / setting,
)  # fmt: skip


def _bulge(bend: float, most: float, profile_radius: float, at: Station) -> str:
    if bend <= 0:
        return f"the path never bends inwards; a bulge may have {profile_radius * 1e3:.4g} mm"
    radius = at.rollers.radius
    largest = (radius + profile_radius) / bend
    return (
        f"the path bends inwards with a radius of {largest * 1e3:.4g} mm, which leaves the profile "
        f"{(largest - radius) * 1e3:.4g} mm at a roller radius of {radius * 1e3:.4g} mm"
        + (" (undercut)" if largest <= radius else "")
        + f"; at least {profile_radius * 1e3:.4g} mm"
    )


UNDERCUT = GuideLimit(
    name="undercut", words="bend inwards by what the roller allows", shown="", text=_bulge, signed=True,
    unit="m", about="radius of the profile where it bulges towards the roller", allowed={"low": 0},
    value=lambda at, setting: -at.curvature * (at.rollers.radius + setting), most=lambda at, setting: 1.0,
    stricter=lambda setting, by, radius: (radius + setting) * by - radius,
)  # fmt: skip

ROLLER_REACTION = GuideLimit(
    name="roller_reaction", words="roller reaction", shown="kN",
    unit="N", about="contact force on a roller", allowed={"above": 0},
    value=lambda at, setting: at.reaction,
    smooth=lambda at, setting: ((at.reaction / setting, 0.0, 1.0),),  # the track can only push
)  # fmt: skip


def _pressed(at: Station, setting: Scalar) -> Rows:
    # by 1 + r kappa on both sides, so that there is a number where the profile is undercut
    r, modulus = at.rollers.radius, contact.contact_modulus(at.rollers)
    pressed = at.reaction * modulus / (math.pi * at.rollers.width * r * setting**2)
    return ((pressed - r * at.curvature, -math.inf, 1.0),)


HERTZ_STRESS = GuideLimit(
    name="hertz_stress", words="contact pressure", shown="MPa",
    unit="Pa", about="contact pressure", allowed={"above": 0},
    value=lambda at, setting: at.hertz_stress, smooth=_pressed,
)  # fmt: skip

CENTRE = GuideLimit(
    name="centre", words="roller radius beside the path's smallest radius", shown="mm",
    value=lambda at, setting: at.rollers.radius, most=lambda at, setting: at.rho, by_closing=True,
    smooth=lambda at, setting: ((at.rollers.radius / at.rho, -math.inf, 1.0),),
)  # fmt: skip
