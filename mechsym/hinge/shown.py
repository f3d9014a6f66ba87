"""What of a hinge design is worth seeing, how engine and hinge turn together, and its report: one HTML file."""

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from mechsym.errors import BadInput
from mechsym.files import Json, to_json, write_quantities, write_text
from mechsym.hinge import plots
from mechsym.hinge.guide import Guide, setting_of, setting_text
from mechsym.hinge.limits import ALL_KEPT, Verdict, at_angles
from mechsym.hinge.plots import elastic_hinge
from mechsym.hinge.result import Design, ripple_text
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.summary import HingeLossNumbers, HingeNumbers, guide_columns, guide_turn, hinge_columns
from mechsym.mechanisms.drawing import Shapes, shapes
from mechsym.mechanisms.drawing import declared as drawn
from mechsym.mechanisms.plan import roles_of
from mechsym.mechanisms.plots import figure_of
from mechsym.mechanisms.record import listing
from mechsym.mechanisms.turning import Load, pushed, rules, scene
from mechsym.page import Card, Picture, View, card, page, ranked, shows, title_mark
from mechsym.page.finding import LEAST_SURE, LOOK_AT, NOT_MET, Finding
from mechsym.quantities import RPM
from mechsym.quantities.display import figure, quantity_text
from mechsym.quantities.results import tell
from mechsym.quantities.units import Pure
from mechsym.style import axis_unit, svg


@shows(Design)
def design_view(design: Design) -> View:
    """Verdict and numbers of a hinge; what runs is computed when it is asked for."""
    return View(
        title=f"Elastic hinge of {design.origin.name}",
        cards=cards(design, HingeNumbers(judged=design)),
        pictures=pictures(design),
        columns=lambda: hinge_columns(design),
        findings=lambda: of_design(design),
    )


def cards(design: Design, numbers: HingeNumbers) -> tuple[Card, ...]:
    """The numbers that decide."""
    guide, check, lost = numbers.guide, numbers.check, numbers.losses
    shown = [
        Card(name="guide", value="can be cut" if guide.feasible else "cannot be built",
             about=f"{design.target.words}; {guide.reason.removeprefix(ALL_KEPT)}" if guide.feasible else guide.reason,
             mark="yes" if design.target.met else "no"),
        Card(name="speed ripple" if lost is None else "speed ripple without losses",
             value=ripple_text(check.speed_ripple), about="simulated with the hinge at "
             f"{quantity_text(design.machine.omega, 'rad/s')}, {'with' if check.losses else 'ideal: no'} losses"),
        card(HingeNumbers, "flywheel_inertia_saved", numbers.flywheel_inertia_saved,
             "by an ideal hinge: what a ripple of 1/50 needs without one"),
        *_dimensions(design, guide),
    ]  # fmt: skip
    if lost is not None:
        share, ripple = numbers.misfire_speed_share, lost.speed_ripple
        of_load = "" if lost.share is None else "of the load torque, "
        shown.insert(
            1,
            Card(
                name="speed ripple with losses",
                value="no steady motion" if ripple is None else ripple_text(ripple),
                about="simulated with assumed friction and heat",
                mark="" if design.target.met else "no",
            ),
        )
        shown += [Card(name="lost in the hinge", value=_lost(lost), about=f"{of_load}with assumed friction and heat")]
        if share is not None:  # of a torque alone it is not known
            shown += [
                Card(name="one misfire", value=f"{figure(100 * share, 2)} % of the speed" if share else "stops",
                     about="with the flywheel that is kept", mark="" if share else "no"),
            ]  # fmt: skip
    return tuple(shown)


def _lost(lost: HingeLossNumbers) -> str:
    if lost.share is None:
        return quantity_text(lost.torques.total, "N*m", 3)
    return f"{figure(100 * lost.share, 3)} %"


def shapes_of(design: Design) -> Callable[[float], Shapes] | None:
    """The mechanism as its declaration draws it, over the crank angle [rad]; None where it draws nothing."""
    mechanism = design.machine.mechanism
    return drawn(mechanism, listing(mechanism.name)) if "drawing" in mechanism.functions else None


def _dimensions(design: Design, guide: Verdict) -> list[Card]:
    spring, setting = design.guide.spring, partial(setting_text, design.guide.spring)
    sizes = "" if not spring.gas else f"piston {quantity_text(spring.area, 'm^2')}, column "\
        f"{quantity_text(spring.H, 'm')}, n = {figure(getattr(spring, 'n', None))}"  # fmt: skip
    shown = [Card(name="spring", value=setting(setting_of(spring)), about=sizes)]
    if design.usable is None:
        return shown
    ends = [quantity_text(rho, "m", 4) for rho in (guide.rho_min, guide.rho_max)]
    rollers = f"{design.guide.rollers} roller{'s' * (design.guide.rollers > 1)} of radius "
    about = f"{rollers}{quantity_text(design.rollers.radius, 'm', 4)}; spring closes "
    about += " to ".join(quantity_text(z, "m", 4) for z in (guide.z_min, guide.z_max))
    return [
        Card(name="guide, radius of the roller centres", value=f"{ends[0]} to {ends[1]}", about=about), *shown,
        card(Verdict, "roller_reaction_max", guide.roller_reaction_max,
             f"pressure angle up to {quantity_text(guide.pressure_angle_max, 'rad', 3)}"),
    ]  # fmt: skip


