"""How the shapes of a drawing are painted, by the part that each stands for."""

from mechsym.style.panels import (
    BLUE,
    GAS,
    GREEN,
    INK,
    ORANGE,
    PAPER,
    PISTON,
    QUIET,
    RED,
    ROLLER,
    VIOLET,
    WHEEL,
)

# role: colour of the line, line width in points, filled colour; what comes first lies behind
STYLES: dict[str, tuple[str, float, str]] = {
    "second_track": (VIOLET, 1.6, "none"),
    "track": (RED, 2.2, "none"),
    "gas": (GAS, 0.5, GAS),
    "frame": (QUIET, 1.4, "none"),
    "flywheel": (QUIET, 1.2, WHEEL),
    "cam": (INK, 1.4, WHEEL),
    "piston": (INK, 1.4, PISTON),
    "planet": (GREEN, 2.0, "none"),
    "rod": (BLUE, 3.0, "none"),
    "spring": (BLUE, 2.0, "none"),
    "crank": (RED, 3.4, "none"),
    "roller": (INK, 1.4, ROLLER),
    "joint": (INK, 1.2, PAPER),
    "force": (ORANGE, 2.6, "none"),
    "trace": (ORANGE, 1.0, "none"),
}

_ADDED = ("second_track", "track", "gas", "spring", "force")  # by a hinge, a gas, a load
DECLARED = tuple(role for role in STYLES if role not in _ADDED)  # what a mechanism may say of its shapes
