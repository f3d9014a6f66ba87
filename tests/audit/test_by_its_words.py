r"""What a sentence, the ends of a turn, rest and the equations of motion make of a formula: right and with one slip."""

import pytest
from audited import blamed, judged, same

from mechsym.audit.read.called import owned

TURN = "The crank of the radius $r$ in m turns by $\\varphi$; the piston has moved by\n$$ x = r(1 - \\cos\\varphi) $$\n"
POTENTIAL = (
    "An arm of the mass $m$ in kg with its centre at the distance $s$ in m stands at $q$ and turns with $\\dot q$.\n"
    "The kinetic energy is\n$$ T = \\frac12 J\\dot q^2 $$\nand the potential energy\n$$ V = m g s\\sin q $$\n"
)
DISCS = (
    "The discs move by\n$$ J_1\\ddot\\varphi_1 + c(\\varphi_1 - \\varphi_2) = 0 $$\n"
    "$$ J_2\\ddot\\varphi_2 - c(\\varphi_1 - \\varphi_2) = 0 $$\nwith frequencies that solve\n"
)


@pytest.mark.parametrize(
    ("before", "left", "right", "wrong"),
    [
        ("A gear without losses has\n", "T_2", r"T_1\frac{\omega_1}{\omega_2}", r"T_1\frac{\omega_2}{\omega_1}"),
        ("The shaft turns at the speed $n$ with\n", r"\omega", r"\frac{\pi n}{30}", r"\frac{\pi n}{60}"),
        (TURN + "and its stroke is\n", "h", "2 r", "r"),
        (
            TURN + "The volume of the cylinder is, with the clearance volume $V_c$ and the area $A$,\n"
            "$$ V = V_c + A x $$\nand the compression ratio\n",
            r"\varepsilon", r"1 + \frac{2 A r}{V_c}", r"1 + \frac{A r}{V_c}",
        ),
        (POTENTIAL + "At rest the motor has to hold\n", r"\tau", r"m g s\cos q", r"m g s\sin q"),
        (DISCS, r"\omega^4 - \omega^2\left(\frac{c}{J_1} + \frac{c}{J_2}\right)", "0", None),
        (
            "The speeds are $\\omega_a$ and $\\omega_b$, the mean speed is\n",
            r"\bar\omega", r"\frac{\omega_{max} + \omega_{min}}{2}", None,
        ),
    ],
)  # fmt: skip
def test_what_words_ask_for_is_right_or_one_slip_away(before, left, right, wrong, tmp_path):
    row = judged(tmp_path, f"{before}$$ {left} = {right} $$", "text.md")[-1]
    assert row["verdict"] == "exact", row
    if wrong is not None:
        row = judged(tmp_path, f"{before}$$ {left} = {wrong} $$", "text.md")[-1]
        assert row["verdict"] == "misprint" and same(row["correction"], right), row


def test_a_determinant_tells_a_frequency_that_is_wrong(tmp_path):
    right, wrong = (rf"\omega^4 - \omega^2\left(\frac{{c}}{{J_1}} {sign} \frac{{c}}{{J_2}}\right)" for sign in "+-")
    row = judged(tmp_path, f"{DISCS}$$ {wrong} = 0 $$", "text.md")[-1]
    assert row["verdict"] == "misprint" and same(row["correction"], right)


def test_letters_of_a_plain_sentence_and_of_one_head_are_known(tmp_path):
    plain = "A disc has the mass m and the radius r.\nThe moment of inertia of the disc is\n$$ I = m r^2 $$"
    row = judged(tmp_path, plain, "text.txt")[-1]
    assert row["verdict"] == "misprint" and same(row["correction"], r"\frac12 m r^2")
    head = "The lengths are $a$ (crank) and $b$ (rod). The bar of mass $m$ has about its end\n"
    text = head + "The moment of inertia about its end is\n$$ I = \\frac{m b^2}{12} $$"
    row = judged(tmp_path, text, "text.md")[-1]
    assert row["verdict"] == "misprint" and same(row["correction"], r"\frac{m b^2}{3}")


