"""SI units of results by their names, for headings: `side_force_1` is in N, `main_bearing_2_x` too, `theta` in rad."""

import re
from collections.abc import Mapping

# names that carry their unit, as speed_rpm does
ENDINGS: Mapping[str, str] = {
    "rpm": "rpm", "bar": "bar", "mpa": "MPa", "kpa": "kPa", "kw": "kW", "deg": "deg", "g_kwh": "g/(kW*h)", "pa": "Pa",
    "k": "K", "m3": "m^3", "n": "N", "nm": "N*m", "kg_s": "kg/s", "j": "J", "w": "W", "kg": "kg", "rad_s": "rad/s",
}  # fmt: skip
_LONGEST_FIRST = "|".join(sorted(ENDINGS, key=len, reverse=True))
_WITH_UNIT = re.compile(rf"^(?P<stem>.+)_(?P<unit>{_LONGEST_FIRST})(?P<rest>_per_cylinder)?$")
_BEARING = "crank_pin|main_bearing|piston_pin|pin|journal"
# the first pattern that fits the whole name says the unit
_PATTERNS = [
    (re.compile(pattern), unit)
    for pattern, unit in (
        (r"phi(_?\w+)?d|thetad|alphad|omega", "rad/s"),
        (r"phi(\d+|_f)?|theta(_\w+)?|alpha|psi(_\d+)?|pressure_angle(_max)?", "rad"),
        (r"(\w*_)?torque(_\d+|_max|_min|_avg|_mean|_peak|_amplitude)?|roll_moment|(two_mass|terskih)_M", "N*m"),
        (r"(brake_)?torque(_avg|_max)?_per_cylinder|(inertia|gas|gravity)_part|(bearing|seal)_loss", "N*m"),
        (r"F(_?[ab]|\d+)?|X_[ab]|R_[xy]_\w+|roller_reaction_\w+|tooth_force\w*|guide_combination", "N"),
        (rf"(\w*_)?force(_\w+)?|({_BEARING})_\d*_?(radial|tangential|load|x|y)|pin_and_guide_[xy]", "N"),
        (r"(two_mass|terskih)_\w+|side_force\w*", "N"),
        (r"x(_\w+)?|rho|z|profile_[xy]|radius\w*|y", "m"),
        (r"drho_dtheta|dx_d\w+", "m/rad"),
        (r"curvature", "1/m"),
        (r"p(_\d+)?|p0|pressure|hertz_stress|spring_excess_pressure", "Pa"),
        (r"work(_\w+)?|hinge_work|dissipation|kinetic_energy|potential_energy", "J"),
        (r"inertia|flywheel", "kg*m^2"),
        (r"t|t_end|window", "s"),
        (r"(brake_)?efficiency|indicated_efficiency|fraction_\w+|energy_residual|speed_ripple|share|difference", "-"),
        (r"knock", "-"),
    )
]


def stem_and_unit(name: str) -> tuple[str, str]:
    """A result's name without the unit that it carries, and its unit: `-` of a pure number, empty where unknown.

    Examples
    --------
    >>> stem_and_unit("speed_rpm"), stem_and_unit("side_force_1"), stem_and_unit("verdict")
    (('speed', 'rpm'), ('side_force_1', 'N'), ('verdict', ''))
    """
    carried = _WITH_UNIT.match(name)
    if carried:
        return carried["stem"] + (carried["rest"] or ""), ENDINGS[carried["unit"]]
    return name, next((unit for pattern, unit in _PATTERNS if pattern.fullmatch(name)), "")
