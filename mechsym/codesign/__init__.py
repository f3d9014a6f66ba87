"""Guide, pressures of springs and a small flywheel designed together, for a range of speeds and loads.

    points      speeds and loads: the work that each wants from the hinge      family, machines: where they come from
    rank        a bound that knows no guide: how many springs pay
    programme   the design: task -> basis, unknowns, motion_block, contact_block, derivatives -> co-design
    front       the same for many ripples; a guide cut for one point
    verify      every number by two other ways: running (over the angle, in time)
    scenarios, changes, manoeuvres    what kills it
    loss, control, realise, cylinders, schedule    what it costs, how it is kept, sized, used

Source: none; the elastic hinge is that of Zotov et al. (2024). See docs/codesign.md for the formulas.
"""

from mechsym.codesign.front import front
from mechsym.codesign.hardware import Bounds, Hardware
from mechsym.codesign.machines import bounds, from_curve, hardware, point
from mechsym.codesign.points import Point, bare_flywheel
from mechsym.codesign.programme import solve
from mechsym.codesign.rank import rank
from mechsym.codesign.scenarios import misfire
from mechsym.codesign.task import CoDesign, CoDesignTask
from mechsym.codesign.verify import fine_path, verify

__all__ = [
    "Bounds", "CoDesign", "CoDesignTask", "Hardware", "Point", "bare_flywheel", "bounds", "fine_path", "from_curve",
    "front", "hardware", "misfire", "point", "rank", "solve", "verify",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__
