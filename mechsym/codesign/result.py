"""What the job of a co-design gives: the design, its bound, what stands beside it, its checks, costs and dangers."""

from mechsym.codesign.front import CutForOne
from mechsym.codesign.peers import Rival
from mechsym.codesign.rank import Bound
from mechsym.codesign.real import Lossy
from mechsym.codesign.scenarios import Scenario
from mechsym.codesign.schedule import RippleMap
from mechsym.codesign.task import CoDesign
from mechsym.codesign.uncertainty import Spread
from mechsym.codesign.verify import Verified
from mechsym.hinge.losses import HingeLosses, LossTorques
from mechsym.page import Shown
from mechsym.quantities import quantity, record


@record
class CoDesignResult(Shown):
    """Everything that the report of a co-design shows."""

    name: str  #: of the case
    about: str
    design: CoDesign
    bound: Bound
    bare: float = quantity("kg*m^2", about="flywheel without a hinge")
    cut: CutForOne  #: the guide of the middle point used for all
    verified: Verified
    losses: tuple[LossTorques, ...]  #: at each point
    assumed: HingeLosses  #: friction and heat that they were computed with
    lossy: tuple[Lossy, ...]  #: each point with them, its springs filled anew
    misfire: tuple[float | None, ...]  #: lowest speed after a lost combustion by the mean, at each point; 0 stalls [-]
    front: tuple[CoDesign, ...]
    peers: tuple[Rival, ...] = ()  #: computed where they are asked for only
    scenarios: tuple[Scenario, ...] = ()  #: computed for the report only
    spread: Spread | None = None  #: computed for the report only
    map: RippleMap | None = None  #: computed for the report only
