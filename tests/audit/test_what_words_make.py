"""Equations of a text that are told by the words in front of them, by their twins, and by names of a table."""

import pytest
from audited import blamed, is_told, judged, same


def _last(tmp_path, text):
    return judged(tmp_path, text, "text.md")[-1]


@pytest.mark.parametrize(
    ("called", "unit", "wanted"),
    [
        ("Young's modulus", "N/m", "Pa"),
        ("moment of inertia of the flywheel", "kg m", "kg m^2"),
        ("gas force on the piston", "Pa", "N"),
        ("torque", "N/m", "N m"),
        ("moment of inertia of the section", "m^4", None),
        ("gas pressure", "kg/m^2", None),  # of a weight
        ("pressure force", "N", None),
        ("angular velocity", "rpm", None),
        ("heat", "J/kg", None),
        ("force per length", "N/m", None),
        ("relative pressure", "-", None),
        ("polytropic exponent", "J/kg", "-"),
        ("mechanical efficiency", "-", None),
        ("second moment of area of the shank", "m^3", "m^4"),
        ("moment of inertia per mass", "m^2", None),
        ("moment of inertia", "kg m s^2", None),  # of technical units
        ("acceleration of the frame", "g", None),
        ("power", "N m", "W"),
        ("heat", "W", None),  # in a time
    ],
)
def test_a_table_is_told_of_by_what_it_calls_a_letter(tmp_path, called, unit, wanted):
    text = f"| $X$ | {called} | {unit} |\n|---|---|---|\n| $k$ | number | - |\n\n$$ y = k X $$"
    note = _last(tmp_path, text)["note"]
    assert (f"the table has X in {unit}, and this wants {wanted}" in note) == (wanted is not None), note


def test_a_ratio_that_the_table_writes_out_is_a_definition(tmp_path):
    text = (
        "| $r$ | crank radius | m |\n|---|---|---|\n| $l$ | rod length | m |\n| $n$ | rod ratio $l/r$ | - |\n\n"
        "$$ x = r\\cos\\varphi + \\sqrt{l^2 - r^2\\sin^2\\varphi} $$\n\nor\n\n"
        "$$ x = r\\left(\\cos\\varphi + \\sqrt{n^2 - \\sin^2\\varphi}\\right) $$"
    )
    assert _last(tmp_path, text)["verdict"] == "exact"
    assert _last(tmp_path, text.replace("n^2 -", "n -"))["verdict"] == "misprint"


SHAFT = r"""The energies of two discs on a shaft are
$$ T = \frac12 J_1\dot\varphi_1^2 + \frac12 J_2\dot\varphi_2^2 $$
$$ V = \frac12 k(\varphi_1 - \varphi_2)^2 $$
Lagrange's equations give
$$ J_1\ddot\varphi_1 + k(\varphi_1 - \varphi_2) = M\cos\Omega t $$"""


def test_energies_tell_of_motion_where_a_text_only_speaks_of_lagrange(tmp_path):
    row = _last(tmp_path, SHAFT)
    assert (row["verdict"], row["matched"]) == ("exact", "the text's energies")
    row = _last(tmp_path, SHAFT.replace(r"+ k(\varphi_1", r"- k(\varphi_1"))
    assert row["verdict"] == "misprint" and same(row["correction"], r"J_1\ddot\varphi_1 + k(\varphi_1 - \varphi_2)")
    # a term of what acts from outside is none of theirs
    assert _last(tmp_path, SHAFT.replace("= M", r"+ c\dot\varphi_1 = M"))["verdict"] == "exact"
    # of Newton no energies are asked
    assert _last(tmp_path, SHAFT.replace("Lagrange's equations give", "By Newton"))["verdict"] == "untestable"


LOOP = r"""The loop closes with
$$ a\cos\theta_2 + b\cos\theta_3 - c\cos\theta_4 - d = 0 $$
$$ a\sin\theta_2 + b\sin\theta_3 - c\sin\theta_4 = 0 $$
Differentiation in time gives
$$ a\omega_2\cos\theta_2 + b\omega_3\cos\theta_3 - c\omega_4\cos\theta_4 = 0 $$"""


