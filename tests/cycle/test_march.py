"""The thesis's march: its balance, and what it must refuse."""

import dataclasses

import numpy as np
import pytest

from mechsym.cases import load
from mechsym.cycle.chamber import volume
from mechsym.cycle.engine import over_speeds
from mechsym.cycle.heat import NasaMixture
from mechsym.cycle.kinds.printed import marched, performance_printed
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine
from mechsym.quantities import RPM

SPEEDS = np.arange(500.0, 8001.0, 500.0) * RPM


@pytest.fixture(scope="module")
def machine():
    return engine(load("nunes-slider-crank", {"cycle.method": "nunes2017_printed"}))


def test_each_step_obeys_the_printed_first_law_3_4(machine):
    result = marched(machine, SPEEDS)
    v1, v2, p1, p2 = result.v[:-1, None], result.v[1:, None], result.p[:-1], result.p[1:]
    right = (p2 * v2 - p1 * v1) / 0.4 + (p1 + p2) / 2 * (v2 - v1)
    left = result.heat_released - result.wall_heat - result.latent_heat
    assert np.abs(left - right).max() < 1e-10


def test_fuel_evaporates_only_before_ignition_and_never_quite_all_of_it(machine):
    result = marched(machine, SPEEDS)
    assert np.all(result.latent_heat[172:] == 0)
    assert np.all(result.latent_heat.sum(axis=0) <= result.fuel * machine.cycle.latent_heat)


def test_method_is_chosen_by_name(machine):
    assert np.array_equal(over_speeds(machine, SPEEDS).p_max, performance_printed(machine, SPEEDS).p_max)


def test_volume_is_the_chamber_s(machine):
    from mechsym.cycle.chamber import chamber

    room = chamber(machine.chamber, machine.motion)
    assert marched(machine, SPEEDS).v[180] == pytest.approx(volume(room, 0.0), rel=1e-14)


def test_only_constant_gamma_and_whole_strokes(machine):
    with pytest.raises(BadInput, match="constant_gamma"):
        marched(dataclasses.replace(machine, gas=NasaMixture()), SPEEDS)
    early = dataclasses.replace(machine.cycle, exhaust_opens=2.5)
    with pytest.raises(BadInput, match="exhaust_opens"):
        marched(dataclasses.replace(machine, cycle=early), SPEEDS)
