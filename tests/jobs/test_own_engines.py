"""Engines on mechanisms from files: the numbers of the built-in mechanism of the same data, and closed forms."""

from dataclasses import replace
from importlib import resources

import numpy as np
import pytest
from one_turn import turned
from own_engines import COMPRESSOR, OPPOSED, RADIAL, RHOMBIC, SLIDER, STIRLING

from mechsym import cases, mechanisms
from mechsym.codesign.machines import point
from mechsym.errors import BadInput
from mechsym.hinge.price import misfire_share
from mechsym.hinge.torque import torque
from mechsym.jobs.cycle import _together, cycle, cylinders
from mechsym.jobs.export import ready
from mechsym.jobs.flywheel import flywheel
from mechsym.jobs.gas import pistons as acting
from mechsym.jobs.indicated import common_gas, indicated
from mechsym.jobs.machine import machine, one_coordinate
from mechsym.jobs.run import loop
from mechsym.jobs.size import size
from mechsym.machine.record import shaft_torque
from mechsym.quantities.results import tell
from mechsym.report.parts import part
from mechsym.simulate.loop.run import run_loop


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("own")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(path / "cache"))
        yield path


def written(folder, name, declaration, text):
    (folder / f"{name}.py").write_text(declaration)
    (folder / f"{name}.toml").write_text(text)
    return cases.load(str(folder / f"{name}.toml"))


def shipped(name):
    """Sections of a built-in case behind its parameters, as text."""
    text = (resources.files("mechsym.cases") / f"{name}.toml").read_text()
    return text[text.index("[operation]") :]


def slider_crank(folder, name, tilt):
    """The slider crank of a built-in case, its cylinder turned by an angle."""
    parameters = '[parameters]\nr = "26 mm"\nl = "90 mm"\nm_p = 0.25\nI = 0.002\n'
    text = f'mechanism = "./{name}.py"\n{parameters}{shipped("nunes-slider-crank")}'
    return written(folder, name, SLIDER.replace("TILT", tilt).replace("cos, sin", "cos, pi, sin"), text)


@pytest.fixture(scope="module")
def slider(folder):
    return slider_crank(folder, "slider", "0")


@pytest.mark.parametrize("tilt", ["0", "pi / 3"])
def test_the_cycle_is_that_of_the_built_in_slider_crank(folder, tilt):
    own, built_in = cycle(slider_crank(folder, f"tilted_{len(tilt)}", tilt)), cycle(cases.load("nunes-slider-crank"))
    for key in ("torque_avg", "torque_max", "p_max_mpa", "p_max_angle_deg", "efficiency", "force_max"):
        np.testing.assert_allclose(own[key], built_in[key], rtol=1e-9, err_msg=key)
    assert own["loads"].keys() == {"R_n_G"}


def test_the_cycle_in_motion_is_that_of_the_built_in_slider_crank(slider):
    own, built_in = (
        run_loop(loop(case), case.need("operation").speed, 2) for case in (slider, cases.load("nunes-slider-crank"))
    )
    assert own.status == built_in.status == "done" and len(own.cycles) == len(built_in.cycles) > 0
    assert own.t[-1] == pytest.approx(built_in.t[-1], rel=1e-7)
    for one, other in zip(own.cycles, built_in.cycles, strict=True):
        assert one.work == pytest.approx(other.work, rel=1e-7)


@pytest.mark.slow
def test_each_piston_has_a_cylinder_with_its_own_motion(folder, slider):
    declaration = SLIDER.replace("TILT", "0").replace("def slider", "def two").replace('"slider"', '"two"', 1)
    declaration = declaration.replace(
        "    m.rotor(",
        """    F2 = m.inputs("F2", "N")
    x2 = m.let("x2", x / 2, "m")
    m.force(F2, along=x2)
    m.piston("half", travel=x2, force=F2)
    m.rotor(""",
    )
    text = (folder / "slider.toml").read_text().replace("./slider.py", "./two.py")
    made = loop(written(folder, "two", declaration, text))
    found = run_loop(made, made.load.speed, 3)
    assert found.status == "done" and abs(found.energy_residual) < 1e-7
    works = {k: [c.work for c in found.cycles if c.cylinder == k] for k in (0, 1)}
    assert works[1][-1] == pytest.approx(works[0][-1] / 2, rel=0.05)  # half the stroke at the same bore
    assert max(abs(c.residual) for c in found.cycles) < 1e-8


