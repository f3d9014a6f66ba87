"""Rows of the programme at motions, guides and gases that are known: closed forms, and the machine by another way."""

import dataclasses
import math
from types import SimpleNamespace as Made

import casadi as ca
import numpy as np
import pytest
from codesigns import OMEGA, constant_load, design, point, ready, task

from mechsym.codesign import programme, running
from mechsym.codesign.loss import friction, gas_turn
from mechsym.codesign.points import even_angles, sample, speed, swing
from mechsym.codesign.realise import _closing, _track
from mechsym.codesign.task import Track, fine_path
from mechsym.codesign.unknowns import (
    Gathered,
    basis,
    closing,
    curve,
    guides,
    matrices,
    middle,
    shapes,
    start_pressures,
    taken,
    warmths,
)
from mechsym.hinge.balance import ripple
from mechsym.hinge.rollers import HingeLosses
from mechsym.hinge.springs.air_thermal import gas_temperature


def at(rows, asked, unknowns, ripple):
    """Each piece of the rows, and the ripple that they show, at numbers of the unknowns and of the ripple asked."""
    pieces = ca.Function("rows", [rows.unknowns, asked], [*rows.rows, rows.ripple])
    return [np.asarray(piece.full()).ravel() for piece in pieces(unknowns, ripple)]


@pytest.mark.parametrize("ratio", [1.05, 2.0, 30.0])
def test_a_governed_motion_meets_its_rows_where_the_elliptic_integral_says(ratio):
    inertia, ripple = constant_load(200.0, ratio)
    one = point(lambda phi: 200.0 * np.sin(2 * phi))
    samples, asked = sample([one], 1440), ca.SX.sym("ripple")
    rows = programme.motion_rows(one, 0, samples, ca.DM(samples.work[0]), inertia, asked)
    a = 2 * 200.0 / inertia
    scale = 0.1 * 400.0
    g = (ratio * a - OMEGA**2) * inertia / (2 * scale)
    ends = np.sqrt(np.array([ratio - 1, ratio + 1]) * a) / OMEGA
    above, below, rest, mean, seen = at(rows, asked, np.array([g, *ends]), ripple)
    # squares of the speed: the least is its lower end, the largest its upper one
    assert above.min() == pytest.approx(0.0, abs=2e-6) and above.max() == pytest.approx(2 * a / OMEGA**2, rel=1e-5)
    assert below.max() == pytest.approx(0.0, abs=2e-6) and below.min() == pytest.approx(-2 * a / OMEGA**2, rel=1e-5)
    assert rest == pytest.approx([0.0], abs=1e-6) and mean == pytest.approx([0.0], abs=1e-6)
    assert seen == pytest.approx([ripple], rel=1e-5)
    assert rows.low == (0.0, -math.inf, -math.inf, 0.0) and rows.high == (math.inf, 0.0, 0.0, 0.0)
    assert rows.start == pytest.approx([0.0, 0.9, 1.1])


def test_a_propeller_leaves_the_linear_filter_of_the_work():
    # E' = -w' - a E with a = 2 (M - what is taken) / (I omega^2), for w = A cos 2 phi
    amplitude, torque, lost, inertia = 300.0, 2300.0, 300.0, 10.0
    one = point(lambda phi: amplitude * np.cos(2 * phi), own=inertia, law="propeller", load_torque=torque)
    samples, asked = sample([one], 720), ca.SX.sym("ripple")
    rows = programme.motion_rows(one, 0, samples, ca.DM(samples.work[0]), inertia, asked, lost)
    a = 2 * (torque - lost) / (inertia * OMEGA**2)
    phi = samples.phi
    energy = np.real(-2j * amplitude / (2j + a) * np.exp(2j * phi))
    g = (energy + samples.work[0]) / (0.1 * 2 * amplitude)
    speeds = np.sqrt(1 + 2 * energy / (inertia * OMEGA**2))
    *_, rest, steps, seen = at(rows, asked, np.array([*g, speeds.min(), speeds.max()]), 0.0)
    # a step by trapezia misses h^3 g''' / 12, and g''' is eight times the work at most
    assert np.abs(steps).max() < 8 * np.ptp(g) * samples.step[0] ** 3 / 12
    assert rest == pytest.approx(np.ptp(speeds) * np.mean(1 / speeds), rel=1e-9) and seen == pytest.approx(rest)


