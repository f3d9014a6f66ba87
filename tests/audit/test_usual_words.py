"""What papers say in other words: parts of an energy, places of masses, names of several letters, angles, cases."""

import pytest
from audited import blamed, judged, same

from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.nomenclature import called, nomenclature
from mechsym.audit.read.subject import subject
from mechsym.audit.read.tree import letters

MASSES = (
    "| $m$ | mass of the rod | kg |\n|---|---|---|\n| $J$ | moment of inertia of the rod | kg m^2 |\n"
    "| $v$ | speed of its centre | m/s |\n| $\\dot\\psi$ | its angular velocity | rad/s |\n\n%s\n"
    "The kinetic energy of the rod is\n$$ T = %s $$"
)


@pytest.mark.parametrize(
    ("before", "energy", "right"),
    [
        ("", r"\frac12 m v^2 + J\dot\psi^2", r"\frac12 m v^2 + \frac12 J\dot\psi^2"),
        ("", r"\frac12 m v^2 + \frac12 J\dot\psi^2", ""),
        ("There are two rods.", r"\frac12 m v^2 + J\dot\psi^2", ""),
    ],
)
def test_each_part_of_a_kinetic_energy_has_its_half(tmp_path, before, energy, right):
    rows = blamed(judged(tmp_path, MASSES % (before, energy), "text.md"))
    assert bool(rows) == bool(right)
    assert all(same(row["correction"], right) for row in rows)


SPRING = (
    "| $F$ | force of the spring | N |\n|---|---|---|\n| $F_0$ | preload | N |\n| $c$ | stiffness | N/m |\n"
    "| $s$ | compression | m |\n| $E$ | energy | J |\n\nThe force is\n$$ F = F_0 + c s $$\n\n"
    "and the energy stored in it\n$$ E = F_0 s + %s $$"
)


@pytest.mark.parametrize(("part", "found"), [(r"\frac{c s^2}{2}", False), ("c s^2", True), (r"\frac{c s^2}{4}", True)])
def test_a_spring_stores_its_force_over_its_way(tmp_path, part, found):
    rows = blamed(judged(tmp_path, SPRING % part, "text.md"))
    assert bool(rows) == found
    assert all(same(row["correction"], r"F_0 s + \frac{c s^2}{2}") for row in rows)


STIFFNESS = (
    "| $F$ | force | N |\n|---|---|---|\n| $A$ | area | m^2 |\n| $p$ | pressure | Pa |\n| $H$ | height | m |\n"
    "| $n$ | exponent | - |\n| $R$ | radius | m |\n| $q$ | radius of the guide | m |\n\nThe way is\n$$ z = R - q $$\n\n"
    "the force\n$$ F = A p\\left(\\frac{H}{H-z}\\right)^n $$\n\nand the stiffness\n"
    "$$ c = \\frac{dF}{dz} = \\frac{n A p}{H}\\left(\\frac{H}{H-z}\\right)^{%s} $$"
)


@pytest.mark.parametrize(("power", "found"), [("n+1", False), ("n", True)])
def test_a_slope_by_what_the_text_defines(tmp_path, power, found):
    rows = blamed(judged(tmp_path, STIFFNESS % power, "text.md"))
    assert [row["verdict"] for row in rows] == ["misprint"] * found
    assert all(same(row["correction"], r"\frac{n A p}{H}\left(\frac{H}{H-z}\right)^{n+1}") for row in rows)


EQUAL = (
    "| $r$ | radius | m |\n|---|---|---|\n| $m_1$ | mass of the first rod | kg |\n| $m_2$ | mass of the second | kg |\n"
    "| $\\varphi$ | crank angle | rad |\n| $\\omega$ | angular velocity | rad/s |\n\n"
    "$$ x = r\\cos\\varphi,\\quad y = r\\sin\\varphi $$\n\n"
    "For equal masses $m_1 = m_2 = m$ the energy is\n$$ T = \\frac12 m r^2\\omega^2 . $$\n\nThe inertia is\n"
    "$$ J = r^2(m_1\\sin^2\\varphi + m_2\\cos^2\\varphi) $$\n\nand its slope\n"
    "$$ \\frac{dJ}{d\\varphi} = r^2(m_1 - m_2)\\%s 2\\varphi . $$"
)


@pytest.mark.parametrize(("function", "found"), [("sin", False), ("cos", True)])
def test_equal_masses_are_equal_in_their_own_case(tmp_path, function, found):
    rows = blamed(judged(tmp_path, EQUAL % function, "text.md"))
    assert [row["verdict"] for row in rows] == ["misprint"] * found
    assert all(same(row["correction"], r"r^2(m_1 - m_2)\sin 2\varphi") for row in rows)


VOLUME = (
    "| $\\theta$ | crank angle%s | rad |\n|---|---|---|\n| $V_c$ | clearance volume | m^3 |\n"
    "| $V_d$ | displaced volume | m^3 |\n| $V$ | cylinder volume | m^3 |\n\nOver a yoke the cylinder volume is\n"
    "$$ V = V_c + \\frac{V_d}{2}(1 %s \\cos\\theta) $$"
)


