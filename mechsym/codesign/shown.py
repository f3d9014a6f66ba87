"""What of a co-design is worth seeing."""

from mechsym.codesign import plots
from mechsym.codesign.findings import of_codesign
from mechsym.codesign.report import point_columns
from mechsym.codesign.result import CoDesignResult
from mechsym.page import Card, Picture, View, shows
from mechsym.quantities.display import figure, quantity_text, ratio_text


@shows(CoDesignResult)
def codesign_view(found: CoDesignResult) -> View:
    """The flywheel beside what it would be otherwise, the ripple that is kept, what is lost."""
    design, broken = found.design, found.verified.broken
    bare = f"added; without a hinge {quantity_text(found.bare, 'kg*m^2', 4)}"
    shares = [at.total / abs(p.load_torque) for at, p in zip(found.losses, design.task.points, strict=True)]
    target = found.target
    cards = (
        Card(name="flywheel", value=quantity_text(design.flywheel, "kg*m^2", 4), about=bare),
        Card(name="speed ripple", value=ratio_text(float(max(design.ripple))),
             about=f"largest of all points, {'with' if design.task.losses else 'without'} losses"),
        Card(name="target", value="kept" if target.met else "missed" if target.held else "no design",
             about=found.answer, mark="yes" if target.met else "no"),
        Card(name="limits", value="kept" if target.held else "NOT kept", about="; ".join(broken) or design.reason,
             mark="" if target.held else "no"),
        Card(name="losses of the hinge", value=f"{figure(100 * float(max(shares)), 3)} %",
             about="of the load's torque at the worst point, with assumed friction"),
    )  # fmt: skip
    drawn = (
        Picture(name="points", see="Ripple by three ways, and the pressures to set.", draw=lambda: plots.points(found)),
        Picture(name="guides", see="Paths of the roller centres, and how the springs close.",
                draw=lambda: plots.guides(found)),
        Picture(name="front", see="Flywheel over the ripple, beside the estimate.", draw=lambda: plots.front(found)),
        Picture(name="works", see="Works that the points want: nearly one curve.", draw=lambda: plots.works(found)),
        Picture(name="losses", see="What friction and heat take.", draw=lambda: plots.losses(found)),
    )  # fmt: skip
    return View(title=f"Co-design of {found.name}", cards=cards, pictures=drawn, columns=lambda: point_columns(found),
                findings=lambda: of_codesign(found))  # fmt: skip