def test_derivatives_piece_by_piece_are_those_of_the_whole():
    x, p = ca.SX.sym("x", 3), ca.SX.sym("p", 2)
    objective = x[0] ** 2 * x[1] + ca.exp(x[2])
    groups = [[x[0] * x[1] - p[0], ca.sin(x[1] * x[2])], [p[1] * x[2] ** 3]]
    solver = programme._solver(x, p, objective, groups, {"ipopt": {"print_level": 0, "sb": "yes"}, "print_time": False})
    g, by, lam = ca.vertcat(*groups[0], *groups[1]), ca.SX.sym("by"), ca.SX.sym("lam", 3)
    whole = ca.hessian(by * objective + ca.dot(lam, g), x)[0]
    where, given = np.array([0.3, -1.2, 0.7]), np.array([0.4, 1.7])
    hessian = ca.Function("hessian", [x, p, by, lam], [ca.triu(whole)])(where, given, 1.3, [0.2, -0.9, 2.0])
    seen = solver.get_function("nlp_hess_l")(where, given, 1.3, [0.2, -0.9, 2.0])
    assert np.asarray(seen.full()) == pytest.approx(np.asarray(hessian.full()), rel=1e-14)
    values, slopes = solver.get_function("nlp_jac_g")(where, given)
    wanted = ca.Function("rows", [x, p], [g, ca.jacobian(g, x)])(where, given)
    assert np.asarray(values.full()) == pytest.approx(np.asarray(wanted[0].full()))
    assert np.asarray(slopes.full()) == pytest.approx(np.asarray(wanted[1].full()))


def test_what_a_limit_costs_is_told_where_moving_it_by_itself_would_show():
    size = 2000.0
    least = 2.0  # a thousandth of it
    keys = [key for key, *_ in programme.asked_of(task().bounds)]
    values = np.array(programme._values(task()))
    assert values[0] == task().ripple and values[-1] == task().widest and values.size == len(keys) + 2
    for factor, told in ((0.99, ()), (1.01, ("ripple", *keys, "track_radius"))):
        active = programme._active(task(), factor * least / values, size)
        assert tuple(one.limit for one in active) == told
        assert all(one.multiplier > 0 for one in active)
    (one,) = programme._active(task(), np.array([-5000.0, *(0.0 for _ in values[1:])]), size)
    assert (one.limit, one.multiplier, one.unit) == ("ripple", -5000.0, "-")


def test_a_limit_that_is_passed_between_the_angles_is_asked_more_strictly(monkeypatch):
    excess = iter([{"roller_reaction": 0.01}, {"roller_reaction": 0.005}, {}])
    bounds, first_design = [], design()

    def solved(asked, ready, near, building):
        bounds.append((asked.bounds.roller_reaction, asked.bounds.closing_share, near, building))
        return dataclasses.replace(first_design, task=asked, wall=1.0)

    monkeypatch.setattr(programme, "_solved", solved)
    monkeypatch.setattr(programme, "passed", lambda design: next(excess))
    made = programme.solve(task(), ready())
    first = task().bounds.roller_reaction
    # each round by the share that is passed and 0.2 % more
    assert [row[0] for row in bounds] == pytest.approx([first, first / 1.012, first / 1.012 / 1.007])
    assert {row[1] for row in bounds} == {task().bounds.closing_share}
    assert bounds[0][2] is None and bounds[1][2] is not None and all(row[3] == 0.0 for row in bounds)
    assert made.task.bounds.roller_reaction == first and made.wall == pytest.approx(3.0)
    monkeypatch.setattr(programme, "passed", lambda design: {"roller_reaction": 0.01})
    assert programme.solve(task(), ready()).wall == pytest.approx(5.0)  # four rounds more at most
    # what a stricter limit leaves no solution for stays as it was
    only = task().bounds

    def stricter_fails(asked, ready, near, building):
        return dataclasses.replace(first_design, status="optimal" if asked.bounds == only else "infeasible")

    monkeypatch.setattr(programme, "_solved", stricter_fails)
    assert programme.solve(task(), ready()).status == "optimal"


