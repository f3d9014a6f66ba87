"""What the equations and the words of one text say of each other: twins, what is solved for, tables, spellings."""

import ast

import pytest
from audited import blamed, is_told, judged, same

from mechsym.audit.judge.kinds import kinds_of
from mechsym.audit.judge.misfits import odd
from mechsym.audit.judge.table_slips import table_slips
from mechsym.audit.read.lagrange import lagrange_equation
from mechsym.audit.read.said import read_text_whole
from mechsym.audit.read.tree import with_one_number


def test_an_angular_speed_in_turns_a_minute_that_nothing_converts_is_a_slip_of_the_table():
    """Called so and used as rad/s; one that is converted, or is called a speed of rotation, is none."""
    text = """| symbol | meaning | unit |
|---|---|---|
| $\\omega$ | NAME | 1/min |
| $r$ | radius | m |

$$ v = r \\omega $$
$$ a = r \\omega^2 SIXTY $$
"""

    def slips(called, converts=""):
        return _slips(text.replace("NAME", called).replace("SIXTY", converts))

    assert slips("angular velocity of the disc") == [("omega", "rpm", "rad/s")]
    assert slips("angular velocity of the disc", r"\frac{\pi^2}{30^2}") == []
    assert slips("speed of rotation") == []


def _slips(text):
    paper = read_text_whole(text)
    kinds = kinds_of(paper)
    return [(s.letter, s.printed, s.wanted) for s in table_slips(paper, kinds, odd(kinds, paper.said)[0])[0]]


def test_the_power_of_a_two_stroke_engine_is_none_of_one_with_four(tmp_path):
    text = r"""\begin{tabular}{lll}
$z$ & number of cylinders & -- \\
$p_{mi}$ & mean indicated pressure & Pa \\
$V_h$ & swept volume of a cylinder & m$^3$ \\
$n$ & engine speed & 1/min \\
$P_i$ & indicated power & W \\
\end{tabular}
The indicated power of a KIND-stroke engine is
\begin{equation} P_i = z p_{mi} V_h \frac{n}{60} \end{equation}"""
    two, four = (judged(tmp_path, text.replace("KIND", kind))[0] for kind in ("two", "four"))
    assert (two["verdict"], two["matched"]) == ("exact", "engine_figures.indicated_two_stroke")
    assert four["verdict"] == "misprint" and same(four["correction"], r"z p_{mi} V_h \frac{n}{120}")


def test_what_follows_from_an_acceleration_with_dots_is_carried(tmp_path):
    text = r"""The travel is $$ x = r (1 - \cos\alpha) $$ and its acceleration at constant speed $\dot\alpha = \omega$
$$ \ddot x = r \omega^2 \sin\alpha $$ so that the inertia force
$$ F = -m \ddot x $$ becomes $$ F = -m r \omega^2 \sin\alpha $$"""
    assert [row["verdict"] for row in judged(tmp_path, text, "text.md")][-1] == "carried"
    right = text.replace(r"\sin\alpha", r"\cos\alpha")
    assert [row["verdict"] for row in judged(tmp_path, right, "text.md")][-1] == "exact"


TWINS = r"""Both pistons turn by $\theta$ and $\theta + \delta$ with $\lambda = R/L$. The torques are
$$ M_1 = F R \frac{\sin(\theta + \beta_1)}{\cos\beta_1} K_1 $$
$$ M_2 = F R \frac{\sin(\theta + \delta + \beta_2)}{\cos\beta_2} K_2 $$
$$ y_1 = A (1 - \cos\theta) + C \sin^2\theta $$
$$ y_2 = A (1 - \cos(\theta + \delta)) + C \sin^2(\theta + \delta) $$"""


@pytest.mark.parametrize(
    ("printed", "instead", "line"),
    [
        (r"{\cos\beta_2}", r"{\sin\beta_2}", 3),
        (r"\sin^2(\theta + \delta)", r"\sin^2(\theta - \delta)", 5),
        (r"+ C \sin^2(\theta + \delta)", r"- C \sin^2(\theta + \delta)", 5),
        # another model, not one slip away
        (r"A (1 - \cos(\theta + \delta)) + C", r"A (1 + \sin(\theta + \delta)) + C", None),
        (r"\delta + \beta_2)}{\cos\beta_2}", r"\delta)}{\cos\beta_2}", None),
    ],
)
def test_an_equation_is_held_against_its_twin(tmp_path, printed, instead, line):
    assert is_told(tmp_path, TWINS, TWINS.replace(printed, instead), line)


