"""Designs of cycles that are solved one by one, against closed forms and fine grids."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.optimise import figures, optimise, programme
from mechsym.optimise.search import FigureProgramme, search
from mechsym.optimise.solver import Limit, Optimise

INF = float("inf")


def task(figures, constraints=(), low=0.0, high=3.0, start=(0.5, 0.6), sign=1.0):
    variables = tuple(Limit(name=f"x{i}", unit="m", low=low, high=high) for i in range(2))
    return FigureProgramme(
        figures=figures, start=np.array(start), objective="J", sign=sign, variables=variables, constraints=constraints
    )


def hill(x):
    return {"J": 5 - (x[0] - 1) ** 2 - 2 * (x[1] - 2) ** 2, "sum": x[0] + x[1], "product": x[0] * x[1]}


def limit(name, low=-INF, high=INF):
    return Limit(name=name, unit="m", low=low, high=high)


def test_free_optimum():
    found = search(task(hill))
    assert found.status == "optimal" and not found.active
    assert found.variables == pytest.approx({"x0": 1, "x1": 2}, abs=1e-4)


def test_multiplier_is_that_of_the_closed_form():
    # nearest point of a line: x0 = 1 - 2 t, x1 = 2 - t, t = (3 - c)/3, J = 5 - 6 t^2, dJ/dc = 4 t
    found = search(task(hill, (limit("sum", high=2.4),)))
    assert found.variables == pytest.approx({"x0": 0.6, "x1": 1.8}, abs=1e-4)
    assert found.multipliers["sum"] == pytest.approx(0.8, rel=1e-4)
    assert [row.name for row in found.active] == ["sum"] and "would change J by" in found.active[0].meaning


def test_bound_of_a_variable_has_its_price():
    found = search(task(hill, high=1.5))
    assert found.variables["x1"] == pytest.approx(1.5) and found.multipliers["x1"] == pytest.approx(2.0, rel=1e-4)


def test_equal_and_lower_limits_and_a_minimum():
    found = search(task(lambda x: {**hill(x), "J": -hill(x)["J"]}, (limit("product", 1.5, 1.5),), sign=-1.0))
    assert found.status == "optimal" and found.figures["product"] == pytest.approx(1.5, abs=1e-6)
    # along the curve x1 = 1.5/x0
    t = np.linspace(0.5, 3, 200_001)
    assert found.objective == pytest.approx(np.min((t - 1) ** 2 + 2 * (1.5 / t - 2) ** 2 - 5), abs=1e-6)


def test_what_cannot_be_kept_is_infeasible():
    found = search(task(hill, (limit("sum", high=2.0), limit("product", low=4.0))))
    assert found.status == "infeasible" and "missed by" in found.reason


def test_a_refused_design_ends_the_search_with_its_words():
    def narrow(x):
        if x[0] > 0.7:
            raise BadInput("x0 is too wide")
        return hill(x)

    found = search(task(narrow))
    assert found.status == "not converged" and "x0 is too wide" in found.reason


def stirling(variables, constraints=None, **more):
    section = Optimise(variables=variables, constraints=constraints or {}, **{"objective": "work", **more})
    case = cases.load("alpha-stirling")
    return programme(case, section, {"knock": {"high": 1.0}})


@pytest.mark.slow
def test_values_of_lists_have_numbers_and_figures_are_si():
    wanted = stirling({"parameters.phase.1": {"low": "60 deg", "high": "120 deg"}})
    assert wanted.start == pytest.approx([np.pi / 2]) and wanted.variables[0].unit == "rad"
    found = wanted.figures(np.array([np.radians(80)]))
    direct = figures(cases.load("alpha-stirling", {"parameters.phase": ["80 deg", 0.0]}))
    assert found == direct and found["work"] == pytest.approx(found["power"] / 10, rel=1e-12)


@pytest.mark.parametrize(
    ("section", "words"),
    [
        ({"variables": {"parameters.phase": {"low": 1, "high": 2}}}, "has several values; add .1"),
        ({"variables": {"parameters.phase.3": {"low": 1, "high": 2}}}, "no value of number 3"),
        ({"variables": {"cycle.gas": {"low": 1, "high": 2}}}, "is no number"),
        ({"variables": {"engine.bore": {"low": 1, "high": 2}}}, "engine.bore is not known"),
        ({"variables": {"cycle.dead_hot": {"low": "1 m", "high": "2 m"}}}, "wrong dimension"),
        ({"variables": {"cycle.dead_hot": {"low": 1e-5, "high": 2e-4}}, "objective": "beauty"}, "is not a figure"),
    ],
)
def test_bad_problems_are_refused(section, words):
    with pytest.raises(BadInput, match=words):
        stirling(**{"variables": {}, **section})


def test_choices_are_lists_of_different_words():
    with pytest.raises(BadInput, match="list of different words"):
        Optimise(variables={"cycle.dead_hot": {"low": 1, "high": 2}}, choices={"cycle.gas": "air"})


def case_file(tmp_path, text, kind="schmidt"):
    file = tmp_path / "mine.toml"
    file.write_text(cases.text("alpha-stirling").replace('"schmidt"', f'"{kind}"') + text)
    return str(file)


PHASE = (
    '[optimise]\nobjective = "work"\n[optimise.variables]\n"parameters.phase.1" = {low = "50 deg", high = "150 deg"}\n'
)


@pytest.mark.slow
def test_best_phase_is_that_of_a_fine_grid(tmp_path):
    found = optimise(cases.load(case_file(tmp_path, PHASE))).best
    grid = np.radians(np.arange(70, 93, 2.0))
    work = [figures(cases.load("alpha-stirling", {"parameters.phase": [lead, 0.0]}))["work"] for lead in grid]
    assert found.status == "optimal" and found.objective >= max(work)
    assert found.variables["parameters.phase.1"] == pytest.approx(grid[np.argmax(work)], abs=np.radians(1.1))


MORE = """
"cycle.dead_regenerator" = {low = "60 cm^3", high = "200 cm^3"}
[optimise.constraints]
p_max = {high = "10 bar"}
[optimise.choices]
"cycle.gas" = ["air", "helium"]
"""


@pytest.mark.slow
@pytest.mark.heavy
def test_gas_phase_and_dead_volume_of_the_adiabatic_engine(tmp_path):
    file = case_file(tmp_path, PHASE + MORE.lstrip(), "stirling-adiabatic")
    done = CliRunner().invoke(mechsym, ["optimise", file, "--json"], catch_exceptions=False)
    found = json.loads(done.stdout)
    assert done.exit_code == 0 and [row["cycle.gas"] for row in found["choices"]] == ["air", "helium"]
    best = max(found["choices"], key=lambda row: row["objective"])
    assert found["chosen"]["cycle.gas"] == best["cycle.gas"] and found["objective"] == best["objective"]
    assert found["figures"]["p_max"] <= 1e6 * (1 + 1e-6) and found["multipliers"]["p_max"] > 0


@pytest.mark.slow
@pytest.mark.heavy
def test_valves_of_an_engine_that_breathes():
    spark = {"cycle.ignition": {"low": "-40 deg", "high": "5 deg"}}
    case = cases.load("generator-breathing", {"optimise.objective": "efficiency", "optimise.variables": spark})
    found = optimise(case).best
    grid = np.radians(np.arange(-40, 5.1, 5))
    efficiency = [figures(cases.load("generator-breathing", {"cycle.ignition": at}))["efficiency"] for at in grid]
    assert found.status == "optimal" and found.objective >= max(efficiency) * (1 - 2e-4)