def test_the_rates_of_a_loop_follow_from_it(tmp_path):
    row = _last(tmp_path, LOOP)
    assert row["verdict"] == "exact" and row["note"].startswith("the rate of")
    row = _last(tmp_path, LOOP.replace(r"- c\omega_4", r"+ c\omega_4"))
    right = r"a\omega_2\cos\theta_2 + b\omega_3\cos\theta_3 - c\omega_4\cos\theta_4"
    assert row["verdict"] == "misprint" and same(row["correction"], right)
    assert (
        _last(tmp_path, LOOP.replace("Differentiation in time gives", "In another linkage"))["verdict"] == "untestable"
    )


@pytest.mark.parametrize(
    ("printed", "verdict"),
    [
        (r"J_2 + m c^2\frac{\omega_4^2}{\omega_2^2}", "exact"),
        (r"J_2 + m c^2\frac{\omega_4}{\omega_2}", "misprint"),
        (r"\frac12 J_2 + m c^2\frac{\omega_4^2}{\omega_2^2}", "misprint"),
    ],
)
def test_a_reduced_inertia_follows_from_the_kinetic_energy(tmp_path, printed, verdict):
    energy = r"$$ T = \frac12 m c^2\dot\theta_4^2 + \frac12 J_2\dot\theta_2^2 $$"
    row = _last(
        tmp_path, f"The kinetic energy is\n{energy}\nReduced to the crank the inertia is\n$$ J_r = {printed} $$"
    )
    assert row["verdict"] == verdict
    assert verdict == "exact" or same(row["correction"], r"J_2 + m c^2\frac{\omega_4^2}{\omega_2^2}")


@pytest.mark.parametrize(
    ("one", "two", "right"),
    [
        # the letter of half a bank angle has the other sign
        (
            r"F_1 = A(\cos(\theta+\psi) + B\cos 2(\theta+\psi))",
            r"F_2 = A(\cos(\theta-\psi) + B\cos(\theta-\psi))",
            r"A(\cos(\theta-\psi) + B\cos 2(\theta-\psi))",
        ),
        (
            r"F_1 = A(\cos(\theta+\psi) + B\cos 2(\theta+\psi))",
            r"F_2 = A(\cos(\theta-\psi) + B\cos 2(\theta-\psi))",
            None,
        ),
        # two axes
        (
            r"x_P = a\cos\alpha + p\cos(\beta+\gamma)",
            r"y_P = a\sin\alpha + p\cos(\beta+\gamma)",
            r"a\sin\alpha + p\sin(\beta+\gamma)",
        ),
        (r"x_P = a\cos\alpha + p\cos(\beta+\gamma)", r"y_P = a\sin\alpha + p\sin(\beta+\gamma)", None),
        (
            r"F_x = A\cos\psi\cos 2\psi\cos 2\theta",
            r"F_y = A\sin\psi\sin 2\psi\sin\theta",
            r"A\sin\psi\sin 2\psi\sin 2\theta",
        ),
        # in space, of a share that is balanced, and where no angle is: no twins
        (r"x_Q = R\cos\alpha\cos\beta + a\cos\beta", r"y_Q = R\sin\alpha\cos\beta + a\cos\beta", None),
        (r"F_x = (1-\xi) m r\omega^2\cos\theta", r"F_y = \xi m r\omega^2\sin\theta", None),
        (r"N_1 = \frac14(1-u)(1-v) + c u v", r"N_2 = \frac14(1+u)(1+v) + c u v", None),
    ],
)
def test_twins_across_a_sign_and_two_axes(tmp_path, one, two, right):
    rows = blamed(judged(tmp_path, f"The parts are\n$$ {one} $$\n$$ {two} $$", "text.md"))
    assert len(rows) == (right is not None)
    assert all(same(row["correction"], right) for row in rows)