def pictures(design: Design) -> tuple[Picture, ...]:
    """The figures that there is something to draw for."""
    gas, phi = design.machine.gas, np.linspace(0, design.hinge.period, 1441)
    ends, swing = (f(design.hinge.torque(phi)) for f in (np.min, np.max)), float(np.ptp(design.hinge.work(phi)))
    # what the picture of the speeds shows: the largest ripples with the hinge and without
    words = []
    for how, hinged in (("with the hinge", True), ("without", False)):
        runs = [t for t in design.trials if (t.name not in ("without", "flywheel")) == hinged]
        known = [(t.speed_ripple, t.about) for t in runs if t.speed_ripple is not None]
        words += [
            f"{how} it ripples by {ripple_text(ripple)} at most ({about})" for ripple, about in sorted(known)[-1:]
        ]
    shown = [
        Picture(name="torque", draw=lambda: plots.torque(design),
                see=f"Hinge torque on the crank, {' to '.join(quantity_text(v, 'N*m', 4) for v in ends)}, with its "
                f"parts, and below its work, which swings by {quantity_text(swing, 'J', 4)} and comes back."),
        Picture(name="speeds", draw=lambda: plots.speeds(design),
                see=", ".join(["Crank speed over the design speed", *words]).replace(", ", ": ", 1) + "."),
    ]  # fmt: skip
    if gas is not None:
        see = f"Cylinder pressure, at most {quantity_text(gas.pressure.p_max, 'Pa', 4)}, over the crank angle with the "
        see += "events of the cycle, and over the volume."
        shown.insert(0, Picture(name="pressure", draw=lambda: plots.pressure(design), see=see))
    if (shapes := shapes_of(design)) is not None:
        shown.insert(0, Picture(name="mechanism", draw=lambda: figure_of(shapes, math.pi / 3),
                                see="The mechanism as its declaration draws it."))  # fmt: skip
    if design.guide.rho is not None:
        radius, at = design.rollers.radius, len(shown) - 1
        radii = [quantity_text(rho, "m", 4) for rho in (design.verdict.rho_min, design.verdict.rho_max)]
        shown[at:at] = [
            Picture(name="elastic_hinge", draw=lambda: plots.hinge(design),
                    see="The hinge to scale: the spring between its pistons turns with the guide's shaft, the rollers "
                    "run on tracks that stand still."),
            Picture(name="track", draw=lambda: plots.track(design, guide_turn(design), radius),
                    see=f"Guide to scale; roller centres {' to '.join(radii)} from the shaft, the profile is the exact "
                    "parallel curve at the roller radius."),
            Picture(name="contact", draw=lambda: plots.contact(guide_turn(design)),
                    see="Contact around the turn: a roller presses with at most "
                    f"{quantity_text(design.verdict.roller_reaction_max, 'N', 4)}, the pressure angle is up to "
                    f"{quantity_text(design.verdict.pressure_angle_max, 'rad', 3)}."),
        ]  # fmt: skip
    if design.retuned is not None:
        rpm = figure(design.retuned.other.omega / RPM, 4)
        shown.append(Picture(name="retuning", draw=lambda: plots.retuning(design),
                             see=f"The same guide at {rpm} rpm: left the torque that is wanted and given, right the "
                             "speed over a steady turn."))  # fmt: skip
    if design.loads:
        shown.append(Picture(name="loads", draw=lambda: plots.loads(design.loads),
                             see="Left: speed ripple over the load, a cross where the crank does not turn steadily. "
                             "Right: the setting of the spring that fits best."))  # fmt: skip
    return tuple(shown)


_FEW = 0.9  # of the speed: what one lost combustion may leave without a word


def of_design(design: Design) -> Iterator[Finding]:
    """What of a hinge design has to be known first."""
    numbers = HingeNumbers(judged=design)
    if not design.target.met:
        worst = [ripple for ripple in design.target.with_losses if ripple is not None]
        words = design.target.words if design.target.held else design.answer
        yield Finding(rank=NOT_MET, words=words, value=max(worst, default=None))
    yield from lost_combustion(numbers.misfire_speed_share)
    yield from _least_sure(design)


def lost_combustion(share: Pure | None, where: str = "") -> Iterator[Finding]:
    """What one lost combustion does, where it is much. share: lowest speed after it by the mean; 0 stalls."""
    if share is not None and share < _FEW:
        left = f"pulls the speed down to {figure(100 * share, 2)} % of its mean" if share else "stops the shaft"
        words = f"one lost combustion{where} {left} with the flywheel that is kept"
        yield Finding(rank=LOOK_AT if share else NOT_MET, words=words, value=share)


