"""Functions beside the formulas of their own descriptions, and the list of slips that was written before."""

import textwrap
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym.audit.hosts.described import descriptions
from mechsym.audit.read.programs.claims import read_program
from mechsym.cli import mechsym

LIST = tomllib.loads((Path(__file__).parent / "described.toml").read_text())


def said_of(row):
    about = textwrap.indent(row["about"], "    ")
    text = f'def f({row["given"]}):\n    r"""What it gives.\n\n{about}\n    """\n    return {row["gives"]}\n'
    return [outcome["verdict"] for _, outcome in descriptions(read_program(text, ".py"))]


@pytest.mark.parametrize("row", LIST["slips"], ids=lambda row: row["gives"])
def test_a_slip_is_told(row):
    assert said_of(row) == ["wrong"]


@pytest.mark.parametrize("row", LIST["peace"], ids=lambda row: row["gives"])
def test_what_agrees_or_is_another_thing_is_left_in_peace(row):
    assert said_of(row) == ([] if row.get("silent") else ["agrees"])


def test_the_command_says_what_the_description_says(tmp_path):
    path = tmp_path / "valve.py"
    path.write_text('def loss(p, rho, v):\n    r"""$k = \\frac{2 p}{\\rho v^2}$"""\n    return 2 * p / (rho * v**2)\n')
    assert CliRunner().invoke(mechsym, ["audit", "--code", str(path)]).exit_code == 0
    path.write_text(path.read_text().replace("2 * p", "p"))
    done = CliRunner().invoke(mechsym, ["audit", "--code", str(path)])
    assert done.exit_code == 1
    assert "is not what its description says" in done.stdout and "one of the two is wrong" in done.stdout


PROGRAMS = {
    ".m": """function x = travel(r, l, theta)
% x = r*(1 - cos(theta)) + l*(1 - sqrt(1 - (r/l*sin(theta))^2))
x = r*(1 - cos(theta)) + l*(1 - sqrt(1 - {});
end
""",
    ".cpp": r"""/// Travel of a piston:
/// \f[ x = r (1 - \cos\theta) + l \left(1 - \sqrt{1 - \left(\frac{r}{l} \sin\theta\right)^2}\right) \f]
double travel(double r, double l, double theta) {
    return r*(1 - cos(theta)) + l*(1 - sqrt(1 - {});
}
""",
    ".jl": """# x = r*(1 - cos(theta)) + l*(1 - sqrt(1 - (r/l*sin(theta))^2))
function travel(r, l, theta)
    return r*(1 - cos(theta)) + l*(1 - sqrt(1 - {})
end
""",
}


@pytest.mark.parametrize("ends", PROGRAMS)
@pytest.mark.parametrize(
    ("root", "verdict"), [("(r*sin(theta)/l)*(r*sin(theta)/l))", "agrees"), ("r*sin(theta)/l)", "wrong")]
)
def test_comments_at_the_head_of_a_function_describe_it(ends, root, verdict):
    reading = read_program(PROGRAMS[ends].replace("{}", root), ends)
    assert [row["verdict"] for _, row in descriptions(reading)] == [verdict]


def test_what_one_branch_gives_settles_a_formula():
    text = 'def f(a, b, c):\n    r"""$F = \\frac{a b}{c}$"""\n'
    text += "    if a > c:\n        return a * b / c\n    return a * b * c\n"
    assert [row["verdict"] for _, row in descriptions(read_program(text, ".py"))] == ["agrees"]


@pytest.mark.parametrize(("number", "verdict"), [("0.5005", "agrees"), ("0.51", "wrong")])
def test_a_rounded_number_is_the_program_s_own(number, verdict):
    text = f'def f(m, v, h):\n    r"""$E = \\frac{{1}}{{2}} m v^2 + h$"""\n    return {number} * m * v**2 + h\n'
    assert [row["verdict"] for _, row in descriptions(read_program(text, ".py"))] == [verdict]


@pytest.mark.parametrize("factor", ["1e-9", "1e-6", "1e-3", "1e3", "1e6", "1e9"])
def test_thousands_in_one_term_are_units(factor):
    text = f'def f(a, b, c):\n    r"""$F = a b + c$"""\n    return {factor} * a * b + c\n'
    assert [row["verdict"] for _, row in descriptions(read_program(text, ".py"))] == ["agrees"]
