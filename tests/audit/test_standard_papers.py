"""What papers of engines in the usual form say of their own equations: letters as exponents, units, energies, words."""

from fractions import Fraction
from itertools import permutations
from math import cos, sin

import pytest
from audited import blamed, judged, same

from mechsym.audit.judge.exponents import exponent, is_left
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.nomenclature import nomenclature
from mechsym.audit.read.reader import AnyLetter, read_expression
from mechsym.audit.read.subject import subject

SPRING = (
    "| $A$ | area of the piston | m^2 |\n|---|---|---|\n| $p_0$ | pressure | Pa |\n| $H$ | height | m |\n"
    "| $z$ | way of the piston | m |\n| $n$ | polytropic exponent | - |\n| $F$ | force of the spring | N |\n"
    "| $E$ | energy | J |\n\n"
)


def _tree(text):
    return read_expression(text, (), AnyLetter())[0]


def test_exponents_with_letters_add_up_where_they_cancel():
    n = exponent(_tree("n"))
    assert exponent(_tree("2*n - (n - 1/2) - n")) == Fraction(1, 2)
    assert exponent(_tree("1/(1 - n)")) == 1 / (1 - n)
    assert exponent(_tree("-n")) == -n != exponent(_tree("-m"))
    assert exponent(_tree("sin(n)")) is exponent(_tree("n**2")) is exponent(_tree("1/(n - n)")) is None
    assert is_left([n]) and not is_left([n - n, Fraction(7, 12)])


def test_no_letter_of_an_exponent_hides_in_a_small_denominator():
    forms = "{0} 1-{0} 1/(1-{0}) 1/({0}+1) ({0}-1)/{0} {0}/({0}-1) 1/(2*{0}-1) 1/(2*{0}+1)"
    forms += " {0}*{1} {0}/{1} {0}-{1} ({0}-1)/{1}"
    for one, other in permutations(("n", "m", "k", "kappa", "gamma", "n1", "n_p", "alpha", "a", "s"), 2):
        for form in forms.split():
            assert is_left([exponent(_tree(form.format(one, other)))]), form.format(one, other)


@pytest.mark.parametrize(
    ("equation", "fits"),
    [
        (r"F = A p_0\frac{H^n}{(H-z)^n}", True),
        (r"F = A p_0\frac{H^n}{(H-z)^{n+1}}", False),
        (r"E = \frac{A p_0 H^n}{n-1}\left[(H-z)^{1-n} - H^{1-n}\right]", True),
        (r"E = \frac{A p_0 H^n}{n-1}\left[(H-z)^{-n} - H^{-n}\right]", False),
        (r"F = A p_0 H^n", True),  # of which nothing is known: a unit with n in it is none
    ],
)
def test_units_of_a_polytrope_fit_for_every_exponent(tmp_path, equation, fits):
    (row,) = judged(tmp_path, f"{SPRING}It is\n$$ {equation} $$", "text.md")
    assert (row["verdict"] == "wrong") != fits, row


def test_a_list_has_units_behind_its_commas():
    points = (
        "\\item $G$: shear modulus, Pa\n\\item $J_1$, $J_2$: moments of inertia, kg m$^2$\n"
        "\\item $L$: length of the shaft, m\n"
        "\\item $K_T$, $K_Q$: thrust and torque coefficients\n\\item $n$: speed of the shaft, at the flange\n"
        "\\item $M$: torque, N m\n"
    )
    written = nomenclature(points)
    units = {k: v.unit for k, v in written.items()}
    assert units["G"] == "Pa" and units["J_1"] == units["J_2"] == "kg m^2" and units["M"] == "N m"
    assert units["K_T"] == units["K_Q"] == "-" and units["n"] == ""
    assert written["n"].meaning == "speed of the shaft, at the flange"
    assert (
        nomenclature("\\item $k$: transfer coefficient\n")["k"].unit == ""
    )  # where nothing has a unit it may have one


