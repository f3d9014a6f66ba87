"""What the pictures, cards and tables of a hinge show is what its own laws give: checked on what is drawn."""

import dataclasses
import math
from functools import cache
from types import SimpleNamespace as Made

import numpy as np
import pytest

from mechsym import cases, jobs
from mechsym.hinge import plots, shown
from mechsym.hinge.guide import closing, path
from mechsym.hinge.rollers import LossTorques
from mechsym.hinge.springs.coil import Coil
from mechsym.hinge.summary import HingeNumbers, guide_columns, guide_turn, hinge_columns
from mechsym.hinge.trials import side_by_side
from mechsym.page.finding import LEAST_SURE, LOOK_AT, NOT_MET
from mechsym.quantities.units import scale

DEGREE = math.pi / 180


@cache
def design(name="zotov-89"):
    return jobs.hinge(cases.load(name))


def curve(axis, k):
    """A line by its number in SI: the labels of its axis say the units."""
    line = axis.lines[k]
    across, up = (label.rpartition("[")[2].rstrip("]") for label in (shared(axis), axis.get_ylabel()))
    return np.asarray(line.get_xdata(), float) * unit(across), np.asarray(line.get_ydata(), float) * unit(up)


def shared(axis):
    """The label below an axis, or below the last one of its column."""
    below = [other.get_xlabel() for other in axis.figure.axes if other.get_xlabel()]
    return axis.get_xlabel() or below[-1]


def unit(words):
    return scale(words.replace("·", "*").replace("²", "^2").replace("³", "^3").replace("°", "deg"))


def test_the_torque_is_the_sum_of_its_parts_and_its_work_the_integral():
    hinge = design().hinge
    upper, lower = plots.torque(design()).axes
    parts = [curve(upper, k) for k in range(4)]
    phi, total = parts[3]
    assert phi[[0, -1]] == pytest.approx([0, hinge.period]) and total == pytest.approx(hinge.torque(phi), abs=1e-6)
    assert sum(values for _, values in parts[:3]) == pytest.approx(total, abs=1e-9 * np.abs(total).max())
    names = [line.get_label() for line in upper.lines[:4]]
    assert names == ["gas and load", "inertia", "gravity", "hinge torque"]
    size = 1e-12 * np.abs(total).max()
    assert parts[1][1] == pytest.approx(hinge.inertia_part(phi), abs=size)
    assert parts[2][1] == pytest.approx(hinge.gravity_part(phi), abs=size)
    assert list(upper.lines[4].get_ydata()) == [0, 0]
    widths = [line.get_linewidth() for line in upper.lines[:4]]
    assert widths == [1, 1, 1, 2]
    at, work = curve(lower, 0)
    steps = np.concatenate([[0.0], np.cumsum((total[1:] + total[:-1]) / 2 * np.diff(phi))])
    assert at == pytest.approx(phi) and work == pytest.approx(steps, abs=1e-4 * np.ptp(steps))


def test_the_loop_of_the_pressure_over_the_volume_is_the_work_of_the_load():
    left, right = plots.pressure(design()).axes[:2]
    phi, over_angle = curve(left, 0)
    volume, pressure = curve(right, 0)
    assert over_angle == pytest.approx(pressure) and phi[-1] == pytest.approx(2 * math.pi)
    gas = design().machine.gas
    assert pressure.max() == pytest.approx(gas.pressure.p_max, rel=1e-3)
    work = float(np.sum((pressure[1:] + pressure[:-1]) / 2 * np.diff(volume)))
    assert work == pytest.approx(2 * math.pi * design().hinge.load_torque, rel=2e-3)
    # at what an angle of a kink is, a point is drawn
    assert np.abs(phi[:, None] - np.array(gas.pressure.kinks) % (2 * math.pi)).min(axis=0).max() < 1e-9


