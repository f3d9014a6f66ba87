"""Springs, dampers and motors by their laws: forces, stored energies and motions against closed forms."""

import numpy as np
import pytest

from mechsym import mechanisms
from mechsym.mechanisms.record import bind
from mechsym.simulate import Settings, simulate
from mechsym.simulate.problem import Problem

HEAD = """from mechsym.derive import Mechanism


def one():
    m = Mechanism("one")
    x, phi = m.coordinates("x", "m"), m.coordinates("phi")
    m.body("block", mass="2 kg", at=(x, 0))
    m.body("wheel", inertia="0.02 kg*m^2", turns=phi)
"""


@pytest.fixture
def built(tmp_path):
    """A block of 2 kg along x, and a wheel of 0.02 kg m^2, with a line of the declaration."""

    def make(line, **files):
        for name, text in files.items():
            (tmp_path / f"{name}.csv").write_text(text)
        (tmp_path / "own.py").write_text(f"{HEAD}    {line}\n    return m\n")
        name = str(tmp_path / "own.py")
        ranges = mechanisms.listing(name)["ranges"]
        return bind(name, {p: ranges[p]["default"] for p in mechanisms.listing(name)["parameters"]})

    return make


def force(mechanism, x=0.0, phi=0.0, xd=0.0, phid=0.0):
    return np.asarray(mechanism.functions["dynamics"](x, phi, xd, phid)[2]).ravel()


def energy(mechanism, x, phi=0.0):
    return float(mechanism.functions["energy"](x, phi, 0, 0)[1])


def run(mechanism, q0, u0, t_end):
    settings = Settings(check="none", tolerance=1e-12)
    return simulate(Problem(mechanism=mechanism, parts=(), q0=q0, u0=u0, t_end=t_end, output=t_end / 10), settings)


def test_a_gas_spring_pushes_by_its_polytrope_and_stores_that_work(built):
    mechanism = built(
        "m.gas_spring('g', x, pressure='8 bar', area='3 cm^2', length='120 mm', exponent='1.3', ambient='1 bar')"
    )
    for x in (-0.02, 0.0, 0.07):
        wanted = -3e-4 * (8e5 * (0.12 / (0.12 - x)) ** 1.3 - 1e5)
        assert force(mechanism, x)[0] == pytest.approx(wanted, rel=1e-12)
    slope = (energy(mechanism, 0.05 + 1e-6) - energy(mechanism, 0.05 - 1e-6)) / 2e-6
    assert slope == pytest.approx(-force(mechanism, 0.05)[0], rel=1e-8)


@pytest.mark.parametrize("t, h, printed", [(3.0, 1.1, 12000), (2.0, 1.4, 4760)])
def test_disc_springs_bear_what_the_standard_prints(built, t, h, printed):
    """Rows 50 of series A and B of DIN 2093: outer 50, inner 25.4 mm, at three quarters of the cone."""
    line = f"m.belleville('b', x, outer='50 mm', inner='25.4 mm', height='{h} mm', thickness='{t} mm')"
    mechanism = built(line)
    assert -force(mechanism, 0.75e-3 * h)[0] == pytest.approx(printed, rel=2e-3)
    flat = h * 1e-3  # there the force is that of a plate alone
    slope = (energy(mechanism, flat + 1e-6) - energy(mechanism, flat - 1e-6)) / 2e-6
    assert slope == pytest.approx(-force(mechanism, flat)[0], rel=1e-7)


def test_a_table_of_a_line_is_a_linear_spring_also_beyond_its_ends(built):
    mechanism = built("m.table_spring('s', x, file='s.csv')", s="stretch [mm], force [N]\n-5,-40\n0,0\n20,160\n")
    result = run(mechanism, (0.05, 0.0), (0.0, 0.0), 0.3)
    np.testing.assert_allclose(result.columns["x"], 0.05 * np.cos(np.sqrt(8000 / 2) * result.t), atol=1e-9)
    assert energy(mechanism, -0.03) == pytest.approx(8000 * 0.03**2 / 2, rel=1e-12)


def test_a_table_of_a_spring_goes_through_its_rows(built):
    rows = {-10: -120, -4: -30, 0: 5, 6: 42, 15: 260}
    table = "stretch [mm], force [N]\n" + "".join(f"{x},{F}\n" for x, F in rows.items())
    mechanism = built("m.table_spring('s', x, file='s.csv')", s=table)
    for x, F in rows.items():
        assert -force(mechanism, 1e-3 * x)[0] == pytest.approx(F, abs=1e-10)
    slope = (energy(mechanism, 8e-3 + 1e-6) - energy(mechanism, 8e-3 - 1e-6)) / 2e-6
    assert slope == pytest.approx(-force(mechanism, 8e-3)[0], rel=1e-8)


def test_a_table_of_a_damper_brakes_by_its_rows(built):
    mechanism = built("m.table_damper('d', x, file='d.csv')", d="speed [m/s], force [N]\n-1,-5\n0,0\n1,5\n")
    result = run(mechanism, (0.0, 0.0), (3.0, 0.0), 0.5)
    np.testing.assert_allclose(result.columns["xd"], 3 * np.exp(-5 / 2 * result.t), rtol=1e-10)
    assert result.columns["dissipation"][-1] == pytest.approx(3**2 - result.columns["xd"][-1] ** 2, rel=1e-9)


def test_a_motor_of_direct_current_runs_up_by_an_exponential(built):
    k, R, U, J = 0.1, 2.0, 24.0, 1e-4
    mechanism = built(f"m.motor('E', phi, k='{k} N*m/A', R='{R} ohm', U='{U} V', J='{J} kg*m^2')")
    result = run(mechanism, (0.0, 0.0), (0.0, 0.0), 4.0)
    wanted = U / k * -np.expm1(-(k**2) / R / (0.02 + J) * result.t)
    np.testing.assert_allclose(result.columns["phid"], wanted, rtol=1e-9, atol=1e-9)


def test_a_motor_of_a_table_turns_by_its_rows(built):
    mechanism = built("m.motor('E', phi, file='E.csv')", E="speed [rpm], torque [N*m]\n0,12\n1500,9\n3000,0\n")
    for rpm, M in ((0, 12), (1500, 9), (3000, 0)):
        assert force(mechanism, phid=rpm * np.pi / 30)[1] == pytest.approx(M, abs=1e-12)
    assert force(mechanism, phid=3300 * np.pi / 30)[1] < 0
