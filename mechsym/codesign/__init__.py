"""Guide, pressures of springs and a small flywheel designed together, for a range of speeds and loads.

    points      speeds and loads: the work that each wants from the hinge      machines: where they come from
    rank        a bound that knows no guide: how many springs pay, and cylinders; certificate: its proof
    programme   the design: task -> unknowns -> co-design
    front       the same for many ripples and pressures; a guide cut for one point
    verify      every number by two other ways: running (over the angle, in time), and how sure it is
    scenarios, manoeuvres    what kills it, what controls it
    loss        friction and heat in the motion
    realise     other hardware for the same works
    result      what the job gives and tells        shown    its pictures and files

Source: none; the elastic hinge is that of Zotov et al. (2024). See docs/codesign.md for the formulas.
"""

from mechsym.quantities import lazily

_NAMES = {
    "bare_flywheel": "mechsym.codesign.points:bare_flywheel",
    "CoDesign": "mechsym.codesign.task:CoDesign",
    "CoDesignTask": "mechsym.codesign.task:CoDesignTask",
    "fine_path": "mechsym.codesign.task:fine_path",
    "from_curve": "mechsym.codesign.machines:from_curve",
    "front": "mechsym.codesign.front:front",
    "Hardware": "mechsym.codesign.task:Hardware",
    "hardware": "mechsym.codesign.machines:hardware",
    "misfire": "mechsym.codesign.scenarios:misfire",
    "Point": "mechsym.codesign.points:Point",
    "point": "mechsym.codesign.machines:point",
    "rank": "mechsym.codesign.rank:rank",
    "solve": "mechsym.codesign.programme:solve",
    "verify": "mechsym.codesign.verify:verify",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)
