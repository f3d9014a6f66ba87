"""Text to tree and back; text is never executed, and what is not arithmetic is refused in one line."""

import ast
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mechsym.audit.read import tree as trees
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.reader import letter_pairs, read, read_expression, write
from mechsym.audit.read.spelling import to_latex, to_python
from mechsym.errors import BadInput

KNOWN = (
    "r1 r2 l1 l2 m1 m2 I01 IC2 phi phid phidd g F M_r lam psi r l x dx_dphi d2x_dphi2 phi0 phi2 x0dd phi0dd P_jx"
).split()

READ = [
    (r"\sin\varphi\left(1+\lambda\right)", "sin(phi)*(1 + lam)"),
    (r"I_{C2}\lambda^2\cos^2\varphi", "IC2*lam**2*cos(phi)**2"),
    (r"\frac12 m_2\dot\varphi^2", "1/2*m2*phid**2"),
    (r"\frac{1}{2} m_{2} \dot{\varphi}^{2}", "1/2*m2*phid**2"),
    (r"\tfrac{\lambda}{2}\sin 2\varphi", "lam/2*sin(2*phi)"),
    (r"\sin^{-1}\left(\lambda\sin\varphi\right)", "asin(lam*sin(phi))"),
    (r"\sin(\varphi+\psi)/\cos\psi", "sin(phi + psi)/cos(psi)"),
    (r"\sin[\varphi]^2", "sin(phi)**2"),
    (r"\sqrt{1-\lambda^2\sin^2\varphi}", "sqrt(1 - lam**2*sin(phi)**2)"),
    (r"\sqrt[3]{r}", "r**(1/3)"),
    (r"\frac{dx}{d\varphi} F", "dx_dphi*F"),
    (r"\frac{d^2x}{d\varphi^2}", "d2x_dphi2"),
    (r"\ddot\varphi_0 + \ddot{\varphi}_0", "phi0dd + phi0dd"),
    (r"0{,}25\lambda^2", "0.25*lam**2"),
    (r"-\lambda \cdot 2 \times r", "-lam*2*r"),
    (r"\operatorname{tg}\psi", "tan(psi)"),
    (r"\left|\cos\varphi\right|", "abs(cos(phi))"),
    (r"\lambda |l_1| F", "lam*abs(l1)*F"),
    (r"|r_1| |r_2| (l - |l_1|)", "abs(r1)*abs(r2)*(l - abs(l1))"),
    (r"\lambda/2\sin2\varphi", "lam/2*sin(2*phi)"),
    (r"\sin\varphi\cos\varphi", "sin(phi)*cos(phi)"),
    (r"\cos\varphi\cdot l_2", "cos(phi)*l2"),
    (r"\sin\frac{\varphi}{2}", "sin(phi/2)"),
    (r"\sin\varphi/\cos\psi", "sin(phi)/cos(psi)"),
    (r"\sum P_{jx}^2", "sum(P_jx**2)"),
    ("r*sin(φ) + lambda^2", "r*sin(phi) + lam**2"),
    ("r·cos(φ0)", "r*cos(phi0)"),
    ("I = +Mr*arcsin(lam)", "M_r*asin(lam)"),
    ("2*x0dd - -3", "2*x0dd - -3"),
    ("2 x r x (l + 1)", "2*r*(l + 1)"),
    (r"{{\sin }^2}\varphi + {\cos}^2\varphi", "sin(phi)**2 + cos(phi)**2"),
    (r"\mathrm{cos}\frac{\mathrm{\pi \varphi }}{2}", "cos(pi*phi/2)"),
    ("acosd(lam)", "acos(lam)*180/pi"),
]

