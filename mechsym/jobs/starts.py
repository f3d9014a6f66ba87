"""Where the motion of a case starts, or is looked for."""

from dataclasses import asdict

from mechsym.cases import Case


def guesses(case: Case) -> dict[str, float]:
    """Coordinates and velocities that `[start]` gives; of coordinates that loops hold they are guesses [rad] or [m]."""
    section = case.sections.get("start")
    return {} if section is None else {k: v for k, v in asdict(section).items() if v is not None}
