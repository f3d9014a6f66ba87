"""The worked example in every sizing rule's docstring gives what it says, and no public rule is without one."""

import doctest
import importlib
import inspect
import pkgutil

import pytest

import mechsym.sizing as package

MODULES = sorted(f"mechsym.sizing.{m.name}" for m in pkgutil.iter_modules(package.__path__))


@pytest.mark.parametrize("name", MODULES)
def test_docstring_examples(name):
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0


RULES = ("gears", "gear_factors", "gear_life", "gear_geometry", "gear_bending", "gear_interference", "agma908", "hertz",
         "piston", "rod", "cylinder", "bolts", "crankshaft", "fatigue", "turning_shaft", "shaft_beam", "bearings",
         "balancing", "masses", "loads", "rod_forces")  # fmt: skip


@pytest.mark.parametrize("name", RULES)
def test_every_rule_has_formula_source_and_example(name):
    module = importlib.import_module(f"mechsym.sizing.{name}")
    for attribute, rule in vars(module).items():
        if inspect.isfunction(rule) and rule.__module__ == module.__name__ and not attribute.startswith("_"):
            doc = inspect.getdoc(rule) or ""
            assert ">>>" in doc, f"{name}.{attribute} has no worked example"
            assert "Source:" in doc or "Print:" in doc, f"{name}.{attribute} names no source"