REFUSED = [
    ("", "empty"), ("   ", "empty"), ("q + 1", "unknown letter 'q'"), ("r1 q2", "unknown letter 'q2'"),
    ("2q + 1", "unknown letter 'q'"), ("__import__('os').system('true')", "not a known function"),
    ("r1.__class__", "not arithmetic"), ("lambda x: x", "cannot be read"), ("r1 if g else r2", "not arithmetic"),
    ("r1 @ r2", "operators are"), ("r1 // r2", "operators are"), ("r1 == r2",
    "a condition alone"),
    ("~r1", "only the signs"), ("'a'", "not a number"), ("True", "not a number"), ("1j", "not a number"),
    ("1e999", "not a number"), ("f(r1)", "not a known function"), ("sin()", "one argument"), ("sin(r1, r2)",
    "one argument"),
    ("sin(x=r1)", "cannot be read"), ("sin(*r1)", "not arithmetic"), ("(x := 3)", "cannot be read"),
    ("r1 = r2 = g", "more than one equals sign"), ("= r1", "empty"),
    ("x = 0", "right side is 0"), ("r1 =", "empty"), ("9" * 5000, "cannot be read"), ("r" * 7000, "at most 6000"),
    ("(" * 90 + "r1" + ")" * 89, "cannot be read"), ("-" * 3000 + "r1", "nested"), ("1+" * 2500 + "1",
    "nested more"),
    ("2**" * 1500 + "2", "nested"), (r"\sin\varphi^2", "does the power belong to the argument"), (r"r_1/g m_{2}",
    "where the divisor ends"),
    (r"\cos\varphi l_2", "does l belong"), (r"\sin\varphi/2", "does /2 belong"),
    (r"\sin\varphi\frac{1}{2}", "belong to the argument"), (r"\int F dx", r"'\\\\int' is not read"),
    (r"\varphi'", "a prime makes another letter"), (r"\sin", "no argument"),
    (r"\frac{1}", "the formula ends"),
    (r"\frac{1}{2", "missing"), ("\\", "not read"), ("{" * 2000, "nested more"), ("\\frac" * 1000, "nested more"),
    ("2^{" * 400, "nested more"), ("x_{" * 500, "closing brace"), ("\\mathrm{" * 50, "missing"),
    (r"r\cdot", "the formula ends"),
    (r"\begin{equation} r \end{equation}", "not read"), ("$r$ $q$", "unknown letter"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "meaning"), READ, ids=[t for t, _ in READ])
def test_reads_what_authors_write(text, meaning):
    assert to_python(read(text, KNOWN).tree) == meaning


@pytest.mark.parametrize(("text", "reason"), REFUSED, ids=[t[:30] for t, _ in REFUSED])
def test_refuses_the_rest_in_one_line(text, reason):
    with pytest.raises(BadInput, match=reason if "\\\\" in reason else re.escape(reason)) as refused:
        read(text, KNOWN)
    assert "\n" not in str(refused.value)


def test_unknown_letters_come_with_the_known_ones():
    with pytest.raises(BadInput, match="letters are r1, r2, l1"):
        read("q", KNOWN)


def test_ambiguous_letters_are_asked_about():
    with pytest.raises(BadInput, match="may mean M_r or Mr_"):
        read_expression("Mr", ["M_r", "Mr_"])


def test_trailing_zero_is_noted_and_left_out():
    formula = read("x = r*sin(phi) = 0", KNOWN)
    assert to_python(formula.tree) == "r*sin(phi)" and "= 0" in formula.note


def test_authors_letters_hide_ours_and_print_as_written():
    formula = read(r"\ell\,\sin\varphi".replace(r"\ell", "R"), KNOWN, {"R": "r1 + r2"})
    assert to_python(formula.tree) == "R*sin(phi)"
    formula = read(r"R_{1}\sin\varphi", KNOWN, {"R_1": "r1 + r2"})
    assert write(formula) == r"R_{1} \sin \varphi"


def test_a_rate_of_an_authors_angle_is_that_of_the_coordinate():
    formula = read(r"r\frac{d\theta}{dt} + \frac{d^2\theta}{dt^2}", KNOWN, {r"\theta": "phi"})
    assert {k: to_python(v) for k, v in formula.letters.items()} == {
        "theta": "phi", "dtheta_dt": "phid", "d2theta_dt2": "phidd",
    }  # fmt: skip


