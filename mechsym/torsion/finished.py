"""A finished run in time and what is said of it, twist of the shaft and start-ups among it."""

from mechsym.page import Shown
from mechsym.plausible import Doubt
from mechsym.quantities import record
from mechsym.quantities.results import Columns, part, quantity, result
from mechsym.simulate import Result
from mechsym.simulate.result import RunNumbers
from mechsym.torsion.startup import StartUp, StartUpNumbers
from mechsym.torsion.train import TrainVibration
from mechsym.torsion.twist import Settling, ShaftSection


@record
class EngineSpeed:
    """What an engine's speed is looked at by."""

    coordinate: str  #: Its shaft
    words: str  #: Its name for people, empty where there is one shaft only
    period: float  #: A turn, or two of a four-stroke engine [rad]
    wanted: float  #: Speed of operation [rad/s]


@result
class FinishedRun(Shown):
    """A finished run and what is said of it."""

    case: str = part()
    backend: str = part()
    tolerance: float = quantity("-")  #: Of a step of the integrator
    summary: RunNumbers = part(inline=True)
    final_state: Columns = part()  #: Coordinates and velocities at the end, under the names of `[start]`
    natural_frequencies: tuple[float, ...] = quantity("rad/s")  #: Of an elastic shaft
    twist: tuple[ShaftSection, ...] = part()
    vibration: TrainVibration | None = part()  #: Criticals of a crank train
    findings: tuple[str, ...] = part()
    start_up: tuple[StartUpNumbers, ...] = part()  #: That of the run first, then one for each further damper
    settling: Settling | None = part()  #: Where an engine settles after a start against a load
    result: Result  # its columns
    start_ups: tuple[StartUp, ...]
    engine: EngineSpeed | None  # of an engine
    doubts: tuple[Doubt, ...] = part(default=())  #: Of gas and window, that no number of the summary tells

    @property
    def speed(self) -> Columns:
        """Mean, least and greatest speed at the end, of the engine's shaft or of the first coordinate [its unit]."""
        speeds = self.summary.speeds
        return speeds[self.engine.coordinate if self.engine else next(iter(speeds))]