def _least_sure(design: Design) -> Iterator[Finding]:
    """The quantity of the spring of which 1 % costs most."""
    sides = [(one, side.speed_ripple) for one in design.sensitivities for side in (one.low, one.high)]
    known = [(ripple, one) for one, ripple in sides if ripple is not None]
    if known:
        ripple, worst = max(known, key=lambda row: row[0])
        value = quantity_text(worst.value, worst.unit, 4)
        words = f"{worst.name} = {value}: 1 % off it, the ripple is {figure(100 * ripple, 2)} %"
        yield Finding(rank=LEAST_SURE, words=words, value=ripple)


_FRAMES = 120


def scenes(design: Design) -> list[Json]:
    """The engine, where there is a drawing of it, and the hinge, where there is a guide, over one period."""
    turns = design.hinge.period / (2 * np.pi)
    frames, moving = round(_FRAMES * max(1.0, turns)), []
    machine = engine(design)
    if machine is not None:
        moving.append(scene(machine, "the engine to scale", turns, frames))
    if design.usable is not None:
        moving.append(hinge_scene(design.usable, design.rollers, turns, frames))
    return moving


def hinge_scene(guide: Guide, rollers: RollerParameters, turns: Pure, frames: int) -> Json:
    """The hinge alone over some turns of the crank."""
    drawn = elastic_hinge(guide, rollers)
    two = any(shape.role == "second_track" for shape in drawn(0.0))
    tracks = ", first track (red) and second (violet), in planes beside each other" if two else ", track"
    shown = scene(drawn, f"the elastic hinge to scale: spring with its pistons, rollers{tracks}", turns, frames)
    theta = guide.parameters.shaft_ratio * np.linspace(0, 2 * np.pi * turns, frames, endpoint=False) % (2 * np.pi)
    turn = at_angles(guide, rollers, theta)
    if turn.pressure is not None:
        share = np.rint(100 * turn.pressure / turn.pressure.max()).astype(int).tolist()
        shown["shapes"] = [shape | {"share": share} if shape["role"] == "gas" else shape for shape in shown["shapes"]]
    return pushed(shown, list(_of_rollers(shown, drawn, (turn.reaction_1, turn.reaction_2))))


def _of_rollers(shown: Json, drawn: Callable[[float], Shapes], reactions: Sequence[np.ndarray]) -> Iterator[Load]:
    """What the tracks press on the rollers with, across the paths of their centres."""
    angles = np.linspace(0, 2 * np.pi * shown["turns"], shown["count"], endpoint=False)
    frames = [[complex(*s.centre) for s in drawn(float(a)) if s.role == "roller"] for a in angles]  # type: ignore[union-attr]
    for number, (at, force) in enumerate(zip(np.array(frames).T, reactions, strict=False), 1):
        across = 1j * (np.roll(at, -1) - np.roll(at, 1))
        inwards = -across / np.abs(across) * np.sign((across * at.conj()).real)
        yield Load(name=f"track on roller {number}", at=at, force=force * inwards)


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


def write(design: Design, folder: Path, finish: Callable[[str], str] = str) -> list[Path]:
    """Write report, tables, summary and pictures into a folder. finish: makes the text that is written of it."""
    numbers, columns = HingeNumbers(judged=design), hinge_columns(design)
    figures = {picture.name: svg(picture.draw()) for picture in pictures(design)}
    files = [write_text(folder / "report.html", finish(html(design, numbers, figures)))]
    files.append(write_text(folder / "summary.json", to_json(tell(numbers)) + "\n"))
    files.append(write_quantities(folder / "hinge.csv", columns, columns.units))
    if design.guide.rho is not None:
        columns = guide_columns(design, guide_turn(design, 3601))
        files.append(write_quantities(folder / "guide.csv", columns, columns.units))
    return files + [write_text(folder / f"{name}.svg", text) for name, text in figures.items()]


def html(design: Design, numbers: HingeNumbers, figures: dict[str, str]) -> str:
    """The report as text."""
    findings = ranked(of_design(design))
    rows = []
    for section, record in design.origin.sections.items():
        for field in dataclasses.fields(record):
            value = getattr(record, field.name)
            if "unit" in field.metadata and isinstance(value, float):
                rows.append((f"{section}.{field.name}", field.metadata["about"], field.metadata["unit"], value))
    return page(
        "hinge.html",
        case=design.origin,
        design=design,
        numbers=numbers,
        cards=cards(design, numbers),
        findings=findings,
        mark=title_mark(findings),
        figures=figures,
        see={picture.name: picture.see for picture in pictures(design)},
        setting=partial(setting_text, design.guide.spring),
        parameters=rows,
        equations=listing(design.machine.mechanism.name)["equations"],
        scenes=scenes(design),
        readouts=readouts(design),
        rules=rules(),
        pistons=bool(roles_of(design.machine.mechanism.name).pistons),
        degrees=180 / np.pi,
    )