def test_a_flywheel_that_nobody_can_tell_from_none_is_none_and_has_no_price():
    best = {"x": ca.DM(design().solution["x0"]), "lam_x": ca.DM(0), "lam_g": ca.DM(0)}
    best["lam_p"] = -ca.DM.ones(len(programme._values(task())))
    read = ready().read(best["x"])
    unit = swing(task().points)
    assert ready().unit == unit
    for flywheel, told in ((2e-7 * unit, 2e-7 * unit), (0.9e-7 * unit, 0.0)):
        given = dataclasses.replace(ready(), read=lambda x, J=flywheel: (*read[:3], ca.DM(J), read[4]))
        solved = Made(values=best, status="optimal", reason="", iterations=7)
        made = programme._result(task(), given, solved, 2.5)
        assert made.flywheel == told and bool(made.active) == bool(told)
        assert (made.iterations, made.wall) == (7, 2.5)
        assert made.tracks[0].p0 == pytest.approx(design().tracks[0].p0, rel=1e-6)
        assert made.tracks[0].hardware.spring.p0 == pytest.approx(design().tracks[0].p0.max(), rel=1e-6)
        assert made.ripple == pytest.approx(design().ripple, rel=1e-6)


def test_a_closing_stores_what_is_asked_as_far_as_it_may_go():
    hardware = task().hardware
    deepest = 0.7 * hardware.spring.H
    spring = hardware.charged(3e6)
    wanted = np.linspace(0.01, 0.9, 7) * float(spring.energy(deepest))
    z = closing(hardware, np.array([*wanted, 5 * float(spring.energy(deepest))]), 3e6, deepest)
    assert spring.energy(z[:-1]) == pytest.approx(wanted, rel=1e-5) and z[-1] == deepest


def test_guides_start_from_the_work_of_the_middle_point_and_pressures_in_its_proportion():
    points = [point(lambda phi, k=k: k * np.sin(2 * phi), omega=3.0 + k) for k in (5e3, 1e3, 2e3, 9e3)]
    asked = dataclasses.replace(task(), points=tuple(points), springs=3)
    samples = sample(asked.points, 120)
    assert middle(samples) == 2  # of four the second by size
    own = task().hardware.spring.p0
    first, second, third = start_pressures(asked, samples)
    assert first == pytest.approx(own * np.array([2.5, 0.5, 1.0, 4.5]), rel=1e-6)
    assert second == pytest.approx(first / 4) and third == pytest.approx(first / 4)
    shape, second, third = shapes(asked, samples)
    spring, H = task().hardware.charged(own), task().hardware.spring.H
    # the wanted work goes into the spring, from its smallest closing on
    stored = spring.energy(shape) + samples.work[2]
    assert np.ptp(stored) < 1e-4 * np.ptp(samples.work[2])
    assert shape.min() == pytest.approx(task().hardware.z_margin, abs=2e-4 * H)
    assert second == pytest.approx(H * (0.15 + 0.05 * np.cos(samples.phi)))
    assert third == pytest.approx(H * (0.15 + 0.05 * np.cos(2 * samples.phi)))