def test_a_sentence_tells_the_unit_of_its_letter(tmp_path):
    text = "A spring of the stiffness $k$ in N/m is drawn by $u$ in m, and stores the energy\n$$ E = \\frac12 k u%s $$"
    assert nomenclature(text)["k"].unit == "N/m" and "w" not in nomenclature("see $w$ in m_1, in sum")
    rows = [judged(tmp_path, text % power, "text.md")[-1]["verdict"] for power in ("^2", "")]
    assert "wrong" not in rows[:1] and rows[1] in ("wrong", "misprint")


@pytest.mark.parametrize(
    ("before", "told"),
    [
        ("What is left of the first order along the axis is", ("", "")),
        ("Hence the force of first order\n\n$$ F = m $$\n\nand that of second order", ("", "force of second order")),
        ("The pressure of a roller on the guide, with the reduced radius", ("reduced radius", "reduced radius")),
        ("The stress is, without a factor,", ("stress", "stress")),
        ("The work of a cycle is $W$, and the mean pressure", ("mean pressure", "mean pressure")),
        ("It pulls with the force and stores", ("stored energy", "stored energy")),
    ],
)
def test_what_a_sentence_gives(before, told):
    phrase, about = subject(f"{before}\n\n$$", alone=True)
    assert (phrase, about if not phrase else phrase) == told


def test_a_thin_space_ends_the_argument_of_a_sine():
    tree, _ = read_latex(r"a\sin\varphi\,\frac{b}{c} + \cos 2\theta\;\frac{1}{d}")
    at = {"a": 2.0, "phi": 0.3, "b": 5.0, "c": 7.0, "theta": 0.4, "d": 3.0}
    assert float(evaluate(tree, at, FLOATS)) == pytest.approx(2 * sin(0.3) * 5 / 7 + cos(0.8) / 3, rel=1e-14)


WAY = (
    "| $r$ | crank radius | m |\n|---|---|---|\n| $\\lambda$ | ratio of crank radius to rod length | - |\n"
    "| $\\theta$ | crank angle | rad |\n| $\\omega$ | angular speed | rad/s |\n\nThe piston moves by\n"
    "$$ x \\approx r\\left[1-\\cos\\theta + \\frac{\\lambda}{4}(1-\\cos 2\\theta)\\right]. \\tag{5} $$\n\n"
    "Differentiating (5) with respect to time gives its velocity\n"
    "$$ v = r\\omega(\\sin\\theta + %s\\sin 2\\theta) \\tag{6} $$"
)


@pytest.mark.parametrize(("share", "verdict"), [(r"\frac{\lambda}{2}", "exact"), (r"\frac{\lambda}{4}", "misprint")])
def test_what_is_differentiated_is_named_by_its_number(tmp_path, share, verdict):
    row = judged(tmp_path, WAY % share, "text.md")[-1]
    assert row["verdict"] == verdict
    assert verdict == "exact" or same(row["correction"], r"r\omega(\sin\theta + \frac{\lambda}{2}\sin 2\theta)")


MOTION = (
    "$$ Q = F r\\sin\\varphi - M_r + M_h \\tag{1} $$\n\nThe equation of motion is\n"
    "$$ I\\ddot\\varphi + \\frac12 K\\dot\\varphi^2 = Q \\tag{2} $$\n\n"
    "For constant speed, $\\dot\\varphi = \\omega$, the hinge must supply\n$$ M_h = \\frac12 K\\omega^2 %s + M_r $$"
)


def test_a_letter_within_another_is_solved_for(tmp_path):
    right, wrong = (
        judged(tmp_path, MOTION % part, "text.md")[-1] for part in (r"- F r\sin\varphi", r"+ F r\sin\varphi")
    )
    assert right["verdict"] == "exact" and "follows from (2)" in right["note"]
    assert wrong["verdict"] == "misprint" and same(wrong["correction"], r"\frac12 K\omega^2 - F r\sin\varphi + M_r")


PARTS = (
    "The crank turns by $\\varphi$ in rad with the angular velocity $\\omega$. The rods move by\n"
    "$$ x = 2e\\cos\\varphi $$\n\nThe kinetic energy of the rods is\n"
    "$$ T_1 = 2 m e^2\\omega^2, \\tag{1} $$\n\nthat of the crank\n$$ T_2 = \\frac12 J_0\\omega^2. \\tag{2} $$\n\n"
    "The reduced moment of inertia is\n$$ J = J_0 + %s m e^2 $$"
)