WIEBE = r"""The fuel burns by
$$ \frac{Q_b}{Q_0} = 1 - \exp\left[-a\left(\frac{\varphi-\varphi_0}{\Delta\varphi}\right)^{m+1}\right] $$
$$ \frac{dQ_b}{d\varphi} = a(m+1)\frac{Q_0}{\Delta\varphi}\left(\frac{\varphi-\varphi_0}{\Delta\varphi}\right)^{m}
   \exp\left[-a\left(\frac{\varphi-\varphi_0}{\Delta\varphi}\right)^{m+1}\right] $$"""


def test_a_share_defines_what_slopes_are_taken_of(tmp_path):
    assert _last(tmp_path, WIEBE)["verdict"] == "exact"
    row = _last(tmp_path, WIEBE.replace("^{m}", "^{m+1}"))
    assert row["verdict"] == "misprint" and row["note"].startswith("repaired by")


def test_the_rate_of_a_letter_of_the_text_has_its_sense(tmp_path):
    text = "The piston is at\n$$ x = 2 r\\cos\\varphi $$\nand at constant speed\n"
    text += "$$ \\ddot x = {} 2 r\\omega^2\\cos\\varphi $$"
    assert _last(tmp_path, text.replace("{}", "-"))["verdict"] == "exact"
    row = _last(tmp_path, text.replace("{}", ""))
    assert row["verdict"] == "misprint" and same(row["correction"], r"-2 r\omega^2\cos\varphi")


def test_a_phrase_that_ends_with_its_own_letter_names_no_other(tmp_path):
    text = "| $M$ | torque | N m |\n|---|---|---|\n| $d$ | diameter | m |\n\n"
    text += (
        r"The stress of a shaft with the inner diameter $d_i$ is"
        + "\n"
        + r"$$ \tau = \frac{16 M d}{\pi(d^4 - d_i^4)} $$"
    )
    assert blamed(judged(tmp_path, text, "text.md")) == []


@pytest.mark.parametrize(
    ("force", "printed", "verdict"),
    [
        ("piston force", r"F r\sin\theta", "exact"),
        ("piston force", r"-F r\sin\theta", "exact"),
        ("piston force", r"F r\cos\theta", "misprint"),
        ("friction force", r"F r\cos\theta", "units agree"),  # of another way
    ],
)
def test_a_torque_does_the_work_of_the_force_on_the_piston(tmp_path, force, printed, verdict):
    text = f"| $F$ | {force} | N |\n|---|---|---|\n| $r$ | crank radius | m |\n\nThe yoke is at\n"
    text += f"$$ x = r(1 - \\cos\\theta) $$\n\nand the torque on the crank is\n$$ M = {printed} $$"
    row = _last(tmp_path, text)
    assert row["verdict"] == verdict
    assert verdict != "misprint" or same(row["correction"], r"F r\sin\theta")


def test_a_frequency_has_the_coefficients_of_its_equation_of_motion(tmp_path):
    text = "The valve moves by\n$$ m_v\\ddot y + k_v y = F $$\nwith the frequency\n$$ \\omega_v = \\sqrt{{{}}} $$"
    assert _last(tmp_path, text.format(r"\frac{k_v}{m_v}"))["verdict"] == "exact"
    row = _last(tmp_path, text.format(r"\frac{m_v}{k_v}"))
    assert row["verdict"] == "misprint" and same(row["correction"], r"\sqrt{\frac{k_v}{m_v}}")
    # with other letters it may be another thing
    assert _last(tmp_path, text.format(r"\frac{m_v}{k_s}"))["verdict"] == "definition"


