"""Two checks of every run: does the energy balance, and does a tighter tolerance say the same."""

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from mechsym.mechanisms.record import Mechanism, velocities
from mechsym.native import compiled
from mechsym.native.evaluate import Compiled
from mechsym.quantities.display import residual_text
from mechsym.quantities.units import Array, Joule, Pure, RadPerSecond, Second
from mechsym.simulate.equations import RUBS, fitted
from mechsym.simulate.problem import Periodic, Problem
from mechsym.simulate.result import Energy

# a run whose energy balances to this is integrated well; if it still differs from its check, the motion is to blame
_GOOD_ENERGY = 1e-6


def energies(
    mechanism: Mechanism, q: np.ndarray, u: np.ndarray, letters: tuple[float, ...] = ()
) -> tuple[np.ndarray, np.ndarray] | None:
    """Kinetic and potential energy along a run.

    q, u: coordinates and velocities, one row each [rad, rad/s], shape (n, m); letters: parameters that the mechanism of
    a family leaves open [SI]. Returns kinetic, potential: None instead of both for a model given only by its equations
    [J], shape (m,).
    """
    if "energy" not in mechanism.functions:
        return None
    kinetic, potential = _energy(mechanism).batch(*q, *u, *letters)
    return kinetic, potential


@lru_cache(maxsize=64)
def _energy(mechanism: Mechanism) -> Compiled:
    return compiled(mechanism.functions["energy"])


def energies_beside(problem: Problem, columns: Mapping[str, np.ndarray]) -> dict[str, Joule[Array]]:
    """Energy in what turns and what is stored beside a mechanism.

    columns: of the run, with the mechanism's own kinetic energy [SI]. Returns energies: `kinetic_energy` of all,
    `stored_energy`; only what there is.
    """
    energies: dict[str, np.ndarray] = {}
    if problem.inertia is not None:
        u = columns[velocities(problem.mechanism)[0]]
        energies["kinetic_energy"] = columns["kinetic_energy"] + _along(problem.inertia[0], columns) * u**2 / 2
    if problem.stored is not None:
        speeds = [columns[name] for name in velocities(problem.mechanism)]
        curves = [_along(curve, columns) for curve in problem.curves]
        energies["stored_energy"] = problem.stored.function(speeds, curves, [columns[s.name] for s in problem.states])
    return energies


def _along(curve: Periodic, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    return np.asarray(fitted(curve)(columns[curve.coordinate]))


def energy_audit(roles: Mapping[str, str], columns: Mapping[str, np.ndarray], heats: tuple[str, ...] = ()) -> Energy:
    """Balance of work, dissipation and energy over a run.

    Where the energy in stores is known, it and the heat that leaves them stand in the balance for their work. roles:
    side of the balance of each part by its name, `drive` counts as work in; columns: its columns, first entry at the
    start, last at the end; heats: columns of heat that has left a store [J].
    """
    work = {name: float(columns[f"work_{name}"][-1]) for name in roles}
    work_in = sum(work[name] for name, role in roles.items() if role == "drive")
    lost = float(columns["dissipation"][-1])
    losses = {name: -work[name] for name, role in roles.items() if role == "loss"}
    losses |= {name: float(columns[name][-1] - columns[name][0]) for name in heats}
    friction = {name.removeprefix(RUBS): float(columns[name][-1]) for name in columns if name.startswith(RUBS)}
    if "kinetic_energy" not in columns:
        return Energy(
            work=work, work_in=work_in, dissipation=lost, change=None, reference=work_in, residual=None, losses=losses,
            friction=friction,
        )  # fmt: skip
    total = columns["kinetic_energy"] + columns["potential_energy"]
    work_done = sum(work.values())
    if "stored_energy" in columns:
        total = total + columns["stored_energy"]
        work_done -= sum(work[name] for name, role in roles.items() if role == "store") + sum(
            losses[name] for name in heats
        )
    change = float(total[-1] - total[0])
    peak = float(max(np.ptp(total), np.max(columns["kinetic_energy"])))
    reference = work_in if abs(work_in) > 1e-3 * peak else peak
    residual = (work_done - lost - change) / reference if reference else 0.0
    return Energy(work=work, work_in=work_in, dissipation=lost, change=change, reference=reference, residual=residual,
                  losses=losses, friction=friction)  # fmt: skip


def speed_difference(a: Mapping[str, RadPerSecond[Array]], b: Mapping[str, RadPerSecond[Array]]) -> Pure[Array]:
    """Difference of two runs at each common time: the worst speed, relative to its peak.

    a, b: velocities of the two runs at the same times. Returns difference: 0 where they agree.
    """
    peaks = {name: float(np.max(np.abs(speed))) or 1.0 for name, speed in a.items()}
    return np.max([np.abs(a[name] - b[name]) / peak for name, peak in peaks.items()], axis=0)


def verdict(
    t: Second[Array], difference: Pure[Array], allowed: Pure, residuals: tuple[Pure | None, Pure | None]
) -> tuple[str, str]:
    """Whether a run converged, and if not whether the integration or the motion is to blame.

    difference: difference to the run at the tighter tolerance; allowed: largest difference that counts as converged;
    residuals: energy residuals of both runs. Returns status, reason: `converged`, `not converged` or `chaotic`, and a
    line that says why.
    """
    worst = float(np.max(difference))
    if worst <= allowed:
        return (
            "converged",
            f"difference to the run at the tighter tolerance: {residual_text(worst, 2)} of the peak speed",
        )
    since = float(t[int(np.argmax(difference > allowed))])
    parted = f"the runs at the two tolerances part by more than {allowed:g} from t = {since:.6g} s on"
    if all(r is not None and abs(r) < _GOOD_ENERGY for r in residuals):
        return "chaotic", (
            f"{parted} although the energy balances in both: the motion is sensitive (chaos, or a resonance that "
            "catches or releases by chance); trust it until then only"
        )
    return "not converged", f"{parted} (up to {worst:.2g}); use a smaller tolerance"
