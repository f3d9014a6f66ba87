"""Forces of a mechanism of the user's own in a report: what bears what, friction, shaking, and its torque."""

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.cases import Case
from mechsym.jobs import own_turn
from mechsym.jobs.report.part import ReportPart
from mechsym.mechanisms import own_drawing, plots
from mechsym.mechanisms.record import listing
from mechsym.page import Grid, Picture, View
from mechsym.quantities.display import figure, quantity_text, shown_in
from mechsym.style import SERIES, axis_unit, over_angle, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def own_force_part(title: str, case: Case) -> ReportPart:
    """The part of a force analysis over one cycle at constant speed."""
    found = own_turn.turn(case)
    numbers = own_turn.summary(found, case)
    torque = [numbers[key]["driving_torque"] for key in ("max", "min")]
    highest, lowest = (quantity_text(value, "N*m", 4) for value in torque)
    return ReportPart(
        name="forces", title=title, view=_view(case, found), facts=tuple(_facts(numbers)), grids=(_borne(numbers),),
        verdict=f"At {figure(numbers['speed_rpm'], 4)} rpm it takes a driving torque of {lowest} to {highest}.",
        silent=("rigid links at constant speed; friction of the first order",), numbers=numbers,
    )  # fmt: skip


def _facts(numbers: dict[str, Any]) -> list[str]:
    lost, shaken = numbers["friction"], numbers["shaking"]
    facts = []
    if lost is not None:
        facts.append(f"friction takes {quantity_text(lost['power'], 'W', 4)}" if lost["places"] else lost["note"])
    if shaken is not None:
        weight = shaken["counterweight"]
        before, after = (quantity_text(weight[key], "N", 4) for key in ("rms_before", "rms_after"))
        facts.append(
            f"shaking force {before} rms; {after} with a counterweight of {figure(weight['unbalance'], 4)} kg*m "
            f"at {figure(weight['angle_deg'], 4)} deg from the crank"
        )
    return facts


def _borne(numbers: dict[str, Any]) -> Grid:
    """Torque and reactions with the joints they act in."""
    rows = [_row(numbers, name, who) for name, who in {"driving_torque": "", **numbers["reactions"]}.items()]
    return Grid(
        title="What bears what", headings=("quantity", "largest", "smallest", "of"), rows=tuple(rows),
        numbers=(False, True, True, False),
    )  # fmt: skip


def _row(numbers: dict[str, Any], name: str, who: str) -> tuple[str, ...]:
    values, unit = shown_in([numbers["max"][name], numbers["min"][name]], numbers["units"][name])
    return name.replace("_", " "), *(f"{figure(value, 4)} {unit}" for value in values), who


def _view(case: Case, found: own_turn.OwnTurn) -> View:
    pictures = [Picture(name="torque", see="The torque that holds the speed.", draw=partial(_torque, found))]
    shapes = own_drawing.drawn(found.mechanism, listing(case.mechanism))
    if shapes is not None:
        drawing = partial(plots.figure_of, shapes, np.pi / 3)
        pictures.insert(0, Picture(name="mechanism", see="The mechanism at 60 deg.", draw=drawing))
    return View(title="Forces", cards=(), pictures=tuple(pictures))


def _torque(found: own_turn.OwnTurn) -> "Figure":
    drawn, axes = panels(9, 3.5, 1, 1, "Driving torque over the crank angle")
    values = found.columns["driving_torque"]
    axis = np.ravel(np.asarray(axes))[0]
    factor, unit = axis_unit("N*m", values)
    angle = over_angle(axis, float(found.phi[-1] + found.phi[1]))
    axis.plot(found.phi * angle, values * factor, color=SERIES[0])
    axis.set_ylabel(f"torque [{unit}]")
    return drawn
