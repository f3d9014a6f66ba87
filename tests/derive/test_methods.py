"""Models of sympy.physics.mechanics run as mechanisms: Kane and Lagrange agree, speeds of their own are put in, a
holonomic constraint is held, all against a pendulum integrated here."""

import numpy as np
import pytest
import scipy
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.derive.files import declared_in
from mechsym.errors import BadInput
from mechsym.jobs.problem import problem_of
from mechsym.mechanisms import build, state
from mechsym.mechanisms.plan import plan_of
from mechsym.simulate import Settings, simulate

MODEL = """
from sympy import cos, symbols
from sympy.physics.mechanics import *

x, y, a, b, u, v, F = dynamicsymbols("x y a b u v F")
m, M, l, g = symbols("m M l g")
units = {"x": "m", "y": "m", "b": "rad", "a": "rad", "F": "N", "m": "kg", "M": "kg", "l": "m", "g": "m/s^2"}
N = ReferenceFrame("N")
O = Point("O")
O.set_vel(N, 0)
held = LagrangesMethod(m * (x.diff() ** 2 + y.diff() ** 2) / 2 - m * g * y, [x, y], hol_coneqs=[x**2 + y**2 - l**2])


def odd():
    B = N.orientnew("B", "Axis", [a, N.z])
    B.set_ang_vel(N, u / (l * (2 + cos(a))) * N.z)
    P = O.locatenew("P", -l * B.y)
    P.v2pt_theory(O, N, B)
    method = KanesMethod(N, [a], [u], kd_eqs=[u - l * (2 + cos(a)) * a.diff()])
    method.kanes_equations([Particle("bob", P, m)], [(P, -m * g * N.y)])
    return method


def cart(rates):
    B = N.orientnew("B", "Axis", [b, N.z])
    B.set_ang_vel(N, rates[1] * N.z)
    C = O.locatenew("C", x * N.x)
    C.set_vel(N, rates[0] * N.x)
    P = C.locatenew("P", -l * B.y)
    P.v2pt_theory(C, N, B)
    return C, P, Particle("cart", C, M), Particle("bob", P, m)


def kane():
    C, P, *bodies = cart([u, v])
    method = KanesMethod(N, [x, b], [u, v], kd_eqs=[u - x.diff(), v - b.diff()])
    method.kanes_equations(bodies, [(C, F * N.x - M * g * N.y), (P, -m * g * N.y)])
    return method


def whole():
    # the pendulum as a System of Kane's, whose speed is its own rate
    B = N.orientnew("B", "Axis", [a, N.z])
    B.set_ang_vel(N, u * N.z)
    P = O.locatenew("P", -l * B.y)
    P.v2pt_theory(O, N, B)
    system = System(N, O)
    system.add_bodies(Particle("bob", P, m))
    system.add_coordinates(a)
    system.add_speeds(u)
    system.add_kdes(u - a.diff())
    system.add_loads(Force(P, -m * g * N.y))
    return system


def turning():
    # a rigid body in space on a gimbal: precession a, leaning b
    A = N.orientnew("A", "Axis", [a, N.z])
    B = A.orientnew("B", "Axis", [b, A.x])
    G = O.locatenew("G", l * B.z)
    G.v2pt_theory(O, N, B)
    body = RigidBody("body", G, B, m, (inertia(B, 2 * M, 2 * M, M), G))
    body.potential_energy = m * g * l * cos(b)
    return LagrangesMethod(Lagrangian(N, body), [a, b], frame=N)


def lagrange():
    C, P, *bodies = cart([x.diff(), b.diff()])
    bodies[1].potential_energy = -m * g * l * cos(b)
    return LagrangesMethod(Lagrangian(N, *bodies), [x, b], forcelist=[(C, F * N.x)], frame=N)
"""
NUMBERS = {"m": 1.2, "l": 0.8, "g": 9.81}


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    file = tmp_path_factory.mktemp("models") / "model.py"
    file.write_text(MODEL)
    return file


def case_of(model, name, start, more="", **numbers):
    letters = "\n".join(f"{k} = {v}" for k, v in (NUMBERS | numbers).items())
    begin = "\n".join(f"{k} = {v!r}" for k, v in start.items())
    text = (
        f'mechanism = "./model.py:{name}"\n[parameters]\n{letters}\n[start]\n{begin}\n{more}\n[simulation]\nt_end = 1'
    )
    file = model.parent / f"{name}.toml"
    file.write_text(text)
    return file


def end_of(case):
    result = simulate(problem_of(cases.load(str(case))), Settings(tolerance=1e-12, check="none"))
    return {n: float(v[-1]) for n, v in result.columns.items()}


@pytest.fixture(scope="module")
def swung():
    rates = lambda t, s: [s[1], -NUMBERS["g"] / NUMBERS["l"] * np.sin(s[0])]  # noqa: E731
    run = scipy.integrate.solve_ivp(rates, (0, 1), [0.7, 0.0], method="DOP853", rtol=1e-13, atol=1e-13)
    return run.y[:, -1]


