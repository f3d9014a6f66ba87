"""The cycles of the built-in marine cases on the derived mechanism: the size of the hinge's job (formulas.md F)."""

import dataclasses
import math

import numpy as np
import pytest

from mechsym import cases
from mechsym.cycle.gas import Gas
from mechsym.cycle.kinds import gas_in_cylinder, with_diagram
from mechsym.cycle.kinds.two_stroke import TwoStrokeMarine
from mechsym.cycle.measured.diagram import Diagram
from mechsym.cycle.measured.measure import measured_cycles
from mechsym.mechanisms import crosshead

PHI = np.linspace(0, 2 * math.pi, 7200, endpoint=False)


def hinge_torque(name, **overrides):
    """M_h at constant speed, eq. (8) of Zotov et al., with the exact inertia of the derivation."""
    case = cases.load(name, overrides)
    parameters, cycle, omega = case.need("parameters"), case.need("cycle"), case.need("operation").speed
    kinematics = crosshead.build(parameters).functions["kinematics"]
    at = {key: np.asarray(value).ravel() for key, value in kinematics(phi=PHI.reshape(1, -1)).items()}
    gas = gas_in_cylinder(cycle, kinematics)
    pressure, cylinder = gas.pressure, gas.chamber
    gas = Gas(pressure=pressure, chamber=cylinder).force(PHI) * at["dx_dphi"]
    # gravity across the cylinder axis: m1 r1 cos phi + m2 l2 cos psi psi'
    lam = (parameters.r1 + parameters.r2) / (parameters.l1 + parameters.l2)
    gravity = parameters.g * (parameters.m1 * parameters.r1 + parameters.m2 * parameters.l2 * lam) * np.cos(PHI)
    inertia = omega**2 * at["dinertia_dphi"] / 2
    return inertia - gas + gas.mean() + gravity, inertia, gas.mean(), pressure


def work_swing(torque):
    return float(np.ptp(np.cumsum(torque) * (PHI[1] - PHI[0])))


@pytest.fixture(scope="module")
def torques():
    return {name: hinge_torque(name) for name in ("zotov-89", "zotov-142")}


def test_stroke_and_load_torque(torques):
    # M_r = p_mi V_d / 2 pi: 9000 N m at 89 rpm, the paper's load by eq. (5)
    swept = math.pi / 4 * 0.3**2 * 1.0
    assert torques["zotov-89"][2] == pytest.approx(8e5 * swept / (2 * math.pi), rel=1e-6)
    assert torques["zotov-142"][2] == pytest.approx(20e5 * swept / (2 * math.pi), rel=1e-6)


def test_mean_hinge_torque_vanishes(torques):
    for torque, *_ in torques.values():
        assert abs(torque.mean()) < 1e-9 * np.abs(torque).max()


def test_peak_grows_about_2_4_times(torques):
    low, high = (np.abs(torques[name][0]).max() for name in ("zotov-89", "zotov-142"))
    assert high / low == pytest.approx(2.4, abs=0.1)


def test_work_swing_at_89_rpm(torques):
    assert 60e3 < work_swing(torques["zotov-89"][0]) < 70e3


def test_inertia_is_about_a_tenth_of_the_peak(torques):
    for torque, inertia, *_ in torques.values():
        assert np.abs(inertia).max() / np.abs(torque).max() == pytest.approx(0.11, abs=0.01)


def test_scavenge_pressure_under_the_piston_takes_5_to_10_per_cent_off_the_swing(torques):
    for name in ("zotov-89", "zotov-142"):
        under = hinge_torque(name, **{"cycle.crank_side": "scavenge"})[0]
        assert 0.05 <= 1 - work_swing(under) / work_swing(torques[name][0]) <= 0.10


def test_cases_have_no_doubts(torques):
    assert all(pressure.doubts == () for *_, pressure in torques.values())


def test_a_diagram_takes_the_place_of_any_cycle():
    cycle = cases.load("zotov-89").need("cycle")
    assert isinstance(cycle, TwoStrokeMarine)
    diagram = with_diagram(cycle, "some.csv")
    assert isinstance(diagram, Diagram) and diagram.working_cycle == "two-stroke"
    assert (diagram.bore, diagram.compression_ratio, diagram.n_c, diagram.file) == (0.3, 17.0, 1.40, "some.csv")
    skeleton = cases.load("generator").need("cycle")
    assert with_diagram(skeleton, "other.csv").n_c == skeleton.n_c == 1.30


def test_model_cycle_written_as_a_diagram_is_read_back(tmp_path):
    from mechsym.files import write_csv

    case = cases.load("zotov-142")
    kinematics = crosshead.build(case.need("parameters")).functions["kinematics"]
    model = gas_in_cylinder(case.need("cycle"), kinematics).pressure
    angle = np.arange(-180, 180, 0.5)
    columns = {"crank_angle_deg": angle + 30, "pressure_bar": model.absolute(np.radians(angle)) / 1e5 + 7.0}
    file = str(write_csv(tmp_path / "model.csv", columns))
    diagram = with_diagram(case.need("cycle"), file)
    known = dataclasses.replace(diagram, alignment="given", tdc_offset=np.radians(30), pegging="polytropic")
    gas = gas_in_cylinder(known, kinematics)
    read, cylinder = gas.pressure, gas.chamber
    phi = np.linspace(0, 7, 400)
    assert np.allclose(read.absolute(phi), model.absolute(phi), atol=0.4e5)
    assert read.mean_indicated == pytest.approx(20e5, rel=0.005)
    found = measured_cycles(diagram, cylinder).alignment.dead_centre
    assert found.low < np.radians(30) < found.high < found.low + np.radians(4)
