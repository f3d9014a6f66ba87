"""Units of results by their names, as the commands have them; those of `size` carry theirs: `piston.mass [kg]`."""

from mechsym.quantities.names import stem_and_unit

# names that carry their unit
_ENDINGS = {
    "_rpm": "rpm", "_bar": "bar", "_mpa": "MPa", "_kpa": "kPa", "_kw": "kW", "_deg": "deg", "_g_kwh": "g/(kW*h)",
    "_k": "K",
}  # fmt: skip
# the last part of a dotted name that contains one of these
_PARTS = {
    "rad/s": ("speed_mean", "speed_min", "speed_max", "mean", "min", "max"),
    "s": ("t_end", "t", "window", "tau"),
    "K": ("wall_temperature",),
    "J": ("work_in", "dissipation", "change", "hinge_work_max", "hinge_work_min"),
    "N*m": (
        "load_torque", "hinge_torque_max", "hinge_torque_min", "hinge_torque_mean", "torque_avg", "torque_max",
        "brake_torque", "tilting_couple_max", "torque_mean", "torque_amplitude", "torque_peak", "bearing", "seal",
        "guide", "rolling", "gas", "total",
    ),
    "N": (
        "force_max", "roller_reaction_max", "spring_force_max", "rms_before", "rms_after", "inertia_resultant_max",
        "inertia_resultant_min",
    ),
    "kg*m": ("unbalance",),
    "W": ("power", "indicated_power"),
    "m": (
        "rho_min", "rho_max", "z_min", "z_max", "curvature_radius_min", "undercut_radius", "bearing_radius",
        "face_width",
    ),
    "kg": ("mass_of_one",),
    "rad": ("pressure_angle_max", "phi", "twist_mean", "twist_amplitude", "twist_peak"),
    "Pa": ("spring_pressure_max", "hertz_stress_max", "friction_mean_pressure"),
    "kg*m^2": (
        "flywheel_inertia_saved", "flywheel_inertia_to_turn", "flywheel_inertia_beside_faulty", "flywheel_inertia",
        "flywheel_inertia_bare", "flywheel_inertia_cut_for_one", "flywheel",
    ),
    "-": (
        "energy_residual", "tolerance_difference", "steps", "feasible", "margin", "judged", "speed_ripple",
        "ripple_wanted", "power_residual", "mechanical_efficiency", "reached", "constraint_rank", "constraint_count",
        "iterations", "difference", "load", "in_programme", "springs_that_pay", "efficiency", "brake_efficiency",
        "p0_ratio", "speed_ripple_paper_factor", "torque_ratio_max",
        "torque_ratio_min", "torque_ratio_peak", "share", "fill", "gas_index", "misfire_speed_share", "bearing_mu",
        "seal_mu", "guide_mu", "gamma", "knock", "failing", "converged", "safety_factor",
    ),
}  # fmt: skip
_GROUPS = {
    "losses.shares.": "-", "energy.work.": "J", "fractions.": "-", "loads.": "N", "margins.": "-",
    "angle_of_max_deg.": "deg", "friction.places.": "W", "two_mass": "-", "weight": "-", "bound.swing": "J",
    "bound.singular_values": "J", "losses.extra_fuel": "-", "losses.shaft_efficiency": "-", "losses.share": "-",
    "losses.speed_ripple": "-", "losses.time_ripple": "-",
}  # fmt: skip
_EXTREMES = ("max.", "min.")  # of the columns of `forces`
_KNOWN = {name: unit for unit, names in _PARTS.items() for name in names}


def unit_of(name: str) -> str:
    """Unit of a result.

    Returns
    -------
    unit : str
        `-` for a pure number, empty when the name does not tell
    """
    for group, unit in _GROUPS.items():
        if name.startswith(group):
            return unit
    if name.startswith(_EXTREMES):
        return stem_and_unit(name.partition(".")[2])[1]
    of, _, last = name.rpartition(".")
    if last in ("min", "max") and not name.startswith("speeds."):  # of a list over speeds and loads
        return unit_of(of)
    for ending, unit in _ENDINGS.items():
        if last.endswith(ending):
            return unit
    if name.startswith("event."):
        # coordinates and velocities at an event
        return "s" if last == "t" else "rad/s" if last.endswith("d") else "rad"
    return _KNOWN.get(last, "")
