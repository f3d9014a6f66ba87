"""A folder outside the package: a declaration and a case go through the commands."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from tables import read_table

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name in ("scotch_yoke.py", "scotch-yoke.toml", "watt_six_bar.py", "watt-six-bar.toml"):
        (tmp_path / name).write_text((EXAMPLES / name).read_text())
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path


def mechsym(*arguments, status=0):
    """JSON of a command."""
    done = subprocess.run(
        [sys.executable, "-m", "mechsym", *arguments, "--json"],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ,
    )
    assert done.returncode == status, done.stderr
    return json.loads(done.stdout) if status != 2 else done.stderr


@pytest.mark.slow
def test_a_scotch_yoke_is_derived_and_evaluated(folder):
    assert len(mechsym("derive", "./scotch_yoke.py", "--out", "derived")["written"]) == 2
    checked = mechsym("derive", "./scotch_yoke.py", "--out", "derived", "--check")
    assert (checked["written"], checked["differs"]) == ([], [])
    (folder / "derived" / "scotch_yoke.py").write_text("spoiled")
    assert mechsym("derive", "./scotch_yoke.py", "--out", "derived", "--check", status=1)["differs"]

    phi, r = 0.7, 0.5
    given = (f"phi={phi}", "phid=9", "F=1e5")
    state = mechsym("eval", "./scotch_yoke.py", "--case", "scotch-yoke.toml", *(w for v in given for w in ("--set", v)))
    inertia = 60 + 460 * (r * np.sin(phi)) ** 2
    assert state["mass_matrix"][0][0] == pytest.approx(inertia, rel=1e-12)
    assert state["kinetic_energy"] == pytest.approx(inertia * 81 / 2, rel=1e-12)
    assert state["generalized_force"][0] == pytest.approx(1e5 * r * np.sin(phi), rel=1e-12)
    assert state["outputs"]["x"] == pytest.approx(r * (1 - np.cos(phi)), rel=1e-12)


@pytest.mark.slow
def test_a_scotch_yoke_has_forces_a_run_and_a_hinge(folder):
    forces = mechsym("forces", "scotch-yoke.toml", "--out", "forces")
    assert forces["power_residual"] < 1e-12
    assert {"R_x_O", "R_y_O", "R_n_S", "R_n_G", "M_G", "driving_torque", "F", "x"} <= set(forces["max"])
    table, units = read_table(folder / "forces" / "forces.csv")
    assert units["R_n_S"] == "N" and units["M_G"] == "N*m" and units["x"] == "m"
    omega = 89 * np.pi / 30
    gas = table["F"]
    acting = gas - 460 * omega**2 * 0.5 * np.cos(np.radians(table["phi_deg"]))  # less what the yoke takes
    np.testing.assert_allclose(table["R_n_S"], -acting, rtol=1e-9, atol=1e-6)
    assert (folder / "forces" / "mechanism.html").read_text().startswith("<!doctype html>")

    run = mechsym("simulate", "scotch-yoke.toml", "--set", "simulation.turns=3")
    assert run["status"] == "converged" and abs(run["energy_residual"]) < 1e-8

    hinge = mechsym("hinge", "scotch-yoke.toml")
    assert hinge["guide"]["feasible"] and hinge["check"]["speed_ripple"] < 1e-6
    assert abs(hinge["hinge_torque_mean"]) < 1e-6 * hinge["hinge_torque_max"]


@pytest.mark.slow
def test_a_six_bar_closed_by_constraint_goes_through_the_commands(folder):
    run = mechsym("simulate", "watt-six-bar.toml", "--set", "simulation.t_end=1 s")
    assert run["status"] == "converged" and abs(run["energy_residual"]) < 1e-8
    forces = mechsym("forces", "watt-six-bar.toml")
    assert forces["power_residual"] < 1e-10
    assert forces["max"]["R_x_B"] == pytest.approx(forces["max"]["R_x_O"], rel=1e-9)  # a crank without mass hands on
    state = mechsym("eval", "./watt_six_bar.py", "--case", "watt-six-bar.toml", "--set", "phi=1", "--set", "phid=20")
    assert state["outputs"]["constraint_rank"] == 4


def test_the_code_is_derived_once(folder):
    from mechsym.mechanisms import own

    first = own.load("./scotch_yoke.py")
    cached = list((folder / "cache" / "mechsym" / "native").glob("derived-*.json"))
    assert len(cached) == 1
    code = (
        "import sys\nfrom mechsym.mechanisms import own\nown.load('./scotch_yoke.py')\nsys.exit('sympy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
    (folder / "scotch_yoke.py").write_text((folder / "scotch_yoke.py").read_text().replace('"piston",', '"main",'))
    assert own.load("./scotch_yoke.py").listing != first.listing
    cached[0].write_text("{}")  # damaged: made again
    own._load.cache_clear()
    assert own.load("./scotch_yoke.py").name == "scotch_yoke"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("eval", "./nothing.py"), "there is no file nothing.py"),
        (("eval", "./scotch_yoke.py:other"), "declares no mechanism 'other'"),
        (("eval", "./scotch_yoke.py"), "no value for r"),
        (("eval", "./scotch_yoke.py", "--case", "scotch-yoke.toml", "--set", "r=-1"), "it must be > 0 m"),
        (("simulate", "scotch-yoke.toml", "--set", "parameters.q=1"), "key parameters.q is not known"),
        (
            (
                "eval",
                "./watt_six_bar.py",
                "--case",
                "watt-six-bar.toml",
                "--set",
                "phi=1",
                "--set",
                "theta2=1",
                "--set",
                "theta3=1.6",
                "--set",
                "theta4=.5",
                "--set",
                "theta5=1.8",
            ),
            "theta5 given (gap 0.105); give another pose, or leave theta2, theta4, theta3, theta5 to follow",
        ),
        (("new", "mechanism", "press", "--kind", "inline", "--bore", "86 mm"), "only an engine has --kind, --bore;"),
    ],
)
def test_wrong_input_is_refused_in_one_line(folder, arguments, message):
    told = mechsym(*arguments, status=2)
    assert message in told and "Traceback" not in told and len(told.strip().splitlines()) == 1


def test_two_files_of_one_mechanism_do_not_overwrite_each_other(folder):
    (folder / "other").mkdir()
    (folder / "other" / "scotch_yoke.py").write_text((folder / "scotch_yoke.py").read_text())
    refused = mechsym("derive", "./scotch_yoke.py", "other/scotch_yoke.py", "--out", "derived", status=2)
    assert "scotch_yoke.py would be of two mechanisms" in refused
    assert not (folder / "derived").exists()
    assert len(mechsym("derive", "./scotch_yoke.py", "./scotch_yoke.py", "--out", "derived")["written"]) == 2
