"""Small sections of a case: where the machine runs, its flywheel, how long trials take, which other speed is tried,
and what the gas must not exceed (`[gas_limits]`, doubted by every command and held by `mechsym optimise`).
"""

import math
from dataclasses import asdict

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.quantities import quantity, record, reference
from mechsym.quantities.ranges import MOST
from mechsym.quantities.units import Pure, RadPerSecond, Second
from mechsym.simulate.settings import Settings, Simulation


@record
class Operation:
    """Where the machine runs."""

    speed: float = quantity("rad/s", low=0.1, high=1e5, about="mean crank speed")


@record
class FlywheelSettings:
    """A flywheel that the engine keeps beside the hinge."""

    inertia: float = quantity("kg*m^2", low=0, about="inertia about the shaft")


@record
class TrialSettings:
    """How long the trials run."""

    turns: float = quantity("-", default=20.0, low=4, high=1000, about="turns of the crank")


@record
class RetuneSettings:
    """At which other speed the guide is tried."""

    case: str = reference("case")  #: Name or path of the case with the other speed


@record
class ReportSettings:
    """How results are shown."""

    units: str = ""  #: Units of text and tables: "mm, MPa, kN, kN*m, deg, rpm, kW"
    #: Title block of `mechsym report`
    project: str = ""
    engine: str = ""
    author: str = ""
    date: str = ""


@record
class Speeds:
    """The speeds of a performance map."""

    lowest: float = quantity("rad/s", above=0, about="first speed")
    highest: float = quantity("rad/s", above=0, about="last speed")
    step: float = quantity("rad/s", above=0, about="distance between speeds")

    def __post_init__(self) -> None:
        if self.highest < self.lowest:
            raise BadInput(f"highest = {self.highest:g} rad/s is below lowest = {self.lowest:g} rad/s")
        if 0 < self.highest - self.lowest < self.step:
            problem = (
                f"step = {self.step:g} rad/s is wider than the range from {self.lowest:g} to {self.highest:g} rad/s"
            )
            raise BadInput(f"{problem}; give a smaller one")


@record
class GasLimits:
    """Limits of the gas that the user sets; one that is left out is none."""

    peak_pressure: float | None = quantity("Pa", default=None, above=0, below=1e9, about="absolute, in the cylinder")
    peak_temperature: float | None = quantity("K", default=None, above=0, below=1e4, about="mean over the cylinder")
    knock: float | None = quantity("-", default=None, above=0, below=1e3, about="integral that ends in knock at 1")


TURN_POINTS = 360  # results a turn of a run over turns


def simulation_of(case: Case) -> Simulation:
    """Section `[simulation]`, or 20 turns from the speed of operation."""
    if "simulation" in case.sections or "operation" not in case.sections:
        return case.need("simulation")
    return Simulation(turns=20.0)


def count_turns(case: Case, turns: float) -> None:
    """Refuse more turns [-] than results fit."""
    _count(case, "turns", turns * TURN_POINTS, f"give at most {MOST // TURN_POINTS} turns")


def count_times(case: Case, t_end: Second, output_step: Second) -> None:
    """Refuse results closer than fit. t_end, output_step: length of the run and spacing of its results."""
    way_out = f"give at least {t_end / MOST:.3g} s, or a shorter t_end"
    _count(case, "output_step", t_end / output_step, way_out)


def count_loop(case: Case, turns: Pure, t_end: Second, speed: RadPerSecond) -> None:
    """Refuse a run of gas in the loop, whose results lie at even times.

    turns: infinite where only the time ends it; t_end: infinite where only the turns end it; speed: at the start.
    """
    in_time = t_end * speed / (2 * math.pi)
    if turns <= in_time:
        return count_turns(case, turns)
    most = MOST / TURN_POINTS * 2 * math.pi / speed
    return _count(case, "t_end", in_time * TURN_POINTS, f"give at most {most:.3g} s")


def _count(case: Case, key: str, points: float, way_out: str) -> None:
    if points > MOST:
        simulation = simulation_of(case)
        asked = (
            f"{simulation.step if key == 'output_step' else getattr(simulation, key):g}{'' if key == 'turns' else ' s'}"
        )
        raise BadInput(
            f"{case.file}: simulation.{key} = {asked} asks for {points:.3g} results; allowed are {MOST}; {way_out}"
        )


def settings_of(case: Case) -> Settings:
    """Tolerance and integrator of a case."""
    wanted = simulation_of(case)
    return Settings(tolerance=wanted.tolerance, backend=wanted.backend, difference_allowed=wanted.difference_allowed)


def guesses(case: Case) -> dict[str, float]:
    """Coordinates and velocities at the start: those of `[start]`, else of the pose of the declaration.

    Of coordinates that loops hold they are guesses [rad] or [m]; `simulation.phi_start` goes before the pose.
    """
    section, posed = case.sections.get("start"), mechanisms.listing(case.mechanism).get("pose", {})
    if posed and case.sections.get("simulation") is not None and case.need("simulation").phi_start:
        posed = {}
    return posed | ({} if section is None else {k: v for k, v in asdict(section).items() if v is not None})
