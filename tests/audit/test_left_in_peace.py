"""What is right in others' texts and was blamed once: products that are none, other cases, names of several things."""

import pytest
from audited import blamed, judged

from mechsym.audit.judge.kinds import kinds_of
from mechsym.audit.read.said import read_text_whole
from mechsym.audit.read.tree import letters


def _why(formula):
    return read_text_whole(f"$$ {formula} $$").said[0].why


@pytest.mark.parametrize(
    ("formula", "reason"),
    [
        (r"\mathbf{M} = \mathbf{r} \times (\boldsymbol{\omega} \times \mathbf{r})", "vectors"),
        (r"F(t) = \frac{H}{2} F(\omega, \theta)", "two things"),
        (r"\mathrm{P}(t) = A \sin(2\pi f t) \mathrm{P}", "two things"),
        (r"u[T^2] = 2 T u[T]", "two things"),
        (r"\mathrm{DFT}(f g) = \mathrm{DFT}(f) \mathrm{DFT}(g)", "two things"),
        (r"C = C_0 \mathrm{erf}\left(\frac{x}{h}\right)", "function"),
        (r"\ln K_r = \ln K_a(\dot{\xi})", "logarithm"),
        (r"x(t+1) = x(t) + v(t+1)", "another step"),
        (r"y(0) = \cosh c + d", "value at 0"),
    ],
)
def test_what_is_no_product_is_not_read(formula, reason):
    assert reason in _why(formula)


@pytest.mark.parametrize(
    "formula",
    [
        r"P = \mathbf{F} \cdot \mathbf{v}",
        r"p = 1.2 \times 10^5",
        r"V(\theta) = V_c + A x(\theta)",
        r"x(t) = r\cos\omega t",
        r"T_2 = T_1 \left[1 + k (\varepsilon - 1)\right]",
        r"\ln\left(\frac{p_2}{p_1}\right) = n \ln\left(\frac{V_1}{V_2}\right)",
    ],
)
def test_what_is_beside_it_is_read(formula):
    assert _why(formula) == ""


@pytest.mark.parametrize(
    "text",
    [
        # numbers that are put in, or to be solved for, or a value that a letter has elsewhere
        r"The way obeys $$ m\ddot{x} = m g - k(x - l) $$ Substituting numerical values $$ 2\ddot{x} = 20 - 2(x-1) $$",
        r"It is $X = \frac{1}{6}$ there. The equation is $$ 1.44 = \frac{X^2}{(1-X)^2} $$",
        r"So $\gamma = \frac{1}{2}$. At $\alpha = \frac{2 b - 1}{b + 1}$ is $$\gamma = \frac{1}{2} - \alpha + b$$",
        r"The length is $$ x_e = \frac{m g}{k} + l = 10 + 1 = 11\,\text{m} $$ with the length $l$.",
        # a letter for several cases
        "In nets $$ \\kappa = 1 + 0.98 e^{-3 q} $$\n\nFor method B, it is $$ \\kappa = 1.15 (1 + 0.98 e^{-3 q}) $$",
        r"The field is $$ \psi = s (x - a)^2 $$ and of both sources $$ \psi = s (x - a)^2 + s (x + a)^2 $$",
        r"\begin{align} y_H &= c_1 e^{-a t} \\ y_H &= c_2 t e^{-a t} \end{align} With it $$ y = y_H + y_{IH} $$",
        r"The red one has $$ P = \frac{K}{f^2} $$ and in general $$ P = \frac{K}{f^\beta} $$",
        # equations that hold together, and letters with an index before and behind
        r"They are \begin{align} y_2 (2-k) - y_3 &= 0 \\ -y_2 + y_3 (2-k) &= 0 \end{align}",
        r"\begin{align} k_{i-1,j} &= j n + i - 1 \\ k_{i+1,j} &= j n + i + 1 \end{align}",
        # units of letters that words in front of them do not tell
        "- $v$: speed of it at an instant in time\n- $x$: length\n\n" r"$$ \frac{d x}{d t} = v \sin\theta $$",
        "- $F$: amplitude of the force\n- $\\omega$: frequency of the applied force\n\n" r"$$ x = a \sin\omega t $$",
        r"The center of mass $r_c$ of a bar of length $l$ is $$ r_c = \frac{l}{2} $$",
        r"Defined as the ratio between the pressure difference and the dynamic pressure: $$ C_p = 1 - 4\sin^2\theta $$",
        r"The generalized force $Q$ of a force $F$ on a length $d$ is $$ Q = F d \cos\theta $$",
        r"Of the power $P$ at the frequency $f$ $$ \log P = \log K - 2\log f $$",
        r"Take $$ \ddot{x} = -\dot{x}^2 + \sin(x) $$",
        r"With the velocity $v$ $$ \dot{x} = v $$ $$ \dot{v} = 0.001 u - 0.0025\cos(3 x) $$",
        "- $F_E$: external force acting onto the mass\n\n" r"With the forces $F_S$ and $F_I$ $$ F_S + F_I = F_E $$",
        r"With the mean torque taken away the work is $$ W = \int_0^{2\pi} M\,d\varphi $$",
        r"It flows in half of a turn; its mean is $$ M = \frac{1}{2\pi} \int_0^{\pi} T\,d\varphi $$",
        r"The final time is $t_f$: $$ \frac{dx}{dt} = -x + u $$ $$ x(t_f) = 1 $$",
    ],
)  # fmt: skip
def test_a_right_text_is_left_in_peace(text, tmp_path):
    assert blamed(judged(tmp_path, text, "text.md")) == []


