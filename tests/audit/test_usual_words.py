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

STIFFNESS = (
    "| $F$ | force | N |\n|---|---|---|\n| $A$ | area | m^2 |\n| $p$ | pressure | Pa |\n| $H$ | height | m |\n"
    "| $n$ | exponent | - |\n| $R$ | radius | m |\n| $q$ | radius of the guide | m |\n\nThe way is\n$$ z = R - q $$\n\n"
    "the force\n$$ F = A p\\left(\\frac{H}{H-z}\\right)^n $$\n\nand the stiffness\n"
    "$$ c = \\frac{dF}{dz} = \\frac{n A p}{H}\\left(\\frac{H}{H-z}\\right)^{%s} $$"
)


EQUAL = (
    "| $r$ | radius | m |\n|---|---|---|\n| $m_1$ | mass of the first rod | kg |\n| $m_2$ | mass of the second | kg |\n"
    "| $\\varphi$ | crank angle | rad |\n| $\\omega$ | angular velocity | rad/s |\n\n"
    "$$ x = r\\cos\\varphi,\\quad y = r\\sin\\varphi $$\n\n"
    "For equal masses $m_1 = m_2 = m$ the energy is\n$$ T = \\frac12 m r^2\\omega^2 . $$\n\nThe inertia is\n"
    "$$ J = r^2(m_1\\sin^2\\varphi + m_2\\cos^2\\varphi) $$\n\nand its slope\n"
    "$$ \\frac{dJ}{d\\varphi} = r^2(m_1 - m_2)\\%s 2\\varphi . $$"
)


SLENDER = (
    "| $r$ | crank radius | m |\n|---|---|---|\n| $\\lambda$ | ratio of crank radius and rod length | - |\n"
    "| $\\theta$ | crank angle from top dead centre | rad |\n| $\\omega$ | angular velocity | rad/s |\n\nThe way is\n"
    "$$ x = r\\left(1 + \\frac{1}{\\lambda} - \\cos\\theta"
    " - \\frac{1}{\\lambda}\\sqrt{1-\\lambda^2\\sin^2\\theta}\\right) $$\n\n"
    "and, nearly,\n$$ \\ddot x \\approx r\\omega^2(\\cos\\theta + %s\\cos 2\\theta) $$"
)


INERTIA = (
    "| $r$ | throw | m |\n|---|---|---|\n| $m$ | mass of the piston | kg |\n| $J_0$ | moment of inertia of the crank | "
    "kg m^2 |\n| $E$ | kinetic energy | J |\n| $\\varphi$ | crank angle | rad |\n\n$$ s = 2r(1-\\cos\\varphi) $$\n\n"
    "$$ E_1 = \\frac12 m\\dot s^2 $$\n\n$$ E_2 = \\frac12 J_0\\dot\\varphi^2 $$\n\n"
    "The reduced moment of inertia is\n$$ J = J_0 + %s m r^2\\sin^2\\varphi $$"
)


SLIPS = {
    "a spring stores its force over its way": (
        SPRING, r"\frac{c s^2}{2}", ("c s^2", r"\frac{c s^2}{4}"), r"F_0 s + \frac{c s^2}{2}",
    ),
    "a slope by what the text defines": (
        STIFFNESS, "n+1", ("n",), r"\frac{n A p}{H}\left(\frac{H}{H-z}\right)^{n+1}",
    ),
    "equal masses are equal in their own case": (EQUAL, "sin", ("cos",), r"r^2(m_1 - m_2)\sin 2\varphi"),
    "a ratio is small by its name": (
        SLENDER, r"\lambda", (r"\frac{\lambda}{2}",), r"r\omega^2(\cos\theta + \lambda\cos 2\theta)",
    ),
    "an inertia by what moves with the angle": (INERTIA, "4", ("2",), r"J_0 + 4 m r^2\sin^2\varphi"),
}  # fmt: skip


@pytest.mark.parametrize("name", SLIPS)
def test_what_is_right_is_left_in_peace_and_a_slip_corrected(tmp_path, name):
    text, good, slips, right = SLIPS[name]
    assert not blamed(judged(tmp_path, text % good, "text.md"))
    for bad in slips:
        (row,) = blamed(judged(tmp_path, text % bad, "text.md"))
        assert row["verdict"] == "misprint" and same(row["correction"], right)


VOLUME = (
    "| $\\theta$ | crank angle%s | rad |\n|---|---|---|\n| $V_c$ | clearance volume | m^3 |\n"
    "| $V_d$ | displaced volume | m^3 |\n| $V$ | cylinder volume | m^3 |\n\nOver a yoke the cylinder volume is\n"
    "$$ V = V_c + \\frac{V_d}{2}(1 %s \\cos\\theta) $$"
)


@pytest.mark.parametrize(
    ("said", "sign", "found"),
    [(" from top dead centre", "-", False), (" from top dead centre", "+", True), ("", "+", False)],
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


AGAIN = (
    "| $F$ | piston force | N |\n|---|---|---|\n| $r$ | crank radius | m |\n| $\\theta$ | crank angle | rad |\n"
    "| $\\beta$ | rod angle | rad |\n\nThe gas temperature $T$ in K and its pressure $p$ in Pa are known.\n\n%s\n"
    "$$ T = F r\\frac{\\sin(\\theta + \\beta)}{\\cos\\beta} $$"
)


@pytest.mark.parametrize(("words", "verdict"), [("The crank torque is", "exact"), ("It is", "wrong")])
def test_a_letter_used_again_has_the_unit_of_its_new_name(tmp_path, words, verdict):
    assert judged(tmp_path, AGAIN % words, "text.md")[-1]["verdict"] == verdict
