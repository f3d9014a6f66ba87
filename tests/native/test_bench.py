"""The routes of the bench start: what they call moves with the package, and a run of all of them takes minutes."""

import functools

import pytest

from benchmarks import p1_derive


@pytest.mark.parametrize("route", ["_warm", "_cold"])
def test_routes_to_accelerations_agree(route):
    routes = {"mechsym": getattr(p1_derive, route), "casadi": p1_derive._casadi}
    taken = p1_derive._checked(1, {name: (functools.partial(make, 1), 1) for name, make in routes.items()})
    assert taken[1].error < 1e-9