def test_the_cut_profile_lies_a_roller_beyond_the_path():
    turn, radius = guide_turn(design()), design().rollers.radius
    (axis,) = plots.track(design(), turn, radius).axes
    free, centre, profile = (np.array(curve(axis, k)) for k in range(3))
    assert np.hypot(*free) == pytest.approx(np.full(361, design().guide.parameters.rho0))
    assert np.hypot(*centre) == pytest.approx(turn.rho) and np.hypot(*(profile - centre)) == pytest.approx(radius)
    assert np.all(np.hypot(*profile) > np.hypot(*centre))
    # two rollers half a turn apart: the second track is the first turned by half a turn
    assert np.array(curve(axis, 3)) == pytest.approx(-profile) and "half a turn" in axis.lines[3].get_label()
    assert axis.get_aspect() == 1.0
    one = dataclasses.replace(
        design(), guide=dataclasses.replace(design().guide, parameters=dataclasses.replace(
            design().guide.parameters, arrangement="one_roller"))
    )  # fmt: skip
    assert len(plots.track(one, turn, radius).axes[0].lines) == 4  # with the cross at the axis


def test_contact_is_drawn_up_to_what_the_verdict_says():
    verdict, turn = design().verdict, guide_turn(design())
    axes = plots.contact(turn).axes
    rows = [curve(axis, 0) for axis in axes]
    assert all(theta == pytest.approx(turn.theta) for theta, _ in rows)
    reaction, angle, pressure, bend = (values for _, values in rows)
    assert reaction.max() == pytest.approx(verdict.roller_reaction_max, rel=1e-3)
    assert np.abs(angle).max() == pytest.approx(verdict.pressure_angle_max, rel=1e-3)
    assert pressure.max() == pytest.approx(verdict.spring_pressure_max, rel=1e-3)
    assert 1 / np.abs(bend).max() == pytest.approx(verdict.curvature_radius_min, rel=2e-3)
    assert [axis.get_ylabel().partition(" [")[0] for axis in axes] == [
        "roller reaction", "pressure angle", "excess pressure in the spring", "curvature of the path",
    ]  # fmt: skip
    coil = plots.contact(dataclasses.replace(turn, pressure=None)).axes[2]
    assert coil.get_ylabel().startswith("spring force [") and curve(coil, 0)[1] == pytest.approx(turn.force)


def test_the_speeds_are_those_of_the_runs_over_the_design_speed():
    left, right = plots.speeds(design()).axes
    runs = {trial.about: trial for trial in design().trials}
    assert right.get_xlim() == (0, 2)
    labels = [line.get_label() for line in left.lines]
    assert not any("no hinge" in label or "flywheel" in label for label in labels)
    assert {name for label in labels for name in label.split(" = ")} == {
        trial.about for trial in design().trials if trial.name not in ("without", "flywheel")
    }
    drawn = {line.get_label().split(" = ")[0]: line for line in right.lines}
    assert sum(len(label.split(" = ")) for label in (line.get_label() for line in right.lines)) == len(runs)
    for name, line in drawn.items():
        columns = runs[name].result.columns
        assert line.get_xdata() * 2 * math.pi == pytest.approx(columns["phi"])
        assert line.get_ydata() * design().machine.omega == pytest.approx(columns["phid"])
        assert line.get_color() == plots._COLORS[runs[name].name]
    fast = [line.get_ydata()[0] for label, line in drawn.items() if "1 % fast" in label]
    assert fast == pytest.approx([1.01] * len(fast)) and fast


def test_runs_that_nobody_can_tell_apart_are_drawn_once():
    columns = {"phi": np.linspace(0, 4 * math.pi, 9), "phid": np.full(9, 9.0)}

    def run(name, **moved):
        return Made(name=name, about=name, result=Made(columns={**columns, **moved}))

    nearly = run("hinge_propeller", phid=columns["phid"] * (1 + 0.9e-4))
    other = run("off_constant", phid=columns["phid"] * (1 + 2e-4))
    shorter = run("off_propeller", phi=columns["phi"] * 0.99)
    engine = Made(machine=Made(mechanism=design().machine.mechanism, omega=9.0))
    rows = plots._runs(engine, [run("hinge_constant"), nearly, other, shorter])
    assert [row[0] for row in rows] == ["hinge_constant = hinge_propeller", "off_constant", "off_propeller"]


