"""Published numbers beside computed ones: keys, record, and what contradicts the print."""

import json
import subprocess
import sys

import numpy as np
import pytest

from mechsym import recorded
from mechsym.errors import BadInput
from mechsym.reproduce import catalogue, prymak, zotov2024
from mechsym.reproduce.chmielewski2015_runs import rigid_speed
from mechsym.reproduce.rows import VERDICTS, row

KEYS = {"source", "item", "published", "computed", "rel_error", "verdict", "note"}


@pytest.mark.parametrize("name", ["zotov2024", "moroianu2017", "prymak"])
def test_rows_have_keys_and_agree_with_the_record(name):
    rows = catalogue.rows(name)
    assert rows and all(set(r) >= KEYS and r["verdict"] in VERDICTS for r in rows)
    assert not recorded.differences("mechsym.reproduce", rows, ("source", "item"), ("verdict",))


def test_differences_from_the_record_are_noticed():
    rows = catalogue.rows("prymak")
    changed = [
        rows[0] | {"verdict": "not reproduced"},
        *rows[2:],
        row(prymak.SOURCE, "new", None, None, "reproduced", ""),
    ]
    lines = recorded.differences("mechsym.reproduce", changed, ("source", "item"), ("verdict",))
    assert len(lines) == 3


def test_the_resultant_turns_with_the_crank():
    alpha = np.linspace(0, 6, 50)
    along, across = prymak.inertia_resultant(alpha)
    assert np.allclose(np.hypot(along, across), 4 * prymak.MASS * prymak.RADIUS * prymak.SPEED**2, rtol=1e-13)
    assert np.allclose(np.unwrap(np.arctan2(across, along)), alpha, atol=1e-12)


def test_hinge_torque_has_no_mean_but_guide_needs_more_pressure_than_printed():
    slow, fast = zotov2024.engines().hinges
    assert abs(slow.mean_torque) < 1e-9 * zotov2024.peak(slow)
    assert 2.3 < zotov2024.peak(fast) / zotov2024.peak(slow) < 2.6
    assert 2.3 < zotov2024.best_pressure().setting / 5e6 < 2.6
    assert all(zotov2024.longest_stretch(m.guide) > 0 for m in zotov2024.guides() if m.start == "as_printed")


def test_a_rigid_drive_cannot_reach_194_by_90_seconds():
    assert rigid_speed(90.0) == pytest.approx(1.5 * 89 / 0.84)
    assert rigid_speed(90.0) < 194


def test_unknown_source_is_refused():
    with pytest.raises(BadInput, match="chmielewski2015"):
        catalogue.short_name("nobody")


def test_command_gives_json_and_figures(tmp_path):
    command = [sys.executable, "-m", "mechsym", "reproduce", "003", "--json", "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert all(set(r) >= KEYS for r in json.loads(done.stdout))
    assert (tmp_path / "prymak-fig3.svg").read_text().startswith("<svg")


@pytest.mark.slow
def test_the_start_up_is_converged_and_contradicts_the_print():
    rows = {r["item"]: r for r in catalogue.rows("chmielewski2015")}
    assert not recorded.differences("mechsym.reproduce", list(rows.values()), ("source", "item"), ("verdict",))
    means = [r["computed"] for item, r in rows.items() if "tolerance" in item and "_printed" in item]
    assert len(means) == 4 and np.ptp(means) < 1e-4 * np.mean(means)
    assert abs(np.mean(means) / 194 - 1) > 0.3
    assert rows["Fig. 11: amplitude of the crank's acceleration at 98 s over that at 90 s"]["rel_error"] < 0.01
