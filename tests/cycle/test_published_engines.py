"""The gas exchange that a new engine starts with, in the sizes of engines whose rated power is published."""

import tomllib
from pathlib import Path

import pytest

from mechsym import cases
from mechsym.cases.new_engine import write_engine
from mechsym.jobs.cycle import cycle

ENGINES = tomllib.loads((Path(__file__).parent / "published-engines.toml").read_text("utf-8"))["engine"]
FIGURES = ("volumetric_efficiency", "mep_kpa", "brake_power_kw", "brake_sfc_g_kwh")


def figures(engine, folder):
    file = write_engine("inline", engine["bore"], engine["stroke"], 1, folder)[0]
    changed = {"operation.speed": f"{engine['rpm']} rpm", "chamber.compression_ratio": str(engine["compression_ratio"])}
    changed["breathing.valves"] = "1"
    for valve, share in (("inlet", 0.43), ("exhaust", 0.37)):
        width = 0.9 * engine[f"{valve}_head"] if f"{valve}_head" in engine else share * engine["bore"]
        changed[f"breathing.{valve}_diameter"] = f"{width} m"
        changed[f"breathing.{valve}_lift"] = f"{engine.get('lift', width / 4)} m"
    found = cycle(cases.load(str(file), changed))
    return {name: float(found[name][0]) for name in FIGURES}


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES, ids=lambda engine: engine["name"])
def test_full_load_of_published_engines(engine, tmp_path):
    """Filling and mean pressure as engines have them; power as far as plain pipes and assumed timing allow."""
    found = figures(engine, tmp_path)
    assert 0.75 < found["volumetric_efficiency"] < 0.92
    assert 800 < found["mep_kpa"] < 1100
    assert 0.7 < found["brake_power_kw"] * engine["cylinders"] / engine["kw"] < 1.1
    assert 230 < found["brake_sfc_g_kwh"] < 330
