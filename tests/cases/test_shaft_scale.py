"""A section of a shaft is judged by the two sides that swing against each other: 1/I = 1/I1 + 1/I2."""

import math

import pytest

from mechsym.cases.doubts import by_shaft
from mechsym.mechanisms.shaft import ElasticShaft


@pytest.mark.parametrize(("zeta", "codes"), [(1.9, []), (2.1, ["shaft_damping"])])
def test_damping_of_two_discs_is_that_of_their_swing(zeta, codes):
    k, c = 400.0, zeta * 2 * math.sqrt(400.0 * 0.75)  # 1 and 3 kg*m^2 swing as 0.75
    assert [d.code for d in by_shaft(ElasticShaft(discs=(1.0, 3.0), k=(k,), c=(c,)))] == codes


def test_a_coupling_carries_all_that_is_before_it():
    discs, k = (1.0, 1.0, 1.0, 6.0), (9e4, 9e4, 100.0)  # 3 against 6: 2 kg*m^2 behind the soft section
    c = 1.9 * 2 * math.sqrt(100.0 * 2.0)
    assert by_shaft(ElasticShaft(discs=discs, k=k, c=(c, c, c))) == ()
    assert [d.code for d in by_shaft(ElasticShaft(discs=discs, k=k, c=(c, c, 1.2 * c)))] == ["shaft_damping"]
