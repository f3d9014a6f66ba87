"""Engines and hinges that several tests share; made once."""

from functools import cache

import numpy as np

from mechsym import cases, jobs
from mechsym.hinge.balance import balance
from mechsym.hinge.torque import EngineTorques, engine_torques, hinge_of, torque

LOWER, HIGHER = "zotov-89", "zotov-142"


@cache
def engine(name=LOWER):
    return jobs.machine(cases.load(name))


@cache
def built(name=LOWER):
    return torque(engine(name))


@cache
def whole(name=LOWER):
    return balance(built(name), "whole_cycle")


def section(name, case=LOWER):
    return cases.load(case).need(name)


def exact_torque(name, phi):
    """Equation (8) from the engine's functions, without any fitted polynomial but the mean."""
    torques, omega = engine_torques(engine(name)), engine(name).omega
    inertia = omega**2 / 2 * torques.dinertia_dphi(phi)
    return inertia - torques.gas_torque(phi) + built(name).load_torque - torques.gravity_torque(phi)


def four_stroke(kink=0.3):
    """A synthetic engine whose torque repeats every two turns: gas work in one of them, a Wiebe-like kink."""

    def burning(phi):
        y = np.mod(phi - kink, 4 * np.pi) / 2
        return np.where(y < np.pi, y**1.72 * np.exp(-3 * y), np.pi**1.72 * np.exp(-3 * np.pi) * (2 * np.pi - y) / np.pi)

    return EngineTorques(
        inertia=lambda phi: 3.0 - np.cos(2 * phi),
        dinertia_dphi=lambda phi: 2 * np.sin(2 * phi),
        gas_torque=lambda phi: 400 * burning(phi) * np.sin(phi) + 30 * np.sin(phi) + 50,
        gravity_torque=lambda phi: 5 * np.cos(phi),
        kinks=(kink, kink + 2 * np.pi),
        period=4 * np.pi,
    )


@cache
def built_four_stroke():
    return hinge_of(four_stroke(), 20.0)


def monotone_seal_torque(swing, mu):
    """Mean torque of seals that slip once each way in a turn: 2 mu swing / 2 pi [N*m]."""
    return mu * swing / np.pi


def small_stroke_index(x, gamma=1.4):
    """Index of a gas spring for small strokes, its imaginary part the loss; x = omega tau [rad]."""
    return 1 + (gamma - 1) * complex(x**2, x) / (1 + x**2)
