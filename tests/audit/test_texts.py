"""Texts as people write them beside their programs: Markdown and notebooks, with formulas and words of many forms."""

import json

import pytest

from mechsym.audit.hosts.whole import check_texts, read_texts
from mechsym.audit.judge.kinds import kinds_of
from mechsym.audit.judge.kinds import text as unit_words
from mechsym.audit.read.displays import displayed
from mechsym.audit.read.nomenclature import nomenclature
from mechsym.audit.read.said import read_text_whole
from mechsym.audit.read.spelling import to_python
from mechsym.audit.verdict import FINDINGS
from mechsym.errors import BadInput

ROOT = r"\sqrt{1 - \frac{r^2 \sin^2(\omega t)}{l^2}}"
PISTON = rf"""Let the crank length be r and the rod length l. At constant speed the piston stands at
<div align='center'>

$x = l {ROOT} + r \cos(\omega t)$

</div>
Its velocity is

$\dot x = -\omega r \sin(\omega t) - \frac{{\omega r^2 \sin(\omega t) \cos(\omega t)}}{{l {ROOT}}}$
"""


def judged(tmp_path, text, name="text.md"):
    (tmp_path / name).write_text(text, encoding="utf-8")
    return check_texts(read_texts(tmp_path / name))[0]


def sides(text):
    return [[to_python(side) for side in said.sides] for said in read_text_whole(text).said if not said.inline]


def test_speed_times_time_is_an_angle(tmp_path):
    assert [row["verdict"] for row in judged(tmp_path, PISTON)] == ["exact", "exact"]


@pytest.mark.parametrize(
    ("right", "printed", "mended"),
    [
        (r"-\omega r \sin(\omega t) -", r"-r \sin(\omega t) -", "put back"),  # the speed stands in the other term
        (r"{l \sqrt", r"{\sqrt", "put back"),
        (r"\sin(\omega t) -", r"\sin(\omega t) +", "sign"),
    ],
)
def test_a_slip_beside_speed_times_time_is_told(right, printed, mended, tmp_path):
    assert PISTON.count(right) == 1
    rows = judged(tmp_path, PISTON.replace(right, printed))
    (slip,) = [row for row in rows if row["verdict"] in FINDINGS]
    assert mended in slip["note"] and r"\omega t" in slip["correction"]


def test_a_time_that_stands_alone_is_no_angle(tmp_path):
    rows = judged(tmp_path, r"$$x = v t + r \cos(\omega t)$$ and $$\dot x = v - r \omega \sin(\omega t)$$")
    assert not [row for row in rows if row["verdict"] in FINDINGS]


def test_arguments_of_a_definition_are_no_factors(tmp_path):
    text = r"""\[ t_p(R) = \frac{p R}{2 \sigma} \] \[ q(R) = \frac{g R}{3} \]
\[ D(R) = \frac{q(R)\, t_p(R)}{k} = \frac{g p R^2}{6 k \sigma} \] \[ m = \rho\,t(R) \] \[ V = \pi (R) h \]"""
    assert sides(text)[2:] == [["D", "q*tp/k", "g*p*R**2/(6*k*sigma)"], ["m", "rho*t"], ["V", "pi*R*h"]]
    assert [row["verdict"] for row in judged(tmp_path, text)][2] == "exact"


def test_words_within_an_index_stay_there():
    text = r"$$T_{\text{in,surf}} = T_\text{in} + D_{\text{cond, wall}}$$"
    assert [one.text for one in displayed(text)] == [r"T_{\text{in,surf}} = T_\text{in} + D_{\text{cond, wall}}"]
    assert sides(text) == [["Tinsurf", "Tin + Dcondwall"]]


def test_lines_of_a_display_are_equations(tmp_path):
    text = "$$\n\\Delta S = S_1 + S_2 \\\\\n\\Delta S = S_1 = m (s_2 - s_1) \\;,\n$$"
    assert sides(text) == [["DeltaS", "S1 + S2"], ["DeltaS", "S1", "m*(s2 - s1)"]]
    assert sides("$$\na = b \\\\\n  + c\n$$") == [["a", "b + c"]]
    assert not [row for row in judged(tmp_path, text) if row["verdict"] in FINDINGS]


