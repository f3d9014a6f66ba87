"""Made texts of mechanics with planted slips: each is found and rightly corrected, and nothing else is blamed."""

import re
import tomllib
from pathlib import Path

import pytest
from audited import blamed, judged, same

from mechsym.audit.hosts.whole import check_texts, read_texts
from mechsym.audit.judge.kinds import kinds_of
from mechsym.audit.judge.world import World
from mechsym.audit.read.displays import displayed
from mechsym.audit.read.lagrange import lagrange_equation
from mechsym.audit.read.macros import expanded
from mechsym.audit.read.mathml import formula as formula_of_page
from mechsym.audit.read.matrices import entrywise
from mechsym.audit.read.nomenclature import called, nomenclature
from mechsym.audit.read.said import read_text_whole
from mechsym.audit.read.subject import listed, subject
from mechsym.errors import BadInput

TEXTS = Path(__file__).parent / "texts"
PLANTED = tomllib.loads((TEXTS / "planted.toml").read_text())


def test_every_text_has_its_list():
    assert {path.stem for path in TEXTS.glob("*.*") if path.suffix != ".toml"} == set(PLANTED)


BY_LENGTH = sorted(PLANTED, key=lambda name: max(path.stat().st_size for path in TEXTS.glob(f"{name}.*")))


# the names of all texts, the longer ones left to the heavy tests
TEXT = [*BY_LENGTH[:40], *(pytest.param(name, marks=[pytest.mark.slow, pytest.mark.heavy]) for name in BY_LENGTH[40:])]


@pytest.mark.parametrize("name", TEXT)
def test_planted_slips_are_found_and_nothing_else_is_blamed(name):
    (path,) = (p for p in TEXTS.glob(f"{name}.*"))
    rows, cover = check_texts(read_texts(path))
    planted = PLANTED[name]
    wanted = {int(line): right for line, right in planted.items() if line.isdigit()}
    assert {row["line"]: row["verdict"] for row in blamed(rows)} == {
        line: "wrong" if right == "units" else "misprint" for line, right in wanted.items()
    }
    for row in blamed(rows):
        right = wanted[row["line"]]
        assert right == "units" or same(row["correction"], right), row["correction"]
    assert cover.equations - cover.read == planted.get("unread", 0)
    letters = {letter for row in rows for letter in re.findall(r"the table has (\w+) in", row["note"])}
    assert letters == set(planted.get("table", ()))  # whose unit there is wrong
    # what is missed stands there, and is read
    missed = {int(line) for line in planted.get("missed", {})}
    assert missed.isdisjoint(wanted) and missed <= {row["line"] for row in rows if row["read"]}


_TAIL = re.compile(r"\s*[.,;]?\s*(?:\\(?:label|tag)\{[^}]*\}|\\\\.*|\$\$.*|\\end\{.*|\\\].*)?\s*$")


def corrected(text, planted):
    """A text with the right side of each slip that stands alone in its line as it should be, and the lines of these."""
    lines, mended = text.split("\n"), set()
    for number, right in planted.items():
        line = lines[int(number) - 1] if number.isdigit() and right != "units" else ""
        head, _, rest = line.partition("=")
        if (
            line.count("=") == 1
            and "quad" not in line
            and "ddot" not in right
            and not rest.lstrip(" &").startswith("0")
        ):
            lines[int(number) - 1] = f"{head}= {right} {_TAIL.search(rest)[0]}"
            mended.add(int(number))
    return "\n".join(lines), mended


#: Lines that follow from a slip, and miss what is right there
FOLLOWING = {"marine": {122}, "rodless_dynamics": {55}}


@pytest.mark.slow
@pytest.mark.parametrize("name", TEXT)
def test_a_text_with_its_slips_corrected_is_left_in_peace(name, tmp_path):
    (path,) = (p for p in TEXTS.glob(f"{name}.*"))
    text, mended = corrected(path.read_text(), PLANTED[name])
    (tmp_path / path.name).write_text(text)
    lines = {row["line"] for row in blamed(check_texts(read_texts(tmp_path / path.name))[0])}
    planted = {int(line) for line in PLANTED[name] if line.isdigit()}
    assert lines <= planted - mended | FOLLOWING.get(name, set())


