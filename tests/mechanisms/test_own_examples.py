"""Examples of declarations: they turn, run, and balance; their dynamics against chains of points that are written down
here with complex numbers and differentiated by Fourier series, and against sympy.physics.mechanics."""

from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from one_turn import turned
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

from mechsym import cases
from mechsym.cases.settings import settings_of
from mechsym.errors import BadInput
from mechsym.jobs.hinge import hinge
from mechsym.jobs.machine import machine, one_coordinate
from mechsym.jobs.problem import problem_of
from mechsym.mechanisms import drawing
from mechsym.mechanisms.record import listing
from mechsym.simulate import simulate

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
G = 9.81


def case_of(name, **settings):
    return cases.load(str(EXAMPLES / f"{name}.toml"), settings)


def meet(A, a, B, b, side):
    """The point at the distances a and b from A and B."""
    d = B - A
    along = (a**2 - b**2 + np.abs(d) ** 2) / (2 * np.abs(d))
    return A + d / np.abs(d) * (along + 1j * side * np.sqrt(a**2 - along**2))


def out(point, length, height):
    """Where a rod from a point ends on the line y = height, on the far side."""
    return point.real + np.sqrt(length**2 - (height - point.imag) ** 2) + 1j * height


def turn_of(vector):
    return np.unwrap(np.angle(vector))


# each: parameters, crank pin's turn e^(i phi) -> bodies (mass, centre, inertia, angle), then travel by input
def scotch_yoke(p, turn):
    return [(p["m_yoke"], p["r"] * turn.real, 0, 0)], {"F": p["r"] * (1 - turn.real)}, p["I_crank"]


def whitworth(p, turn):
    D = -1j * p["h"]
    way = p["r"] * turn - D
    rocker = way / np.abs(way)
    ram = out(D + p["s"] * rocker, p["l"], p["y"])
    bodies = [(p["m_rocker"], D + p["s"] / 2 * rocker, p["I_rocker"], turn_of(way)), (p["m_ram"], ram, 0, 0)]
    return bodies, {"F": -ram.real}, p["I"]


def v_twin(p, turn):
    A, way = p["r"] * turn, np.exp(1j * p["v"])
    B1 = out(A, p["l"], 0.0)
    K = A + p["ra"] * (B1 - A) / p["l"] * way
    B2 = out(K / way, p["l2"], 0.0) * way
    bodies = [
        (p["m_rod"], A + (B1 - A) / 3, p["I_rod"], turn_of(B1 - A)),
        (p["m_rod"] / 2, (K + B2) / 2, p["I_rod"] / 3, turn_of(B2 - K)), (p["m_p"], B1, 0, 0), (p["m_p"], B2, 0, 0),
    ]  # fmt: skip
    return bodies, {"F1": -B1.real, "F2": -(B2 / way).real}, p["I"]


def atkinson(p, turn):
    A = 1j * p["h"] + p["r"] * turn
    B = meet(A, p["l2"], 0 * A, p["l3"], 1)
    P = out(B, p["l"], 0.0)
    bodies = [
        (p["m_link"], (A + B) / 2, p["I_link"], turn_of(B - A)), (0, B, p["I_rocker"], turn_of(B)),
        (p["m_rod"], B + (P - B) / 3, p["I_rod"], turn_of(P - B)), (p["m_p"], P, 0, 0),
    ]  # fmt: skip
    return bodies, {"F": -P.real}, p["I"]


def compressor(p, turn):
    A = p["r"] * turn
    P = out(A, p["l"], p["e"])
    return [(p["m_rod"], A + (P - A) / 3, p["I_rod"], turn_of(P - A)), (p["m_piston"], P, 0, 0)], {"F": -P.real}, p["I"]


def swash_plate(p, turn):
    # the plate stands square to its normal (sin tilt, 0, cos tilt), turned with the shaft: n . (place, x) = 0
    slope = np.tan(p["tilt"])
    xs = [-slope * p["R"] * (turn * np.exp(-2j * np.pi * k / 3)).real for k in range(3)]
    return [(p["m_p"], x, 0, 0) for x in xs], {f"F{k + 1}": x for k, x in enumerate(xs)}, p["I"]