@pytest.mark.parametrize(
    ("latex", "tree"),
    [
        (r"a = b \tanh(c)", "b*((exp(c) - exp(-c))/2/((exp(c) + exp(-c))/2))"),
        (r"a = \sec\beta", "1/cos(beta)"),
        (r"a = \log_{10} b", "log(b)/log(10)"),
        (r"a = b \cos 2\omega t", "b*cos(2*omega*t)"),
        (r"a = b \sin n\omega_1 t", "b*sin(n*omega1*t)"),
        (r"a = \mathrm{inv}\alpha + b", "tan(alpha) - alpha + b"),
        (r"a = d^2_{t,1} + \lvert b \rvert", "dt1**2 + abs(b)"),
        (r"a = \cos\alpha\prime", "cos(alphaprime)"),
    ],
)
def test_forms_of_latex(latex, tree):
    assert sides(f"$${latex}$$") == [["a", tree]]


@pytest.mark.parametrize(
    ("latex", "text", "unit", "aside"),
    [
        (r"q_0 = 0.023\ \text{W/m}^3", "q_0 = 0.023", "W/m^3", ""),
        (r"c = 8 \mbox{ parrots}", "c = 8", "", r"\mbox{ parrots}"),
        (r"v^2/2 + g h = \text{constant}", r"v^2/2 + g h = \text{constant}", "", ""),
    ],
)
def test_data_with_a_unit_are_read(latex, text, unit, aside):
    (one,) = displayed(rf"\[ {latex} \]")
    assert (one.text, one.unit, one.aside) == (text, unit, aside)
    assert all(sides(rf"\[ {latex} \]"))


def test_an_environment_within_a_display_is_none():
    assert sides("$$\n\\begin{align*}\na &= b \\\\\nc &= d\n\\end{align*}\n$$") == [["a", "b"], ["c", "d"]]
    assert sides("$$\\begin{equation} a = b \\end{equation}$$") == [["a", "b"]]


def test_what_is_said_at_rest_is_nothing_of_its_rates(tmp_path):
    """A column of liquid that stands at y = P/(rho g), and then swings about another place."""
    text = r"$$y = \frac{P}{\rho g}$$ and $$\frac{d^2y}{dt^2} + \frac{2 g}{L} y = \frac{1}{\rho L} P$$"
    assert not [row for row in judged(tmp_path, text) if row["verdict"] in FINDINGS]


def test_a_slope_has_the_unit_of_a_quotient(tmp_path):
    text = (
        "- Radius: `R` [m]\n- Arc: `s` [m]\n\n$$\\frac{1}{R} = \\frac{d\\theta}{ds}$$\n\n$$R = \\frac{d\\theta}{ds}$$"
    )
    text += r" with $$\sin\theta = 0.5$$"
    assert [row["verdict"] for row in judged(tmp_path, text)][:2] == ["units agree", "wrong"]


def test_what_holds_in_another_case_is_no_slip(tmp_path):
    text = r"""For $a + b \leq 1$ it is

$$l = m \left(1 - \frac{a b}{e f}\right)$$

and for $a + b \gt 1$ it is

$$l = m \left(1 - \frac{(1 - a)(1 - b)}{e f}\right)$$"""
    assert not [row for row in judged(tmp_path, text) if row["verdict"] in FINDINGS]


def test_a_model_with_one_letter_more_is_no_slip(tmp_path):
    text = r"$$\dot\theta = A \cos(\omega t)$$ with friction $$\dot\theta = A e^{-\lambda t} \cos(\omega t)$$"
    assert not [row for row in judged(tmp_path, text) if row["verdict"] in FINDINGS]