def test_own_commands_are_written_out_and_lines_keep_their_numbers():
    text = (
        "\\newcommand{\\dd}{\\mathrm{d}}\n\\newcommand{\\pd}[2]{\\frac{\\partial #1}{\\partial #2}}\n"
        "\\def\\half{\\tfrac12}\n\\DeclareMathOperator{\\inv}{inv}\n\\newcommand{\\be}{\\begin{equation}}\n"
        "\\newcommand{\\ee}{\\end{equation}}\n\\newcommand{\\opt}[2][x]{#1_{#2}}\n"
        "\\be v = \\half\\pd{T}{\\dot q} + \\opt{1}\\opt[y]{2}\\ddot z \\ee\n"
    )
    (equation,) = displayed(expanded(text))
    assert equation.line == 8 and expanded(text).count("\n") == text.count("\n")
    assert equation.text == r"v = \tfrac12\frac{\partial T}{\partial \dot q} + x_{1}y_{2}\ddot z"


def test_commands_within_themselves_come_to_an_end():
    loop = r"\newcommand{\a}{\a\a}$$x = \a$$"
    assert len(expanded(loop)) < 12_000
    assert expanded(r"\newcommand{\open}{ $x = \open$") == r"\newcommand{\open}{ $x = \open$"


def test_equations_side_by_side_are_told_apart():
    rows = displayed("\\begin{align}\na &= b + c, & d &= e,\\\\\nf &= g \\\\\n&\\quad + h\n\\end{align}")
    assert [(row.text, row.number) for row in rows] == [("a = b + c", "1"), ("d = e", "1"), (r"f = g \quad + h", "2")]


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (r"\begin{bmatrix} u \\ v \end{bmatrix} = \begin{bmatrix} a & 0 \\ b & c \end{bmatrix}\begin{bmatrix} x \\ y"
         r" \end{bmatrix}", ["u = a x", "v = b x + c y"]),
        (r"\begin{pmatrix} u \\ v \end{pmatrix} = -2\begin{pmatrix} a \\ b \end{pmatrix} + \begin{pmatrix} x \\ y"
         r" \end{pmatrix} k", ["u = -2 a + x k", "v = -2 b + y k"]),
    ],
)  # fmt: skip
def test_matrices_are_multiplied_out(text, parts):
    entries = entrywise(text)
    assert len(entries) == len(parts)
    for one, right in zip(entries, parts, strict=True):
        (left, value), (wanted, formula) = (t.split("=") for t in (one, right))
        assert left.strip() == wanted.strip() and same(value, formula)


@pytest.mark.parametrize(
    "text",
    [
        r"x = \begin{cases} a & b < c \\ d \end{cases}",
        r"\frac{d}{dt}\begin{bmatrix} x \\ y \end{bmatrix} = \begin{bmatrix} u \\ v \end{bmatrix}",
        r"\begin{bmatrix} u & v \end{bmatrix} = \begin{bmatrix} x \\ y \end{bmatrix}",
        r"\mathbf{A} = \begin{bmatrix} a & b \\ c & d \end{bmatrix}",
        r"\mathbf{y} = \mathbf{C}\begin{bmatrix} x \\ y \end{bmatrix}",
        r"\begin{bmatrix} u \\ v \end{bmatrix}^T = \begin{bmatrix} x \\ y \end{bmatrix}",
    ],
)
def test_what_is_no_matrix_equation_of_entries_stays_as_it_is(text):
    assert entrywise(text) == [text]


