"""What of a force analysis is worth seeing: its cards, its figures, its curves."""

import numpy as np

from mechsym.forces import cams, plots
from mechsym.forces.result import Forces
from mechsym.forces.summary import CounterweightNumbers, half
from mechsym.page import Card, Finding, Picture, View, card, shows
from mechsym.page.finding import NOT_MET
from mechsym.quantities.display import figure, quantity_text

_LARGEST = (("crank pin", "crank_pin", "_load"), ("main bearing", "main_bearing", "_load"),
            ("side force on a guide", "side_force", ""), ("tooth force", "tooth_force", ""),
            ("guide of a slider", "X_", ""))  # fmt: skip


@shows(Forces)
def forces_view(forces: Forces) -> View:
    """Largest loads, friction and shaking of a turn."""
    return View(
        title=f"Forces of {forces.turn.drive.name} at {quantity_text(forces.turn.omega, 'rad/s')}",
        cards=_cards(forces),
        pictures=_pictures(forces),
        columns=lambda: forces.columns,
        findings=lambda: [
            *(Finding(rank=NOT_MET, words=reason) for reason in forces.unbalanced),
            *cams.findings(forces.turn),
        ],
    )


def _cards(forces: Forces) -> tuple[Card, ...]:
    cards, units = [], forces.columns.units
    for name, start, end in _LARGEST:
        fitting = {k: abs(v).max() for k, v in forces.columns.items() if k.startswith(start) and k.endswith(end)}
        if fitting:
            largest = max(map(float, fitting.values()))
            most = next(k for k, v in fitting.items() if v >= (1 - 1e-6) * largest)  # the first of equal ones
            where = most.replace("_load", "").replace("_", " ")
            about = "largest" if where in name else f"largest, {where}"
            cards.append(Card(name=name, value=quantity_text(float(fitting[most]), units[most], 4), about=about))
    torque, of = forces.turn.torque, "of one piston, " if half(forces) else ""
    mean, low, high = (quantity_text(float(v), units["torque"], 4) for v in (torque.mean(), torque.min(), torque.max()))
    cards.append(Card(name="torque at the shaft", value=mean, about=f"{of}{low} to {high}"))
    if forces.losses is not None:
        share = forces.losses.mechanical_efficiency
        about = of.rstrip(", ") if share is None else f"{of}mechanical efficiency {figure(100 * share, 4)} %"
        power = quantity_text(sum(forces.losses.places.values()), "W", 4)
        cards.append(Card(name="friction", value=power, about=about))
    if forces.shaking is None:
        return tuple(cards)
    weight = forces.shaking.counterweight
    size = max((float(abs(v).max()) for k, v in forces.columns.items() if k != "phi_deg"), default=1.0)
    shaken = 0.0 if weight.rms_before < 1e-9 * size else weight.rms_before
    about = "root mean square, without a further counterweight"
    cards.append(card(CounterweightNumbers, "rms_before", shaken, about))
    return tuple(cards)


def _pictures(result: Forces) -> tuple[Picture, ...]:
    beside = "; dotted, the rod as two masses" if plots.lumped(result) else ""
    rows = [
        Picture(name="forces", draw=lambda: plots.chain(result), see=f"Exact forces over the cycle{beside}."),
        Picture(name="orders", draw=lambda: plots.orders(result),
                see="Amplitudes by order, oscillations per turn: what a counterweight can take and what it cannot."),
    ]  # fmt: skip
    if result.loads.pins and result.loads.bearings:
        rows.insert(1, Picture(name="polar", draw=lambda: plots.polar_diagrams(result),
                    see="The crank pin's load seen from the crank, the main bearing's from the frame: where a bearing "
                    "is never loaded, oil may enter."))  # fmt: skip
    if result.journals:
        rows.append(Picture(name="journals", draw=lambda: plots.journal_loads(result),
                    see="What the shaft presses on each main bearing; neighbours share a throw."))  # fmt: skip
    if result.losses is not None and any(np.abs(v).max() > 0 for v in result.losses.curves.values()):
        see = "Where friction takes its power."
        rows.append(Picture(name="friction", draw=lambda: plots.friction(result), see=see))
    if result.losses is not None and result.losses.mechanical_efficiency is not None and rows[-1].name == "friction":
        rows.append(Picture(name="brake", draw=lambda: plots.brake_bar(result),
                    see="Brake power and what friction takes add up to the net indicated power."))  # fmt: skip
    if result.comparison is not None:
        peers = result.comparison
        rows.append(Picture(name="comparison", draw=lambda: plots.comparison(peers),
                            see="The mechanisms at equal stroke, mass and indicator diagram."))  # fmt: skip
    return tuple(rows)
