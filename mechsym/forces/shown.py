"""What of a force analysis is worth seeing: its cards, its figures, its curves."""

from mechsym.forces import plots
from mechsym.forces.result import Forces
from mechsym.forces.summary import half
from mechsym.page import Card, Picture, View, shows
from mechsym.quantities.display import figure, quantity_text

_LARGEST = (("crank pin", "crank_pin", "_load"), ("main bearing", "main_bearing", "_load"),
            ("side force on a guide", "side_force", ""), ("tooth force", "tooth_force", ""),
            ("guide of a slider", "X_", ""))  # fmt: skip


@shows(Forces)
def forces_view(found: Forces) -> View:
    """Largest loads, friction and shaking of a turn."""
    return View(
        title=f"Forces of {found.turn.drive.name} at {quantity_text(found.turn.omega, 'rad/s')}",
        cards=_cards(found),
        pictures=_pictures(found),
        columns=lambda: found.columns,
    )


def _cards(found: Forces) -> tuple[Card, ...]:
    cards = []
    for name, start, end in _LARGEST:
        fitting = {k: abs(v).max() for k, v in found.columns.items() if k.startswith(start) and k.endswith(end)}
        if fitting:
            largest = max(map(float, fitting.values()))
            most = next(k for k, v in fitting.items() if v >= (1 - 1e-6) * largest)  # the first of equal ones
            where = most.replace("_load", "").replace("_", " ")
            about = "largest" if where in name else f"largest, {where}"
            cards.append(Card(name=name, value=quantity_text(float(fitting[most]), "N", 4), about=about))
    torque, of = found.turn.torque, "of one piston, " if half(found) else ""
    about = f"{of}{quantity_text(float(torque.min()), 'N*m', 4)} to {quantity_text(float(torque.max()), 'N*m', 4)}"
    cards.append(Card(name="torque at the shaft", value=quantity_text(float(torque.mean()), "N*m", 4), about=about))
    if found.losses is not None:
        share = found.losses.mechanical_efficiency
        told = of.rstrip(", ") if share is None else f"{of}mechanical efficiency {figure(100 * share, 4)} %"
        power = quantity_text(sum(found.losses.places.values()), "W", 4)
        cards.append(Card(name="friction", value=power, about=told))
    weight = found.shaking.counterweight
    size = max((float(abs(v).max()) for k, v in found.columns.items() if k != "phi_deg"), default=1.0)
    shaken = 0.0 if weight.rms_before < 1e-9 * size else weight.rms_before
    cards.append(Card(name="shaking force", value=quantity_text(shaken, "N", 4),
                      about="root mean square, without a further counterweight"))  # fmt: skip
    return tuple(cards)


def _pictures(found: Forces) -> tuple[Picture, ...]:
    beside = "; dotted, the rod as two masses" if plots.lumped(found) else ""
    rows = [
        Picture(name="forces", draw=lambda: plots.chain(found), see=f"Exact forces over the cycle{beside}."),
        Picture(name="polar", draw=lambda: plots.polar_diagrams(found),
                see="The crank pin's load seen from the crank, the main bearing's from the frame: where a bearing is "
                "never loaded, oil may enter."),
        Picture(name="orders", draw=lambda: plots.orders(found),
                see="Amplitudes by order, oscillations per turn: what a counterweight can take and what it cannot."),
    ]  # fmt: skip
    if found.losses is not None:
        rows.append(Picture(name="friction", draw=lambda: plots.friction(found), see="Where friction takes its power."))
    if found.comparison is not None:
        made = found.comparison
        rows.append(Picture(name="comparison", draw=lambda: plots.comparison(made),
                            see="The mechanisms at equal stroke, mass and indicator diagram."))  # fmt: skip
    return tuple(rows)