def test_the_same_guide_at_another_speed():
    again = design().retuned
    left, right = plots.retuning(design()).axes
    phi, first = curve(left, 0)
    assert first == pytest.approx(design().hinge.torque(phi)) and curve(left, 1)[1] == pytest.approx(
        again.wanted.torque(phi)
    )
    # what the guide gives grows with its pressure alone
    assert np.argmax(curve(left, 2)[1]) == pytest.approx(np.argmax(first), abs=30)
    assert again.paper.speed_mean is None and len(right.lines) == 1
    assert np.ptp(curve(right, 0)[1]) == pytest.approx(again.steady.speed_ripple, rel=1e-2)
    turning = Made(hinge=design().hinge, guide=design().guide, retuned=dataclasses.replace(again, paper=again.steady))
    best, paper = plots.retuning(turning).axes[1].lines
    assert list(best.get_ydata()) == list(paper.get_ydata()) and best.get_label() != paper.get_label()
    with pytest.raises(ValueError, match="not retuned"):
        plots.retuning(Made(retuned=None))


def test_ripple_over_the_load_has_a_cross_where_it_does_not_turn():
    def at(share, cut, reset, ratio):
        return Made(share=share, as_cut=Made(speed_ripple=cut), reset=Made(speed_ripple=reset), ratio=ratio)

    left, right = plots.loads([at(1.2, None, 0.01, 1.3), at(0.5, 0.04, 0.02, 0.6)]).axes
    cut, stopped, reset, none = left.lines
    assert list(cut.get_xdata()) == list(reset.get_xdata()) == [50, 120]
    assert cut.get_ydata() == pytest.approx([4, math.nan], nan_ok=True) and reset.get_ydata() == pytest.approx([2, 1])
    assert (list(stopped.get_xdata()), list(stopped.get_ydata())) == ([120], [1.0]) and not len(none.get_xdata())
    assert list(right.lines[0].get_ydata()) == [0.6, 1.3] and list(right.lines[1].get_ydata()) == [1, 1]
    assert left.get_ylim()[0] == 0
    calm = plots.loads([at(1.0, 1e-9, 1e-9, 1.0)]).axes[0]
    assert calm.get_ylim()[1] >= 1e-3


def shapes(guide, angle):
    return plots.elastic_hinge(guide, design().rollers)(angle)


@pytest.mark.parametrize("angle", [0.0, 0.7, 4.0])
def test_the_hinge_is_drawn_to_scale(angle):
    guide, rollers = design().guide, design().rollers
    drawn = shapes(guide, angle)
    rho = float(path(guide)(angle))
    # the rollers stand on one line through the shaft, turned with it
    centres = [complex(*s.centre) for s in drawn if s.role == "roller"]
    assert centres == pytest.approx([rho * np.exp(1j * angle), -rho * np.exp(1j * angle)])
    assert {s.radius for s in drawn if s.role == "roller"} == {rollers.radius}
    gas, *pistons = (np.array([complex(*p) for p in s.points]) for s in drawn if s.role in ("gas", "piston"))
    sides = np.sort(np.abs(np.diff(gas)))
    z, spring = float(closing(guide, np.array(rho))), guide.spring
    assert sides[-1] == pytest.approx(spring.H - z) and math.pi / 4 * sides[0] ** 2 == pytest.approx(spring.A)
    assert len(pistons) == 2 and abs(gas[:4].mean()) < 1e-12
    # rods reach from the pistons to the rollers, and are of one length all the turn
    rods = [[complex(*p) for p in s.points] for s in drawn if s.role == "rod"]
    assert [rod[1] for rod in rods] == pytest.approx(centres)
    thick = min(0.25 * sides[0], 0.08 * guide.parameters.rho0)
    length = guide.parameters.rho0 - spring.H / 2 - thick
    assert [abs(rod[1] - rod[0]) for rod in rods] == pytest.approx([length, length])
    # the sleeve is as long as the gas and its pistons ever are
    sleeve = [np.array(s.points) @ [1, 1j] * np.exp(-1j * angle) for s in drawn if s.role == "frame"]
    longest = spring.H - 2 * (guide.parameters.rho0 - design().verdict.rho_max) + 2 * thick
    assert np.array(sleeve).imag == pytest.approx(0.52 * sides[0] * np.array([[-1, -1], [1, 1]]))
    assert [np.ptp(line.real) for line in sleeve] == pytest.approx([longest] * 2, rel=1e-3)
    assert drawn[-1].radius == 0.02 * guide.parameters.rho0 and drawn[-1].centre == (0.0, 0.0)


