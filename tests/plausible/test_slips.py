"""Slips of unit, sign, place and number, one by one: each is refused or doubted, by the case or by the command."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases.new_engine import write_engine
from mechsym.cases.outcomes import of_forces
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.forces.friction import ContactPressure
from mechsym.jobs.forces import forces
from mechsym.plausible import sifted


def run(*words):
    done = CliRunner().invoke(mechsym, list(words))
    return done.exit_code, done


IMPOSSIBLE = [
    ("nunes-slider-crank", "cycle.intake_temperature=15"),
    ("nunes-slider-crank", "cycle.intake_pressure=14.7"),
    ("nunes-slider-crank", "heating_value=43.5"),
    ("nunes-slider-crank", "chamber.bore=60"),
    ("nunes-slider-crank", "gas.gamma=1.0001"),
    ("nunes-slider-crank", "heat_transfer.wall_temperature=77"),
    ("moroianu", "mu_guide=2"),
    ("moroianu", "operation.speed=12700 rpm"),
    ("zotov-89", "rollers.E=206 MPa"),
    ("chmielewski", "simulation.output_step=200"),
    ("alpha-stirling", "T_e=900000"),
    ("nunes-slider-crank", "cycle.ignition=-170 deg"),
    ("zotov-89", "axis_tilt=90"),
    ("alpha-stirling", "operation.speed=600000 rpm"),
    ("generator-breathing", "breathing.inlet_temperature=20"),
    ("zotov-89", "cycle.evo=31 deg"),
    ("nunes-hypocycloid", "part_gears.teeth_ring=26"),
    ("nunes-hypocycloid", "part_crank.pin_bore=30 mm"),
    ("nunes-slider-crank", "speeds.step=80000 rpm"),
    ("chmielewski", "drive.time=-1 s"),
]


@pytest.mark.parametrize(("name", "setting"), IMPOSSIBLE)
def test_the_impossible_is_refused_with_what_is_possible(name, setting):
    key, _, value = setting.partition("=")
    with pytest.raises(BadInput) as told:
        cases.load(name, {key: value})
    words = str(told.value)
    assert "\n" not in words
    assert key.rpartition(".")[2] in words


def test_an_engine_that_was_built_and_printed_has_no_doubts():
    """The GPU-3 of General Motors, as Martini prints it."""
    assert cases.load(str(Path(__file__).parents[2] / "examples/gpu-3.toml")).doubts == ()


DOUBTED = [
    ("zotov-89", "rollers.plane_offset=15 mm", "track_planes"),
    ("zotov-89", "rollers.moving_mass=9 t", "roller_mass"),
    ("zotov-89", "codesign.moving_mass=9.9 t", "roller_mass"),
    ("zotov-89", "codesign.track_radius=1.5 mm", "guide_size"),
    ("zotov-89", "limits.profile_radius=5 m", "profile_limit"),
    ("zotov-89", "losses.tau=1 ms", "heat_time"),
    ("zotov-89", "spring.pa=1 MPa", "back_pressure"),
    ("moroianu", "part_crosshead.pin_arc=2 deg", "shell"),
    ("moroianu", "part_crosshead.rod_diameter=2.2 m", "rod_width"),
    ("moroianu", "part_crosshead.pin_diameter=1 m", "shaft_size"),
    ("nunes-hypocycloid", "part_piston.rod=26.5 cm", "rod_width"),
    ("nunes-hypocycloid", "part_cylinder.length=17 mm", "cylinder_length"),
    ("nunes-hypocycloid", "part_crank.pin=250 mm", "shaft_size"),
    ("nunes-hypocycloid", "sizing.speed_step=500 rad/s", "few_speeds"),
    ("nunes-hypocycloid", "sizing.head_dT=75 degC", "head_temperature"),
    ("nunes-slider-crank", "cycle.ignition=90 deg", "ignition"),
    ("zotov-89", "parameters.g=981", "gravity"),
    ("zotov-89", "rho0=80 m", "guide_size"),
    ("zotov-89", "cycle.a_p=34", "burnt_share"),
    ("zotov-89", "cycle.duration=2 deg", "burn_duration"),
    ("moroianu", "cycle.c_v=90000 J/kg/K", None),
    ("moroianu", "cycle.c_v=15000 J/kg/K", "heat_capacity"),
    ("moroianu", "oil=30", "viscosity"),
    ("moroianu", "part_crosshead.pin_length=400", "part_size"),
    ("moroianu", "radius_main=0.23 mm", "bearing_size"),
    ("moroianu", "I01=1e-9", "crank_inertia"),
    ("zotov-89", "spring.p0=5 bar", "spring_force"),
    ("zotov-89", "guide.rho0=70 mm", "guide_size"),
    ("moroianu", "IC2=1.4e5", "part_inertia"),
    ("moroianu", "flywheel.inertia=2e8", "inertia"),
    ("moroianu", "m1=2e6", "magnitude"),
    ("balandin", "u1=-10", "unbalance"),
    ("chmielewski", "I2=1e5", "inertia"),
    ("chmielewski", "m0=1100", "carried"),
    ("chmielewski", "k1=1e13", "shaft_frequency"),
    ("chmielewski", "c1=1e4", "shaft_damping"),
    ("zotov-89", "spring.H=70", "spring_height"),
    ("zotov-89", "rollers.width=3", "roller_size"),
    ("zotov-89", "spring.p0=5 kPa", "spring_pressure"),
    ("zotov-89", "simulation.difference_allowed=1", "convergence"),
    ("alpha-stirling", "wire=10 mm", "wire"),
    ("alpha-stirling", "dead_hot=0.1", "dead_volume"),
    ("alpha-stirling", "cycle.mean_pressure=5e9", None),
    ("alpha-stirling", "stirling.buffer_volume=1e-9", None),
    ("alpha-stirling", "stirling.buffer_volume=500 cm^3", "buffer_volume"),
    ("alpha-stirling", "stirling.conductance=1e9", None),
    ("alpha-stirling", "stirling.conductance=40", "conductance"),
    ("nunes-hypocycloid", "part_masses.piston=294.7", "mass_density"),
    ("generator-breathing", "inlet_lift=6", "valve_lift"),
    ("generator-breathing", "throttle_diameter=180 mm", "throat_size"),
    ("generator-breathing", "plenum_volume=100 L", "pipe_volume"),
    ("generator-breathing", "inlet_opens=200 deg", "valve_timing"),
    ("generator-breathing", "exhaust_closes=280 deg", "valve_timing"),
    ("generator-breathing", "air_fuel_ratio=1.05", "air_fuel_ratio"),
    ("generator-breathing", "heat_transfer.c1=228", "fitted_constant"),
    ("nunes-slider-crank", "heat_transfer.radiation=4.25e-6", "radiation"),
    ("nunes-slider-crank", "heat_transfer.exponent=0.07", "reynolds_exponent"),
    ("nunes-slider-crank", "chamber.back_pressure=100 bar", "back_pressure_share"),
    ("nunes-slider-crank", "sizing.life=200", "life"),
    ("nunes-hypocycloid", "sizing.head_dT=7500", "head_temperature"),
    ("nunes-hypocycloid", "sizing.ring_thickness=20 mm", "ring_size"),
    ("nunes-hypocycloid", "part_gears.module=2.54 mm", "gear_pitch"),
    ("nunes-hypocycloid", "part_gears.face=390 mm", "part_size"),
    ("nunes-hypocycloid", "part_cylinder.thread_mm=0.01", "thread"),
    ("nunes-hypocycloid", "friction.contact_ratio=16", "contact_ratio"),
    ("zotov-89", "cycle.p_back=101.325", "back_pressure"),
    ("zotov-89", "cycle.n_e=1.66", "exponent"),
    ("zotov-89", "cycle.n_c=1.01", "exponent"),
    ("zotov-89", "limits.hertz_stress=1500 GPa", "contact_limit"),
    ("zotov-89", "limits.spring_pressure=25 GPa", "pressure_limit"),
    ("zotov-89", "limits.pressure_angle=89 deg", "angle_limit"),
    ("zotov-89", "limits.roller_reaction=600 MN", "reaction_limit"),
    ("zotov-89", "losses.bearing_radius=150 mm", "bearing_share"),
    ("generator", "cycle.fit_to=-1 deg", "fit_window"),
    ("moroianu", "part_crosshead.shoe_pressure=60 MPa", "bearing_pressure"),
    ("moroianu", "part_crosshead.wanted=0.01", "safety"),
    ("moroianu", "part_crosshead.rod_length=0.22 m", "piston_rod"),
    ("moroianu", "part_crosshead.web_thickness=2.5 m", "part_size"),
    ("alpha-stirling", "regenerator_length=2 m", "exchanger_share"),
    ("alpha-stirling", "heater_diameter=30 mm", "tube_share"),
    ("alpha-stirling", "shuttle_length=0.1 mm", "seal_share"),
    ("alpha-stirling", "simulation.turns=0.001", "run_length"),
    ("alpha-stirling", "simulation.phi_start=90", "angle"),
    ("alpha-stirling", "load.torque=1e6", "load_pressure"),
    ("balandin", "closing.k_a=200", "joint_stiffness"),
    ("balandin", "closing.k_a=2e8 N/mm", "joint_stiffness"),
    ("generator-breathing", "cycle.duration=5.05 deg", "flame_speed"),
    ("moroianu", "flywheel.inertia=2", "flywheel_share"),
    ("opposed-pistons", "mean_indicated_pressure=7 MPa", "full_load"),
    ("chmielewski", "startup.claim_time=900 s", "window"),
    ("chmielewski", "startup.twist_limit=100", "twist_limit"),
    ("generator", "parameters.m3=50", "reciprocating_mass"),
    ("generator-breathing", "chamber.back_pressure=25 bar", "back_pressure_share"),
    ("generator-breathing", "exhaust_diameter=0.87 mm", "throat_size"),
    ("nunes-slider-crank", "speeds.highest=100000 rpm", None),
    ("nunes-slider-crank", "speeds.highest=20000 rpm", "piston_speed"),
    ("generator-breathing", "discharge=0.006", "discharge"),
    ("nunes-slider-crank", "combustion_efficiency_max=0.09", "combustion_efficiency"),
    ("nunes-slider-crank", "rings.intake_ratio=101", "intake_ratio"),
    ("nunes-hypocycloid", "part_gears.ring_outside=62", None),
    ("nunes-hypocycloid", "part_gears.shift=50", "addendum"),
    ("nunes-hypocycloid", "part_gears.pressure_angle=1 deg", "gear_pressure_angle"),
    ("nunes-hypocycloid", "part_piston.land=40 mm", "thin_size"),
    ("nunes-hypocycloid", "friction.module=25.4 mm", "tooth_size"),
    ("nunes-hypocycloid", "sizing.head=1500", "safety"),
    ("zotov-89", "codesign.full_load=20", "full_load"),
    ("zotov-89", "cycle.soc=50 deg", "ignition"),
    ("zotov-89", "friction.radius_crank_pin=0.55 m", "bearing_size"),
    ("generator-breathing", "inlet_lift=20 mm", "lift_share"),
    ("generator-breathing", "breathing.valves=4", "valve_area"),
    ("nunes-hypocycloid", "chamber.bore=10.2 mm", "stroke_ratio"),
    ("zotov-89", "codesign.full_speed=1420 rpm", "piston_speed"),
]
# lists, which only a file can give
LISTED = [
    ("alpha-stirling", "phase", "[90, 0]", "angle"),
    ("balandin", "areas", '["25 cm^2", "25 cm^2", "25 cm^2", "25 cm^2"]', "face_area"),
    ("zotov-89", "heights", '["50 mm", "7 mm", "7 mm", "7 mm"]', "ring_size"),
    ("opposed-pistons", "axis_x", '["0 m", "0.3 m"]', "opposed_span"),
    ("opposed-pistons", "phase", '["0 deg", "0 deg"]', "firing_off"),
    ("opposed-pistons", "r", '["40 mm", "4 mm"]', "unequal"),
    ("opposed-pistons", "I0", "[0.01, 1.0]", "unequal"),
    ("opposed-pistons", "axis_x", '["0 m", "4.6 m"]', "opposed_span"),
]


@pytest.mark.parametrize(("name", "key", "written", "code"), LISTED)
def test_values_of_lists_are_judged(tmp_path, name, key, written, code):
    file = tmp_path / "mine.toml"
    file.write_text(re.sub(rf"^{key} = .*$", f"{key} = {written}", cases.text(name), flags=re.MULTILINE))
    case = cases.load(str(file))
    assert code in {d.code for d in sifted(case.doubts, case.acceptances)[0]}


@pytest.mark.parametrize(
    ("written", "doubted"),
    [
        ('["0 mm", "98 mm", "196 mm", "294 mm"]', False),
        ('["294 mm", "196 mm", "98 mm", "0 mm"]', False),
        ('["0 mm", "80 mm", "160 mm", "240 mm"]', True),
        ('["0 mm", "98 mm", "98 mm", "294 mm"]', True),
        ("0", False),  # a plane model: nothing is said of where the throws stand
    ],
)
def test_cylinders_that_cut_each_other_are_doubted(tmp_path, written, doubted):
    file = write_engine("inline", 0.082, 0.09, 4, tmp_path)[0]
    file.write_text(re.sub(r"^z = .*$", f"z = {written}", file.read_text(), flags=re.MULTILINE))
    assert ("cylinder_pitch" in {d.code for d in cases.load(str(file)).doubts}) == doubted


@pytest.mark.parametrize("bank", [5, 30])
def test_the_banks_of_a_v_stand_apart(tmp_path, bank):
    file = write_engine("v", 0.095, 0.084, 6, tmp_path)[0]
    banks = ", ".join(f'"{sign}{bank} deg"' for sign in "---+++".replace("+", " ")).replace('" ', '"')
    file.write_text(re.sub(r"^bank = .*$", f"bank = [{banks}]", file.read_text(), flags=re.MULTILINE))
    assert ("cylinder_pitch" in {d.code for d in cases.load(str(file)).doubts}) == (bank == 5)


def test_a_stirling_engine_whose_cold_piston_leads_is_doubted_by_its_forces(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(cases.text("alpha-stirling").replace('phase = ["90 deg"', 'phase = ["-90 deg"'))
    case = cases.load(str(file))
    assert [d.code for d in of_forces(case, forces(case))] == ["driven"]


def test_rings_need_a_share_each():
    with pytest.raises(BadInput, match=r"2 heights and 1 gas_shares: rings need one of each"):
        ContactPressure(mu=0.05, heights=(1e-3, 1e-3), gas_shares=(1.0,), elastic=1e5)
    with pytest.raises(BadInput, match="at least one"):
        ContactPressure(mu=0.05, heights=(), gas_shares=(), elastic=1e5)


@pytest.mark.parametrize(("name", "setting", "code"), DOUBTED)
def test_what_no_engine_has_is_doubted(name, setting, code):
    key, _, value = setting.partition("=")
    if code is None:
        with pytest.raises(BadInput, match="possible is at"):
            cases.load(name, {key: value})
        return
    case = cases.load(name, {key: value})
    assert code in {d.code for d in sifted(case.doubts, case.acceptances)[0]}


MEAN = {"full_load", "peak_pressure", "mean_pressure"}
SCALED = [  # what is possible in one engine and not in another
    ("forces", "nunes-slider-crank", "m5=250", {"reciprocating_mass", "efficiency", "force_ratio"}),
    ("forces", "nunes-slider-crank", "m5=0.0025", {"reciprocating_mass"}),
    ("forces", "moroianu", "m5=45000", {"reciprocating_mass"}),
    ("forces", "moroianu", "mean_indicated_pressure=100 bar", MEAN | {"gas_temperature"}),
    ("forces", "balandin", "m_b=240", {"reciprocating_mass", "efficiency", "force_ratio"}),
    ("cycle", "moroianu", "mean_indicated_pressure=60 bar", MEAN | {"gas_temperature"}),
    ("forces", "alpha-stirling", "m_piston=0.1", {"reciprocating_mass"}),
    ("hinge", "zotov-89", "spring.A=0.0001", {"spring_area"}),
    ("cycle", "nunes-hypocycloid", "alpha_n=1 deg", {"gear_pressure_angle"}),
    ("cycle", "nunes-slider-crank", "heat_transfer.a=49", {"nusselt_factor"}),
    ("simulate", "chmielewski", "drive.time=100 s", {"drive_start"}),
]


@pytest.mark.parametrize(("command", "name", "setting", "codes"), SCALED)
def test_what_is_out_of_proportion_is_doubted(command, name, setting, codes):
    _, done = run(command, name, "--set", setting, "--json", *(["--no-check"] if command == "simulate" else []))
    assert {d["code"] for d in json.loads(done.stdout)["doubts"]} == codes


@pytest.mark.parametrize(
    ("name", "setting"), [("zotov-89", "spring.A=31"), ("zotov-89", "m5=1e6"), ("nunes-hypocycloid", "m3=2500000")]
)
def test_what_no_engine_has_is_refused(name, setting):
    key, _, value = setting.partition("=")
    with pytest.raises(BadInput, match=r"piston area.* = .*possible is at least"):
        cases.load(name, {key: value})


def test_letters_of_an_own_mechanism_are_not_guessed_at():
    from mechsym.cases.doubts import judged

    sections = cases.load("moroianu", {"m5": 45000}).sections
    assert [d.code for d in judged(sections, "crosshead")] == ["reciprocating_mass"]
    assert judged(sections, "./mine.py") == ()


def test_letters_beyond_the_largest_machines_are_doubted_whatever_they_mean():
    from mechsym.cases.doubts import judged

    case = cases.load("chmielewski", {"I2": 1e9})
    assert [d.code for d in judged(case.sections, "./mine.py")] == ["magnitude"]
    status, done = run("eval", "crosshead", "--case", "zotov-89", "--set", "phid=1e12", "--json")
    assert [(d["code"], d["quantity"]) for d in json.loads(done.stdout)["doubts"]] == [("magnitude", "phid")]
    assert run("eval", "crosshead", "--case", "zotov-89", "--set", "phid=1e3", "--strict")[0] == 0


@pytest.mark.parametrize(("apart", "codes"), [("2 m", set()), ("0 m", set()), ("150 m", {"shaft_distance"})])
def test_balancer_shafts_stand_a_stroke_or_two_apart(apart, codes):
    _, done = run("balance", "moroianu", "--shafts", "1", "--apart", apart, "--json")
    assert {d["code"] for d in json.loads(done.stdout)["doubts"]} == codes
