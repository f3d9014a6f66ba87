"""How a problem is integrated and how far its result must be trusted."""

from dataclasses import dataclass

from mechsym.quantities import check, choice, quantity
from mechsym.simulate.backends import BACKENDS, DEFAULT


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Tolerance, integrator and check of a run.

    Parameters
    ----------
    tolerance : float
        Relative and absolute tolerance of a step [-]
    backend : str
        Name of the integrator
    check : str
        `tolerance` runs again at a hundredth of the tolerance and compares; `none` leaves that out
    difference_allowed : float
        Largest difference of a speed between the two runs, relative to its peak, that counts as converged [-]
    max_steps : int
        Limit of steps in a smooth phase
    """

    tolerance: float = quantity("-", default=1e-10, low=3e-14, high=1e-2, about="tolerance of a step")
    backend: str = choice(*BACKENDS, default=DEFAULT, about="integrator")
    check: str = choice("tolerance", "none", default="tolerance", about="check of convergence")
    difference_allowed: float = quantity("-", default=1e-4, above=0, about="difference that counts as converged")
    max_steps: int = 5_000_000

    def __post_init__(self) -> None:
        check(self)