def test_free_hardware_is_a_share_of_the_given_one_and_leaves_room_for_the_gas():
    asked = dataclasses.replace(task(at=(2,)), free=("A", "rho0", "moving_mass"))
    samples, gathered = sample(asked.points, 60), Gathered()
    (guide,) = guides(asked, samples, basis(asked.points[0].period, (), 20), gathered)
    unknowns = ca.vertcat(*gathered.unknowns)
    shown = ca.Function("values", [unknowns], [guide.values[k] for k in ("A", "H", "rho0", "radius", "moving_mass")])
    start = np.concatenate(gathered.start)
    A, H, rho0, radius, mass = (float(v) for v in shown(start))
    h = asked.hardware
    assert (A, H, rho0, radius) == pytest.approx((h.spring.A, h.spring.H, h.rho0, h.radius))
    assert mass == pytest.approx(0.1 * swing(asked.points) / h.spring.H**2)
    (room,) = gathered.rows[0]
    of = ca.Function("room", [unknowns], [room])
    assert float(of(start)) == pytest.approx((h.rho0 - h.spring.H / 2 - h.radius) / h.spring.H)
    assert gathered.low[0] == [0.0] and gathered.high[0] == [np.inf]
    start[0] *= 1.5
    assert float(shown(start)[0]) == pytest.approx(1.5 * h.spring.A)
    # the path closes c rollers, and their inertia is that of the masses on it
    path, inertia = ca.Function("path", [unknowns], [guide.path.rho, guide.inertia])(start)
    z = matrices(basis(asked.points[0].period, (), 20), samples.phi)[0] @ start[3:23]
    assert np.asarray(path).ravel() == pytest.approx(h.rho0 - np.asarray(z).ravel() / h.count)
    assert float(inertia[0]) > 0.99 * h.count * h.shaft_ratio**2 * mass * float(path[0]) ** 2


@pytest.mark.parametrize("tau", [0.02, 0.3, 5.0])  # work of the gas summed as work, and as heat
def test_losses_of_the_programme_are_those_of_its_guide_by_the_machine(tau):
    losses = HingeLosses(tau=tau)
    asked = dataclasses.replace(task(at=(2,)), losses=losses)
    (one,), gathered = asked.points, Gathered()
    samples = sample(asked.points, 360)
    splines = basis(one.period, one.kinks, 40)
    symbols = guides(asked, samples, splines, gathered)
    (warm,) = warmths(asked, samples, symbols, losses, gathered)
    first = sum(len(part) for part in gathered.start[:-1])  # of the entropies
    lost = taken(asked, one, samples, symbols, [symbols[0].p0[0]], warm, losses, gathered)
    n, unknowns, start = samples.phi.size, ca.vertcat(*gathered.unknowns), np.concatenate(gathered.start)
    *_, of_gas, of_work = (ca.vertcat(*group) for group in gathered.rows)
    c = start[: splines.count]
    track = Track(hardware=asked.hardware, z=curve(splines, c), p0=start_pressures(asked, samples)[0])
    volume = 1 - track.z(samples.phi) / asked.hardware.spring.H
    x = one.omega * tau
    start[first : first + n] = gas_temperature(volume, samples.step, x, losses.gamma, 1.0) * volume ** (
        losses.gamma - 1
    )
    shown = ca.Function("rows", [unknowns], [of_gas, of_work, lost.torque, lost.work, warm.ratio[0]])
    assert np.abs(np.asarray(shown(start)[0])).max() < 1e-10
    # the lost work follows from its rows, which are linear in it
    slope = ca.Function("slope", [unknowns], [ca.jacobian(of_work, unknowns[-n:])])(start).full()
    start[-n:] -= np.linalg.solve(slope, np.asarray(shown(start)[1]).ravel())
    _, rest, torque, work, ratio = (np.asarray(part).ravel() for part in shown(start))
    assert np.abs(rest).max() < 1e-9
    p0 = float(track.p0[0])
    turned, (phi, path) = gas_turn(track, p0, one, losses), fine_path(track, one.period)
    rubbed = sum(friction(track, path, track.hardware.spring.A * turned.pressure, one.omega, losses).values())
    assert torque == pytest.approx(np.mean(rubbed) + turned.loss / one.period, rel=2e-2)
    assert np.interp(phi, samples.phi, ratio)[:-4] == pytest.approx(turned.warmth[:-4], rel=1e-2)
    # over the turn the gas and what is lost beyond the mean give what the spring's torque does
    gas = asked.hardware.spring.A * turned.pressure * track.z.derivative()(phi) + rubbed
    given = np.concatenate([[0.0], np.cumsum((gas[1:] + gas[:-1]) / 2 * np.diff(phi))]) - torque * phi
    swing = np.interp(phi, samples.phi, work) - work[0]
    assert swing[:-4] == pytest.approx(given[:-4], abs=1e-2 * np.ptp(given))