def test_omega_beside_a_dotted_angle_is_the_constant_speed(tmp_path):
    text = (
        "| $\\omega$ | angular velocity of the crank | rad/s |\n|---|---|---|\n| $m$ | mass | kg |\n\n"
        "$$ x = 2 e\\cos\\varphi $$\n\n$$ \\ddot x = -2 e\\omega^2\\{} $$\n\n"
        "$$ J\\ddot\\varphi = M - k\\dot\\varphi $$\n"
    )
    assert judged(tmp_path, text.replace("\\{}", "\\cos\\varphi"), "text.md")[1]["verdict"] == "exact"
    row = judged(tmp_path, text.replace("\\{}", "\\sin\\varphi"), "text.md")[1]
    assert row["verdict"] == "misprint" and same(row["correction"], r"-2 e\omega^2\cos\varphi")


def test_a_theory_says_what_it_is_not_of(tmp_path):
    text = (
        "{}The volume is\n$$ V = V_c + 2\\frac{{\\pi D^2}}{{4}} s $$\nwith the bore $D$, the clearance volume $V_c$\n"
    )
    text += "and the piston displacement $s$."
    assert len(blamed(judged(tmp_path, text.format(""), "text.md"))) == 1
    assert blamed(judged(tmp_path, text.format("Both pistons are opposed. "), "text.md")) == []


def test_a_theory_may_be_of_texts_with_a_word_of_its_own(tmp_path):
    """Two rods of a rodless mechanism have together an energy that does not swing."""
    text = "{} mechanism has the crank radius $r$ and turns with the angular velocity $\\omega$. "
    text += "With the mass $m$ of a rod the energy of both rods is\n$$ E = m r^2\\omega^2 $$"
    (row,) = blamed(judged(tmp_path, text.format("A rodless"), "text.md"))
    assert row["verdict"] == "misprint" and same(row["correction"], r"2 m r^2\omega^2")
    assert blamed(judged(tmp_path, text.format("A"), "text.md")) == []


CHAIN = r"""The shaft vibrates freely,
$$ J_1\ddot\vartheta_1 + c_1(\vartheta_1 - \vartheta_2) = 0 $$
$$ J_2\ddot\vartheta_2 + c_1(\vartheta_2 - \vartheta_1) + c_2(\vartheta_2 - \vartheta_3) = 0 $$
$$ J_3\ddot\vartheta_3 + c_2(\vartheta_3 - \vartheta_2) = 0 $$"""


@pytest.mark.parametrize(
    ("printed", "instead", "line"),
    [
        (r"c_2(\vartheta_3 - \vartheta_2)", r"c_2(\vartheta_2 - \vartheta_3)", 4),
        (r"+ c_1(\vartheta_1 -", r"- c_1(\vartheta_1 -", 2),
        (r"+ c_2(\vartheta_2 - \vartheta_3)", r"- c_2(\vartheta_2 - \vartheta_3)", 3),
        # divided by its inertia, and of two springs: nothing can be told
        (r"J_1\ddot\vartheta_1 + c_1(", r"\ddot\vartheta_1 + \frac{c_1}{J_1}(", None),
        (r"c_2(\vartheta_3 - \vartheta_2)", r"c_3(\vartheta_3 - \vartheta_2)", None),
    ],
)
def test_what_a_spring_does_to_one_disc_it_does_to_the_other(tmp_path, printed, instead, line):
    assert is_told(tmp_path, CHAIN, CHAIN.replace(printed, instead), line)


def test_of_a_chain_the_earlier_form_may_be_the_wrong_one(tmp_path):
    text = "With\n$$ t = \\frac{J\\Omega}{M} $$\nthe heat is\n"
    text += "$$ W = \\frac{1}{2} J\\Omega{} = \\frac{1}{2} M\\Omega t $$"
    assert _last(tmp_path, text.replace("{}", "^2"))["verdict"] == "exact"
    row = _last(tmp_path, text.replace("{}", ""))
    assert row["verdict"] == "misprint" and same(row["correction"], r"\frac{1}{2} J\Omega^2")


