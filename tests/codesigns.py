"""Co-designs that several tests share, made once; points whose motion has a closed form."""

import dataclasses
import math
from functools import cache

import numpy as np
from scipy.interpolate import CubicSpline, PPoly
from scipy.special import ellipk

from mechsym import cases
from mechsym.codesign import front as fronts
from mechsym.codesign.front import cut_for_one
from mechsym.codesign.points import Point
from mechsym.codesign.programme import programme, solve
from mechsym.codesign.rank import rank
from mechsym.codesign.verify import verify
from mechsym.jobs.codesign import task_of


@cache
def task(**changes):
    """The built-in family: 60 to 142 rpm on the propeller curve, 2 %, one spring."""
    case = cases.load("zotov-89")
    made = task_of(case, case.need("codesign"))
    hardware = {k: changes.pop(k) for k in ("moving_mass",) if k in changes}
    made = dataclasses.replace(made, hardware=dataclasses.replace(made.hardware, **hardware))
    if "at" in changes:
        made = dataclasses.replace(made, points=tuple(made.points[k] for k in changes.pop("at")))
    return dataclasses.replace(made, **changes)


@cache
def ready(**changes):
    return programme(task(**changes))


@cache
def design(ripple=0.02, **changes):
    return solve(task(ripple=ripple, **changes), ready(**changes))


@cache
def verified(ripple=0.02, **changes):
    return verify(design(ripple, **changes))


@cache
def bound():
    return rank(task().points)


@cache
def cut():
    return cut_for_one(task(), 2)


@cache
def front():
    return fronts(task(), (0.02, 0.05, 0.12), ready())


OMEGA, OWN = 12.0, 0.5
TURN = 2 * math.pi


def periodic(values, period=TURN, count=361):
    x = np.linspace(0, period, count)
    y = values(x)
    y[-1] = y[0]
    spline = CubicSpline(x, y, bc_type="periodic")
    return PPoly(spline.c, spline.x, extrapolate="periodic")


def point(work, omega=OMEGA, own=OWN, law="constant", load_torque=40.0, period=TURN, kinks=()):
    return Point(
        omega=omega, load_torque=load_torque, law=law, period=period, work=periodic(work, period),
        inertia=periodic(lambda phi: np.full_like(phi, own), period), torque=np.zeros_like, kinks=kinks,
    )  # fmt: skip


def constant_load(amplitude, ratio):
    r"""Inertia and ripple of phid = sqrt(b - a sin 2 phi), b = ratio a, whose mean in time is OMEGA.

    The mean of 1 / phid over the angle is 2 K(2a / (a + b)) / (pi sqrt(a + b)).
    """
    root = OMEGA * 2 * ellipk(2 / (1 + ratio)) / math.pi  # sqrt(a + b)
    a = root**2 / (1 + ratio)
    return 2 * amplitude / a, (root - math.sqrt((ratio - 1) * a)) / OMEGA