def test_a_closing_for_other_hardware_stores_the_same_over_the_turn():
    hardware = task().hardware
    phi = np.arange(720) * 2 * np.pi / 720
    size = 0.3 * float(hardware.charged(3e6).energy(0.6 * hardware.spring.H))
    spring = dataclasses.replace(hardware, spring=hardware.charged(3e6))
    stored = size * (1 - np.cos(phi)), size * np.sin(phi), size * np.cos(phi)
    least = 0.05 * hardware.spring.H
    z, dz, d2z = _closing(spring, stored, least)
    assert z[0] == pytest.approx(least, rel=1e-9)
    assert spring.spring.energy(z) - spring.spring.energy(least) == pytest.approx(stored[0], abs=1e-9 * size)
    turned = np.fft.fft(z) * 1j * np.fft.fftfreq(720, 1 / 720)
    assert dz == pytest.approx(np.fft.ifft(turned).real, abs=1e-8)
    again = np.fft.ifft(turned * 1j * np.fft.fftfreq(720, 1 / 720)).real
    assert d2z == pytest.approx(again, abs=1e-6)


def test_pressures_of_other_hardware_are_those_whose_works_are_nearest():
    (old,) = design().tracks
    period = design().task.points[0].period
    phi = np.arange(720) * period / 720
    other = old.hardware.changed({"A": 2 * old.hardware.spring.A, "pa": old.hardware.spring.pa / 2})
    made = _track(old, other, old.z(phi), phi, period)
    # twice the area at half of both pressures is the same spring
    assert made.p0 == pytest.approx(old.p0 / 2, rel=1e-6) and made.z(phi) == pytest.approx(old.z(phi), abs=1e-9)
    assert made.hardware.spring.p0 == pytest.approx(old.p0.max() / 2, rel=1e-6)


def test_the_wall_of_a_gas_spring_knows_the_speed_of_its_own_shaft():
    whole, losses = task().hardware, HingeLosses()
    half = dataclasses.replace(whole, shaft_ratio=0.5)
    # the index of the spring says omega tau of the shaft that closes it: at half the speed it takes twice the time
    assert half.walled(5e6, losses, 20.0).tau == pytest.approx(2 * whole.walled(5e6, losses, 20.0).tau)
    assert half.walled(5e6, HingeLosses(tau=0.3), 20.0).tau == 0.3


def test_the_ripple_of_the_programme_is_that_of_its_motion_by_the_closed_form():
    for k in (0, 5):
        (track,), one = design().tracks, design().task.points[k]
        phi = even_angles(one)
        rollers = running.added_inertia(track, phi)
        missing = one.work(phi) + running.spring_energy(track, track.p0[k], phi) + one.omega**2 / 2 * rollers
        uneven = ripple(speed(one, missing - missing.mean(), one.inertia(phi) + design().flywheel + rollers))
        # the programme has 180 angles, and the ends of the speed may lie between them
        assert design().ripple[k] == pytest.approx(uneven, rel=3e-3)
        assert np.ptp(rollers) > 1.0  # they count


def test_free_hardware_is_paid_with_the_inertia_of_its_rollers_and_stays_where_nothing_asks():
    asked = dataclasses.replace(task(at=(2,)), free=("A",), knots=20, angles=60)
    prepared = programme.programme(asked)
    objective = prepared.solver.get_function("nlp_f")
    values, start = programme._values(asked), prepared.start.copy()
    flywheel = float(prepared.read(start)[3])
    z = curve(prepared.basis, np.asarray(prepared.read(start)[0].full()).ravel())
    phi = np.arange(7200) * asked.points[0].period / 7200
    rollers = running.inertia_of(asked.hardware, z(phi), z.derivative()(phi)).mean()
    unit = swing(asked.points)
    assert flywheel == pytest.approx(3 * unit)
    assert float(objective(start, values)) == pytest.approx((flywheel + rollers) / unit, rel=1e-4)
    start[0] *= 3.0  # the share of the piston's area stands first
    assert float(objective(start, values) - objective(prepared.start, values)) == pytest.approx(4e-6, rel=1e-3)