def test_a_dotted_letter_is_none_with_an_index(tmp_path):
    text = (
        "With the kinetic energy $E = \\frac12 J\\Omega^2$\n\n$$ \\dot E = P $$\n\n| $P$ | power | W |\n|---|---|---|\n"
    )
    text += "| $E$ | energy | J |\n"
    assert blamed(judged(tmp_path, text, "text.md")) == []


def test_a_rate_in_time_takes_time_itself(tmp_path):
    text = "It swings by\n$$ r = A e^{-q t}\\sin(w t) $$\nThe derivative is\n$$ \\dot r = w A e^{-q t}\\cos(w t){} $$"
    assert _last(tmp_path, text.replace("{}", r" - q A e^{-q t}\sin(w t)"))["verdict"] == "exact"
    assert blamed(judged(tmp_path, text.replace("{}", ""), "text.md")) == []  # a term is left out, as weak damping lets


def test_an_equation_of_mathematics_has_no_seconds(tmp_path):
    text = "The angle of\n$$ z = \\sin y $$\nobeys\n$$ \\frac{dy}{dt} = -2 y t $$"
    assert blamed(judged(tmp_path, text, "text.md")) == []
    # a mass has a unit
    text = "| $m$ | mass | kg |\n|---|---|---|\n| $q$ | mass flow | kg/s |\n\n$$ q = m t $$"
    assert len(blamed(judged(tmp_path, text, "text.md"))) == 1


CRANK = r"""| $\varphi$ | crank angle | rad |
|---|---|---|
| $\beta$ | angle of the rod | rad |
| $\omega$ | angular velocity of the crank | rad/s |

The crosshead is loaded by $F$, and the rod carries
$$ S = \frac{F}{\cos\beta} $$
The tangential force is
$$ T = S\sin(\varphi+\beta) $$
the radial force
$$ K = S\cos(\varphi+\beta) $$
and the torque
$$ M = T r = F r\frac{\sin(\varphi+\beta)}{\cos\beta} $$"""


def test_a_slip_is_told_where_it_stands_and_not_where_it_leads(tmp_path):
    assert blamed(judged(tmp_path, CRANK, "text.md")) == []
    rows = judged(tmp_path, CRANK.replace(r"\frac{F}{\cos\beta}", r"F\cos\beta"), "text.md")
    assert blamed(rows) == [rows[0]] and rows[3]["verdict"] == "exact"
    assert same(rows[0]["correction"], r"\frac{F}{\cos\beta}") and "as corrected" in rows[3]["note"]
    # where one equation alone misses its words, it is that one
    alone = CRANK.replace(r"\frac{F}{\cos\beta}", r"F\cos\beta").partition("the radial force")[0]
    alone = alone.replace("the rod carries", "with it")
    (row,) = blamed(judged(tmp_path, alone, "text.md"))
    assert row["equation"] == judged(tmp_path, alone, "text.md")[-1]["equation"]


def test_turns_a_minute_and_the_angular_speed_of_the_crank_are_one_thing(tmp_path):
    text = "| $\\omega$ | angular velocity of the crank | rad/s |\n|---|---|---|\n| $M$ | torque | N m |\n\n"
    text += "$$ x = r\\cos\\varphi $$\n\n$$ v = -r\\omega\\sin\\varphi $$\n\nWith the speed $n$ in 1/min the power is\n"
    text += "$$ P = M\\omega = \\frac{\\pi n M}{30} $$"
    assert _last(tmp_path, text)["verdict"] == "exact"
    row = _last(tmp_path, text.replace("{30}", "{60}"))
    assert row["verdict"] == "misprint" and same(row["correction"], r"\frac{\pi n M}{30}")


def test_cross_coupled_stiffness_of_a_bearing_is_no_spring(tmp_path):
    text = "The rotor moves by\n$$ m\\ddot x + k x + q y = 0 $$\n$$ m\\ddot y + k y - q x = 0 $$"
    assert blamed(judged(tmp_path, text, "text.md")) == []


