"""Section `[codesign]` of a case: the family of operating points, and what is asked of the guides."""

from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record, reference

#: values of the hardware that a programme may choose: smallest and largest share of the value that the case gives [-]
FREE = {"A": (0.5, 4.0), "H": (0.5, 4.0), "rho0": (0.5, 4.0), "radius": (0.5, 4.0), "width": (0.5, 4.0)}
CURVES = ("propeller", "constant_speed")
LOSSES = ("inside", "beside", "none")  # in the programme, computed beside it, left out altogether


@record
class CoDesignSettings:
    """Speeds and loads that one guide has to serve, and the ripple that is allowed."""

    speeds: tuple[float, ...] = quantity("rad/s", above=0, about="speeds of the points")
    #: `propeller`: mep with the square of the speed; `constant_speed`: `loads` at each speed; or a CSV file of points
    curve: str = reference("file", "propeller", words=CURVES)
    loads: tuple[float, ...] = quantity("-", default=(1.0,), above=0, high=2, about="shares of the full load")
    full_speed: float = quantity("rad/s", above=0, about="speed of full load")
    full_load: float = quantity("Pa", above=0, about="mean indicated pressure of full load")
    scavenge: str = "p_s = max(1.05, 1.6 + (mep-8)/6) bar"  #: scavenge pressure of mep, both in bar
    #: case whose combustion stands at the upper end, this case's at the lower; linear in mep
    high_case: str = reference("case", "")
    ripple: float = quantity("-", default=0.02, above=0, below=1, about="allowed (max - min) / mean of the speed")
    springs: float = quantity("-", default=1, low=1, high=3, about="guides with a spring and pressure of their own")
    schedule: str = choice("each_point", "one", default="each_point", about="pressures: set at each point, or one")
    losses: str = choice(
        "by_case",
        *LOSSES,
        default="by_case",
        about="friction and heat in the programme; by case: inside with [losses]",
    )
    saving: float = quantity(
        "-", default=0.3, low=0, below=1, about="share of the bare flywheel that a hinge must save to be a design"
    )
    robust: float = quantity("-", default=0.0, low=0, high=0.2, about="error of every p0 that the ripple must bear")
    free: tuple[str, ...] = ()  #: values of the hardware that are chosen too
    track_radius: float = quantity(
        "m",
        default=0.0,
        low=0,
        high=100,
        about="largest reach of the rollers where hardware is free; 0: 1.5 (rho0 + r)",
    )
    moving_mass: float = quantity("kg", default=0.0, low=0, high=10000, about="mass that moves with each roller")
    misfire_speed: float = quantity(
        "-", default=0.0, low=0, below=1, about="share of the speed that a lost combustion must leave; 0 asks nothing"
    )
    knots: float = quantity("-", default=60, low=12, high=360, about="knots of a guide in a turn")
    angles: float = quantity("-", default=180, low=60, high=1440, about="angles of the programme in a turn")

    def __post_init__(self) -> None:
        if self.curve not in CURVES and not self.curve.endswith(".csv"):
            raise BadInput(f"curve = {self.curve!r} is not an option; options are {', '.join(CURVES)} or a .csv file")
        for name in self.free:
            short = name.rpartition(".")[2]
            if short not in (*FREE, "moving_mass"):
                raise BadInput(f"free = {name!r} is not an option; options are {', '.join((*FREE, 'moving_mass'))}")
        if self.springs % 1 or self.knots % 1 or self.angles % 1:
            given = f"springs = {self.springs:g}, knots = {self.knots:g} and angles = {self.angles:g}"
            raise BadInput(f"{given} must be whole numbers")
        for name in ("speeds", "loads"):
            given = getattr(self, name)
            if len(set(given)) < len(given) or not given:
                raise BadInput(f"{name}: give at least one, each of them once")