def test_tracks_are_closed_and_the_second_is_the_first_half_a_turn_on():
    drawn = {s.role: s for s in shapes(design().guide, 0.3) if s.role.endswith("track")}
    first, second = (np.array(drawn[role].points) for role in ("track", "second_track"))
    assert first[0] == pytest.approx(first[-1]) and first == pytest.approx(-second) and len(first) == 181
    turn = np.linspace(0, 2 * math.pi, 9)
    oval = np.column_stack([2 * np.cos(turn), np.sin(turn)])
    assert plots.same_after_half_a_turn(oval)
    assert not plots.same_after_half_a_turn(oval + [1e-5, 0])


def test_one_roller_and_a_coil_are_drawn_on_their_side():
    alone = dataclasses.replace(design().guide.parameters, arrangement="one_roller")
    guide = dataclasses.replace(design().guide, parameters=alone)
    drawn = shapes(guide, 0.0)
    assert sum(s.role == "roller" for s in drawn) == 1 and sum(s.role == "rod" for s in drawn) == 1
    gas = np.array(next(s.points for s in drawn if s.role == "gas"))
    rho = float(path(guide)(0.0))
    z = float(closing(guide, np.array(rho)))
    assert np.ptp(gas[:, 0]) == pytest.approx(guide.spring.H - z)
    coil = dataclasses.replace(design().guide, spring=Coil(F0=1e5, k=1e5, H=1.0))
    drawn = shapes(coil, 0.0)
    wire = np.array(next(s.points for s in drawn if s.role == "spring"))
    radius, rho = design().rollers.radius, float(path(coil)(0.0))
    assert wire[[0, -1], 0] == pytest.approx([-(rho - 1.6 * radius), rho - 1.6 * radius]) and len(wire) == 19
    assert np.abs(wire[1:-1, 1]) == pytest.approx(0.8 * radius) and np.all(np.diff(np.sign(wire[1:-1, 1])) != 0)
    seat = [np.array(s.points) for s in drawn if s.role == "piston"]
    assert [abs(s[0, 0]) for s in seat] == pytest.approx([rho - 1.6 * radius] * 2) and np.ptp(
        seat[0][:, 1]
    ) == pytest.approx(1.92 * radius)


def test_tables_hold_what_the_hinge_and_its_guide_are():
    hinge, columns = design().hinge, hinge_columns(design(), 37)
    phi = columns["phi"]
    assert phi == pytest.approx(np.linspace(0, hinge.period, 37))
    assert columns["hinge_torque"] == pytest.approx(hinge.torque(phi)) and columns["hinge_work"] == pytest.approx(
        hinge.work(phi)
    )
    bore = design().machine.gas.chamber.bore
    net = columns["piston_force"] / (math.pi / 4 * bore**2)
    assert np.ptp(columns["pressure"] - net) < 1e-6 * columns["pressure"].max()  # less the pressure behind the piston
    turn = guide_turn(design(), 91)
    table = guide_columns(design(), turn)
    away = np.hypot(
        table["profile_x"] - turn.rho * np.cos(turn.theta), table["profile_y"] - turn.rho * np.sin(turn.theta)
    )
    assert away == pytest.approx(np.full(91, design().rollers.radius))
    # virtual work: what drives the shaft is what the spring gives back
    assert table["torque"] == pytest.approx(2 * table["spring_force"] * table["drho_dtheta"])
    assert set(table) - set(guide_columns(design(), dataclasses.replace(turn, pressure=None))) == {
        "spring_excess_pressure"
    }


