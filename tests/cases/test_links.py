"""Links of own mechanisms by the law of their bodies: slips are told, the shipped mechanisms are left in peace."""

import math
from pathlib import Path

import pytest

from mechsym import cases
from mechsym.cases.links import by_force, by_links, by_sign
from mechsym.cases.new_engine import write_engine
from mechsym.cases.outcomes import of_own
from mechsym.jobs.machine import one_coordinate

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
#: case, letter, value: code of the doubt
SLIPS = {
    ("watt-six-bar", "m2", "1 t"): "link_density",
    ("watt-six-bar", "I3", 4.0): "link_inertia",
    ("watt-six-bar", "I5", 5e-8): "link_inertia",
    ("watt-six-bar", "g", 9810.0): "gravity",
    ("whitworth", "I_rocker", "40 kg*m^2"): "link_inertia",
    ("whitworth", "r", "60 m"): "point_speed",
    ("radial-engine", "mr", "1 t"): "link_density",
    ("walking-leg", "J", 0.1): "link_inertia",
    ("radial-engine", "mp", 800.0): "link_density",
    ("atkinson", "I_rocker", 5.0): "link_density",
    ("atkinson", "m_link", 0.0): "massless",
}


def doubts(name, values):
    return {d.code for d in cases.load(str(EXAMPLES / f"{name}.toml"), values).doubts}


@pytest.mark.parametrize("slip", SLIPS, ids=str)
def test_a_slip_is_doubted_by_the_law_of_a_link(slip):
    name, letter, value = slip
    assert SLIPS[slip] in doubts(name, {f"parameters.{letter}": value}) - doubts(name, {})


