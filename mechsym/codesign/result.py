"""What the job of a co-design gives: the design, its bound, what stands beside it, its checks, costs and dangers."""

from mechsym.codesign.floor import Floor
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
from mechsym.hinge.target import Target, design_words
from mechsym.page import Shown
from mechsym.quantities import quantity, record


@record
class CoDesignResult(Shown):
    """Everything that the report of a co-design shows."""

    name: str  #: of the case
    about: str
    design: CoDesign
    given: CoDesign | None  #: the same with the hardware of the case, where some of it is free
    bound: Bound
    floor: Floor
    bare: float = quantity("kg*m^2", about="flywheel without a hinge")
    cut: CutForOne  #: the guide of the middle point used for all
    verified: Verified
    losses: tuple[LossTorques, ...]  #: at each point
    assumed: HingeLosses  #: friction and heat that they were computed with
    lossy: tuple[Lossy, ...]  #: each point with them, its springs filled anew
    taken: str  #: where friction and heat are: `inside` the programme, `beside` it, or `none`
    misfire: tuple[float | None, ...]  #: lowest speed after a lost combustion by the mean, at each point; 0 stalls [-]
    front: tuple[CoDesign, ...]
    peers: tuple[Rival, ...] = ()  #: computed where they are asked for only
    #: what follows is computed for the report only
    scenarios: tuple[Scenario, ...] = ()
    spread: Spread | None = None
    map: RippleMap | None = None
    #: least flywheel with which a lost combustion leaves half the speed, these guides [kg*m^2]; None if not known
    misfire_floor: float | None = None

    @property
    def target(self) -> Target:
        """The ripple that was asked for, and whether every point keeps it with losses."""
        held = self.design.status == "optimal" and not self.verified.broken
        ripples = tuple(at.ripple for at in self.lossy)
        return Target(ripple=self.design.task.ripple, with_losses=ripples, held=held, losses=self.taken != "none")

    @property
    def answer(self) -> str:
        """The verdict in a sentence."""
        return design_words(self.target, self.design.status, "; ".join(self.verified.broken) or self.design.reason)
