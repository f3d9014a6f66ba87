"""The Geneva wheel of the book: while the pin drives, the wheel stands as the flank under the pin says."""

import re
from pathlib import Path

import numpy as np
import pytest

from mechsym import cases, jobs

PAGE = Path(__file__).parents[2] / "docs" / "own-mechanism.md"


@pytest.mark.slow
def test_a_pin_turns_the_wheel_by_a_quarter_in_each_turn(tmp_path):
    for file, text in re.findall(r"```\w+ file=(geneva\.\w+)\n(.*?)```", PAGE.read_text(), re.S):
        (tmp_path / file).write_text(text)
    result = jobs.run(cases.load(str(tmp_path / "geneva.toml"))).result
    t, phi, psi = result.t, result.columns["phi"], result.columns["psi"]
    events = [(e.name, e.kind, e.t) for e in result.happened.events]
    leaves = next(at for name, kind, at in events if (name, kind) == ("right0", "release"))
    drives = (t > events[0][2]) & (t < leaves)
    a, r, play = 0.06, 0.0424264068711928, 0.1e-3
    x, y = r * np.cos(phi[drives]) - a, r * np.sin(phi[drives])
    assert drives.sum() > 10
    np.testing.assert_allclose(
        psi[drives] % (2 * np.pi), np.arctan2(y, x) % (2 * np.pi) + np.arcsin(play / np.hypot(x, y)), atol=1e-9
    )
    stands = [psi[np.searchsorted(t, at)] for at in (0.7, 1.7)]
    assert stands[1] - stands[0] == pytest.approx(-np.pi / 2, abs=1e-6)
    assert abs(result.energy.residual) < 1e-10