def test_the_energies_of_the_parts_make_one_inertia(tmp_path):
    rows = [judged(tmp_path, PARTS % number, "text.md")[-1] for number in ("4", "2")]
    assert [row["verdict"] for row in rows] == ["exact", "misprint"]
    assert same(rows[1]["correction"], "J_0 + 4 m e^2")


def test_a_ratio_of_speeds_stands_squared_in_an_inertia(tmp_path):
    text = (
        "The kinetic energy is\n$$ T = \\frac12 J_a\\dot\\theta^2 + \\frac12 J_c\\dot\\beta^2 $$\n\nWith the ratio\n"
        "$$ i = \\frac{\\dot\\beta}{\\dot\\theta} $$\n\nthe reduced moment of inertia is\n$$ J = J_a + i%s J_c $$"
    )
    rows = [judged(tmp_path, text % power, "text.md")[-1] for power in ("^2", "")]
    assert [row["verdict"] for row in rows] == ["exact", "misprint"]


def test_forces_along_two_ways_do_their_work_together(tmp_path):
    text = (
        "The rods move by\n$$ x = 2e\\cos\\varphi $$\n\nand\n$$ y = 2e\\sin\\varphi $$\n\n"
        "With the gas force $F_x$ in N along the first rod and $F_y$ in N along the second\n"
        "the virtual work gives the torque\n"
        "$$ M = -2e(F_x\\sin\\varphi %s F_y\\cos\\varphi) $$"
    )
    rows = [judged(tmp_path, text % sign, "text.md")[-1] for sign in "-+"]
    assert [row["verdict"] for row in rows] == ["exact", "misprint"]


def test_beside_three_forces_a_fourth_is_a_force(tmp_path):
    table = "| $m$ | mass | kg |\n|---|---|---|\n| $r$ | radius | m |\n| $\\omega$ | angular speed | rad/s |\n"
    forces = [f"| ${letter}$ | force | N |\n" for letter in ("F", "F_g", "F_s", "F_n")]
    text = "\nThe masses load the bearing with\n$$ F_r = m r\\omega $$"
    few, many = (judged(tmp_path, table + "".join(forces[:n]) + text, "text.md")[-1] for n in (2, 4))
    assert few["verdict"] != "wrong" and many["verdict"] == "wrong"


def test_another_letter_that_is_a_quantity_already_is_not_blamed_for_it(tmp_path):
    text = (
        "With the reciprocating mass $m_o$ in kg, the crank radius $r$ in m, the angular velocity\n"
        "$\\omega$ and the crank angle $\\varphi$ the force of first order is\n"
        "$$ F_I = m_o r\\omega^2\\cos\\varphi $$\n\n"
        "A counterweight leaves along the cylinder\n$$ F_x = \\frac12 m_o r\\omega^2\\cos\\varphi $$"
    )
    rows = judged(tmp_path, text, "text.md")
    assert rows[0]["verdict"] == "exact" and blamed(rows) == []


def test_two_cylinders_are_not_those_of_a_machine_of_one(tmp_path):
    text = (
        "%s\n\nWith the reciprocating mass $m$ in kg, the crank radius $r$ in m, the rod ratio $\\lambda$, the\n"
        "angular velocity $\\omega$ and the crank angle $\\varphi$ there is\n"
        "$$ F = 2\\lambda m r\\omega^2\\cos 2\\varphi $$"
    )
    one, two = (judged(tmp_path, text % title, "text.md")[-1] for title in ("Of one cylinder", "Of a twin"))
    assert "twin" not in one["matched"] and "twin" in two["matched"]


def test_a_place_behind_its_name_changes_no_unit(tmp_path):
    text = "| $\\rho_0$ | density upstream | %s |\n|---|---|---|\n| $v$ | velocity | m/s |\n\n$$ q = \\rho_0 v $$"
    notes = [judged(tmp_path, text % unit, "text.md")[-1]["note"] for unit in ("kg", "kg/m^3")]
    assert "rho0 in kg, and this wants kg/m^3" in notes[0] and "wants" not in notes[1]