def test_words_in_front_of_letters_name_them():
    text = (
        "With the rod force $S$, the side thrust $N$ and a spring of stiffness $k$ the load $F$ the stress is high; "
        "the load $q$ per metre, the compression ratio is $\\varepsilon$, "
        "the moments of inertia $J_1$ and $J_2$, the sun has $z_s$ teeth."
    )
    assert called(text) == {
        "S": "rod force", "N": "side thrust", "k": "spring stiffness", "F": "load", "q": "load per metre",
        "\\varepsilon": "compression ratio",
        "J_1": "moment of inertia", "J_2": "moment of inertia", "z_s": "sun teeth",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("before", "phrase"),
    [
        ("The hoop stress of a cylinder of diameter $D$ and thickness $t$ is\n\\begin{equation}", "hoop stress"),
        ("With the torque $T_1$ of the pinion the tangential force is\n\n$$", "tangential force"),
        ("The piston has the kinetic energy\n\\[", "kinetic energy"),
        ("The gas force on the piston, with the pressure $p_0$:\n$$", "gas force"),
        ("It follows.\n\n$$", ""),
        ("The force is the product of the pressure $p$ and the area $A$:\n$$", "force"),
        ("The reciprocating mass is that of the piston $m_k$ and the first:\n$$", "reciprocating mass"),
        ("The torque that the rod exerts on the crank follows as\n$$", "torque"),
        ("and the guide is loaded by\n$$", "force on the guide"),
        ("The mass at the pin causes the centrifugal force\n$$", "centrifugal force"),
        ("The engine runs with the degree of irregularity\n$$", "degree of irregularity"),
        ("and the torque at the output shaft is\n$$", "torque"),
        ("For long rods the piston acceleration may be taken as\n$$", "piston acceleration"),
        ("and the kinetic energy of the flywheel at the mean angular velocity $w$ amounts to\n$$", "kinetic energy"),
        ("The force along the rod is therefore\n$$", "force"),
        ("The energy of the gas per unit volume is\n$$", ""),
        ("The ratio of the force to the area is\n$$", ""),
        ("During compression the pressure rises from $p_1$ by a polytrope,\n$$", "pressure"),
        ("The gas above the piston presses with\n$$", "gas force"),
        ("The gas pressure $p$ above atmosphere presses on the piston with\n$$", "gas force"),
        ("and the torque $M$ in it makes the shear stress\n$$", "shear stress"),
        ("The shear stress by the torque of the shaft is\n$$", "shear stress"),
        ("The mean torque at the pressure $p$ is with the volume $V$ of both\n$$", "mean torque"),
        ("The tooth force is with the module $m$ and the pitch radius\n$$", "pitch radius"),
        ("With the mean and the degree of irregularity\n$$", "degree of irregularity"),
        ("It gives the power of the engine\n$$", "power"),
        ("The mean power at $n$ turns per minute is\n$$", "mean power"),
    ],
)
def test_a_sentence_says_what_its_equation_gives(before, phrase):
    assert subject(before, alone=True)[0] == phrase
    assert subject(before, alone=False)[0] == ""


def test_a_lagrange_equation_is_taken_apart():
    text = (
        r"\frac{\mathrm{d}}{\mathrm{d} t}\left(\frac{\partial\mathcal{L}}{\partial\dot{q}_i}\right)"
        r"- \frac{\partial \mathcal{L}}{\partial q_i} = Q_i,"
    )
    equation = lagrange_equation(text)
    assert [(t.of, t.by, t.sign, t.timed) for t in equation.terms] == [
        ("calL", "qid", 1, True), ("calL", "qi", -1, False),
    ]  # fmt: skip
    assert equation.right == "Q_i"
    assert (
        lagrange_equation(r"\frac{d}{dt} x = v") is None
        and lagrange_equation(r"\frac{\partial U}{\partial q} = Q") is None
    )


ENERGIES = r"""$$T = \frac12 m\dot x^2 + \frac12 J\dot\varphi^2$$ $$V = \frac12 k(x - r\varphi)^2$$
$$\frac{d}{dt}\frac{\partial T}{\partial\dot x} - \frac{\partial T}{\partial x} + \frac{\partial V}{\partial x} = F$$
$$\frac{d}{dt}\frac{\partial T}{\partial\dot\varphi} + \frac{\partial V}{\partial\varphi} = 0$$
"""


@pytest.mark.parametrize(
    ("equation", "verdict"),
    [
        (r"m\ddot x + k(x - r\varphi) = F", "exact"),
        (r"\ddot x + \frac{k}{m}(x - r\varphi) = \frac{F}{m}", "exact"),
        (r"J\ddot\varphi = k r(x - r\varphi)", "exact"),
        (r"\ddot\varphi = \frac{k r}{J}(x - r\varphi)", "exact"),
        (r"m\ddot x + k(x + r\varphi) = F", "misprint"),
        (r"\ddot\varphi = \frac{k}{J r}(x - r\varphi)", "misprint"),
    ],
)
def test_equations_of_motion_follow_from_the_energies(equation, verdict, tmp_path):
    row = judged(tmp_path, f"{ENERGIES}\n$${equation}$$", "text.md")[-1]
    assert (row["verdict"], row["matched"]) == (verdict, "the text's energies"), row["note"]


