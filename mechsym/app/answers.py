"""What the workbench shows as a slider moves: verdict in words, limits with their margins, curves, a moving picture."""

import math
from collections.abc import Callable, Mapping

import numpy as np

from mechsym import cases
from mechsym.app.told import measure, span
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.hinge.balance import constant_load_speed, propeller_load_speed, ripple
from mechsym.hinge.limits import ALL_KEPT
from mechsym.hinge.result import Design
from mechsym.hinge.shown import of_design, scenes
from mechsym.hinge.summary import guide_turn
from mechsym.jobs.export import loaded, turning
from mechsym.jobs.hinge import hinge
from mechsym.machine.loads import PropellerLoad
from mechsym.mechanisms import plots
from mechsym.page import Finding, ranked
from mechsym.periodic import even_angles
from mechsym.plausible import sifted
from mechsym.quantities import quantity, record
from mechsym.report import case_report, html
from mechsym.report.parts import PARTS

_POINTS = 241  # of each curve
_DIGITS = 6  # of its largest value


@record
class Plotted:
    """One curve of a chart."""

    name: str
    chart: str  #: curves of one chart stand together
    x_name: str
    y_name: str
    x: tuple[float, ...]  #: in the unit that `x_name` says [-]
    y: tuple[float, ...]  #: in the unit that `y_name` says [-]


@record
class Bar:
    """A limit with what is left of it."""

    name: str
    text: str
    kept: bool
    margin: float | None  #: share of the limit that is left [-]


@record
class Answer:
    """What is known of a case at once."""

    good: bool  #: can be cut and keeps the ripple with losses
    words: str
    rows: tuple[tuple[str, str], ...] = ()  #: name and value with its unit
    bars: tuple[Bar, ...] = ()
    curves: tuple[Plotted, ...] = ()
    doubts: tuple[str, ...] = ()
    #: tells what has to be known first, the worst first; it runs the machine without a combustion
    findings: Callable[[], tuple[Finding, ...]] = tuple
    #: makes the scenes of mechanism and guide in motion; they cost more than all of the rest
    scenes: Callable[[], list[Json]] = list
    turns: int = 1  #: of the crank in a cycle
    ratio: float = quantity("-", default=1.0, about="turns of the guide in a turn of the crank")


def hinge_answer(name: str, values: Mapping[str, float]) -> Answer:
    """The hinge of a case with other values by key [SI]; what is impossible is an answer too, in words."""
    try:
        case = cases.load(name, values)
        design = hinge(case)
    except BadInput as refused:
        return Answer(good=False, words=f"no hinge: {refused}")
    verdict = design.verdict
    doubts = tuple(
        f"{d.quantity} = {d.value:g}, usual is {d.usual}: {d.why}" for d in sifted(case.doubts, case.acceptances)[0]
    )
    words = f"{design.answer} ({verdict.reason.removeprefix(ALL_KEPT)})"
    return Answer(
        good=design.target.met, words=words, rows=_rows(design), doubts=doubts,
        bars=tuple(Bar(name=c.name, text=c.text, kept=c.kept, margin=c.margin) for c in verdict.checks),
        curves=_curves(design), findings=lambda: ranked(of_design(design)),
        scenes=lambda: loaded(scenes(design), case),
        turns=round(design.hinge.period / (2 * math.pi)), ratio=design.guide.parameters.shaft_ratio,
    )  # fmt: skip


def moving(answer: Answer, title: str) -> str | None:
    """A page in which what an answer draws turns; None where it draws nothing."""
    shown = answer.scenes()
    return plots.turning_page(shown, title) if shown else None


def reading(name: str, values: Mapping[str, float], part: str) -> str:
    """The part of a report that a command gives of a case with other values, as a page; empty where it has none."""
    if part not in PARTS:
        return ""
    try:
        return html([case_report(cases.load(name, values), [part])])
    except BadInput:
        return ""


def machine(name: str, values: Mapping[str, float]) -> str | None:
    """A page in which the machine of a case with other values turns [SI unit of the key]; None where nothing draws."""
    try:
        shown = turning(cases.load(name, values))
    except BadInput:
        return None
    return plots.turning_page(shown, "the machine") if shown else None


