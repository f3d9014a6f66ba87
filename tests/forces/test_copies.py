"""A built-in mechanism's declaration copied beside a case: only its roles are known, and the results are the same."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym

ROOT = Path(__file__).parents[2]
COPIES = {
    "zotov-89": "crosshead", "moroianu": "crosshead", "nunes-slider-crank": "crosshead",
    "nunes-hypocycloid": "hypocycloid", "balandin": "rodless", "chmielewski": "crankshaft_flywheel",
}  # fmt: skip
FILES = ("forces.csv", "parts.csv", "parts.json", "mechanism.svg", "mechanism.html", "forces.svg", "polar.svg",
         "orders.svg", "friction.svg", "report.html")  # fmt: skip


def run(folder, command, name, text, monkeypatch):
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.toml").write_text(text)
    monkeypatch.chdir(folder)
    result = CliRunner().invoke(mechsym, [*command, f"{name}.toml", "--json", "--out", "out"])
    written = {n: (folder / "out" / n).read_text() for n in FILES if (folder / "out" / n).exists()}
    return result.exit_code, result.stdout, written


def both(command, name, tmp_path, monkeypatch):
    mechanism = COPIES[name]
    text = cases.text(name)
    (tmp_path / "copy").mkdir()
    shutil.copy(ROOT / f"derivations/{mechanism}.py", tmp_path / "copy")
    copied = text.replace(f'mechanism = "{mechanism}"', f'mechanism = "./{mechanism}.py"')
    assert copied != text
    there = run(tmp_path / "built_in", command, name, text, monkeypatch)
    here = run(tmp_path / "copy", command, name, copied, monkeypatch)
    return there, here


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[] if name in ("moroianu", "nunes-hypocycloid") else pytest.mark.slow)
        for name in COPIES
    ],
)
def test_forces_and_drawings_are_the_same(name, tmp_path, monkeypatch):
    there, here = both(["forces"], name, tmp_path, monkeypatch)
    assert there[:2] == here[:2] and there[2] == here[2]
    assert name == "chmielewski" or (there[0] == 0 and "mechanism.svg" in there[2])


@pytest.mark.slow
@pytest.mark.parametrize("name", COPIES)
def test_sizes_are_the_same(name, tmp_path, monkeypatch):
    there, here = both(["size"], name, tmp_path, monkeypatch)
    assert there == here


FRICTION = """
[friction]
mu_guide = 0.05
mu_pin = 0.01
mu_main = 0.005
radius_piston_pin = "12 mm"
radius_crank_pin = "20 mm"
radius_main = "25 mm"
"""
ENGINES = {"v-twin": ("v_twin", 0.05, 0.2, 2), "radial-engine": ("radial_engine", 0.05, 0.2, 3)}  # crank, rod, pistons


@pytest.mark.parametrize("name", ENGINES)
def test_friction_of_an_engine_of_ones_own_is_told_by_place(name, tmp_path, monkeypatch):
    """Coulomb's law on its loads, with speeds by hand: the first rod swings by asin(r sin / l)."""
    stem, r, rod, pistons = ENGINES[name]
    folder = ROOT / "examples/mechanisms"
    shutil.copy(folder / f"{stem}.py", tmp_path)
    code, out, files = run(tmp_path, ["forces"], name, (folder / f"{name}.toml").read_text() + FRICTION, monkeypatch)
    told = json.loads(out)
    heads, *rows = [line.split(",") for line in files["forces.csv"].splitlines()]
    column = dict(zip(heads, np.array(rows, dtype=float).T, strict=True))
    phi, omega = np.radians(column["phi_deg"]), told["speed_rpm"] * np.pi / 30
    swing = r / rod * np.cos(phi) / np.sqrt(1 - (r / rod * np.sin(phi)) ** 2)
    main, crank_pin = (np.hypot(column[f"R_x_{at} [N]"], column[f"R_y_{at} [N]"]) for at in "OA")
    sides = [column[f"R_n_G{n} [N]"] * slope(phi, column[f"x{n} [m]"]) for n in range(1, pistons + 1)]
    places = told["friction"]["places"]
    assert code == 0 and places["main_bearings"] == pytest.approx(0.005 * 0.025 * np.mean(main) * omega)
    assert places["crank_pins"] == pytest.approx(0.01 * 0.02 * np.mean(crank_pin * (1 + swing)) * omega, rel=1e-9)
    assert places["guides"] == pytest.approx(0.05 * np.abs(sides).mean(axis=1).sum() * omega, rel=1e-9)
    assert places["piston_pins"] > 0
    code, out, _ = run(tmp_path, ["size"], name, (folder / f"{name}.toml").read_text(), monkeypatch)
    largest = {row["component"]: row["value"] for row in json.loads(out) if row["quantity"] == "load, largest"}
    assert code == 0 and largest["R_x_O"] == max(abs(told["max"]["R_x_O"]), abs(told["min"]["R_x_O"]))


def slope(phi, values):
    """Derivative over a turn by its Fourier series: exact for what is smooth and periodic."""
    harmonics = np.fft.rfftfreq(phi.size, d=(phi[1] - phi[0]) / (2 * np.pi))
    return np.fft.irfft(1j * harmonics * np.fft.rfft(values), n=phi.size)


@pytest.mark.parametrize("name", ["opposed-pistons", "balandin", "zotov-89"])
def test_what_no_rule_sizes_tells_the_loads_of_its_joints(name):
    result = CliRunner().invoke(mechsym, ["size", name, "--json"])
    rows = json.loads(result.stdout)
    assert result.exit_code == 0 and {row["quantity"] for row in rows} == {"load, largest", "load, root mean square"}
    assert all(row["unit"] in ("N", "N*m") for row in rows)


def test_the_page_says_at_which_angle_a_load_is_largest(tmp_path, monkeypatch):
    """In degrees, as the JSON has it: within the cycle."""
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(mechsym, ["forces", "zotov-89", "--json", "--out", "out"])
    angle = json.loads(result.stdout)["angle_of_max_deg"]["crank_pin_load"]
    row = (tmp_path / "out/report.html").read_text().partition("<td>crank pin load</td>")[2].partition("</tr>")[0]
    assert f"{angle:.4g} deg</td>" in row
