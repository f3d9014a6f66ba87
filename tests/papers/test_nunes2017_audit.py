"""Chapter 4 of the thesis and the claims of its engine model, as the audit judges them."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from mechsym.audit.hosts import sources as findings
from mechsym.audit.hosts.sources import Printed, TextClaim
from mechsym.audit.read.algebra import FLOATS
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import complete
from mechsym.papers import sources
from mechsym.papers.nunes2017 import claims as loads
from mechsym.sizing.rules import crankshaft, gears, piston

STEM = "004_e00ef50339108dab"
ALL = sources("nunes2017")[0].entries
# claims of the model, chapter 4, results
LATER = ALL[next(i for i, e in enumerate(ALL) if e.equation == "list of symbols") :]

# erratum: (where, words of the claim, largest relative error by hand, what the errata must tell)
ERRATA = {
    "E1": ("table 3.2", "0.02827", 9.0, ["0.0028274 m^2", "179.8 mm", "83.5 mm", "11.6 mm"]),
    "E1 gap": ("4.15", "1.2 mm", 1 - 1.2 / 11.556, ["11.56 mm"]),
    "E1 cylinder": ("4.17", "169.4", 1 - 169.4 / 179.756, ["10.4 mm too short"]),
    "E1 rod": ("4.12", "88.6", 88.6 / 83.472 - 1, ["83.5 mm"]),
    "E3": ("text 5.1.1", "unburnt", 0.1442 / 0.1396 - 1, ["0.1362 to 0.1396"]),
    "E4": ("text 3.4.3", "9.604", 1 - 9.604 / 9.667, ["9.667 MPa"]),
    "E5": ("text 5.1", "5400", None, ["0.0034", "435 rpm", "394.01"]),
    "E7": ("text 3.4", "largest torques", 0.5, ["552.5 and 487.2 N m"]),
    "E8": ("text 5.2", "6436", 1 - 6436 / 6515, ["6515 rpm", "74 mm"]),
    "E11": ("text 3.1.1", "displacement", 0.9, ["2.9405e-04 m^3"]),
    "E11 table": ("table 3.1", "column", None, ["350.93 -4.457e-04 N", "30.66 +2.654e-03 N", "0.37 degrees"]),
    "E12": ("table 4.9", "26 mm", 1.0, ["13 mm"]),
    "E12 modules": ("text 4.4.1", "modules", None, ["1 and 0.5"]),
    "E13": ("table 4.13", "dedenda", 1 - 0.5 / 0.85, ["0.85 and 1.85 mm"]),
    "E14 constant": ("4.25", "200", None, ["196.85"]),
    "E14 K_v": ("table 4.10", "dynamic", 1 - 1.1073 / 1.1438, ["1.1438 for both"]),
    "E14 K_m": ("table 4.10", "load distribution", 1 - 1.1349 / 1.2537, ["1.2537 for both"]),
    "E14 width": ("table 4.12", "39 mm", 1 - 39 / 39.81, ["39.81 mm"]),
    "E15": ("table 4.11", "ring's diameter", 0.5, ["36.06 mm are 72.12 mm"]),
    "E16": ("table 4.10", "Z_E", 999.0, ["187.03 (N/mm^2)^0.5"]),
    "E16 gamma": ("list of symbols", "gamma", None, ["no unit"]),
    "E17 rod": ("4.5", "60 MPa", 26.29 / 24.0 - 1, ["24.00 mm", "50 MPa"]),
    "E17 force": ("text 4.5", "27410", 27410 / 27140 - 1, ["13570 N", "23.56 mm"]),
    "E17 web": ("4.34", "118.074", 1 - 118.074 / 186.2, ["116.9 MPa", "186.2 MPa"]),
    "E18": ("4.35", "7.82", 1 - 7.82 / 11.418, ["11.42 mm", "2423 MPa", "unsafe"]),
    "E19": ("text 4.6.1", "2783 g mm/s^2", None, ["g mm", "centripetal"]),
    "E20": ("4.11", "294.7", 1 - 0.25 / 0.579, ["0.579 kg", "11856 N", "-10279 N", "-5081 N"]),
    "E21": ("text 4.8", "HN 1516", 1 - 27.14 / 33.24, ["30.0 kN", "33.2 kN"]),
    "E22": ("4.18", "10 mm", 104 / 70 - 1, ["9.94 mm", "8.16 mm", "M14 to M18"]),
    "E23": ("2.64", "absolute", 286.49 / (27140 - 286.49), ["286.5 N", "272.42 and 240.24"]),
    "bearing set": ("text 4.8", "HK 2516", 30.2 / 25.889 - 1, ["25.9 kN"]),
    "planet speed": ("table 4.16", "HN 1516", 0.5, ["16000 rpm", "7500 rpm"]),
    "maraging": ("text 6.1", "maraging", 1 - 0.5 / 0.5283, ["0.648"]),
}


@pytest.fixture(scope="module")
def audited():
    return [findings.row(STEM, entry) for entry in LATER]


def found(rows, where, words):
    (row,) = [r for r in rows if r["equation"] == where and words in r["claim"] and r["verdict"].endswith("claim")]
    return row


@pytest.mark.slow
@pytest.mark.parametrize("erratum", ERRATA)
def test_errata_stand_with_their_numbers(audited, erratum):
    where, words, error, told = ERRATA[erratum]
    row = found(audited, where, words)
    assert row["verdict"] == "unsupported claim"
    if error is not None:
        assert row["max_rel_error"] == pytest.approx(error, rel=0.02)
    for text in told:
        assert text in row["note"]


def test_what_holds_is_supported(audited):
    supported = {r["equation"] for r in audited if r["verdict"] == "supported claim"}
    assert supported == {"4.3", "text 4.6.1", "text 5.1.2"}


def test_parts_as_chosen_name_the_output_shaft_first_of_all_by_its_factor(audited):
    note = found(audited, "chapter 4", "as chosen")["note"]
    assert "11 of 46" in note
    for part in ("output shaft (fatigue factor, 0.0726", "cylinder (length", "M10", "ring, bending"):
        assert part in note


def test_mesh_speed_is_a_misprint_for_the_planet_and_right_for_the_ring(audited):
    planet, ring = (r for r in audited if r["equation"] == "4.26")
    assert (planet["verdict"], planet["correction"]) == ("misprint", "pi*d_pitch*N/30")
    assert planet["max_rel_error"] == pytest.approx(0.5)
    assert "21.78 m/s" in planet["effect"] and "39.81 mm" in planet["effect"]
    assert ring["verdict"] == "exact"


def test_formulas_that_are_derived_are_exact(audited):
    derived = [r for r, e in zip(audited, LATER, strict=True) if isinstance(e, Printed)]
    exact = {r["equation"] for r in derived if r["verdict"] == "exact"}
    assert exact == {"4.2", "4.5", "4.6", "4.13", "4.15", "4.16", "4.17", "4.18", "4.26", "4.30", "4.31", "4.32",
                     "4.34", "4.35"}  # fmt: skip


def test_every_numbered_relation_of_chapter_4_is_there():
    numbers = {e.equation for e in ALL if not isinstance(e, TextClaim)}
    assert {f"4.{n}" for n in range(1, 38)} <= numbers


@pytest.mark.parametrize(("quantity", "wrong"), [
    ("cylinder_length", "V_C/A_piston + 2*L_piston + 2.15*S/2"),
    ("web_stress", "6*F_bearing*(d_force - l_crankpin/2)/(w_crankweb*t_crankweb**2)"),
    ("shaft_diameter", "(Tq_max*32/(pi*sigma_S))**(1/3)"),
    ("head_strength", "sqrt(3*p*B**2/(8*sigma_t))"),
    ("Z_E", "sqrt(1/(2*pi*((1 - nu_pinion**2)/E_pinion + (1 - nu_gear**2)/E_gear)))"),
])  # fmt: skip
def test_a_wrong_rule_is_not_exact(quantity, wrong):
    entry = Printed(equation="x", claim="x", statement=wrong, quantity=f"engine_parts.{quantity}")
    assert findings.row(STEM, entry)["verdict"] in ("misprint", "wrong")


def test_theory_agrees_with_the_sizing_rules():
    parts = theory("engine_parts")
    names = {k: letter.value for k, letter in parts.letters.items()} | {"pi": math.pi}
    complete(parts, names, parts.results, FLOATS)
    v = SimpleNamespace(**names)
    shaft, omega = v.F_bearing, v.N * math.pi / 30
    rules = {
        "head_strength": piston.head_thickness_strength(v.p, v.B, v.sigma_t),
        "rod_diameter": piston.rod_diameter(v.F_t, v.sigma_f),
        "ring_thickness": piston.ring_radial_thickness(v.B, v.p_w, v.sigma_ring),
        "wall_thickness": piston.wall_thickness(v.p, v.B, v.sigma_c, v.C_reboring),
        "d_TDC": piston.tdc_gap(v.V_C, v.A_piston),
        "cylinder_length": piston.cylinder_length(v.d_TDC, v.L_piston, v.S / 2),
        "bolt_core": piston.core_diameter(v.p, v.B, int(v.n_bolt), v.sigma_bolt),
        "F_bearing": crankshaft.bearing_reaction(v.F_t, v.d_force, v.d_bearing),
        "crankpin_diameter": crankshaft.crankpin_diameter(shaft, v.d_force, v.sigma_b),
        "web_stress": crankshaft.web_stress(shaft, v.d_force, v.l_crankpin, v.t_crankweb, v.w_crankweb),
        "shaft_diameter": crankshaft.shaft_diameter(v.Tq_max, v.sigma_S),
        "mesh_speed": gears.mesh_speed(v.d_pinion, omega),
        "Z_E": gears.elastic_coefficient(v.E_pinion, v.nu_pinion, v.E_gear, v.nu_gear),
    }
    for name, value in rules.items():
        assert names[name] == pytest.approx(value, rel=1e-12), name


def test_journal_load_by_hand(monkeypatch):
    theta, force = np.radians([0.0, 40.0, 90.0]), np.array([20000.0, 20000.0, 9000.0])
    # across the cylinder rod and teeth add up, the separating force stands at a right angle to them
    across = np.hypot(18000.0, 9000.0 * np.tan(np.radians(25)))
    assert loads._with_separation(force, theta)[[0, 2]] == pytest.approx([20000.0, across], rel=1e-12)
    monkeypatch.setattr(loads, "_PRESSURE_ANGLE", 0.0)
    plain = force * np.sqrt(1 + 3 * np.sin(theta) ** 2)
    assert loads._with_separation(force, theta) == pytest.approx(plain, rel=1e-12)


def test_readable_errata_have_them(audited):
    source = sources("nunes2017")[0]
    text = findings.errata([source], audited, "")
    for needed in ("### Unsupported claim: (4.35), the output shaft needs 7.82 mm", "2423 MPa", "### Misprint: (4.26)"):
        assert needed in text