def _rows(design: Design) -> tuple[tuple[str, str], ...]:
    phi = np.linspace(0, design.hinge.period, _POINTS)
    torque, verdict = design.hinge.torque(phi), design.verdict
    rows = [
        ("load torque", measure(design.hinge.load_torque, "N*m")),
        ("hinge torque", span(float(torque.min()), float(torque.max()), "N*m")),
    ]
    if verdict.rho_min is not None:
        rows += [
            ("guide, radius", f"{1e3 * verdict.rho_min:.4g} to {1e3 * (verdict.rho_max or 0):.4g} mm"),
            ("spring closes", f"{1e3 * (verdict.z_min or 0):.4g} to {1e3 * (verdict.z_max or 0):.4g} mm"),
            ("roller force", f"{(verdict.roller_reaction_max or 0) / 1e3:.4g} kN"),
            ("contact pressure", f"{(verdict.hertz_stress_max or 0) / 1e6:.4g} MPa"),
            ("pressure angle", f"{math.degrees(verdict.pressure_angle_max or 0):.3g} deg"),
        ]
        if verdict.spring_pressure_max is not None:
            rows.append(("spring pressure", f"{verdict.spring_pressure_max / 1e6:.4g} MPa"))
    if verdict.tilting_couple_max:
        rows.append(("tilting couple of the tracks", f"{verdict.tilting_couple_max / 1e3:.4g} kN m"))
    if verdict.loss_torque_mean:
        rows.append(("rollers resist with", f"{verdict.loss_torque_mean:.4g} N m"))
    inertia = design.hinge.inertia(even_angles(design.hinge.period))
    rows.append(("inertia on the shaft", f"{inertia.min():.4g} to {inertia.max():.4g} kg m²"))
    facts = design.machine.gas.pressure.facts if design.machine.gas else ()
    return (*rows, ("speed ripple without the hinge", _bare(design, inertia)), *(("cycle", fact) for fact in facts))


def _bare(design: Design, inertia: np.ndarray) -> str:
    """Ripple of the engine with an inertia [kg*m^2] and without the hinge, under the load of the case."""
    phi, wanted = even_angles(design.hinge.period), design.hinge
    missing = wanted.work(phi)
    if isinstance(design.machine.load, PropellerLoad):
        speed = propeller_load_speed(missing, inertia, wanted.omega, wanted.load_torque, wanted.period)
    else:
        speed = constant_load_speed(missing, inertia, wanted.omega)
    share = ripple(speed)
    return "the shaft stops" if share is None else f"{100 * share:.4g} %"


def _curves(design: Design) -> tuple[Plotted, ...]:
    phi = np.linspace(0, design.hinge.period, _POINTS)
    curves = [
        _curve("wanted", "hinge torque", "crank angle [deg]", "kN m", np.degrees(phi), design.hinge.torque(phi) / 1e3)
    ]
    if design.guide.rho is not None:
        turn, angle = guide_turn(design, _POINTS), "angle of the guide [deg]"
        theta = np.degrees(turn.theta)
        curves += [
            _curve("path", "radius of the guide", angle, "mm", theta, 1e3 * turn.rho),
            _curve("contact 1", "contact force", angle, "kN", theta, turn.reaction_1 / 1e3),
            _curve("contact 2", "contact force", angle, "kN", theta, turn.reaction_2 / 1e3),
        ]
    return tuple(curves)


def _curve(name: str, chart: str, x_name: str, unit: str, x: np.ndarray, y: np.ndarray) -> Plotted:
    return Plotted(name=name, chart=chart, x_name=x_name, y_name=f"{chart} [{unit}]", x=_short(x), y=_short(y))


def _short(values: np.ndarray) -> tuple[float, ...]:
    largest = float(np.max(np.abs(values)))
    places = _DIGITS - 1 - math.floor(math.log10(largest)) if largest > 0 else 0
    return tuple(np.round(values, places).tolist())
