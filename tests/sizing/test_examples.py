"""The worked example in every sizing rule's docstring gives what it says, and no public rule is without one."""

import doctest
import importlib
import inspect
import pkgutil

import pytest

import mechsym.sizing as package
from mechsym.sizing import rules

MODULES = sorted(m.name for m in pkgutil.walk_packages(package.__path__, "mechsym.sizing."))
DATA = ("materials",)  # tables and their readers, no rules


@pytest.mark.parametrize("name", MODULES)
def test_docstring_examples(name):
    result = doctest.testmod(importlib.import_module(name))
    assert result.failed == 0


RULES = [
    *(
        m.name
        for m in pkgutil.iter_modules(rules.__path__, "mechsym.sizing.rules.")
        if m.name.rpartition(".")[2] not in DATA
    ),
    "mechsym.sizing.loads",
]


@pytest.mark.parametrize("name", RULES)
def test_every_rule_has_formula_source_and_example(name):
    module = importlib.import_module(name)
    for attribute, rule in vars(module).items():
        if inspect.isfunction(rule) and rule.__module__ == module.__name__ and not attribute.startswith("_"):
            doc = inspect.getdoc(rule) or ""
            assert ">>>" in doc, f"{name}.{attribute} has no worked example"
            assert "Source:" in doc or "Print:" in doc, f"{name}.{attribute} names no source"