def test_numbers_of_a_correction_are_added_up():
    tree = ast.parse("a*(b - 1 + 1) + c - 2 + 3", mode="eval").body
    assert ast.unparse(with_one_number(tree)) == "a * b + c + 1"


@pytest.mark.parametrize(
    "right",
    [
        r"Q - \frac{\partial \Pi}{\partial q} - \frac{\partial \Phi}{\partial \dot q}",
        r"-\frac{\partial \Pi}{\partial q} + Q",
    ],
)
def test_a_lagrange_equation_has_terms_on_both_sides(right):
    one = lagrange_equation(
        rf"\frac{{d}}{{dt}}\frac{{\partial T}}{{\partial\dot q}} - \frac{{\partial T}}{{\partial q}} = {right}"
    )
    assert (
        one.right == "Q"
        and [(t.of, t.by, t.sign, t.timed) for t in one.terms]
        == [("T", "qd", 1, True), ("T", "q", -1, False), ("Pi", "q", 1, False), ("Phi", "qd", 1, False)][
            : len(one.terms)
        ]
    )
    assert len(one.terms) == 2 + right.count("partial") // 2


def test_both_forms_of_a_greek_letter_are_two_letters_where_a_text_has_both(tmp_path):
    both = r"""$$ \tan\vartheta = \frac{a}{b} $$ $$ y = \theta b $$ $$ z = \vartheta c $$"""
    paper = read_text_whole(both)
    assert [said.spelled[said.sides[1].left.id] for said in paper.said[1:]] == [r"\theta", r"\vartheta"]
    assert [said.sides[1].left.id for said in paper.said[1:]] == ["theta", "Vartheta"]
    one = read_text_whole(both.replace(r"y = \theta b", "y = b"))
    assert one.said[2].sides[1].left.id == "theta"


def test_slopes_tell_the_angle_of_a_text_without_sines(tmp_path):
    text = r"""The rise over the angle $\beta$ with $\theta = \varphi/\beta$ is $$ z = h (3\theta^2 - 2\theta^3) $$
$$ \frac{dz}{d\varphi} = \frac{6 h}{\beta} (\theta - \theta^2) $$
$$ \frac{d^2z}{d\varphi^2} = \frac{6 h}{\beta^2} (1 - 3\theta) $$"""
    rows = judged(tmp_path, text, "text.md")
    assert [row["verdict"] for row in rows] == ["definition", "exact", "misprint"]
    assert same(rows[2]["correction"], r"\frac{6 h}{\beta^2} (1 - 2\theta)")


def test_a_reciprocal_on_the_left_is_judged_by_words(tmp_path):
    text = r"""The reduced modulus of two bodies with the moduli $E_1$ and $E_2$ is
$$ \frac{1}{E^*} = \frac{1 - \nu_1^2}{E_1} SIGN \frac{1 - \nu_2^2}{E_2} $$"""
    (right,), (wrong,) = (judged(tmp_path, text.replace("SIGN", sign), "text.md") for sign in "+-")
    assert (right["verdict"], right["matched"]) == ("exact", "strength.E_star")
    assert wrong["verdict"] == "misprint" and same(
        wrong["correction"], text.partition("=")[2].replace("SIGN", "+").strip("$ ")
    )


def test_two_numbers_turned_over_are_turned_back(tmp_path):
    """In the place of the second of them made a fraction."""
    text = r"""The radius of the path is $$ R = \frac{(\rho^2 + s^2)^{3/2}}{\rho^2 + 2 s^2} $$
$$ R = \frac{(\rho^2 + s^2)^{2/3}}{\rho^2 + 2 s^2} $$"""
    (row,) = blamed(judged(tmp_path, text, "text.md"))
    assert row["note"] == "repaired by number: 2/3 becomes 3/2"