def six_bar(p, turn):
    A, D, F = p["r"] * turn, p["x_D"] + 1j * p["y_D"], p["x_F"] + 1j * p["y_F"]
    C = meet(A, p["l2"], D, p["l3"], 1)
    coupler = (C - A) / p["l2"]
    E = A + (p["u_E"] + 1j * p["v_E"]) * coupler
    K = meet(E, p["l4"], F, p["l5"], 1)
    bodies = [
        (p["m2"], A + (p["l2"] / 2 + 1j * p["v_E"] / 3) * coupler, p["I2"], turn_of(C - A)),
        (p["m3"], (C + D) / 2, p["I3"], turn_of(C - D)), (p["m4"], (E + K) / 2, p["I4"], turn_of(K - E)),
        (p["m5"], (F + K) / 2, p["I5"], turn_of(K - F)),
    ]  # fmt: skip
    return bodies, {}, p["I1"]


CHAINS = {
    "scotch-yoke": scotch_yoke, "whitworth": whitworth, "v-twin": v_twin, "atkinson": atkinson,
    "compressor": compressor, "swash-plate": swash_plate, "watt-six-bar": six_bar,
}  # fmt: skip
WEIGHT = ("whitworth", "watt-six-bar")


def slope(values):
    """Derivative over evenly spaced angles of one turn."""
    n = len(values)
    return np.fft.ifft(np.fft.fft(values) * 1j * np.fft.fftfreq(n, 1 / n))


@pytest.mark.parametrize("name", CHAINS)
def test_the_torque_is_that_of_virtual_work_on_a_chain_of_points(name):
    case = case_of(name)
    found = turned(case)
    parameters = asdict(case.need("parameters"))
    bodies, travels, inertia = CHAINS[name](parameters, np.exp(1j * found.phi))
    inertia = inertia + sum(
        m * np.abs(slope(np.broadcast_to(c, found.phi.shape))) ** 2
        + I * slope(np.broadcast_to(a, found.phi.shape)).real ** 2
        for m, c, I, a in bodies
    )
    wanted = found.omega**2 / 2 * slope(inertia).real
    if name in WEIGHT:
        wanted = wanted + sum(m * G * slope(c.imag).real for m, c, _, _ in bodies)
    wanted = wanted - sum(found.columns[n] * slope(x).real for n, x in travels.items())
    size = np.abs(found.columns["driving_torque"]).max()
    np.testing.assert_allclose(found.columns["driving_torque"], wanted, atol=1e-10 * size)
    if "inertia" in found.columns:
        np.testing.assert_allclose(found.columns["inertia"], inertia, rtol=1e-12)
    assert found.power_residual < 1e-12


def test_the_compressor_moves_as_sympy_mechanics_says():
    p = asdict(case_of("compressor").need("parameters"))
    phi, t, F, M = dynamicsymbols("phi"), dynamicsymbols._t, *sp.symbols("F M")
    r, l, e = (sp.Float(p[n]) for n in "rle")
    A = sp.Matrix([r * sp.cos(phi), r * sp.sin(phi)])
    P = sp.Matrix([A[0] + sp.sqrt(l**2 - (e - A[1]) ** 2), e])
    C, angle = A + (P - A) / 3, sp.asin((e - A[1]) / l)
    speed = [v.diff(t).dot(v.diff(t)) for v in (C, P)]
    T = p["I"] * phi.diff(t) ** 2 / 2 + p["I_rod"] * angle.diff(t) ** 2 / 2
    T += p["m_rod"] * speed[0] / 2 + p["m_piston"] * speed[1] / 2
    method = LagrangesMethod(T, [phi])
    (equation,) = method.form_lagranges_equations()
    force = -F * P[0].diff(phi) - M
    at = {"phi": 0.7, "phid": 80.0, "F": 2000.0, "M": 12.0}
    numbers = [(phi.diff(t), at["phid"]), (phi, at["phi"]), (F, at["F"]), (M, at["M"])]
    (acceleration,) = sp.solve(equation.subs(phi.diff(t, 2), "a").subs(numbers) - force.subs(numbers), "a")
    mechanism = one_coordinate(case_of("compressor"))
    mass, bias, generalised = mechanism.functions["dynamics"](at["phi"], at["phid"], at["F"], at["M"])
    assert float((generalised - bias) / mass) == pytest.approx(float(acceleration), rel=1e-12)