def test_words_of_sentences_and_lists_name_letters():
    text = r"""where \(F_t\) is the transmitted tangential force, \(b\)
the face width, \(m\) the module and \(y\) the form factor.
- Internal pressure: `p` [Pa]
- **M** = Bending torque (N*mm)
* $R$ — journal (rotor) radius
* $\varepsilon = e / c$ — eccentricity ratio
of specific heat $c$, of mass $m_1$"""
    names = nomenclature(text.replace(r"\(", " $").replace(r"\)", "$ "))
    told = {letter.strip().strip("\\"): (about.meaning, about.unit) for letter, about in names.items()}
    assert told == {
        "F_t": ("transmitted tangential force", ""), "b": ("face width", ""), "m": ("module", ""),
        "y": ("form factor", ""), "p": ("Internal pressure", "Pa"), "M": ("Bending torque", "N*mm"),
        "varepsilon": ("eccentricity ratio", ""), "m_1": ("mass", ""),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("words", "unit"),
    [
        ("where $a$ is the angular velocity of the shaft", "s^-1"),
        ("the rotor of mass $a$", "kg"),
        ("where $a$ is the mass per unit length", None),
        ("where $a$ is the internal energy", None),
        ("where $a$ is the heat of a kilogram", None),
        ("$a$ the pressure ratio", "1"),
        ("- Internal pressure: `a` [Pa]", "kg m^-1 s^-2"),
    ],
)
def test_what_a_letter_is_called_tells_its_unit(words, unit):
    kind = kinds_of(read_text_whole(f"{words}\n\n$$b = a c$$")).of("a")
    assert (None if kind is None else unit_words(kind)) == unit


def notebook(*cells, indent):
    cells = [{"cell_type": k, "metadata": {}, "source": s.splitlines(keepends=True)} for k, s in cells]
    return json.dumps({"cells": cells, "nbformat": 4}, indent=indent)


@pytest.mark.parametrize("indent", [1, None])
def test_the_words_of_a_notebook_are_a_text(indent, tmp_path):
    cells = [("code", "x = 3\n"), ("markdown", "Two forms:\n\n$$a = 2 b = 3 b$$\n"), ("code", "'$$a = b$$'\n")]
    (row,) = judged(tmp_path, notebook(*cells, indent=indent), "text.ipynb")
    assert (row["verdict"], row["printed"]) == ("misprint", "a = 2 b = 3 b")
    if indent:
        lines = (tmp_path / "text.ipynb").read_text().split("\n")
        assert "$$a = 2 b = 3 b$$" in lines[row["line"] - 1]


def test_formulas_of_a_page_of_sphinx(tmp_path):
    text = """.. math::
   :label: travel

   x = r + l

   x = l + r \\\\
   y = x

with :math:`r` the radius of the crank, and

.. math:: z = 2 y

Then ``x = 3``::

    w = 4 x
"""
    rows = judged(tmp_path, text, "page.rst")
    assert [(row["line"], row["printed"]) for row in rows] == [
        (4, "x = r + l"), (6, "x = l + r"), (7, "y = x"), (11, "z = 2 y"),
    ]  # fmt: skip
    assert rows[1]["verdict"] == "exact"


def test_a_program_in_a_page_is_no_formula(tmp_path):
    text = "```math\na = b\n```\n\n```python\ncost = '$$c = d$$'\nx = y + z\n```\n"
    assert [row["printed"] for row in judged(tmp_path, text)] == ["a = b"]
    with pytest.raises(BadInput, match="no display equation"):
        judged(tmp_path, "```\nx = y + z\n```\n\n    x = y + z\n")


def test_of_a_folder_what_cannot_be_read_is_a_row(tmp_path):
    (tmp_path / "a.ipynb").write_text("no notebook")
    with pytest.raises(BadInput, match=r"a\.ipynb: no notebook"):
        check_texts(read_texts(tmp_path))
    (tmp_path / ".hidden").mkdir()
    (tmp_path / ".hidden" / "b.md").write_text("$$a = b$$")
    rows = judged(tmp_path, "$$a = b$$", "c.md") and check_texts(read_texts(tmp_path))[0]
    assert [(row["file"].rpartition("/")[2], row["read"]) for row in rows] == [("a.ipynb", False), ("c.md", True)]


def test_lines_of_a_page_of_its_own_language_are_no_equations(tmp_path):
    page = '<div align="center">\nattrs==19.3.0\n- r = 3 m\n[![x](https://a.b/c?d=e)]\n`a = b`\n'
    with pytest.raises(BadInput, match="no display equation"):
        judged(tmp_path, page)