def test_the_numbers_of_a_design():
    numbers, made = HingeNumbers(judged=design()), design()
    assert numbers.speed_rpm == pytest.approx(89) and numbers.p_max_bar == pytest.approx(
        made.machine.gas.pressure.p_max / 1e5
    )
    again, retuned = numbers.retune, made.retuned
    assert again.speed_rpm == pytest.approx(142) and again.p0_ratio == pytest.approx(again.p0 / made.guide.spring.p0)
    assert again.torque_ratio_max == pytest.approx(retuned.wanted.torque_max / made.hinge.torque_max)
    assert again.torque_ratio_min == pytest.approx(retuned.wanted.torque_min / made.hinge.torque_min)
    peak = max(again.torque_ratio_max * made.hinge.torque_max, -again.torque_ratio_min * made.hinge.torque_min)
    assert again.torque_ratio_peak == pytest.approx(peak / max(made.hinge.torque_max, -made.hinge.torque_min))
    lost = numbers.losses
    assert lost.total == pytest.approx(sum(getattr(lost.torques, kind) for kind in lost.shares))
    assert sum(lost.shares.values()) == pytest.approx(
        lost.share
    ) and lost.share * made.hinge.load_torque == pytest.approx(lost.total)
    assert lost.assumed.bearing_radius == made.rollers.radius / 2
    assert [o.balance for o in numbers.offers] == ["whole_cycle"] and list(numbers.runs) == [
        t.name for t in made.trials
    ]
    none = HingeNumbers(
        judged=dataclasses.replace(made, guide=dataclasses.replace(made.guide, rho=None), other=lambda: None)
    )
    assert none.check.speed_ripple is none.losses is none.retune.p0 is none.misfire_speed_share is None


def card(changed, name, **numbers):
    made = HingeNumbers(judged=changed)
    seen = Made(**{k: numbers.get(k, getattr(made, k)) for k in
                   ("guide", "check", "losses", "flywheel_inertia_saved", "misfire_speed_share")})  # fmt: skip
    return {c.name: c for c in shown.cards(changed, seen)}[name]


def test_cards_say_what_decides():
    made, numbers = design(), HingeNumbers(judged=design())
    assert card(made, "guide").value == "can be cut" and card(made, "guide").mark == (
        "yes" if made.target.met else "no"
    )
    assert made.target.words in card(made, "guide").about and "within all limits" not in card(made, "guide").about
    broken = dataclasses.replace(made.verdict, feasible=False, reason="too steep")
    assert (
        card(made, "guide", guide=broken).value == "cannot be built"
        and card(made, "guide", guide=broken).about == "too steep"
    )
    share = numbers.losses.share
    assert card(made, "lost in the hinge").value == f"{100 * share:.3g} %"
    no_load = dataclasses.replace(numbers.losses, share=None, torques=LossTorques(
        bearing=900.0, seal=100.0, guide=0.0, rolling=0.0, gas=234.0))  # fmt: skip
    lost = card(made, "lost in the hinge", losses=no_load)
    assert lost.value.startswith("1.23 kN") and "load torque" not in lost.about
    assert card(made, "one misfire", misfire_speed_share=0.734).value == "73 % of the speed"
    stops = card(made, "one misfire", misfire_speed_share=0.0)
    assert (stops.value, stops.mark) == ("stops", "no")
    assert card(made, "speed ripple", losses=None).value == card(made, "speed ripple without losses").value
    still = dataclasses.replace(numbers.losses, speed_ripple=None)
    assert card(made, "speed ripple with losses", losses=still).value == "no steady motion"
    ends = card(made, "guide, radius of the roller centres")
    low, high = (f"{1e3 * r:.4g} mm" for r in (made.verdict.rho_min, made.verdict.rho_max))
    assert ends.value == f"{low} to {high}" and "2 rollers of radius" in ends.about