@pytest.mark.slow
def test_pistons_that_move_differently_have_each_their_figures(folder):
    declaration = SLIDER.replace("TILT", "0").replace("def slider", "def unlike").replace('"slider"', '"unlike"', 1)
    declaration = declaration.replace(
        "    m.rotor(",
        """    F2 = m.inputs("F2", "N")
    x2 = m.let("x2", x / 2, "m")
    m.force(F2, along=x2)
    m.piston("half", travel=x2, force=F2)
    m.rotor(""",
    )
    data = '[parameters]\nr = "40 mm"\nl = "150 mm"\nm_p = 0.9\nI = 0.2\n'
    text = f'mechanism = "./unlike.py"\n{data}{shipped("opposed-pistons")}'
    case = written(folder, "unlike", declaration, text)
    found = cycle(case)
    (first, half), one = found["pistons"].values(), found["torque_avg"][0]
    assert list(found["pistons"]) == ["p", "half"] and found["cylinders"] == 2
    assert half["torque_avg"][0] == pytest.approx(first["torque_avg"][0] / 2, rel=1e-9)  # half the stroke, one mep
    assert one == pytest.approx(1.5 * first["torque_avg"][0], rel=1e-9)
    assert found["mep_kpa"][0] == pytest.approx(first["mep_kpa"][0], rel=1e-12)
    # the same by another way: gas on the whole mechanism
    torque = -turned(case).columns["driving_torque"]
    assert one == pytest.approx(torque.mean(), rel=1e-6)
    assert found["torque_max"][0] == pytest.approx(torque.max(), rel=1e-12)
    with pytest.raises(BadInput, match="piston half moves otherwise than p:"):
        cylinders(case)


def test_figures_of_unlike_pistons_keep_work_heat_and_fuel():
    shares = {"work": np.array([0.4]), "heat": np.array([0.6])}, {"work": np.array([0.25]), "heat": np.array([0.75])}
    rows = [
        {"power_kw": np.array([p]), "efficiency": share["work"], "sfc_g_kwh": 84 / share["work"], "p_max_mpa": peak,
         "p_max_angle_deg": 3 * peak, "energy_residual": res, "mep_kpa": np.array([mep]), "fractions": share}
        for p, share, peak, res, mep in zip((30.0, 10.0), shares, np.array([[5.0], [7.0]]),
                                            np.array([[1e-12], [-3e-12]]), (900.0, 600.0), strict=True)
    ]  # fmt: skip
    whole = _together(rows, np.array([0.1, 0.05]))
    heat, fuel = 30 / 0.4 + 10 / 0.25, 30 * 84 / 0.4 + 10 * 84 / 0.25
    assert whole["power_kw"][0] == 40
    assert whole["efficiency"][0] == pytest.approx(40 / heat) == pytest.approx(whole["fractions"]["work"][0])
    assert sum(v[0] for v in whole["fractions"].values()) == pytest.approx(1)
    assert whole["sfc_g_kwh"][0] == pytest.approx(fuel / 40)
    assert whole["mep_kpa"][0] == pytest.approx((900 * 0.1 + 600 * 0.05) / 0.15)
    assert (whole["p_max_mpa"][0], whole["p_max_angle_deg"][0], whole["energy_residual"][0]) == (7, 21, -3e-12)


@pytest.mark.slow
def test_the_flywheel_is_that_of_the_built_in_slider_crank(slider):
    own, built_in = (flywheel(case, 0.02, turns=2) for case in (slider, cases.load("nunes-slider-crank")))
    assert own.inertia == pytest.approx(built_in.inertia, rel=1e-6)


def test_a_rhombic_drive_does_the_work_of_the_isothermal_cycle(folder):
    case = written(folder, "rhombic", RHOMBIC, STIRLING)
    phi = np.arange(2048) * 2 * np.pi / 2048
    rise = 0.02 * np.sin(phi)
    reach = np.sqrt(0.07**2 - (0.04 + 0.02 * np.cos(phi)) ** 2)
    x_d, x_p = -(rise - reach), -(rise + reach)
    A, ring = np.pi * 0.03**2, np.pi * (0.03**2 - 0.005**2)
    V_e, V_c = A * x_d, ring * (x_p - x_d)
    V_e, V_c = V_e - V_e.min() + 2e-5, V_c - V_c.min() + 2e-5  # with heater and cooler
    p = 1 / (V_e / 900 + V_c / 330 + 2e-5 * np.log(900 / 330) / (900 - 330))
    p *= 5e5 / p.mean()
    k = np.arange(1025) * 1j
    work = np.sum(p * np.fft.irfft(np.fft.rfft(V_e + V_c) * k)) * 2 * np.pi / 2048
    assert cycle(case)["work_j"][0] == pytest.approx(work, rel=1e-6)
    assert shaft_torque(machine(case), "drive", phi).mean() * 2 * np.pi == pytest.approx(work, rel=1e-6)