def test_a_row_with_the_letter_of_the_row_before_it_is_told(tmp_path):
    """One part is left without an equation, and the two rows say the same of two sides."""
    rows = r"""$$ m_T \ddot{w} = (m_R + m_L + m_H) \ddot{w} $$ where
\begin{align}
m_T &= \rho A L \\
m_R &= \rho A \left( \frac{L-B}{2} + w \right) \\
m_SIDE &= \rho A \left( \frac{L-B}{2} - w \right) \\
m_H &= \rho A B
\end{align}"""
    assert blamed(judged(tmp_path, rows.replace("SIDE", "L"), "text.md")) == []
    (row,) = blamed(judged(tmp_path, rows.replace("SIDE", "R"), "text.md"))
    assert row["line"] == 5 and row["correction"].startswith("m_L = ")


@pytest.mark.parametrize(
    ("listed", "unit"),
    [
        ("speed of the shaft at a time", None),
        ("pressure at the end of the stroke", "Pa"),
        ("frequency of the force", "1/s"),
        ("amplitude of the force", "N"),
        ("coefficient of pressure", None),
        ("vector of length 3", None),
    ],
)
def test_a_list_measures_a_letter_by_the_head_of_what_it_is(listed, unit):
    of_it = kinds_of(read_text_whole(f"- **q**: {listed}\n\n$$ y = q $$")).of("q")
    wanted = {None: None, "Pa": (1, -1, -2), "1/s": (0, 0, -1), "N": (1, 1, -2)}[unit]
    assert (of_it and of_it[:3]) == wanted


@pytest.mark.parametrize("text", [r"Y(e^{j \Omega}) = X(e^{j \Omega}) \cdot H(e^{j \Omega})", "h(t - c) = h^*(-t + c)"])
def test_a_function_of_a_time_or_of_an_exponential_is_no_product(text):
    assert _why(text) != ""


def test_the_square_of_what_is_a_function_elsewhere_is_no_product():
    text = r"$$ D(x) = D_i + (D_e - D_i) \frac{x}{L} $$ $$ A(x) = \frac{\pi}{4} D(x)^2 $$"
    *_, area = read_text_whole(text).said
    assert set(letters(area.sides[1])) == {"pi", "D"}


def test_the_displacement_of_a_mass_is_measured_in_no_kilograms():
    text = "The displacement of the mass over time $y(t)$, as in $y(t) = 1$ $$ F = k y $$"
    assert kinds_of(read_text_whole(text)).of("y") is None


def test_empty_brackets_are_of_nothing():
    assert _why("y[] = a b[]") != ""


def test_a_rate_without_a_slope_stops_no_text(tmp_path):
    text = r"""Lagrange's equations of $$ T = \frac{1}{2} J\dot\varphi^2 $$ and $$ U = \frac{1}{2} c\varphi^2 $$ give
$$ J\ddot\varphi + c\varphi = 0 $$ $$ \frac{d^2\theta_A}{dt^2} + \ddot{u}_{t+\Delta t} = \frac{d T}{d n} $$"""
    rows = judged(tmp_path, text, "text.md")
    assert [row["verdict"] for row in rows][2] == "exact" and len(rows) == 4


def test_a_unit_in_brackets_is_no_letter():
    text = "- $r$ – crank radius (m)\n- $m$ – mass of one piston (kg)\n\n$$ F = m r $$"
    assert {k: v.unit for k, v in read_text_whole(text).named.items()} == {"r": "m", "m": "kg"}
