"""Parameters of a linkage in space, whose loop is closed by rows, out of its own speeds."""

from pathlib import Path

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.files import write_quantities
from mechsym.jobs.identify import identify
from mechsym.jobs.run import run

CASE = str(Path(__file__).parents[2] / "examples/space/rssr.toml")
SHORT = {"simulation.output_step": "0.005 s", "simulation.t_end": "0.8 s"}


@pytest.fixture(scope="module")
def trace(tmp_path_factory):
    columns = run(cases.load(CASE, SHORT)).result
    file = tmp_path_factory.mktemp("rssr") / "trace.csv"
    noise = np.random.default_rng(7).normal(0.0, 1e-3, columns.t.size)
    return write_quantities(file, {"t [s]": columns.t, "phid [rad/s]": columns.columns["phid"] + noise})


def test_two_letters_of_its_own_trace_lie_within_their_intervals(trace):
    found = identify(cases.load(CASE, {"I1": "0.024 kg*m^2", "m3": "0.5 kg"}), str(trace), ("I1", "m3"))
    assert found.status == "found"
    for name, value in (("I1", 0.02), ("m3", 0.6)):
        one = found.parameters[name]
        assert one.low < value < one.high
        assert one.high - one.low < 0.02 * value


def test_lengths_move_the_loop_too(trace):
    (one,) = identify(cases.load(CASE, {"c": "0.325 m"}), str(trace), ("c",)).estimates
    assert one.low < 0.32 < one.high and one.high - one.low < 0.002


def test_loops_that_leave_several_coordinates_are_refused(tmp_path):
    sizes = (
        "R = 1.0\nr = 0.6\nhalf = 0.4\ngap = 0.2\nplate_mass = 30\nlow = 3\nup = 2\nI = 2\nA = 0.1\nC = 0.005\ng = 9.81"
    )
    platform = Path(CASE).with_name("stewart.py")
    (tmp_path / "stewart.toml").write_text(f'mechanism = "{platform}:stewart"\n[parameters]\n{sizes}\n')
    with pytest.raises(BadInput, match="leave 6 coordinates; identify takes one"):
        identify(cases.load(str(tmp_path / "stewart.toml")), str(tmp_path / "t.csv"), ("I",))