@pytest.mark.parametrize(
    ("words", "printed"),
    [
        ("Without the rod the torque is", r"F r\sin\varphi"),
        ("With a long rod the torque is nearly", r"F r(\sin\varphi + \frac{\lambda}{2}\sin 2\varphi)"),
        ("On the second crank, 90 degrees ahead, the gas gives the torque", r"F r\cos\varphi"),
        ("The torque of the weight of the crank is", r"W r\cos\varphi"),
    ],
)
def test_torques_that_are_cut_short_or_of_another_crank_are_left_in_peace(tmp_path, words, printed):
    text = (
        "| $F$ | gas force | N |\n|---|---|---|\n| $r$ | crank radius | m |\n| $\\lambda$ | rod ratio $r/l$ | - |\n"
        "| $l$ | rod length | m |\n\nThe piston moves by\n"
        f"$$ x = r(1-\\cos\\varphi) + l(1-\\sqrt{{1-\\lambda^2\\sin^2\\varphi}}) $$\n\n{words}\n$$ M = {printed} $$"
    )
    assert blamed(judged(tmp_path, text, "text.md")) == []


def test_an_exponent_is_no_speed_in_turns_a_minute(tmp_path):
    text = (
        "| $n$ | engine speed | rpm |\n|---|---|---|\n| $M$ | torque | N m |\n| $\\omega$ | angular speed | rad/s |\n\n"
    )
    text += "$$ P = M\\omega = \\frac{\\pi n M}{30} $$\n\n$$ p = p_0 z^n $$"
    assert blamed(judged(tmp_path, text, "text.md")) == []


RATE = r"r\omega\left(\sin\alpha + \frac{\lambda\sin\alpha\cos\alpha}{\sqrt{1-\lambda^2\sin^2\alpha}}\right)"


@pytest.mark.parametrize(
    ("printed", "verdict"),
    [(RATE, "exact"), (f"-{RATE}", "convention"), (RATE.replace("+", "-"), "misprint")],
)
def test_the_speed_of_a_piston_is_the_rate_of_its_way(tmp_path, printed, verdict):
    text = "With $\\lambda = r/l$ and the angular velocity $\\omega$ the exhaust piston is at\n"
    text += "$$ x_e = r(1-\\cos\\alpha) + l(1-\\sqrt{1-\\lambda^2\\sin^2\\alpha}) $$\n\nand has the speed\n"
    row = _last(tmp_path, f"{text}$$ v_e = {printed} $$")
    assert row["verdict"] == verdict
    assert verdict != "misprint" or same(row["correction"], RATE)


def test_a_word_that_corrects_a_formula_says_more_than_its_units(tmp_path):
    text = "| $\\sigma$ | bending stress | Pa |\n|---|---|---|\n| $\\tau$ | shear stress | Pa |\n\n"
    row = _last(tmp_path, text + "The equivalent stress is\n" + r"$$ \sigma_v = \sqrt{\sigma^2 + 3\tau} $$")
    assert row["verdict"] == "misprint" and same(row["correction"], r"\sqrt{\sigma^2 + 3\tau^2}")


def test_a_diameter_before_a_letter_is_no_differential(tmp_path):
    text = "The pin of diameter $d$ and width $b$ bears the force $F$ with the specific load\n"
    assert _last(tmp_path, text + r"$$ p = \frac{F}{d b} $$")["verdict"] == "exact"
    row = _last(tmp_path, text + r"$$ p = \frac{F}{\pi d b} $$")
    assert row["verdict"] == "misprint" and same(row["correction"], r"\frac{F}{d b}")


@pytest.mark.parametrize(
    ("right", "read"),
    [(r"U_{s}(0)\left(1 + \frac{z}{d}\right)", False), (r"U_s\cos(0) + z", True), (r"U_s(1 + z)", True)],
)
def test_a_value_at_nought_is_no_product(tmp_path, right, read):
    assert _last(tmp_path, f"The current is\n$$ U = {right} $$")["read"] is read