def test_another_case_of_a_letter_is_none_of_its_slips(tmp_path):
    text = "Type 1: two diodes\n$$ V = U - 2 v $$\n\nType 2: one diode\n$$ V = U - v $$"
    assert blamed(judged(tmp_path, text, "text.md")) == []


SECTION = "The polar section modulus of the shaft of diameter $d$ in m is\n$$ W = \\frac{\\pi d^3}{%s} $$"
JOURNAL = (
    "With the eccentricity $e$ in m and the radial clearance $c$ in m\n$$ \\epsilon = %s $$\n"
    "is the relative eccentricity of the journal in its bearing.\n"
)
GEAR = (
    "A gear with the gear ratio $i = %s$ moves the moment of inertia $J_2$ to the first shaft, where the reduced\n"
    "inertia is\n$$ J_{red} = \\frac{J_2}{i^2} $$"
)

PUMP = (
    "A pump of the displacement $V_g$ in m^3 and the efficiency $\\eta$ at the pressure $p$ needs a torque\n"
    "$$ M = %s $$"
)


@pytest.mark.parametrize(
    ("text", "right", "wrong", "verdicts"),
    [
        (SECTION, "16", "32", ("exact", "misprint")),  # which is that in bending
        (JOURNAL, r"\frac{e}{c}", r"\frac{c}{e}", ("exact", "misprint")),  # named behind the equation
        (
            GEAR,
            r"\omega_1/\omega_2",
            r"\omega_2/\omega_1",
            ("exact", "units agree"),
        ),  # counted the other way round by its text
        # of what is needed a word tells that it is more than what is given, and not how much that is
        (PUMP, r"\frac{V_g p}{2\pi\eta}", r"\frac{V_g p}{2\pi}\eta", ("units agree", "misprint")),
    ],
)
def test_of_two_forms_that_are_alike_one_is_right(text, right, wrong, verdicts, tmp_path):
    rows = [judged(tmp_path, text % form, "text.md")[-1] for form in (right, wrong)]
    assert [row["verdict"] for row in rows] == [*verdicts]


def test_a_letter_is_called_by_what_gives_or_takes_it():
    text = "The sun receives the torque $T_1$, and the shaft turns at the speed $n$. The stroke is $s$."
    assert dict(owned(text)) == {"T_1": "sun torque", "n": "shaft speed"}


@pytest.mark.parametrize(
    ("engine", "torque", "right"),
    [
        ("a four-stroke engine", r"\frac{p_e V_H}{4\pi}", ""),
        ("a four-stroke engine", r"\frac{p_e V_H}{2\pi}", r"\frac{p_e V_H}{4\pi}"),
        ("a two-stroke engine", r"\frac{p_e V_H}{2\pi}", ""),
    ],
)
def test_an_engine_has_two_strokes_or_four(tmp_path, engine, torque, right):
    text = (
        f"Of {engine} with the total displacement $V_H$ at $n$ revolutions per second and the brake mean effective "
        f"pressure $p_e$ the engine torque is $$ M = {torque} $$"
    )
    (row,) = judged(tmp_path, text, "text.md")
    assert same(row["correction"], right) if right else row["verdict"] == "exact"


def test_a_letter_is_what_quantities_give_that_hang_on_it(tmp_path):
    text = (
        "A four-stroke engine of $z$ cylinders is to give the effective power $P_e$ at $n$ revolutions per second. At "
        "the brake mean effective pressure $p_e$ the swept volume of a cylinder is $$ V_h = %s $$"
    )
    (right,) = judged(tmp_path, text % r"\frac{2 P_e}{z p_e n}", "text.md")
    assert right["verdict"] == "exact" and right["claim"] == "engine_figures.V_d"
    (wrong,) = judged(tmp_path, text % r"\frac{P_e}{z p_e n}", "text.md")
    assert same(wrong["correction"], r"\frac{2 P_e}{z p_e n}")