@pytest.mark.slow
def test_three_pistons_on_one_shaft_give_the_sum_of_their_torques(folder, slider):
    marine = shipped("opposed-pistons")
    data = '[parameters]\nr = "40 mm"\nl = "150 mm"\nm_p = 0.9\nI = 0.2\n'
    three = written(folder, "radial", RADIAL, f'mechanism = "./radial.py"\n{data}{marine}')
    one = written(folder, "single", SLIDER.replace("TILT", "0"), f'mechanism = "./single.py"\n{data}{marine}')
    hinges = torque(machine(three)), torque(machine(one))
    phi = np.linspace(0, 2 * np.pi, 145)
    summed = sum(hinges[1].gas_part(phi - turned) for turned in (0, 2 * np.pi / 3, 4 * np.pi / 3))
    np.testing.assert_allclose(hinges[0].gas_part(phi), summed, atol=1e-8 * np.abs(summed).max())
    assert hinges[0].load_torque == pytest.approx(3 * hinges[1].load_torque, rel=1e-9)
    inertia = sum(hinges[1].inertia(phi - turned) for turned in (0, 2 * np.pi / 3, 4 * np.pi / 3)) - 2 * 0.2
    np.testing.assert_allclose(hinges[0].inertia(phi), inertia, rtol=1e-9)
    turned = written(folder, "turned", SLIDER.replace("TILT", "pi / 3").replace("cos, sin", "cos, pi, sin"),
                     f'mechanism = "./turned.py"\n{data}{marine}')  # fmt: skip
    found = torque(machine(turned)).gas_part(phi + np.pi / 3)
    np.testing.assert_allclose(found, hinges[1].gas_part(phi), atol=1e-8 * np.abs(found).max())
    for case in (three, turned):  # the crank loses a part of its energy, and turns on
        assert 0 < misfire_share(machine(case), hinges[0], None, None) < 1
        designed = point(machine(case), 7e5)
        assert designed.misfire is None
        assert designed.load_torque == pytest.approx(torque(machine(case)).load_torque, rel=1e-9)
    whole, single = cycle(three), cycle(one)
    assert (whole["cylinders"], single["cylinders"]) == (3, 1)
    assert whole["torque_avg"][0] == pytest.approx(hinges[0].load_torque, rel=1e-6)
    assert single["torque_avg"][0] < whole["torque_max"][0] < 3 * single["torque_max"][0]


def test_sizing_gives_the_loads_of_every_joint(slider):
    rows = {(row["component"], row["quantity"]): row for row in size(slider).rows}
    assert {"R_x_O", "R_x_A", "R_x_B", "R_n_G", "driving_torque"} <= {name for name, _ in rows}
    pin = rows["R_x_A", "load, largest"]
    assert pin["unit"] == "N" and pin["value"] >= rows["R_x_A", "load, root mean square"]["value"] > 0


def test_a_mechanism_without_a_piston_says_how_to_declare_one(slider):
    with pytest.raises(BadInput, match="has no piston for an engine cycle; declare one with m.piston"):
        cycle(replace(slider, mechanism="rodless_constraints"))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["tilted", "stirling"])
def test_the_torque_on_the_crank_tells_the_pressure(folder, kind):
    """What drives the shaft against the gas, over one cycle, gives back the gas: of one piston and of two."""
    if kind == "tilted":
        case = slider_crank(folder, "told_by_torque", "pi / 3")
    else:
        case = written(folder, "rhombic", RHOMBIC, STIRLING)
    one, (first, *_) = turned(case), acting(case, one_coordinate(case))
    rows = "\n".join(f"{a:.17g},{-m:.17g},{one.omega:.17g}"
                     for a, m in zip(np.degrees(one.phi), one.columns["driving_torque"], strict=True))  # fmt: skip
    (folder / "torque.csv").write_text(f"phi [deg],torque_with_inertia [N*m],speed [rad/s]\n{rows}\n")
    found = indicated(case, str(folder / "torque.csv"), 0.0).indicated
    truth = first.gas.pressure.absolute(one.phi - first.start)
    assert found.clear.mean() > 0.9
    assert np.abs(found.p - truth)[found.clear].max() < 1e-9 * truth.max()


