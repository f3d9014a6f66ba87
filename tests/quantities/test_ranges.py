"""One grammar of lists and ranges, for every option; and values in SI."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mechsym.errors import BadInput
from mechsym.quantities.ranges import read_range, values


@pytest.mark.parametrize(
    "text, unit, plain, found",
    [
        ("0.5,0.75,1", "-", "", [0.5, 0.75, 1]),
        ("50,75,100%", "-", "", [0.5, 0.75, 1]),
        ("50 %, 75 %", "-", "", [0.5, 0.75]),
        ("1", "-", "", [1]),
        ("3..8 MPa:3", "Pa", "", [3e6, 5.5e6, 8e6]),
        ("3 MPa .. 8 MPa : 2", "Pa", "", [3e6, 8e6]),
        ("8..3:2", "-", "", [8, 3]),
        ("30:90:30", "rad/s", "rpm", [3.141592653589793, 6.283185307179586, 9.42477796076938]),
        ("1:2:0.5 rad/s", "rad/s", "rpm", [1, 1.5, 2]),
        ("-30 deg:0 deg:15 deg", "rad", "", [-0.5235987755982988, -0.2617993877991494, 0]),
        ("0.1:0.3:0.1", "-", "", [0.1, 0.2, 0.3]),
        ("1e-1..+.5:2", "-", "", [0.1, 0.5]),
    ],
)
def test_values_in_si(text, unit, plain, found):
    assert values(text, unit, "--any", plain) == pytest.approx(found, rel=1e-15)


@pytest.mark.parametrize(
    "text, words",
    [
        ("", "--any '' takes numbers, as a list or a range; write for example 1,2,5 Pa, 1..5 Pa:9"),
        ("1,", "takes numbers"),
        ("1,two", "takes numbers"),
        ("nan", "takes numbers"),
        ("1..2:2.5", "takes numbers"),
        ("0.1:0.3:3", "the step 3 is longer than the range, one value is left; for 3 values write 0.1..0.3:3"),
        ("1:2", "takes numbers"),
        ("1..2", "--any: 1..2 does not say how many; write 1..2:5 or a list"),
        ("1+-2", "does not say how many"),
        ("1..2kPa:1", "one value of a range is its first end alone; write 1 kPa, or more values"),
        ("1..2:0", "0 values; allowed are 1 to 1000000"),
        ("1:1e9:1", "1000000000 values; allowed"),
        ("2:1:1", "needs a <= b and a step > 0"),
        ("1:2:0", "a step > 0"),
        ("1e999,2", "not finite"),
        ("1 Pa,2 kPa", "units Pa and kPa; write all values in one unit"),
        ("1,2 kg", "wrong dimension; give it in Pa"),
        ("1,2 stone", "'stone' is not known"),
    ],
)
def test_what_cannot_be_read_says_how_to_write_it(text, words):
    with pytest.raises(BadInput, match=words):
        values(text, "Pa", "--any")


def test_a_key_stands_in_the_message():
    with pytest.raises(BadInput, match="--over 'p0=x' takes numbers.* p0=1..5 Pa:9"):
        read_range("x", "--over", "Pa", "p0")


@pytest.mark.parametrize("text, kind", [("1..2 kg", "even"), ("3+-0.1 kg", "normal")])
def test_samples(text, kind):
    found = read_range(text, "--over")
    assert (found.kind, found.unit) == (kind, "kg")


@given(st.integers(-1000, 1000), st.integers(1, 100), st.integers(1, 200))
def test_steps_in_tenths_hold_both_ends(first, step, count):
    last = first + (count - 1) * step
    found = values(f"{first / 10}:{last / 10}:{step / 10}", "-", "--any")
    assert found == pytest.approx([(first + k * step) / 10 for k in range(count)], abs=1e-9)
