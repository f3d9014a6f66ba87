"""How a problem is integrated and how far its result must be trusted."""

from mechsym.quantities import choice, quantity, record
from mechsym.simulate.backends import BACKENDS, DEFAULT


@record
class Settings:
    """Tolerance, integrator and check of a run."""

    #: Relative and absolute tolerance of a step [-]
    tolerance: float = quantity("-", default=1e-10, low=3e-14, high=1e-2, about="tolerance of a step")
    backend: str = choice(*BACKENDS, default=DEFAULT, about="integrator")
    #: `tolerance` runs again at a hundredth of the tolerance and compares; `none` leaves that out
    check: str = choice("tolerance", "none", default="tolerance", about="check of convergence")
    #: Largest difference of a speed between the two runs, relative to its peak, that counts as converged [-]
    difference_allowed: float = quantity("-", default=1e-4, above=0, about="difference that counts as converged")
    max_steps: int = 5_000_000  #: Limit of steps in a smooth phase