@pytest.mark.parametrize(
    "name", [*CHAINS, *(pytest.param(n, marks=pytest.mark.slow) for n in ("radial-engine", "walking-leg"))]
)
def test_an_example_runs_and_is_drawn(name):
    case = case_of(name)
    problem = problem_of(case)
    result = simulate(problem, settings_of(case))
    assert result.status == "converged" and abs(result.energy.residual) < 1e-8
    mechanism = one_coordinate(case)
    shapes = drawing.declared(mechanism, listing(case.mechanism))
    assert shapes is not None
    counts = {len(shapes(a)) for a in np.linspace(0, 2 * np.pi, 12)}
    assert len(counts) == 1 and counts.pop() >= 3
    points = np.array([xy for shape in shapes(1.0) for xy in getattr(shape, "points", ())])
    assert np.isfinite(points).all() and np.ptp(points[:, 0]) > 0


@pytest.mark.parametrize("name", ["scotch-yoke", "compressor", pytest.param("v-twin", marks=pytest.mark.slow)])
def test_a_hinge_is_cut_for_it(name):
    found = hinge(case_of(name))
    assert found.verdict.feasible
    assert found.check.speed_ripple < 1e-9 and abs(found.check.result.energy.residual) < 1e-8


def test_weight_under_a_hinge_is_the_mechanism_s_own(tmp_path):
    text = (EXAMPLES / "compressor.py").read_text()
    heavy = text.replace("    m.piston(", '    m.weight(0, -m.parameters("g", "m/s^2", default=9.81))\n    m.piston(')
    (tmp_path / "compressor.py").write_text(heavy)
    (tmp_path / "c.toml").write_text((EXAMPLES / "compressor.toml").read_text())
    case = cases.load(str(tmp_path / "c.toml"))
    built = machine(case)
    phi, step = np.linspace(0, 6, 25), 1e-4
    around = [np.asarray(built.mechanism.functions["energy"](phi + s, 0.0)[1]).ravel() for s in (step, -step)]
    whole = np.asarray(built.mechanism.functions["dynamics"](phi, 0.0, 0.0, 0.0)[2]).ravel()
    assert np.abs(whole).max() > 0.1
    np.testing.assert_allclose(-(around[0] - around[1]) / (2 * step), whole, atol=1e-6)
    result = simulate(problem_of(case), settings_of(case))
    assert abs(result.energy.residual) < 1e-8


def test_the_ram_returns_faster_than_it_goes():
    found = turned(case_of("whitworth"))
    x = found.columns["x"]
    top, bottom = found.phi[np.argmax(x)], found.phi[np.argmin(x)]
    there = (bottom - top) % (2 * np.pi)
    # the rocker is at its ends where the crank is across it: cos = r / h
    wanted = np.pi + 2 * np.arcsin(60 / 150)
    assert max(there, 2 * np.pi - there) == pytest.approx(wanted, abs=4 * np.pi / 720)
    angle = found.columns["rocker_angle"]
    assert angle.max() == pytest.approx(np.arcsin(60 / 150), abs=1e-4)


def test_the_master_piston_is_a_slider_crank_and_the_other_is_not():
    found = turned(case_of("v-twin"))
    r, l, phi = 0.05, 0.2, found.phi
    plain = r * (1 - np.cos(phi)) + l - np.sqrt(l**2 - (r * np.sin(phi)) ** 2)
    np.testing.assert_allclose(found.columns["x1"], plain, atol=1e-14)
    assert np.ptp(found.columns["x2"]) > 2 * r + 1e-5  # an articulated rod lengthens the stroke


def test_atkinsons_piston_makes_two_long_and_two_short_strokes_in_a_turn():
    x = turned(case_of("atkinson")).columns["x"]
    tops = np.flatnonzero((x < np.roll(x, 1)) & (x <= np.roll(x, -1)))
    bottoms = np.flatnonzero((x > np.roll(x, 1)) & (x >= np.roll(x, -1)))
    assert len(tops) == len(bottoms) == 2
    assert x[tops] == pytest.approx([0, 0], abs=1e-6)  # rocker and rod in line, twice
    short, long = sorted(x[bottoms])
    assert long / short > 1.4


def test_a_piston_with_four_strokes_in_a_turn_takes_no_cycle(tmp_path):
    compressor = (EXAMPLES / "compressor.toml").read_text()
    start = compressor.index("[cycle]")
    cycle = compressor[start : compressor.index("[spring]")]
    (tmp_path / "atkinson.py").write_text((EXAMPLES / "atkinson.py").read_text())
    (tmp_path / "a.toml").write_text((EXAMPLES / "atkinson.toml").read_text() + cycle)
    with pytest.raises(BadInput, match="out and back 2 times in a turn"):
        turned(cases.load(str(tmp_path / "a.toml")))
