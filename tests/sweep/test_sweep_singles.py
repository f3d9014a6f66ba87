"""Sweeps over what the other commands say, and sweeps on a cluster: the numbers are those of single commands."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.sweep import Means, Plan, columns, failures, sweep


def command(*words):
    return json.loads(CliRunner().invoke(mechsym, [*words, "--json"]).stdout)


@pytest.mark.slow
def test_forces_are_those_of_the_command():
    data = columns(sweep(Plan(case="zotov-89", over=("speed_rpm=88,89",), analysis="forces")))
    alone = command("forces", "zotov-89", "--set", "speed_rpm=88")
    named = {f"{end}.{name}": value for end in ("max", "min") for name, value in alone[end].items()}
    assert len(named) > 20 and {name: data[name][0] for name in named} == named
    assert data["power_residual"][0] == alone["power_residual"] and data["max.torque"][0] != data["max.torque"][1]


@pytest.mark.slow
def test_sizes_are_those_of_the_command():
    data = columns(sweep(Plan(case="nunes-slider-crank", over=("sizing.life=500,600 h",), analysis="size")))
    rows = command("size", "nunes-slider-crank", "--set", "sizing.life=600 h")
    values = sorted(v for n, v in ((n, v[1]) for n, v in data.items()) if not n.endswith((".limit", ".safety_factor")))
    alone = [float(r["value"]) for r in rows if isinstance(r["value"], int | float)]
    # no row is lost to another of its name; failing and converged come on top
    assert values == sorted([*alone, 0.0, 1.0])
    checks = [r for r in rows if r["limit"] is not None]
    assert sum(n.endswith(".safety_factor") for n in data) == len(checks) > 5


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_a_cluster_of_two_gives_the_same():
    distributed = pytest.importorskip("distributed")
    plan = Plan(case="zotov-89", over=("spring.p0=4,6,8 MPa", "speed=-1,9"), show=("check.speed_ripple", "guide"))
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        found = sweep(plan, means=Means(scheduler=cluster.scheduler_address))
    alone = sweep(plan)
    np.testing.assert_equal(columns(found), columns(alone))
    assert failures(found) == failures(alone) and len(failures(alone)) == 3


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_nobody_at_the_address():
    pytest.importorskip("distributed")
    with pytest.raises(BadInput, match="--scheduler nonsense://x: no scheduler answers"):
        sweep(Plan(case="zotov-89", over=("spring.p0=4,6 MPa",)), means=Means(scheduler="nonsense://x"))


def test_without_dask(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(BadInput, match=r"needs dask.distributed .* pip install 'mechsym\[cluster\]'"):
        sweep(Plan(case="zotov-89", over=("spring.p0=4,6 MPa",)), means=Means(scheduler="tcp://127.0.0.1:1"))