RIM = "A %s of the radius $R$ in m with the mass $m$ in kg has the moment of inertia about its axis\n$$ J = %s m R^2 $$"


@pytest.mark.parametrize(
    ("body", "share", "right"),
    [("rim", r"\frac12", "m R^2"), ("disc", "", r"\frac12 m R^2"), ("rim", "", ""), ("disc", r"\frac12", "")],
)
def test_a_rim_is_no_disc(tmp_path, body, share, right):
    row = judged(tmp_path, RIM % (body, share), "text.md")[-1]
    assert same(row["correction"], right) if right else row["verdict"] == "exact"


def test_an_efficiency_is_what_comes_out_by_what_goes_in(tmp_path):
    text = (
        "With the thrust $T$ in N, the speed of advance $v_a$ in m/s and the delivered power $P_D$ in W\n"
        "the efficiency of the propeller is\n$$ \\eta = %s $$"
    )
    right, wrong = r"\frac{T v_a}{P_D}", r"\frac{P_D}{T v_a}"
    rows = [judged(tmp_path, text % form, "text.md")[-1] for form in (right, wrong)]
    assert rows[0]["verdict"] == "exact" and rows[1]["verdict"] == "misprint" and same(rows[1]["correction"], right)


def test_a_mean_with_a_slip_does_not_come_back_to_what_is_solved_by_it(tmp_path):
    text = (
        "The flywheel gives the work\n$$ D = W(1-e) $$\n\nor between the speeds\n"
        "$$ D = \\frac12 J(\\omega_1^2 - \\omega_2^2). $$\n\nWith the mean speed\n"
        "$$ \\omega_m = \\frac{\\omega_1 - \\omega_2}{2} $$\n\nand the coefficient of fluctuation\n"
        "$$ C = \\frac{\\omega_1 - \\omega_2}{\\omega_m} $$\n\nits moment of inertia is\n"
        "$$ J = \\frac{D}{C\\omega_m^2} $$"
    )
    rows = blamed(judged(tmp_path, text, "text.md"))
    assert [row["line"] for row in rows] == [8] and same(rows[0]["correction"], r"\frac{\omega_1 + \omega_2}{2}")


def test_a_force_in_the_rod_is_the_force_of_the_rod(tmp_path):
    text = (
        "Under the piston force $F$ the rod of length $l$ on the crank of radius $r$ is inclined by\n"
        "$$ \\sin\\beta = \\frac{r}{l}\\sin\\varphi, $$\n\nthe force in the rod\n$$ S = %s $$"
    )
    rows = [judged(tmp_path, text % form, "text.md")[-1] for form in (r"\frac{F}{\cos\beta}", r"F\cos\beta")]
    assert [row["verdict"] for row in rows] == ["exact", "misprint"]


def test_a_ratio_of_lengths_is_put_in_for_no_length(tmp_path):
    inside = r"\left(\sin\varphi + \frac{\lambda}{2}\sin 2\varphi\right)^2"
    text = (
        "The crank ratio is\n$$ \\lambda = \\frac{r}{l} $$\n\nand the kinetic energy\n"
        f"$$ T = \\frac12 I_0\\dot\\varphi^2 + \\frac12 m r^2 {inside}\\dot\\varphi^2. $$\n\n"
        f"The reduced moment of inertia is\n$$ I = I_0 + %s m r^2 {inside} $$"
    )
    rows = [judged(tmp_path, text % share, "text.md")[-1] for share in ("", r"\frac12")]
    assert [row["verdict"] for row in rows] == ["exact", "misprint"]


def test_a_compressor_has_no_strokes_of_an_engine(tmp_path):
    text = (
        "The piston of the compressor goes from the bottom dead centre to the top.\n"
        "The work of a turn is\n$$ W = p V_s. $$\n\nAt $N$ revolutions per minute the indicated power is\n"
        "$$ P_i = \\frac{W N}{%d} $$"
    )
    rows = [judged(tmp_path, text % number, "text.md")[-1] for number in (60, 120)]
    assert [row["verdict"] for row in rows] == ["exact", "misprint"]