@pytest.mark.parametrize(
    ("said", "sign", "found"), [(" from top dead centre", "-", False), (" from top dead centre", "+", True)]
)
def test_an_angle_from_the_top_leaves_no_other_sign(tmp_path, said, sign, found):
    assert bool(blamed(judged(tmp_path, VOLUME % (said, sign), "text.md"))) == found


@pytest.mark.parametrize(
    ("before", "told"),
    [
        ("The travel of the piston is, to the second order in $\\lambda$,", "travel"),
        ("From it follow, at an even speed $\\omega$, the piston speed", "piston speed"),
        ("The crosshead presses on its guide with", "side force"),
        ("In hertz it is", "natural frequency in hertz"),
        ("The rod is replaced by two point masses. At the crank pin", "mass at the crank pin"),
        ("The mean pressure of the bearing refers to the projected area:", "mean pressure"),
        ("and the force in its rod", "force"),
    ],
)
def test_what_other_words_give(before, told):
    assert subject(f"{before}\n\n$$", alone=True)[0] == told


ITEMS = """
- $P_i$, $P_e$: indicated and effective power, W
- $J_e$, $J_p$: moments of inertia of the engine and of the propeller, kg m^2
- $n$: speed, 1/s
- $z$: number of cylinders, 1
"""
SENTENCE = """
The symbols are: $r$ -- crank radius, m; $c$ -- stiffness of the spring, N/m; $m$ -- mass, kg;
$J$ -- moment of inertia, kg\\,m$^2$.
"""


def test_an_item_of_two_letters_names_each():
    names = nomenclature(ITEMS)
    assert [names[k].meaning for k in ("P_i", "P_e")] == ["indicated power", "effective power"]
    assert [names[f"J_{k[0]}"].meaning for k in ("engine", "propeller")] == [
        f"moment of inertia of the {k}" for k in ("engine", "propeller")
    ]


def test_a_list_in_a_sentence():
    names = {k: (v.meaning, v.unit) for k, v in nomenclature(SENTENCE).items()}
    assert names == {
        "r": ("crank radius", "m"),
        "c": ("stiffness of the spring", "N/m"),
        "m": ("mass", "kg"),
        "J": ("moment of inertia", "kg m^2"),
    }


def test_what_a_letter_stands_under_is_no_name():
    assert "F" not in called("The crosshead is in equilibrium under $F$ and the force $N$.")


@pytest.mark.parametrize(
    ("text", "used"),
    [
        (r"d\rho/d\varphi", ["drho_dphi"]),
        (r"d^2x/dt^2", ["d2x_dt2"]),
        (r"d_1/d_2", ["d1", "d2"]),
        (r"F d/D", ["F", "d", "D"]),
        (r"\frac{l_2}{l} r\cos\varphi\,\dot\varphi", ["l2", "l", "r", "phi", "phid"]),
    ],
)
def test_slopes_with_a_stroke(text, used):
    assert sorted(letters(read_latex(text)[0])) == sorted(used)


SLENDER = (
    "| $r$ | crank radius | m |\n|---|---|---|\n| $\\lambda$ | ratio of crank radius and rod length | - |\n"
    "| $\\theta$ | crank angle from top dead centre | rad |\n| $\\omega$ | angular velocity | rad/s |\n\nThe way is\n"
    "$$ x = r\\left(1 + \\frac{1}{\\lambda} - \\cos\\theta"
    " - \\frac{1}{\\lambda}\\sqrt{1-\\lambda^2\\sin^2\\theta}\\right) $$\n\n"
    "and, nearly,\n$$ \\ddot x \\approx r\\omega^2(\\cos\\theta + %s\\cos 2\\theta) $$"
)


@pytest.mark.parametrize(("share", "found"), [(r"\lambda", False), (r"\frac{\lambda}{2}", True)])
def test_a_ratio_is_small_by_its_name(tmp_path, share, found):
    rows = blamed(judged(tmp_path, SLENDER % share, "text.md"))
    assert [row["verdict"] for row in rows] == ["misprint"] * found
    assert all(same(row["correction"], r"r\omega^2(\cos\theta + \lambda\cos 2\theta)") for row in rows)


INERTIA = (
    "| $r$ | throw | m |\n|---|---|---|\n| $m$ | mass of the piston | kg |\n| $J_0$ | moment of inertia of the crank | "
    "kg m^2 |\n| $E$ | kinetic energy | J |\n| $\\varphi$ | crank angle | rad |\n\n$$ s = 2r(1-\\cos\\varphi) $$\n\n"
    "$$ E_1 = \\frac12 m\\dot s^2 $$\n\n$$ E_2 = \\frac12 J_0\\dot\\varphi^2 $$\n\n"
    "The reduced moment of inertia is\n$$ J = J_0 + %s m r^2\\sin^2\\varphi $$"
)


@pytest.mark.parametrize(("factor", "found"), [("4", False), ("2", True)])
def test_an_inertia_by_what_moves_with_the_angle(tmp_path, factor, found):
    rows = blamed(judged(tmp_path, INERTIA % factor, "text.md"))
    assert [row["verdict"] for row in rows] == ["misprint"] * found
    assert all(same(row["correction"], r"J_0 + 4 m r^2\sin^2\varphi") for row in rows)
