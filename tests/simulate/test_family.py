"""Problems that differ in numbers only share one function, and run as they would alone."""

from dataclasses import replace

import numpy as np
import pytest

from mechsym import cases
from mechsym.jobs.problem import problem_of
from mechsym.mechanisms.record import LazyFunctions, bind
from mechsym.simulate import Settings, simulate, simulate_many
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
