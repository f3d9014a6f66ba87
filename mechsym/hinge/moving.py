"""Engine and elastic hinge turning together, with what the spring does at each angle."""

from collections.abc import Callable
from functools import partial

import numpy as np

from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.hinge.contact import at_angles
from mechsym.hinge.drawing import elastic_hinge
from mechsym.hinge.guide import Guide
from mechsym.hinge.result import Design
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.shown import shapes_of
from mechsym.mechanisms.drawing import Shapes, shapes
from mechsym.mechanisms.turning import scene
from mechsym.quantities.display import figure
from mechsym.quantities.units import Pure
from mechsym.style import axis_unit

_FRAMES = 120


def scenes(design: Design) -> list[Json]:
    """The engine, where there is a drawing of it, and the hinge, where there is a guide, over one period."""
    turns = design.hinge.period / (2 * np.pi)
    frames, found = round(_FRAMES * max(1.0, turns)), []
    machine = engine(design)
    if machine is not None:
        found.append(scene(machine, "the engine to scale", turns, frames))
    if design.usable is not None:
        found.append(hinge_scene(design.usable, design.rollers, turns, frames))
    return found


def hinge_scene(guide: Guide, rollers: RollerParameters, turns: Pure, frames: int) -> Json:
    """The hinge alone over some turns of the crank."""
    drawn = elastic_hinge(guide, rollers)
    two = any(shape.role == "second_track" for shape in drawn(0.0))
    tracks = ", first track (red) and second (violet), in planes beside each other" if two else ", track"
    shown = scene(drawn, f"the elastic hinge to scale: spring with its pistons, rollers{tracks}", turns, frames)
    theta = guide.parameters.shaft_ratio * np.linspace(0, 2 * np.pi * turns, frames, endpoint=False) % (2 * np.pi)
    pressure = at_angles(guide, rollers, theta).pressure
    if pressure is not None:
        share = np.rint(100 * pressure / pressure.max()).astype(int).tolist()
        shown["shapes"] = [shape | {"share": share} if shape["role"] == "gas" else shape for shape in shown["shapes"]]
    return shown


def engine(design: Design) -> Callable[[float], Shapes] | None:
    """Crank angle [rad] to a drawing of the engine; None of a mechanism without one."""
    if (own := shapes_of(design)) is not None:
        return own
    gas = design.machine.gas
    bore = float(gas.chamber.bore) if gas is not None else None
    drawn = partial(shapes, design.machine.mechanism.name, design.origin.sections["parameters"], bore=bore)
    try:
        drawn(0.0)
    except BadInput:
        return None
    return drawn


def readouts(design: Design) -> list[Json]:
    """What is read beside the drawing: name, unit and the number as text for each frame."""
    turns = design.hinge.period / (2 * np.pi)
    phi = np.linspace(0, design.hinge.period, round(_FRAMES * max(1.0, turns)), endpoint=False)
    rows: list[tuple[str, str, np.ndarray]] = [("torque on the crank", "N*m", design.hinge.torque(phi))]
    if design.usable is not None:
        theta = design.guide.parameters.shaft_ratio * phi % (2 * np.pi)
        turn = at_angles(design.usable, design.rollers, theta)
        rows += [] if turn.pressure is None else [("excess pressure in the spring", "Pa", turn.pressure)]
        rows += [("spring force", "N", turn.force), ("roller force N₁", "N", turn.reaction_1)]
        rows += [("closing of the spring", "m", turn.z)]
    return [_readout(*row) for row in rows]


def _readout(name: str, si: str, values: np.ndarray) -> Json:
    factor, unit = axis_unit(si, values)
    return {"name": name, "unit": unit, "text": [figure(float(v), 4) for v in values * factor]}