def test_a_number_alone_has_the_unit_behind_it(tmp_path):
    text = r"- Flow: `q` [m^3/s]\n\n$$q = q_1 - q_2 = 120 \mbox{ liters/hr}$$".replace(r"\n", "\n")
    assert not [row for row in judged(tmp_path, text) if row["verdict"] in FINDINGS]


def test_a_later_section_says_nothing_of_an_earlier_one(tmp_path):
    """A level A that is a share of the signal's, where an equation before had another A."""
    text = r"## Even\n$$s = \frac{4 x^2}{12}$$\n$$s = \frac{4 x^2 A^2}{12}$$\n## Waves\n$$A = \frac{\sqrt{s}}{x}$$"
    assert not [row for row in judged(tmp_path, text.replace(r"\n", "\n")) if row["verdict"] in FINDINGS]


@pytest.mark.parametrize("latex", [r"a = E\{b\} c", r"a = b e^{\mathrm{j} c}", r"F = \mathcal{L}\{f\}"])
def test_operators_and_complex_numbers_are_not_read(latex, tmp_path):
    (row,) = judged(tmp_path, f"$${latex}$$")
    assert not row["read"] and "complex numbers and operators" in row["note"]


@pytest.mark.parametrize("latex", [r"a \sin b = c - d", r"F + e = c = F_1 - d"])
def test_an_equation_is_not_held_against_what_it_was_solved_for(latex, tmp_path):
    assert [row["verdict"] for row in judged(tmp_path, f"$${latex}$$")] == ["definition"]


def test_steps_of_a_cycle_are_no_squares():
    assert sides("$$Q_1^2 = a$$ $$Q_{2}^{3} = b$$ $$Q_4^1 = c$$") == [["Q12", "a"], ["Q23", "b"], ["Q41", "c"]]
    assert sides("$$E = Q_1^2 + Q_2^2$$") == [["E", "Q1**2 + Q2**2"]]
    assert sides("$$Q_1^2 = a$$") == [["Q1**2", "a"]]
    assert sides("$$λ = r/l$$ $$a = λ b$$") == [["lam", "r/l"], ["a", "lam*b"]]


def test_a_raised_circle_is_a_state_or_degrees():
    assert sides(r"$$g_i^{\circ} = h^\circ - T s_{i,0}^\circ$$") == [["gio", "ho - T*si0o"]]
    assert sides(r"$$a = \sin(30^\circ + \theta^{\circ})$$") == [["a", "sin(30*pi/180 + theta*pi/180)"]]


def test_data_in_a_row_have_units_that_stand_elsewhere(tmp_path):
    text = "$$J \\ddot\\theta = -b \\dot\\theta - k r \\sin\\theta$$\n\n$$k = 1, \\quad J = 9, \\quad b = 10$$"
    assert not [row for row in judged(tmp_path, text) if row["verdict"] in FINDINGS]


def test_raised_numbers_that_count_are_no_powers(tmp_path):
    rows = judged(
        tmp_path, "$$U = U^1 = U^2$$\n\n$$f = L^0 f(x^{0}) + L^{2} f(x^{2})$$\n\n$$a = b^{10} + c^{-1} + d^{1/2}$$"
    )
    assert ["indices" in row["note"] for row in rows] == [True, True, False]


def test_matrices_are_not_read(tmp_path):
    text = (
        "$$A = \\begin{bmatrix} 1 & 0 \\\\ 0 & 2 \\end{bmatrix}$$\n\n$$x^T y = 0$$\n\n$$y = A x = x A$$\n\n$$z = A h$$"
    )
    rows = judged(tmp_path, text)
    assert ["matrices" in row["note"] for row in rows][1:] == [True, True, False] and rows[3]["read"]


@pytest.mark.parametrize(
    "text",
    ["$$a = 1" + r"\," * 2000 + "x$$", "$$a = 1" + "~" * 5000 + "x$$", "- " + "a" * 200_000 + ": $b$", "```\n" * 5000],
    ids=["thin", "tied", "long", "fences"],
)
def test_no_sign_that_is_repeated_takes_minutes(text):
    assert len(read_text_whole(text).said) < 2
