"""What of a start-up is worth seeing."""

import numpy as np

from mechsym.page import Card, Picture, View, shows
from mechsym.quantities.display import figure, quantity_text
from mechsym.torsion import plots
from mechsym.torsion.startup import StartUp


@shows(StartUp)
def startup_view(found: StartUp) -> View:
    """The speed that is reached, what held the shaft, and the twist that it bore."""
    held = ", ".join(f"order {c.critical.order:g} from {figure(c.t_start, 3)} s" for c in found.captures)
    bears = found.twist_peak <= found.claim.twist_limit
    limit = quantity_text(found.claim.twist_limit, "rad", 3)
    cards = (
        Card(name="mean speed at the end", value=quantity_text(float(found.speed_mean[-1]), "rad/s", 4)),
        Card(name="held at a critical speed", value=held or "nowhere", mark="no" if held else "yes"),
        Card(name="largest twist", value=quantity_text(found.twist_peak, "rad", 4),
             about=f"a linear shaft is a model up to {limit}", mark="" if bears else "no"),
        Card(name="largest torque of the shaft", value=quantity_text(found.torque_peak, "N*m", 4)),
    )  # fmt: skip
    drawn = (
        Picture(name="startup", see="Mean speed and twist over time, beside a rigid shaft.",
                draw=lambda: plots.start_up([found], found.claim.claim_speed)),
        Picture(name="campbell", see="Where an order meets the natural frequency the shaft may be held.",
                draw=lambda: plots.campbell(found)),
    )  # fmt: skip
    return View(title="Start-up", cards=cards, pictures=drawn, columns=lambda: _columns(found))


def _columns(found: StartUp) -> dict[str, np.ndarray]:
    return {"t": found.t, "speed_mean [rad/s]": found.speed_mean, "twist_amplitude [rad]": found.twist_amplitude}
