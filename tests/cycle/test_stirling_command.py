"""`mechsym cycle` of the built-in Stirling engine, all kinds, and the forces on its train."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.gas import gas
from mechsym.jobs.machine import turn
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters


def cycle(*options):
    found = CliRunner().invoke(mechsym, ["cycle", "alpha-stirling", "--json", *options])
    assert found.exit_code == 0, found.output
    return json.loads(found.stdout)


@pytest.mark.parametrize(
    ("kind", "work", "efficiency"),
    [("schmidt", 224.08, 0.6333), ("stirling-adiabatic", 201.23, 0.4915)],
)
def test_figures_of_the_ideal_kinds(kind, work, efficiency):
    found = cycle("--set", f"cycle.kind={kind}", "--speeds", "300,600")
    assert found["work_j"] == pytest.approx([work, work], abs=0.01)
    assert found["efficiency"] == pytest.approx([efficiency] * 2, abs=1e-4)
    assert found["power_kw"][0] == pytest.approx(work * 5 / 1e3, rel=1e-4)
    assert found["sfc_g_kwh"] == [None, None]
    assert found["losses"] == {}
    assert max(map(abs, found["energy_residual"])) < 1e-10
    for name in ("heat_in_j", "heat_out_j", "heat_regenerator_j", "T_e_max_k"):
        assert found[name][0] > 0


def test_losses_of_the_second_order_add_up():
    found = cycle("--set", "cycle.kind=stirling-second-order")
    lost = {name: values[0] for name, values in found["losses"].items()}
    work = sum(value for name, value in lost.items() if not name.endswith("_heat"))
    heat = sum(value for name, value in lost.items() if name.endswith("_heat"))
    turns = found["speed_rpm"][0] / 60
    assert found["power_kw"][0] * 1e3 == pytest.approx(found["work_j"][0] * turns - work, rel=1e-12)
    assert found["heat_in_kw"][0] * 1e3 == pytest.approx(found["heat_in_j"][0] * turns + heat, rel=1e-12)
    assert 0 < found["efficiency"][0] < found["indicated_efficiency"][0]


def test_files_and_text(tmp_path):
    options = ["cycle", "alpha-stirling", "--set", "cycle.kind=stirling-adiabatic", "--out", str(tmp_path)]
    found = CliRunner().invoke(mechsym, options)
    assert found.exit_code == 0
    assert "first law closed" in found.output
    table = np.genfromtxt(tmp_path / "cycle.csv", delimiter=",", names=True, deletechars="")
    assert {path.name for path in tmp_path.iterdir()} == {"performance.csv", "cycle.csv", "cycle.svg", "summary.json"}
    pressure = next(name for name in table.dtype.names if name.startswith("p_pa"))
    assert table[pressure].max() == pytest.approx(1.0374e6, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["schmidt", "stirling-adiabatic", "stirling-second-order"])
def test_mean_torque_on_the_train_is_the_work_of_the_gas(kind):
    case = cases.load("alpha-stirling", {"cycle.kind": kind})
    found = turn(case)
    work = float(np.mean(found.torque)) * 2 * math.pi
    assert work == pytest.approx(cycle("--set", f"cycle.kind={kind}")["work_j"][0], rel=1e-6)


def test_a_displacer_is_hardly_pushed():
    case = cases.load("alpha-stirling", {"cycle.arrangement": "beta", "cycle.kind": "stirling-adiabatic"})
    pushed = gas(case).pistons
    assert pushed[0] == 0
    assert pushed[1] == pytest.approx(math.pi / 4 * 0.09**2)


def test_missing_losses_are_named():
    case = cases.load("alpha-stirling", {"cycle.kind": "stirling-second-order"})
    bare = {name: section for name, section in case.sections.items() if name != "stirling"}
    with pytest.raises(BadInput, match=r"\[stirling\]"):
        turn(type(case)(**{**vars(case), "sections": bare}))
    assert isinstance(case.need("parameters"), CrankTrainParameters)


def test_rhombic_drive_is_a_crank_train():
    """The GPU-3 on the derived train is the one of test_stirling_second_order, whose drive is written out."""
    file = Path(__file__).parents[2] / "examples/gpu-3.toml"
    found = CliRunner().invoke(mechsym, ["cycle", str(file), "--json"])
    assert found.exit_code == 0, found.output
    result = json.loads(found.stdout)
    assert result["power_kw"][0] == pytest.approx(4.150, abs=0.002)
    assert result["efficiency"][0] == pytest.approx(0.3348, abs=0.001)


def with_phases(folder, phases):
    text = (Path(cases.__file__).parent / "alpha-stirling.toml").read_text()
    file = folder / "turned.toml"
    file.write_text(text.replace('phase = ["90 deg", "0 deg"]', f"phase = {phases}"))
    return str(file)


@pytest.mark.parametrize(("phases", "work"), [('["0 deg", "90 deg"]', -224.077), ('["0 deg", "0 deg"]', 0.0)])
def test_what_is_no_engine_has_no_efficiency(tmp_path, phases, work):
    # the cold piston leads: a heat pump; both together: the work of a turn is exactly nothing, and so is the heat
    done = CliRunner().invoke(mechsym, ["cycle", with_phases(tmp_path, phases), "--json"])
    found = json.loads(done.stdout)
    assert found["efficiency"] == [None] and found["indicated_efficiency"] == [None]
    assert [doubt["code"] for doubt in found["doubts"]] == ["driven"]
    assert abs(found["energy_residual"][0]) < 1e-10
    assert found["work_j"][0] == pytest.approx(work, abs=1e-3)


@pytest.mark.parametrize("side", ["hot", "cold"])
def test_second_order_without_an_exchanger_is_refused(side):
    settings = ["--set", "cycle.kind=stirling-second-order", "--set", f"cycle.clearance_share_{side}=1"]
    done = CliRunner().invoke(mechsym, ["cycle", "alpha-stirling", *settings])
    assert isinstance(done.exception, BadInput) and f"clearance_share_{side} = 1" in str(done.exception)


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ("operation.speed=3000 rpm", "flow_share"), ("operation.speed=5 rpm", "screen_reynolds"),
        ("stirling.seal_gap=0.3 mm", "seal_reynolds"), ("stirling.seal_gap=0.3 mm", "seal_gap"),
        ("stirling.porosity=0.9", "porosity"), ("stirling.shuttle_gap=5.5 mm", "shuttle_gap"),
    ],
)  # fmt: skip
def test_second_order_beyond_its_laws_is_doubted(change, code):
    found = cycle("--set", "cycle.kind=stirling-second-order", "--set", change)
    assert code in {doubt["code"] for doubt in found["doubts"]}
    assert found["flow_share"][0] > 0 and found["seal_reynolds"][0] > 0
