"""Two checks of every run: does the energy balance, and does a tighter tolerance say the same."""

from collections.abc import Mapping

import numpy as np

from mechsym.mechanisms.record import Mechanism
from mechsym.native import compiled
from mechsym.simulate.result import Energy

# a run whose energy balances to this is integrated well; if it still differs from its check, the motion is to blame
_GOOD_ENERGY = 1e-6


def energies(mechanism: Mechanism, q: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Kinetic and potential energy along a run.

    Parameters
    ----------
    q, u : ndarray, shape (n, m)
        Coordinates and velocities, one row each [rad, rad/s]

    Returns
    -------
    kinetic, potential : ndarray, shape (m,)
        None instead of both for a model given only by its equations [J]
    """
    if "energy" not in mechanism.functions:
        return None
    kinetic, potential = compiled(mechanism.functions["energy"]).batch(*q, *u)
    return kinetic, potential


def energy_audit(roles: Mapping[str, str], columns: Mapping[str, np.ndarray]) -> Energy:
    """Balance of work, dissipation and energy over a run.

    Parameters
    ----------
    roles : mapping of str to str
        Side of the balance of each part by its name, `drive` counts as work in
    columns : mapping of str to ndarray
        Its columns, first entry at the start, last at the end
    """
    work = {name: float(columns[f"work_{name}"][-1]) for name in roles}
    work_in = sum(work[name] for name, role in roles.items() if role == "drive")
    lost = float(columns["dissipation"][-1])
    if "kinetic_energy" not in columns:
        return Energy(work=work, work_in=work_in, dissipation=lost, change=None, reference=work_in, residual=None)
    total = columns["kinetic_energy"] + columns["potential_energy"]
    change = float(total[-1] - total[0])
    peak = float(max(np.ptp(total), np.max(columns["kinetic_energy"])))
    reference = work_in if abs(work_in) > 1e-3 * peak else peak
    residual = (sum(work.values()) - lost - change) / reference if reference else 0.0
    return Energy(work=work, work_in=work_in, dissipation=lost, change=change, reference=reference, residual=residual)


def speed_difference(a: Mapping[str, np.ndarray], b: Mapping[str, np.ndarray]) -> np.ndarray:
    """Difference of two runs at each common time: the worst speed, relative to its peak.

    Parameters
    ----------
    a, b : mapping of str to ndarray, shape (n,)
        Velocities of the two runs at the same times [rad/s]

    Returns
    -------
    difference : ndarray, shape (n,)
        0 where they agree [-]
    """
    peaks = {name: float(np.max(np.abs(speed))) or 1.0 for name, speed in a.items()}
    return np.max([np.abs(a[name] - b[name]) / peak for name, peak in peaks.items()], axis=0)


def verdict(
    t: np.ndarray, difference: np.ndarray, allowed: float, residuals: tuple[float | None, float | None]
) -> tuple[str, str]:
    """Whether a run converged, and if not whether the integration or the motion is to blame.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times [s]
    difference : ndarray, shape (n,)
        Difference to the run at the tighter tolerance [-]
    allowed : float
        Largest difference that counts as converged [-]
    residuals : tuple of float or None
        Energy residuals of both runs [-]

    Returns
    -------
    status, reason : str
        `converged`, `not converged` or `chaotic`, and a line that says why
    """
    worst = float(np.max(difference))
    if worst <= allowed:
        return "converged", f"speeds differ by {worst:.2g} at most from the run at the tighter tolerance"
    since = float(t[int(np.argmax(difference > allowed))])
    parted = f"the runs at the two tolerances part by more than {allowed:g} from t = {since:.6g} s on"
    if all(r is not None and abs(r) < _GOOD_ENERGY for r in residuals):
        return "chaotic", (
            f"{parted} although the energy balances in both: the motion is sensitive (chaos, or a resonance that "
            "catches or releases by chance); trust it until then only"
        )
    return "not converged", f"{parted} (up to {worst:.2g}); use a smaller tolerance"
