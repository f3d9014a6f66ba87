"""The package in tests/plugin: what its entry point names is a mechanism, with the numbers of a bar that falls."""

import json
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym

PLUGIN = Path(__file__).parents[1] / "plugin"


def test_the_bar_of_the_example_package_falls_as_a_bar_does(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    (module,) = tomllib.loads((PLUGIN / "pyproject.toml").read_text())["project"]["entry-points"]["mechsym.mechanisms"][
        "swing"
    ].split()
    file = PLUGIN.joinpath(*module.split(".")).with_suffix(".py")
    words = ["eval", str(file), "--set", "l=2", "--set", "mass=3", "--set", "phi=0.4", "--json"]
    done = CliRunner().invoke(mechsym, words)
    assert done.exit_code == 0, done.output
    found = json.loads(done.output)
    assert found["acceleration"] == pytest.approx([-1.5 * 9.81 / 2 * 0.9210609940028851], rel=1e-12)
    assert found["mass_matrix"][0] == pytest.approx([3 * 2**2 / 3], rel=1e-12)
