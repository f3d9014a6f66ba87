"""Livengood and Wu's integral of each cylinder of a loop, while its end gas waits for the flame."""

from typing import Any

import numpy as np

from mechsym.cycle.knock import end_gas_temperature, ignition_delay, kappa
from mechsym.simulate.loop.events import GasState
from mechsym.simulate.loop.system import PER_CYLINDER, Loop

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_BURNING = 1  # phase


class EndGas:
    """The integrals of all cylinders: `share` is 1 where the end gas ignites by itself [-]."""

    def __init__(self, loop: Loop) -> None:
        self.loop = loop
        self.share = [0.0] * len(loop.cylinders)
        self._start = [(1.0, 1.0, 0.0)] * len(loop.cylinders)  # p [Pa], T [K] and R/cp [-] when combustion starts

    def follow(self, piece: Any, function: Any, held: np.ndarray, gases: list[GasState]) -> None:
        """Add what a smooth piece of the run brings to the cylinders that are closed and not burnt out.

        Parameters
        ----------
        held : ndarray, shape (4 * cylinders,)
            As for `right_side` [rad]
        """
        waiting = [k for k, gas in enumerate(gases) if gas.whole and gas.phase <= _BURNING]
        if not waiting:
            return
        edges = piece.t
        half = np.diff(edges) / 2
        times = ((edges[:-1] + half)[:, None] + half[:, None] * _NODES).ravel()
        states = piece.sol(times)
        p = np.asarray(function.map(len(times))(states, np.repeat(held[:, None], len(times), axis=1))[1])
        weights = (half[:, None] * _WEIGHTS).ravel()
        for k in waiting:
            p_0, T_0, slope = self._start[k]
            T = states[self._own(k)] if gases[k].phase < _BURNING else end_gas_temperature(p[k], p_0, T_0, slope)
            self.share[k] += float(np.sum(weights / ignition_delay(p[k], T, self.loop.engine.cycle.octane)))

    def event(self, k: int, was: GasState, now: GasState, y: np.ndarray, p: float) -> None:
        """What the integral of a cylinder starts from in its next phase.

        Parameters
        ----------
        k : int
            Number of the cylinder, from 0
        y : ndarray, shape (n,)
            State, in its mixed units [-]
        p : float
            Pressure in the cylinder [Pa]
        """
        if now.phase == 0:
            self.share[k] = 0.0
        elif was.phase == 0:
            T = float(y[self._own(k)])
            self._start[k] = (p, T, float(kappa(self.loop.engine.gas, T)))

    def _own(self, k: int) -> int:
        return 2 * len(self.loop.mechanism.coordinates) + len(PER_CYLINDER) * k
