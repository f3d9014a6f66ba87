"""How a problem is integrated, by which integrator, and how far its result must be trusted.

`native` runs a whole problem in compiled C; `auto` takes it where there is a compiler and the problem has no plain
Python callables, otherwise scipy. Each of the others takes a `Phase` and returns a `Leg`; a new one is one line here.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

from mechsym.errors import BadInput
from mechsym.quantities import choice, load, quantity, record

if TYPE_CHECKING:
    from mechsym.simulate.phase import Leg, Phase


DEFAULT, FALLBACK = "auto", "scipy-dop853"
NATIVE = ("auto", "native")
# name: ("module:function", arguments after the phase); imported on first use
_PHASES: dict[str, tuple[str, tuple[str, ...]]] = {
    "scipy-dop853": ("mechsym.simulate.backends:advance", ("DOP853",)),
    "scipy-rk45": ("mechsym.simulate.backends:advance", ("RK45",)),
    "scipy-rk23": ("mechsym.simulate.backends:advance", ("RK23",)),
    "scipy-lsoda": ("mechsym.simulate.backends:advance", ("LSODA",)),
    "scipy-radau": ("mechsym.simulate.backends:advance", ("Radau",)),
    "scipy-bdf": ("mechsym.simulate.backends:advance", ("BDF",)),
    "sundials": ("mechsym.simulate.backends:advance_sundials", ()),
    "heyoka": ("mechsym.simulate.backends:advance_heyoka", ()),
}

BACKENDS = (*NATIVE, *_PHASES)


def backend(name: str) -> "Callable[[Phase], Leg]":
    """The function that integrates a phase."""
    if name not in _PHASES:
        raise BadInput(f"backend {name!r} does not go phase by phase; there are {', '.join(_PHASES)}")
    path, arguments = _PHASES[name]
    advance = load(path)
    return lambda phase: advance(phase, *arguments)


_STEP = 0.01  # of results where none is given [s]


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


@record
class Simulation:
    """Section `[simulation]`: how long, from where, how exactly."""

    #: Last time; with turns too, the run ends at what comes first [s]
    t_end: float | None = quantity("s", default=None, above=0, about="last time")
    #: Turns of the crank to run [-]
    turns: float | None = quantity("-", default=None, above=0, about="turns to run")
    #: Speed of every coordinate at the start; None takes the speed of operation of an engine, else rest [rad/s]
    speed_start: float | None = quantity("rad/s", default=None, about="speed at the start")
    phi_start: float = quantity("rad", default=0.0, about="angle at the start")
    #: Relative and absolute tolerance of a step [-]
    tolerance: float = quantity("-", default=1e-10, low=3e-14, high=1e-2, about="tolerance of a step")
    backend: str = choice(*BACKENDS, default=DEFAULT, about="integrator")
    #: Spacing of the results in a run to t_end, None for 0.01 s; a run over turns has 360 results a turn [s]
    output_step: float | None = quantity(
        "s", default=None, above=0, about="spacing of the results, 0.01 s if not given"
    )
    #: Stretch at the end over which speeds are summed up; None takes the last period of what drives (a turn, or two of
    #: a four-stroke engine), or all of a run to t_end [s]
    window: float | None = quantity("s", default=None, above=0, about="stretch at the end for the mean speed")
    #: `designed` puts the hinge of the case's `[spring]` and `[guide]` on the shaft, `none` leaves it away
    hinge: str = choice("designed", "none", default="designed", about="hinge of an engine")
    #: Largest relative difference to the run at the tighter tolerance that counts as converged [-]
    difference_allowed: float = quantity("-", default=1e-4, above=0, about="difference that counts as converged")

    def __post_init__(self) -> None:
        if self.t_end is None and self.turns is None:
            raise BadInput("neither t_end nor turns says where the run ends; give t_end in s or turns")
        if self.t_end is None and self.output_step is not None:
            why = f"output_step = {self.output_step:g} s is not used over turns, which give 360 results each"
            raise BadInput(f"{why}; leave it out, or give t_end in s")
        if self.t_end is not None and self.turns is None:
            for name, value in (("output_step", self.output_step), ("window", self.window)):
                if (value or 0.0) > self.t_end:
                    raise BadInput(f"{name} = {value:g} s is longer than the run, t_end = {self.t_end:g} s; shorten it")

    @property
    def step(self) -> float:
        """Spacing of the results in a run to t_end [s]."""
        return _STEP if self.output_step is None else self.output_step


@record
class StepTorque:
    """Section `[drive]`: a torque that is switched on."""

    #: The mechanism's input; None takes M_drive of a crank train, the torque at its free end, and M of any other
    input: str | None = None
    time: float = quantity("s", default=0.0, low=0, about="when the torque is switched on")
    #: Torque from then on, 0 before [N*m]
    torque: float = quantity("N*m", about="driving torque")