@pytest.mark.parametrize("text", [r"\frac{P'}{\ell}", "P'/ℓ"])
def test_a_prime_and_a_script_letter_are_letters(text):
    assert to_python(read(text, KNOWN, {"P'": "F", "ℓ": "l1"}).tree) == "Pprime/ell"


def test_a_cross_beside_a_letter_x_is_said():
    assert "times sign" in read("2 x r", KNOWN).note
    assert not read("2 x r", ["r"]).note and not read("2*x*r", KNOWN).note


def test_letter_pairs():
    assert letter_pairs("R=r1+r2, L = l1+l2;") == {"R": "r1+r2", "L": "l1+l2"}
    for text in ("R", "R=", "=r1"):
        with pytest.raises(BadInput, match="LETTER=EXPRESSION"):
            letter_pairs(text)


NAMES = st.sampled_from(["r", "lam", "phi", "M_r", "IC2"]).map(trees.name)
NUMBERS = st.one_of(
    st.integers(0, 60).map(trees.number), st.sampled_from([0.25, 0.5, 1e-6]).map(lambda v: ast.Constant(v))
)


def bigger(inner):
    operators = st.sampled_from([ast.Add, ast.Sub, ast.Mult, ast.Div])
    return st.one_of(
        st.builds(trees.binary, operators, inner, inner),
        st.builds(lambda base, power: trees.binary(ast.Pow, base, trees.number(power)), inner, st.integers(2, 4)),
        inner.map(trees.negative),
        st.builds(trees.call, st.sampled_from(["sin", "cos", "sqrt", "exp", "abs", "asin"]), inner),
    )


TREES = st.recursive(st.one_of(NAMES, NUMBERS), bigger, max_leaves=12)
VALUES = {"r": 0.7, "lam": 0.31, "phi": 1.1, "M_r": 3.7, "IC2": 0.9, "pi": 3.14159}


@settings(deadline=None, derandomize=True, max_examples=200)
@given(TREES)
def test_printed_text_reads_back_to_the_same_value(tree):
    with np.errstate(all="ignore"):
        value = evaluate(tree, VALUES, FLOATS)
        for text in (to_python(tree), f"${to_latex(tree, {})}$"):
            back = evaluate(read_expression(text, [*VALUES])[0], VALUES, FLOATS)
            assert np.isclose(back, value, rtol=1e-12, equal_nan=True), text


PIECES = [
    "r1", "phi", "sin", "(", ")", "+", "-", "*", "/", "^", "2", "0.5", " ", "=", "\\frac", "{", "}", "\\sin",
    "\\varphi", "_", "\\left(", "\\right)", "|", "&", "\\\\", "\\begin{cases}", "\\end{cases}", "<", ",", "np.",
    "atan2", "piecewise", "\\sum", "\\dot", "\\vec", "²", "φ", "O(\\lambda^3)", "\\tag{3}", "\\approx", "if", "[",
]  # fmt: skip


@settings(deadline=None, max_examples=300)
@given(st.lists(st.sampled_from(PIECES), max_size=14).map("".join))
def test_whatever_is_typed_is_read_or_refused_in_one_line(text):
    try:
        read(text, KNOWN)
    except BadInput as refused:
        assert "\n" not in str(refused)


@pytest.mark.parametrize(
    ("text", "place", "way_out"),
    [
        ("r1*/2", "near 'r1*/2'", "brackets in pairs"),
        ("r1*(2 + r2", "near 'r1*(2 + r", "brackets in pairs"),
        ("r1 + r2 // 3", "'r2 // 3'", "operators are"),
        ("r1 and r2", "'r1 and r2'", "use + - *"),
        ("r1 < r2", "'r1 < r2'", "piecewise(a < b"),
        ("pow(r1)", "pow takes 2", "write pow(a, b)"),
        ("sin(r1, r2)", "sin takes one", "write sin(a)"),
        ("r1 + €", "'€'", "write letters"),
    ],
)
def test_a_refusal_says_where_and_what_to_write(text, place, way_out):
    with pytest.raises(BadInput) as refused:
        read(text, ["r1", "r2"])
    assert place in str(refused.value)
    assert way_out in str(refused.value)