def test_an_index_that_lends_no_unit_blames_nobody(tmp_path):
    """S_p of a piston's speed is no stroke, and a_w no crank radius."""
    table = "| S | stroke | m |\n| a | crank radius | m |\n| N | speed | 1/s |\n"
    text = f"{table}\n$$S_p = 2 S N$$\n\nThe share is\n\n$$x = 1 - \\exp(-a_w y)$$"
    assert not blamed(judged(tmp_path, text, "text.md"))


@pytest.mark.parametrize(("formula", "verdict"), [(r"m_1\dot x_1", "exact"), (r"2 m_1\dot x_1", "misprint")])
def test_a_slope_by_a_rate_is_that_of_the_text(formula, verdict, tmp_path):
    text = rf"$$T = \frac12 m_1\dot x_1^2$$ and $$p_1 = \frac{{\partial T}}{{\partial\dot x_1}} = {formula}$$"
    assert judged(tmp_path, text, "text.md")[-1]["verdict"] == verdict


def test_a_page_shows_indices_as_they_are_printed_and_what_is_not_read_as_its_source():
    assert "<mi>l</mi><mi>c2</mi>" in formula_of_page(r"x = l_{c2}\cos\varphi")
    assert formula_of_page(r"\det\mathbf J = l_1").startswith("<code>")
    assert formula_of_page(r"\frac{d}{dt}\frac{\partial L}{\partial\dot q} = 0").startswith("<code>")


def test_what_cannot_be_judged_is_a_row_and_the_rest_is_judged(tmp_path, monkeypatch):
    """A derivative that a theory has not, of one equation, once took the whole text."""
    monkeypatch.setattr("mechsym.audit.hosts.equations.Judge._met", _failing)
    rows = judged(tmp_path, "$$a = b c$$ and $$d = e f$$", "text.md")
    assert [row["verdict"] for row in rows] == ["untestable", "untestable"]
    assert "b is none" in rows[0]["note"]


def _failing(*_):
    raise BadInput("b is none")


def test_what_is_cut_short_is_no_slip(tmp_path):
    text = f"{ENERGIES}\nFor small angles\n\n$$\\ddot\\varphi = \\frac{{k}}{{J}}(x - r\\varphi)$$"
    assert not blamed(judged(tmp_path, text, "text.md"))


def test_an_index_t_makes_no_time(tmp_path):
    text = r"A bar of diameter $d_t$ under the torque $M_t$ has the shear stress $$\tau_t = \frac{16 M_t}{\pi d_t^3}$$"
    (row,) = judged(tmp_path, text, "text.md")
    assert row["verdict"] == "units agree"


def test_each_section_has_energies_of_its_own(tmp_path):
    """Two machines in one text, with the same letters for energies and coordinate."""
    lagrange = (
        r"$$\frac{d}{dt}\frac{\partial T}{\partial\dot x} - \frac{\partial T}{\partial x}"
        r" + \frac{\partial V}{\partial x} = 0$$"
    )
    text = ""
    for head, potential, force in (("A spring", r"\frac12 k x^2", "k x"), ("A weight", "m g x", "m g")):
        text += f"# {head}\n\n" + r"$$T = \frac12 m\dot x^2$$" + f" $$V = {potential}$$\n{lagrange}\n"
        text += rf"$$m\ddot x + {force} = 0$$" + "\n\n"
    rows = judged(tmp_path, text, "text.md")
    assert [row["verdict"] for row in rows if r"\ddot" in row["printed"]] == ["exact", "exact"] and not blamed(rows)