def test_speeds_of_its_own_are_put_in(model, swung):
    end = end_of(case_of(model, "odd", {"a": 0.7}))
    assert [end["a"], end["ad"]] == pytest.approx(swung.tolist(), abs=1e-10)


def test_a_system_runs_as_its_method_does(model, swung):
    end = end_of(case_of(model, "whole", {"a": 0.7}))
    assert [end["a"], end["ad"]] == pytest.approx(swung.tolist(), abs=1e-10)


def test_frames_in_space_are_a_mechanism(model):
    """A body on a gimbal against its moments of inertia: A sin^2 b + C cos^2 b about the upright."""
    m, l, g, M, b = 1.2, 0.8, 9.81, 0.3, 0.6
    plan = plan_of(f"{model}:turning")
    at = {"a": 0.2, "b": b, "ad": 1.5, "bd": -0.7}
    found = state(build(f"{model}:turning", plan.parameters(m=m, l=l, g=g, M=M)), at).acceleration
    A, C = 2 * M + m * l**2, M
    upright, slope = A * np.sin(b) ** 2 + C * np.cos(b) ** 2, 2 * (A - C) * np.sin(b) * np.cos(b)
    wanted = [-slope * 1.5 * -0.7 / upright, (slope / 2 * 1.5**2 + m * g * l * np.sin(b)) / A]
    assert found == pytest.approx(wanted, rel=1e-12)


def test_a_holonomic_constraint_is_held(model, swung):
    l = NUMBERS["l"]
    end = end_of(case_of(model, "held", {"x": l * np.sin(0.7).item(), "y": -l * np.cos(0.7).item()}))
    assert [end["x"], end["y"]] == pytest.approx([l * np.sin(swung[0]), -l * np.cos(swung[0])], abs=1e-10)


@pytest.mark.slow
def test_kane_and_lagrange_are_one_machine_and_go_through_the_commands(model):
    at = {"x": 0.1, "b": 0.5, "xd": 0.3, "bd": 1.0, "F": 3.0}
    found = []
    for name in ("kane", "lagrange"):
        plan = plan_of(f"{model}:{name}")
        numbers = plan.parameters(**NUMBERS, M=2.0)
        found.append(state(build(f"{model}:{name}", numbers), at).acceleration)
    m, M, l, g, angle = 1.2, 2.0, 0.8, 9.81, 0.5
    mass = np.array([[M + m, m * l * np.cos(angle)], [m * l * np.cos(angle), m * l**2]])
    force = [3.0 + m * l * np.sin(angle), -m * g * l * np.sin(angle)]
    assert found[0] == pytest.approx(np.linalg.solve(mass, force).tolist(), rel=1e-12)
    assert found[1] == pytest.approx(found[0], rel=1e-12)
    more = '[inputs]\nF = "3 N"\n[motion]\nx = "cycloid"\nrise = "0.5 m"\nduration = "1 s"\n'
    case = str(case_of(model, "kane", {"b": 0.5}, more, M=2.0))
    out = model.parent
    for command in (
        ["simulate", case], ["forces", case], ["sweep", case, "--over", "m=1..2:2", "--out", str(out / "sweep")],
        ["fmu", case, "--fmi", "2", "--out", str(out / "k.fmu")], ["page", case, "--out", str(out / "k.html")],
        ["export", case, "--to", "c", "--out", str(out / "c")],
    ):  # fmt: skip
        done = CliRunner().invoke(mechsym, [*command, "--trust"] if command[0] != "export" else command)
        assert done.exit_code == 0, (command, done.output)


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("r = KanesMethod(N, [a], [u], kd_eqs=[u - a.diff()])", "call r.kanes_equations"),
        ("from sympy import Symbol\nr = LagrangesMethod(a.diff() ** 2 * Symbol('t'), [a])", "depends on the time t"),
        ("r = LagrangesMethod(a.diff() ** 2 + a.diff() * u.diff(), [a])", "an input of its own"),
        ("r = LagrangesMethod(a.diff() ** 2 * (2 + gamma(a)), [a])", "gamma"),
        ("r = LagrangesMethod(x.diff()**2 + y.diff()**2, [x, y], nonhol_coneqs=[x.diff() - y.diff()])", "KanesMethod"),
    ],
)
def test_a_model_that_cannot_run_is_refused_in_one_line(tmp_path, line, told):
    file = tmp_path / "model.py"
    head = 'from sympy import gamma, symbols\nfrom sympy.physics.mechanics import *\nN = ReferenceFrame("N")\n'
    file.write_text(f'{head}x, y, a, u = dynamicsymbols("x y a u")\n{line}\n')
    with pytest.raises(BadInput, match=told) as error:
        declared_in(file)
    assert str(error.value).startswith("model.py: ") and "\n" not in str(error.value)
