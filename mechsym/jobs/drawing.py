"""The moving machine of a case: its bodies over the crank angle, to scale."""

from collections.abc import Callable

from mechsym.cases import Case
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.forces.moving import charged
from mechsym.hinge.guide import Guide
from mechsym.hinge.moving import hinge_scene
from mechsym.jobs.gas import gas
from mechsym.jobs.machine import acting_on, drive_of, one_coordinate
from mechsym.mechanisms.drawing import Shapes, drawn
from mechsym.mechanisms.turning import FRAMES, scene


def drawing(case: Case) -> Callable[[float], Shapes] | None:
    """Crank angle [rad] to the machine of a case as its declaration draws it; None where nothing draws it."""
    try:
        acting = gas(case)
        bore = None if acting is None else float(acting.chamber.bore)
        return drawn(case.mechanism, case.need("parameters"), lambda: one_coordinate(case), bore)
    except BadInput:
        return None


def with_gas(scenes: list[Json], case: Case) -> list[Json]:
    """Scenes of a case whose first shows what the gas of its cycle does; as they are where there is none."""
    if not scenes or "cycle" not in case.sections:
        return scenes
    try:
        drive = drive_of(case)
        acting = acting_on(case, drive)
    except BadInput:
        return scenes
    return [charged(scenes[0], drive, acting), *scenes[1:]]


def turning(case: Case, guide: Guide | None = None) -> list[Json]:
    """The machine of a case as a page turns it, and the hinge of a guide; nothing of one without a drawing."""
    shapes, found = drawing(case), []
    turns = 1 if guide is None else max(1, round(1 / guide.parameters.shaft_ratio))
    if shapes is not None:
        found.append(scene(shapes, "the machine to scale", turns, turns * FRAMES))
    if guide is not None:
        found.append(hinge_scene(guide, case.need("rollers"), turns, turns * FRAMES))
    return with_gas(found, case)