def test_what_has_to_be_known_first():
    def told(**changes):
        made = {"target": Made(met=True, held=True, words="words", with_losses=(0.01,)), "answer": "answer",
                "sensitivities": (), "price": Made(misfire_speed_share=None), **changes}  # fmt: skip
        return [(f.rank, f.words, f.value) for f in shown.of_design(answering(design(), **made))]

    assert told() == []
    missed = Made(met=False, held=True, words="missed by much", with_losses=(0.05, None, 0.07))
    assert told(target=missed) == [(NOT_MET, "missed by much", 0.07)]
    unheld = Made(met=False, held=False, words="w", with_losses=(None,))
    assert told(target=unheld) == [(NOT_MET, "answer", None)]
    for share, rank, words in ((0.0, NOT_MET, "stops the shaft"), (0.62, LOOK_AT, "down to 62 % of its mean")):
        ((got, text, value),) = told(price=Made(misfire_speed_share=share))
        assert (got, value) == (rank, share) and words in text
    assert told(price=Made(misfire_speed_share=0.9)) == []
    sides = [
        Made(name="p0", value=5e6, unit="Pa", low=Made(speed_ripple=0.03), high=Made(speed_ripple=None)),
        Made(name="H", value=0.9, unit="m", low=Made(speed_ripple=0.01), high=Made(speed_ripple=0.041)),
    ]
    assert told(sensitivities=sides) == [(LEAST_SURE, "H = 900 mm: 1 % off it, the ripple is 4.1 %", 0.041)]


def answering(made, **changes):
    """A design with other answers in place of what it computes."""
    other = object.__new__(type("Other", (type(made),), dict(changes)))
    other.__dict__.update({k: v for k, v in vars(made).items() if k not in changes})
    return other


def test_the_moving_picture_has_the_gas_and_what_the_tracks_press_with():
    guide, rollers = design().guide, design().rollers
    scene = shown.hinge_scene(guide, rollers, 1.0, 24)
    gas = next(s for s in scene["shapes"] if s["role"] == "gas")
    phi = 2 * math.pi * np.arange(24) / 24
    rho = path(guide)(phi)
    pressure = guide.spring.pressure(closing(guide, rho))
    assert gas["share"] == pytest.approx(100 * pressure / pressure.max(), abs=0.51)
    drawn = plots.elastic_hinge(guide, rollers)
    reactions = (np.full(24, 3e5), np.full(24, 3e5))
    first, second = shown._of_rollers({"turns": 1.0, "count": 24}, drawn, reactions)
    assert np.abs(first.force) == pytest.approx(3e5) and first.at == pytest.approx(rho * np.exp(1j * phi))
    # inwards, and across the path: the radial part is that of the pressure angle
    slope = path(guide).derivative()(phi)
    along = (first.force * np.exp(-1j * phi)).real
    assert along == pytest.approx(-3e5 / np.hypot(1, slope / rho), rel=2e-2)
    assert second.at == pytest.approx(-first.at) and second.force == pytest.approx(-first.force, abs=3e3)


def test_readouts_are_the_numbers_of_each_frame():
    rows = {row["name"]: row for row in shown.readouts(design())}
    assert list(rows) == [
        "torque on the crank", "excess pressure in the spring", "spring force", "roller force N₁",
        "closing of the spring",
    ]  # fmt: skip
    phi = 2 * math.pi * np.arange(120) / 120
    for name, values in (("torque on the crank", design().hinge.torque(phi)),
                         ("closing of the spring", closing(design().guide, path(design().guide)(phi)))):  # fmt: skip
        text = [float(t) * unit(rows[name]["unit"]) for t in rows[name]["text"]]
        assert text == pytest.approx(values, rel=1e-3, abs=1e-3 * np.abs(values).max())


def test_without_a_guide_there_is_one_run():
    runs = side_by_side(design().machine, design().hinge, None, 1.0, None)
    assert [t.name for t in runs] == ["without"] and runs[0].losses is None