@pytest.mark.parametrize(
    ("words", "printed", "verdict"),
    [
        ("which gives", r"\frac{2 m g}{\rho v^2 A}", "exact"),
        ("Hence the coefficient is", r"\frac{2 m g}{\rho v^2 A}", "exact"),
        ("from which", r"\frac{m g}{\rho v^2 A}", "misprint"),
        ("so that", r"-\frac{2 m g}{\rho v^2 A}", "misprint"),
        # without a word it is what it is defined as, and of another model it is another
        ("In another flow", r"\frac{m g}{\rho v^2 A}", "units agree"),
        ("For small speeds this gives", r"\frac{m g}{\rho v^2 A}", "units agree"),
    ],
)
def test_what_an_equation_gives_is_what_the_one_before_it_is_solved_for(tmp_path, words, printed, verdict):
    text = rf"""The mass $m$, the area $A$, the density $\rho$, the speed $v$ and gravity $g$ hold
$$ m g = \frac{{1}}{{2}} C_d \rho v^2 A $$
{words}
$$ C_d = {printed} $$"""
    row = judged(tmp_path, text, "text.md")[-1]
    assert row["verdict"] in (verdict, {"units agree": "definition"}.get(verdict, verdict))
    if verdict == "misprint":
        assert same(row["correction"], r"\frac{2 m g}{\rho v^2 A}")


def test_a_theory_whose_stroke_is_another_says_nothing_of_a_volume(tmp_path):
    """Of two throws, and of four as in a mechanism without rods; the table is one of Sphinx."""
    text = """=========  ==============  ====
$r$        crank radius    m
$D$        cylinder bore   m
=========  ==============  ====

The stroke of the piston is $S = TIMES r$, the swept volume is

$$ V_h = \\frac{\\pi D^2}{4} TIMES r $$"""
    assert read_text_whole(text).named["D"].unit == "m"
    two, four = (judged(tmp_path, text.replace("TIMES", times), "text.md")[0] for times in "24")
    assert (two["verdict"], two["matched"]) == ("exact", "cylinder_volume.V_d")
    assert four["verdict"] in ("units agree", "definition")


@pytest.mark.parametrize("printed", ["+", "-"])
def test_a_slip_of_an_energy_is_told_there_and_not_in_what_follows(printed, tmp_path):
    """Both equations of motion are right, and neither follows from the energy with the other sign."""
    text = r"""The kinetic energy is $$ T = \frac{1}{2} J_1\dot\varphi_1^2 + \frac{1}{2} J_2\dot\varphi_2^2 $$ and
$$ U = \frac{1}{2} c(\varphi_1 SIGN \varphi_2)^2 $$ and Lagrange's equations become
$$ J_1\ddot\varphi_1 + c(\varphi_1 - \varphi_2) = 0 $$
$$ J_2\ddot\varphi_2 - c(\varphi_1 - \varphi_2) = 0 $$"""
    rows = judged(tmp_path, text.replace("SIGN", printed), "text.md")
    assert [row["line"] for row in blamed(rows)] == ([2] if printed == "+" else [])
    assert [row["verdict"] for row in rows[2:]] == ["exact", "exact"]
    if printed == "+":
        assert same(blamed(rows)[0]["correction"], r"\frac{1}{2} c(\varphi_1 - \varphi_2)^2")


def test_what_turns_uniformly_has_no_acceleration(tmp_path):
    text = r"""The shaft of the moment of inertia $J$ obeys
$$ J\dot\omega + c\omega^2 = M_s - M_r $$
It turns uniformly if the torque of the spring is
$$ M_s = M_r + c\omega^2 $$"""
    assert is_told(tmp_path, text, text.replace("M_r +", "M_r -"), 4)


def test_a_sum_of_forces_is_a_force(tmp_path):
    text = r"""| $F$ | gas force | N |
|---|---|---|
| $I$ | inertia force | N |
| $\psi$ | angle of the connecting rod | rad |

The side force of the piston is
$$ N = (F + I)\tan\psi $$"""
    assert is_told(tmp_path, text, text.replace("tan", "sin"), 7)