@pytest.mark.parametrize(
    ("formula", "verdict"),
    [
        (r"F\tan\psi", "exact"),
        (r"-F\tan\psi", "convention"),
        (r"F\sin\psi", "misprint"),
        (r"\frac{F}{\tan\psi}", "misprint"),
    ],
)
def test_what_words_tell_is_no_more_than_it_is(formula, verdict, tmp_path):
    """The other way round is another sense; the sine of a rod's angle is no series of its tangent, but near to it."""
    text = (
        "The crank of radius $r$ and the rod of length $l$ with the rod angle $\\psi$ carry the piston force $F$.\n\n"
        f"$$\\psi = \\arcsin\\frac{{r\\sin\\alpha}}{{l}}$$\n\nThe side thrust is\n\n$$N = {formula}$$"
    )
    row = judged(tmp_path, text, "text.md")[-1]
    assert (row["verdict"], row["matched"]) == (verdict, "slider_forces.side_force"), row["note"]
    if verdict == "misprint":
        assert same(row["correction"], r"F\tan\psi")
    for said, cut in (("N = F\\sin", "N \\approx F\\sin"), ("The side", "For small angles the side")):
        if "sin" in formula:
            assert not blamed(judged(tmp_path, text.replace(said, cut), "text.md"))


def test_a_dotted_letter_has_as_many_rates_as_dots(tmp_path):
    """The rate of z_d is no second rate of z."""
    text = (
        r"$$T = \frac12 m\dot z_d^2$$ $$V = \frac12 k z_d^2$$" "\n"
        r"$$\frac{d}{dt}\frac{\partial T}{\partial\dot z_d} + \frac{\partial V}{\partial z_d} = 0$$"
        "\n" r"$$m\ddot z_d + k z_d = 0$$"
    )  # fmt: skip
    paper = read_text_whole(text)
    assert World(paper=paper, kinds=kinds_of(paper)).coordinates == {"zd"}
    assert judged(tmp_path, text, "text.md")[-1]["verdict"] == "exact"


@pytest.mark.parametrize(
    ("sentence", "letter", "name"),
    [
        (r"The crank of radius $R$ turns by $\theta$.", "R", "crank radius"),
        ("the power of $z$ cylinders", "z", "cylinders"),
        ("it runs at $n$ turns per minute", "n", "turns per minute"),
        ("a shaft of torsional stiffness $k$", "k", "shaft torsional stiffness"),
        ("the swept volume $V_H$ of all cylinders", "V_H", "swept volume of all cylinders"),
        ("The sun has $z_1$ teeth, each planet $z_2$ and the ring $z_3$.", "z_3", "ring teeth"),
        ("The fluctuation of energy of a turn, $E$, is taken up by a flywheel.", "E", "fluctuation of energy of turn"),
        ("It leaves the nozzle through $k$ holes of diameter $d$.", "k", "holes"),
    ],
)
def test_words_belong_to_their_letter(sentence, letter, name):
    assert called(sentence)[letter] == name


@pytest.mark.parametrize(
    ("before", "names"),
    [
        (
            "The angular velocity and the angular acceleration of the rod are",
            ["angular velocity", "angular acceleration"],
        ),
        ("At the pin are the side force and the torque", ["side force", "torque"]),
        ("the tangential and radial forces", ["tangential force", "radial force"]),
    ],
)
def test_a_row_of_equations_has_a_name_for_each(before, names):
    assert listed(before, 2) == names


def test_letters_of_a_list_in_a_sentence_and_of_one_with_dashes():
    run = "$D$ bore (m), $S$ stroke\n(m), $z$ number of cylinders, $n$ speed (1/min), $p$ gas pressure (Pa)."
    assert {k: (v.meaning, v.unit) for k, v in nomenclature(run).items()} == {
        "D": ("bore", "m"), "S": ("stroke", "m"), "z": ("number of cylinders", ""), "n": ("speed", "rpm"),
        "p": ("gas pressure", "Pa"),
    }  # fmt: skip
    ((letter, named),) = nomenclature(r"\item $s_k$ -- pull-out slip of the motor [kg m$^2$]").items()
    assert (letter, named.meaning, named.unit) == ("s_k", "pull-out slip of the motor", "kg m^2")
    # what a sentence defines on its way is not what comes behind
    assert not nomenclature(r"With $\lambda = r/l$ the way of the piston is")
