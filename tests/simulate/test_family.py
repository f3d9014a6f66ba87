"""Problems that differ in numbers only share one function, and run as they would alone."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.jobs.problem import problem_of
from mechsym.mechanisms.crank_train import build
from mechsym.mechanisms.record import LazyFunctions, bind, form_of
from mechsym.simulate import Settings, simulate, simulate_many
from mechsym.simulate import integrate as integrate_module
from mechsym.simulate import run as run_module
from mechsym.simulate.equations import held, start_of, system
from mechsym.simulate.many import systems
from mechsym.simulate.problem import FormulaForce, Problem

SHORT = {"t_end": "2 s", "window": "0.5 s"}


def problems(**values: tuple[float, ...]) -> list[Problem]:
    count = len(next(iter(values.values())))
    return [
        problem_of(cases.load("chmielewski", {**SHORT, **{k: v[i] for k, v in values.items()}})) for i in range(count)
    ]


FAMILIES = {
    "torque": {"drive.torque": (1.0, 1.5, 2.0)},
    "one letter": {"k1": (6000.0, 6500.0, 7000.0)},
    "three letters": {"m0": (1.0, 1.1, 1.2), "r": (0.05, 0.06, 0.055), "c1": (0.0, 0.5, 2.0)},
}


@pytest.mark.parametrize("name", FAMILIES)
def test_a_family_has_one_function_with_the_rates_of_each_member(name):
    family = problems(**FAMILIES[name])
    found = systems(family)
    assert all(s.function is found[0].function for s in found)
    rng = np.random.default_rng(1)
    for problem, shared in zip(family, found, strict=True):
        alone = system(problem)
        assert shared.columns == alone.columns
        for _ in range(5):
            y = start_of(problem, alone) + rng.normal(size=len(alone.columns))
            expected = np.asarray(alone.function(0.0, y, held(alone, 1.5)))
            np.testing.assert_allclose(shared.function(0.0, y, held(shared, 1.5)), expected, rtol=1e-13, atol=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["torque", "three letters"])
def test_a_family_runs_as_its_members_alone(name):
    family, settings = problems(**FAMILIES[name]), Settings(tolerance=1e-10, check="none")
    for found, problem in zip(simulate_many(family, settings), family, strict=True):
        alone = simulate(problem, settings)
        for key, values in alone.columns.items():
            np.testing.assert_allclose(found.columns[key], values, atol=1e-7 * max(1.0, np.abs(values).max()))
        assert found.energy.residual == pytest.approx(alone.energy.residual, abs=1e-9)


def test_a_force_by_formula_keeps_equations_of_its_own():
    family = problems(k1=(6000.0, 7000.0))
    for k, problem in enumerate(family):
        force = replace(problem.parts[0], value=FormulaForce(function=lambda t, q, u, k=k: k - u[0]))
        family[k] = replace(problem, parts=(force,))
    found = systems(family)
    assert found[0].function is not found[1].function
    assert not any(s.letters for s in found)


def test_a_mechanism_is_bound_once_and_its_functions_are_built_when_asked_for():
    values = {n: v for n, v in problems(c1=(0.0,))[0].mechanism.parameters.items()}
    found = bind("crankshaft_flywheel", {**values, "c1": 0.625})
    assert found is bind("crankshaft_flywheel", {**values, "c1": 0.625})
    assert found is not bind("crankshaft_flywheel", values)
    assert isinstance(found.functions, LazyFunctions)
    assert found.functions["energy"] is found.functions["energy"]
    assert list(found.functions) == list(dict(found.functions))
    with pytest.raises(KeyError):
        found.functions["nothing"]
    below, above = (bind("crankshaft_flywheel", {**values, "c1": zero}) for zero in (-0.0, 0.0))
    assert below is not above


@pytest.mark.slow
def test_engines_of_ones_own_that_differ_in_masses_and_springs_share_equations_and_what_drives_them(tmp_path):
    file = tmp_path / "three.toml"
    words = ["new", "engine", "--kind", "inline", "--bore", "80 mm", "--stroke", "80 mm", "--cylinders", "3"]
    assert CliRunner().invoke(mechsym, [*words, "--out", str(file)]).exit_code == 0
    values = [
        {"parameters.I_f": 0.1 + 0.02 * i, "parameters.k": 3e5 + 1e4 * i, "simulation.turns": 4} for i in range(3)
    ]
    kept = {}
    family = [problem_of(cases.load(str(file), v), kept) for v in values]
    assert len(kept) == 1
    found = systems(family)
    assert all(s.function is found[0].function for s in found)
    assert family[0].parts[-1].value.numbers == family[1].parts[-1].value.numbers  # of the propeller
    for value, problem, together in zip(values, family, simulate_many(family), strict=True):
        alone = simulate(problem_of(cases.load(str(file), value)))
        assert together.status == alone.status == "converged"
        for key in ("phi1d", "phi_fd", "kinetic_energy"):
            np.testing.assert_allclose(together.columns[key], alone.columns[key], rtol=1e-9)
        # what the last steps keep is the run itself, as it is without them
        times = np.linspace(alone.t[-1] - 0.01, alone.t[-1], 300)
        again = simulate(problem, Settings(check="none"))
        for key, speed in together.dense(times).items():
            np.testing.assert_allclose(speed, again.dense(times)[key], rtol=1e-8)


def test_a_train_that_is_put_together_otherwise_has_another_form():
    p = cases.load("alpha-stirling").need("parameters")
    forms = [form_of(build(replace(p, **change))) for change in ({}, {"I_f": 3.0}, {"c": 7.0}, {"r": 0.05})]
    assert forms[0] == forms[1] == forms[2] != forms[3]
    opened = forms[0].bound({**vars(p), "I_f": ca.SX.sym("I_f")})
    rates = opened.functions["dynamics"]
    assert rates.name_in()[-1] == "I_f"
    at = {n: 0.3 for n in rates.name_in()}
    whole = build(replace(p, I_f=3.0)).functions["dynamics"](**{n: v for n, v in at.items() if n != "I_f"})
    for name, value in rates(**{**at, "I_f": 3.0}).items():
        np.testing.assert_allclose(value, whole[name], rtol=1e-14)


def test_a_stretch_before_the_last_steps_is_taken_up_once(monkeypatch):
    case = cases.load("zotov-89", {"simulation.turns": 3})  # a table of gas forces: no steps but those of DOP853
    problem = problem_of(case)
    whole = simulate(problem).dense
    monkeypatch.setattr(integrate_module, "_KEEP", 4)
    few = simulate(problem)
    taken, integrate = [], run_module._raw
    monkeypatch.setattr(run_module, "_raw", lambda *words: taken.append(1) or integrate(*words))
    middle = few.t[len(few.t) // 2]
    for end in (0.02, 0.015, 0.01):
        times = np.linspace(middle, middle + end, 50)
        for key, values in few.dense(times).items():
            np.testing.assert_allclose(values, whole(times)[key], rtol=1e-8, atol=1e-10)
    assert len(taken) == 1