@pytest.mark.parametrize("case", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_shipped_mechanisms_are_left_in_peace(case):
    told = {d.code for d in cases.load(str(case)).doubts}
    assert not told & {"link_density", "link_inertia", "link_centre", "point_speed", "gravity", "massless"}


DECLARED = """from mechsym.derive import Mechanism, output


def bar():
    m = Mechanism("bar")
    phi = m.coordinates("phi")
    r, l, u = m.parameters("r l u", "m")
    mass, I, J = m.parameters("mass", "kg"), m.parameters("I", "kg*m^2"), m.parameters("J", "kg*m^2")
    crank = m.link("crank", turns=phi, inertia=J)
    rod = m.link("rod", mass=mass, centre=(u, 0), inertia=I)
    slide = m.link("slide", mass=mass / 2)
    m.pin("A", m.frame, crank)
    m.pin("B", crank.at(r), rod)
    m.pin("C", rod.at(l), slide)
    m.slider("G", m.frame.line(), slide)
    output(m, rod.angle)
    return m
"""
BAR = {"r": 0.1, "l": 0.35, "u": 0.15, "mass": 1.0, "I": 0.012, "J": 0.5}


@pytest.mark.parametrize(
    ("values", "speed", "codes"),
    [
        ({}, 300.0, set()),
        ({"I": 0.0, "J": 0.0}, 300.0, set()),  # a model without inertia
        ({"u": -0.1}, 300.0, set()),  # with a counterweight
        ({"u": 10.5}, 300.0, {"link_centre"}),
        ({"mass": 1000.0}, 300.0, {"link_density", "link_inertia"}),
        ({"I": 12.0}, 300.0, {"link_inertia"}),
        ({"u": 0.175, "I": 0.35**2 / 4}, 300.0, set()),  # all its mass at both ends
        ({"u": 0.175, "I": 0.35**2 / 3}, 300.0, {"link_inertia"}),  # that of a bar about its end
        ({}, 300_000 * 3.14159 / 30, {"point_speed"}),
    ],
)
def test_a_rod_of_a_ton_a_centre_far_off_and_a_crank_that_bursts_are_told(tmp_path, values, speed, codes):
    (tmp_path / "bar.py").write_text(DECLARED)
    numbers = "".join(f"{letter} = {value!r}\n" for letter, value in (BAR | values).items())
    case = tmp_path / "bar.toml"
    case.write_text(f'mechanism = "./bar.py"\nabout = "bar"\n[parameters]\n{numbers}[operation]\nspeed = {speed!r}\n')
    told = {d.code for d in cases.load(str(case)).doubts}
    assert {c for c in told if c.startswith(("link", "point"))} == codes


OWN = Path(__file__).parents[1] / "plausible" / "own"


@pytest.mark.parametrize(
    ("machine", "values", "code", "value"),
    [
        # 32 kg as a shaft of steel, m = rho pi r^2 L and I = m r^2 / 2
        ("conveyor", {"I_u": "2e-3 kg*m^2"}, "shaft_length", None),
        ("conveyor", {"I_u": "2e-6 kg*m^2"}, "shaft_length", 32**2 / (2 * math.pi * 7850 * 2e-6)),
        ("conveyor", {"e": 80.0}, "point_speed", 80 * 960 * math.pi / 30),
        # 35 kg that swing, not more than three times as deep as the clapper is long, 2 * 0.7 m
        ("bell", {"I_k": "6e-3 kg*m^2"}, "shaft_length", None),
        ("bell", {"I_k": "5e-3 kg*m^2"}, "shaft_length", 35**2 / (2 * math.pi * 7850 * 5e-3)),
        ("bell", {}, "link_centre", None),  # the yoke's joints stand closer than the bell is wide
        ("bell", {}, "link_density", None),
        # 85 kg, a cube of steel 0.22 m wide, beside 0.5 mm of unbalance
        ("absorber", {"J": 199 * 85 * (85 / 7850) ** (2 / 3)}, "link_inertia", None),
        ("absorber", {"J": 201 * 85 * (85 / 7850) ** (2 / 3)}, "link_inertia", 201.0),
        ("absorber", {"J": 85 * (299 / (1480 * math.pi / 30)) ** 2}, "point_speed", None),
        ("absorber", {"J": 85 * (301 / (1480 * math.pi / 30)) ** 2}, "point_speed", 301.0),
        ("scara", {"I_a": "0.0129 kg*m^2"}, "link_inertia", None),
        ("scara", {"I_a": "0.012 kg*m^2"}, "link_inertia", 0.012 / (8 * 0.4**2)),
    ],
)
def test_bodies_by_the_shaft_that_they_would_be_and_by_the_speed_of_the_start(machine, values, code, value):
    changes = {f"parameters.{letter}": text for letter, text in values.items()}
    values_of = {d.code: d.value for d in cases.load(str(OWN / f"{machine}.toml"), changes).doubts}
    assert values_of.get(code) == (None if value is None else pytest.approx(value))


def test_a_rod_by_the_same_mass_at_both_its_joints(tmp_path):
    file, *_ = write_engine("v", 0.095, 0.088, 8, tmp_path / "engine")
    assert "rod_ends" not in {d.code for d in cases.load(str(file)).doubts}
    changes = {"parameters.l1": "5.133 mm", "parameters.l2": "102.7 mm", "parameters.m_rod": "0.77 kg",
               "parameters.I_rod": "0.00366 kg*m^2"}  # fmt: skip
    (ratio,) = (d.value for d in cases.load(str(file), changes).doubts if d.code == "rod_ends")
    assert ratio == pytest.approx(0.00366 / (0.77 * 5.133e-3 * 0.1027))


@pytest.mark.parametrize(
    ("element", "value", "codes"),
    [
        ("damper", -0.1, {"damper_sign"}),
        ("damper", 0.0, set()),
        ("damper", 0.1, set()),
        ("spring", -5.0, {"spring_sign"}),
        ("spring", 5.0, set()),
    ],
)
def test_a_spring_or_damper_that_drives_is_told(tmp_path, element, value, codes):
    unit = {"damper": "N*m*s/rad", "spring": "N*m/rad"}[element]
    said = f"c = m.parameters('c', '{unit}')\n    m.{element}(c, stretch=phi)\n    crank = m.link("
    (tmp_path / "bar.py").write_text(DECLARED.replace("crank = m.link(", said))
    numbers = "".join(f"{letter} = {number!r}\n" for letter, number in (BAR | {"c": value}).items())
    case = tmp_path / "bar.toml"
    case.write_text(f'mechanism = "./bar.py"\nabout = "bar"\n[parameters]\n{numbers}')
    assert {d.code for d in cases.load(str(case)).doubts} == codes


# two bars of a kilogram in all and 0.35 m: 364 mm^2 of steel
@pytest.mark.parametrize(("force", "told"), [(0.5 * 5e8 * 3.64e-4, False), (2 * 5e8 * 3.64e-4, True)])
def test_a_force_that_no_bar_of_the_links_mass_holds_is_told(tmp_path, force, told):
    pushed = DECLARED.replace(
        "    output(m", '    F = m.inputs("F", "N")\n    m.force(F, along=slide.at().x)\n    output(m'
    )
    (tmp_path / "bar.py").write_text(pushed)
    numbers = "".join(f"{letter} = {number!r}\n" for letter, number in BAR.items())
    case = tmp_path / "bar.toml"
    case.write_text(f'mechanism = "./bar.py"\nabout = "bar"\n[parameters]\n{numbers}[inputs]\nF = {force!r}\n')
    assert ("link_stress" in {d.code for d in cases.load(str(case)).doubts}) == told


@pytest.mark.parametrize(("mass", "told"), [(0.12, False), (80.0, True)])
def test_pistons_without_links_are_held_against_the_letters_of_their_mechanism(mass, told):
    assert ("link_density" in doubts("swash-plate", {"parameters.m_p": mass})) == told


# 4 kg on 100 N/m: 0.39 m of rest, critical at 40 N*s/m
@pytest.mark.parametrize(
    ("values", "changes", "codes"),
    [
        ({}, {}, []),
        ({"k": 0.99 * 4 * 9.81 / 4}, {}, ["spring_rest"]),
        ({"k": 1.01 * 4 * 9.81 / 4}, {}, []),
        ({"k": 0.99 * 4 * 9.81 / 4}, {"links": [{}]}, []),
        ({"c": 9 * 40.0}, {}, []),
        ({"c": 11 * 40.0}, {}, ["damping_share"]),
        ({"c": 11 * 40.0}, {"springs": []}, []),
        ({"A": 2.0, "C": 3.999}, {}, []),  # a flat disc has C = 2 A
        ({"A": 2.0, "C": 4.01}, {}, ["principal_moments"]),
        ({"A": 2.0, "C": 0.0}, {}, []),  # a model of a body that never turns about its axis
    ],
)
def test_a_mass_on_a_spring_and_a_tensor_are_held_against_each_other(values, changes, codes):
    units = {"m": "kg", "k": "N/m", "c": "N*s/m", "A": "kg*m^2", "C": "kg*m^2"}
    listing = {"parameters": units, "springs": ["k"], "dampers": ["c"], "tensors": {"disc": ["A", "A", "C", *"000"]}}
    letters = {"m": 4.0, "k": 100.0, "c": 8.0, "A": 2.0, "C": 3.0} | values
    assert [d.code for d in by_sign(listing | changes, letters)] == codes


ARM = {"name": "arm", "mass": "m", "inertia": "I", "centre": ["l/2", "0"], "points": [["0", "0"], ["l", "0"]],
       "pivot": ["0", "0"], "turns": "q"}  # fmt: skip
ROD = {"name": "rod", "mass": "0", "inertia": "0", "centre": ["0", "0"], "points": [["0", "0"], ["L", "0"]],
       "pivot": None, "turns": ""}  # fmt: skip
SIZES = {"m": 4.0, "I": 0.05, "l": 0.35, "L": 0.3}
SECTION = 4.0 / 7850 / 0.35  # of a bar of steel of that mass and length [m^2]


@pytest.mark.parametrize(
    ("values", "changes", "torque", "code"),
    [
        ({}, {}, 0.0, None),
        ({"I": 4.5 * 4 * 0.35**2}, {}, 0.0, None),  # with a motor behind its gear
        ({"I": 5.5 * 4 * 0.35**2}, {}, 0.0, "link_needle"),
        ({"m": 1e-3, "I": 1.1e-5 * 1e-3 * 0.35**2}, {"centre": ["l", "0"]}, 0.0, None),  # its mass at one end
        ({"m": 1e-3, "I": 0.9e-5 * 1e-3 * 0.35**2}, {"centre": ["l", "0"]}, 0.0, "link_needle"),
        ({"I": 0.9e-2 * 4 * 0.35**2}, {}, 0.0, "link_inertia"),
        ({"I": 4 * 0.1**2 / 2, "l": 0.02, "L": 0.1}, {}, 0.0, None),  # a disc with a crank pin
        ({"I": 50.0}, {"centre": ["0", "0"]}, 0.0, None),  # balanced: a wheel
        ({"l": 0.05}, {}, 0.0, None),  # a crank whose webs are wider than its throw
        ({"l": 0.05, "L": 0.07}, {}, 0.0, "link_density"),
        ({}, {}, 0.9 * 5e8 * SECTION**1.5 / 6, None),
        ({}, {}, 1.1 * 5e8 * SECTION**1.5 / 6, "link_stress"),
        ({"m": 1e-3, "I": 0.9e-5 * 1e-3 * 0.35**2}, {"points": [["0", "0"]]}, 0.0, "link_needle"),
        ({"m": 1e-3, "I": 1.1e-5 * 1e-3 * 0.35**2}, {"points": [["0", "0"]]}, 0.0, None),
        ({"I": 7.9 * 4 * 0.35**2}, {"points": [["0", "0"]]}, 0.0, None),  # a disc beside its axis
        ({"I": 8.1 * 4 * 0.35**2}, {"points": [["0", "0"]]}, 0.0, "link_inertia"),
    ],
)
def test_a_link_that_its_drive_turns_is_held_against_its_bar(values, changes, torque, code):
    listing = {"links": [ARM | changes, ROD], "parameters": {"m": "kg", "I": "kg*m^2", "l": "m", "L": "m"},
               "coordinates": {"q": "rad"}, "inputs": {"M": "N*m"}}  # fmt: skip
    assert [d.code for d in by_links(listing, SIZES | values, {"M": -torque}, {"q": 10.0})] == ([code] if code else [])


def test_a_rotor_carries_its_flywheel():
    listing = {"links": [ARM], "parameters": {}, "coordinates": {"q": "rad"}, "inputs": {}}
    heavy = SIZES | {"I": 50.0}
    assert [d.code for d in by_links(listing, heavy, {}, {})] == ["link_needle"]
    assert by_links(listing | {"roles": {"rotor": [{"name": "arm", "angle": "q"}]}}, heavy, {}, {}) == ()


def test_what_joints_bear_is_held_against_the_stoutest_link():
    """A bar of 7.85 kg and a metre has 10 cm^2 of steel: 400 kN are 400 MPa, 600 kN are beyond what steel bears."""
    link = {"name": "bar", "mass": "m", "inertia": "0", "centre": ["0", "0"], "points": [["0", "0"], ["l", "0"]]}
    listing = {"links": [link | {"pivot": None, "turns": ""}]}
    assert by_force(listing, {"m": 7.85, "l": 1.0}, 4e5) == ()
    (doubt,) = by_force(listing, {"m": 7.85, "l": 1.0}, 6e5)
    assert doubt.code == "link_stress" and doubt.value == pytest.approx(6e8)


def test_a_speed_that_no_rod_bears_is_doubted():
    case = str(EXAMPLES / "whitworth.toml")
    quiet, wild = ({d.code for d in _judged(case, speed)} for speed in ("60 rpm", "3000 rpm"))
    assert "link_stress" in wild - quiet


def _judged(case, speed):
    return of_own(cases.load(case, {"operation.speed": speed}), one_coordinate)


# machines without links, by their closed forms
TURNING = {"coordinates": {"phi": "rad", "s": "m"}, "parameters": {"r": "m"}, "inputs": {}}
SHAFT = {
    "coordinates": {"phi": "rad", "psi": "rad"},
    "parameters": {"I": "kg*m^2", "J": "kg*m^2", "k": "N*m/rad", "c": "N*m*s/rad"},
    "inputs": {"M": "N*m"},
    "springs": ["k"],
    "dampers": ["c"],
}


def _values(doubts):
    return {d.code: d.value for d in doubts}


def test_a_body_on_an_arm_is_as_fast_as_its_end():
    listing = {**TURNING, "bodies": {"bob": ["r*cos(phi)", "r*sin(phi)"]}}
    assert _values(by_links(listing, {"r": 3.0}, {}, {"phi": -50.0})) == {"point_speed": pytest.approx(150.0)}
    assert _values(by_links(listing, {"r": 1.0}, {}, {"phi": 50.0})) == {}
    geared = {**TURNING, "bodies": {"car": ["r*phi/8", "0"]}}
    assert _values(by_links(geared, {"r": 3.0}, {}, {"phi": 400.0})) == {"point_speed": pytest.approx(150.0)}


def test_a_body_that_slides_along_an_arm_is_where_it_was_assembled():
    listing = {**TURNING, "bodies": {"slider": ["s*cos(phi)", "s*sin(phi)"]}}
    assert _values(by_links(listing, {"r": 1.0}, {}, {"phi": 500.0, "s": 1.0})) == {}
    assembled = by_links({**listing, "pose": {"s": 0.5}}, {"r": 1.0}, {}, {"phi": 500.0, "s": 1.0})
    assert _values(assembled) == {"point_speed": pytest.approx(250.0)}


def test_a_spring_is_wound_up_by_the_largest_torque():
    letters = {"I": 2.0, "J": 1.0, "k": 10.0, "c": 0.0}
    assert _values(by_links(SHAFT, letters, {"M": 10 * math.pi}, {})) == {}  # half a turn
    assert _values(by_links(SHAFT, letters, {"M": -100.0, "phi": 5.0}, {})) == {"spring_wound": pytest.approx(10.0)}


def test_inertias_and_dampers_are_held_against_their_neighbours():
    letters = {"I": 2.0, "J": 1e-6, "k": 8.0, "c": 1600.0}
    assert _values(by_links(SHAFT, letters, {}, {})) == {"inertia_spread": pytest.approx(2e6)}
    assert _values(by_sign(SHAFT, letters)) == {"damping_share": pytest.approx(200.0)}  # of critical, 2 sqrt(k I) = 8


def test_a_motor_turns_by_the_ratio_faster_than_its_load():
    """I / (J i^2), a ratio up or down."""
    geared = {**SHAFT, "parameters": {**SHAFT["parameters"], "i": "-"}}
    for ratio in (30.0, 1 / 30.0):
        letters = {"I": 2.0, "J": 2e-6, "k": 8.0, "c": 0.0, "i": ratio}
        assert _values(by_links(geared, letters, {}, {})) == {}
        seen = _values(by_links(geared, {**letters, "J": 2e-8}, {}, {}))
        assert seen == {"inertia_spread": pytest.approx(1e8 / 900)}


@pytest.mark.parametrize(("heavy", "codes"), [(119.0, []), (121.0, ["mass_spread"])])
def test_masses_are_held_against_one_another(heavy, codes):
    listing = {"coordinates": {"x": "m"}, "inputs": {}, "parameters": {"m_1": "kg", "m_2": "kg", "m_3": "kg"}}
    letters = {"m_1": 2.0 * heavy, "m_2": 2.0, "m_3": 0.0}  # what is left away is no part
    assert [d.code for d in by_links(listing, letters, {}, {})] == codes


def test_lengths_of_a_machine_without_links_are_held_against_one_another():
    listing = {"coordinates": {"phi": "rad"}, "inputs": {}, "parameters": {"p": "m", "q": "m", "e": "m"}}
    assert _values(by_links(listing, {"p": 2e-3, "q": -8.0, "e": 0.0}, {}, {})) == {"link_spread": pytest.approx(4e3)}
    assert _values(by_links(listing, {"p": 2.0, "q": -8.0, "e": 0.0}, {}, {})) == {}


@pytest.mark.parametrize(("rotor", "radius", "told"), [(False, 3.9, False), (False, 4.1, True), (True, 4.1, False)])
def test_a_body_is_a_disc_no_wider_than_its_machine_but_for_a_flywheel(rotor, radius, told):
    """I / (m L^2) of a disc, R^2 / (2 L^2), is 8 where it is four times as wide."""
    listing = {
        "coordinates": {"phi": "rad"}, "inputs": {}, "parameters": {"m": "kg", "I": "kg*m^2", "q": "m"},
        "solids": [["m", "I", "phi"]], "roles": {"rotor": [{"angle": "phi"}]} if rotor else {},
    }  # fmt: skip
    letters = {"m": 10.0, "q": 2.0, "I": 10.0 * (radius * 2.0) ** 2 / 2}
    doubts = {"link_inertia": pytest.approx(radius**2 / 2)} if told else {}
    assert _values(by_links(listing, letters, {}, {})) == doubts
    # a model without its mass has no size
    assert "link_inertia" not in _values(by_links(listing, {**letters, "m": 0.0}, {}, {"phi": 10.0}))


@pytest.mark.parametrize(
    ("weight", "doubts"),
    [
        ([], {}),
        (["0", "-weight_y"], {}),
        (["g", "0"], {}),  # on its side
        (["0", "-g"], {}),  # a letter is judged by itself
        (["0", "-100*weight_y"], {"weight": 981.0}),
        (["0", "g"], {"weight_up": 1.0}),
        (["0", "0", "g"], {"weight_up": 1.0}),
        (["g/2", "g/2"], {}),  # along no axis
    ],
)
def test_a_declaration_falls_down_as_fast_as_on_earth(weight, doubts):
    listing = {"coordinates": {"phi": "rad"}, "inputs": {}, "parameters": {"g": "m/s^2"}, "weight": weight}
    assert _values(by_sign(listing, {"g": 9.81, "weight_y": 9.81})) == doubts


def test_a_crank_without_a_mass_is_no_thread():
    """I / l^5 of a link between joints 0.1 m apart; a wire of steel a thousandth as thick has 5e-4."""
    link = {
        "name": "gear", "mass": "0", "inertia": "I", "centre": ["0", "0"], "turns": "phi", "pivot": ("0", "0"),
        "points": [("0", "0"), ("r", "0")],
    }  # fmt: skip
    listing = {"coordinates": {"phi": "rad"}, "inputs": {}, "parameters": {"r": "m", "I": "kg*m^2"}, "links": [link]}
    wire = 7850 * math.pi / 4 * 1e-6 / 3  # about its end
    for density, doubts in ((wire, {}), (wire / 10, {"link_thread": pytest.approx(wire / 10)}), (0.0, {})):
        assert _values(by_links(listing, {"r": 0.1, "I": density * 1e-5}, {}, {})) == doubts


@pytest.mark.parametrize(("force", "told"), [("F", False), ("G", True)])
def test_an_input_that_moves_nothing_is_told(tmp_path, force, told):
    """A force on the slide of a crank, and one on a point of the frame."""
    acting = '    F, G = m.inputs("F G", "N")\n' + "".join(
        f"    m.force({f}, along=slide.at().{x})\n" for f, x in ("Fx", "Gy")
    )
    (tmp_path / "bar.py").write_text(DECLARED.replace("    output(", f"{acting}    output("))
    letters = "\n".join(f"{name} = {value}" for name, value in BAR.items())
    case = tmp_path / "bar.toml"
    case.write_text(
        f'mechanism = "./bar.py"\n[parameters]\n{letters}\n[operation]\nspeed = "60 rpm"\n[inputs]\n{force} = 100.0\n'
    )
    doubts = of_own(cases.load(str(case)), one_coordinate)
    assert ("idle_input" in {doubt.code for doubt in doubts}) == told


@pytest.mark.parametrize(
    ("setting", "code"),
    [
        ({}, None),
        ({"parameters.z": ["0 mm", "60 m", "120 mm", "180 mm"]}, "cylinder_pitch"),
        ({"parameters.I0": "13.73 kg*m^2"}, "crank_inertia"),  # as heavy as no crank beside a flywheel
        ({"parameters.I_f": "13.73 kg*m^2"}, None),
    ],
)
def test_cylinders_and_cranks_of_a_boxer_engine(tmp_path, setting, code):
    file = write_engine("boxer", 0.1, 0.08, 4, tmp_path / "boxer")[0]
    assert {d.code for d in cases.load(str(file), setting).doubts} == ({code} if code else set())