@pytest.mark.slow
def test_the_torque_of_a_star_tells_no_pressure(folder):
    text = '[parameters]\nr = "26 mm"\nl = "90 mm"\nm_p = 0.25\nI = 0.002\n' + shipped("nunes-slider-crank")
    with pytest.raises(BadInput, match="3 cylinders fire one after the other"):
        common_gas(written(folder, "star", RADIAL, f'mechanism = "./star.py"\n{text}'))


@pytest.mark.slow
def test_opposed_pistons_share_a_chamber_as_one_travel(folder):
    both, one = (
        written(folder, name, text, f'mechanism = "./{name}.py"\n{COMPRESSOR}')
        for name, text in (("opposed", OPPOSED), ("single", SLIDER.replace("TILT", "0").replace("slider", "single", 1)))
    )
    pair, alone = turned(both), turned(one)
    np.testing.assert_allclose(pair.columns["x"], 2 * alone.columns["x"], atol=1e-15)
    # the same pressure at the same angle, on two pistons of the same motion
    np.testing.assert_allclose(pair.columns["F"], alone.columns["F"], rtol=1e-9, atol=1e-6)
    torque, half = pair.columns["driving_torque"], alone.columns["driving_torque"]
    np.testing.assert_allclose(torque, 2 * half, atol=1e-9 * np.abs(half).max())
    # each guide bears what the guide of one piston bears
    force = np.abs(alone.columns["R_n_G"])
    for name in ("left", "right"):
        np.testing.assert_allclose(np.abs(pair.columns[f"R_n_G_{name}"]), force, atol=1e-9 * force.max())
    assert cycle(both)["torque_avg"][0] == pytest.approx(2 * cycle(one)["torque_avg"][0], rel=1e-9)


@pytest.mark.parametrize("change", [("    m.force(F, along=x)\n", ""), ("m.force(F, ", "m.force(-F, ")])
def test_a_piston_that_its_force_does_not_push_is_refused(folder, change):
    name = f"slack{len(change[1])}"
    declaration = SLIDER.replace("TILT", "0").replace(*change)
    case = written(folder, name, declaration, f'mechanism = "./{name}.py"\n{COMPRESSOR}')
    with pytest.raises(BadInput, match="the force F of the piston p does not act along its travel x; write m.force"):
        turned(case)


@pytest.mark.parametrize("in_loop", [True, False])
def test_a_piston_fires_at_its_own_dead_centres_only(monkeypatch, slider, in_loop):
    """A turn later is one; anywhere else energy in and out would differ by a third."""
    roles = mechanisms.roles_of(slider.mechanism)

    def starts(fires):
        pistons = tuple(replace(role, fires=fires) for role in roles.pistons)
        monkeypatch.setattr(mechanisms, "roles_of", lambda name: replace(roles, pistons=pistons))
        if in_loop:
            return [c.firing for c in loop(slider).cylinders]
        return [p.start for p in acting(slider, one_coordinate(slider))]

    assert starts(2 * np.pi) == pytest.approx([2 * np.pi])
    with pytest.raises(BadInput, match="p fires 114.6 deg after its own top dead centre at 0 deg, .* mm below it"):
        starts(2.0)


def test_gas_by_spark_leaves_as_few_splines(slider):
    """The table behind the cycle is no polynomial: fitted to round-off it had 17000 pieces and an FMU of 6 MB."""
    run = ready(slider).problem
    (piston,) = acting(slider, one_coordinate(slider))
    value = next(p for p in run.parts if p.input == piston.input).value.value
    phi = np.linspace(0, 4 * np.pi, 20001)
    near = np.min(np.abs(phi[:, None] - np.array(run.kinks[0].angles)), axis=1) < 1e-3
    off = np.abs(value(phi) - piston.force(phi))[~near]
    assert value.c.shape[1] < 300 and len(run.kinks[0].angles) == 4
    assert off.max() < 1e-4 * np.abs(piston.force(phi)).max()  # the table is straight between its angles, by so much


def test_the_report_has_the_forces_of_a_mechanism_from_a_file(folder):
    case = written(folder, "told", SLIDER.replace("TILT", "0"), f'mechanism = "./told.py"\n{COMPRESSOR}')
    found = part("forces", case)
    assert found.state == "done"
    rows = {row[0]: row for row in found.grids[0].rows}
    assert rows["R n G"][3] == "frame on piston, slider G" and rows["R n G"][1].endswith(" N")
    assert rows["M G"][1].endswith("N*m") and rows["torque"][1].endswith("N*m")
    assert tell(found.numbers)["max"]["R_n_G"] == turned(case).columns["R_n_G"].max()
    assert all(picture.draw().axes for picture in found.view.pictures)
