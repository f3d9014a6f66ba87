"""Case -> how a run is wanted: length, start, tolerance; one with too many results is refused before it begins."""

import math
from dataclasses import asdict

from mechsym import mechanisms
from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.quantities.ranges import MOST
from mechsym.quantities.units import Pure, RadPerSecond, Second
from mechsym.simulate.settings import Settings, Simulation

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
        found = simulation_of(case)
        asked = f"{found.step if key == 'output_step' else getattr(found, key):g}{'' if key == 'turns' else ' s'}"
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
    section, run = case.sections.get("start"), case.sections.get("simulation")
    posed = {} if run is not None and run.phi_start else mechanisms.listing(case.mechanism).get("pose", {})
    return posed | ({} if section is None else {k: v for k, v in asdict(section).items() if v is not None})
