"""How a mechanism bears its forces over a turn, said once in its own module: what follows need not know which it is.

Forces on the crank pin are those of the rod (planet, link) on the crank: radial positive outwards, tangential positive
in the sense of rotation. The side force is that of the guide on the piston or slider. Bearing forces are those on the
crank, in the frame; the same forces turned into the crank give the polar diagram of the pin.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import record

Pressures = Callable[[np.ndarray], np.ndarray]  # crank angle [rad] to net pressure [Pa]


class DriveSeen(Protocol):
    """A mechanism with its record, as its own module is asked about it."""

    @property
    def parameters(self) -> Any:
        """The mechanism's record."""

    @property
    def mechanism(self) -> Mechanism:
        """With one coordinate and all reactions."""

    @property
    def faces(self) -> Any:
        """Working faces, where the case names them."""

    @property
    def closing(self) -> Any:
        """How the parts of an overconstrained mechanism give way."""


class TurnSeen(Protocol):
    """One turn of it at constant speed."""

    @property
    def drive(self) -> DriveSeen:
        """What turns."""

    @property
    def omega(self) -> float:
        """Crank speed [rad/s]."""

    @property
    def phi(self) -> np.ndarray:
        """Crank angles, shape (n,) [rad]."""

    @property
    def kinematics(self) -> Mapping[str, np.ndarray]:
        """Outputs at these angles, shape (n,)."""

    @property
    def reactions(self) -> Mapping[str, np.ndarray]:
        """Joint forces at these angles, shape (n,) [N]."""

    @property
    def momentum(self) -> Mapping[str, np.ndarray]:
        """Rates of momentum at these angles, shape (n,) [N] or [N*m]."""


@record
class Pin:
    """A crank pin with what acts on it."""

    name: str  #: `crank_pin`, or `crank_pin_3` of a crank train
    angle: np.ndarray  #: shape (n,): Angle of its crank from the x axis of the frame [rad]
    radius: float  #: Crank radius [m]
    sense: float  #: Sense of rotation, 1 or -1 [-]
    #: shape (n,): Force on the crank pin, in the frame [N]
    x: np.ndarray
    y: np.ndarray


@record
class Loads:
    """The loads that bearings and guides carry."""

    pins: tuple[Pin, ...]
    bearings: Mapping[str, tuple[np.ndarray, np.ndarray]]  #: Main bearings by name: force on the crank in the frame [N]
    guides: Mapping[str, np.ndarray]  #: Side forces by name [N]
    weight_torque: np.ndarray  #: shape (n,): Torque of the crank's own weight [N*m]


@record
class Rubbing:
    """Two parts that slide or turn on each other, besides the main bearings."""

    place: str  #: `guides`, `piston_pins`, `crank_pins` or `teeth`
    force: np.ndarray  #: shape (n,): Between them [N]
    #: shape (n,): Speed of one against the other: [m/s] in a guide, else [rad/s]
    speed: np.ndarray


@record
class SliderCrank:
    """A slider crank in the letters of the sources."""

    #: Crank radius and rod length [m]
    R: float
    L: float
    L_m: float  #: Crank pin to the rod's centre of mass [m]
    #: Mass of the rod [kg] and its inertia about the centre of mass [kg*m^2]
    m_b: float
    I_b: float
    m_p: float  #: Mass that moves with the piston: piston, piston rod, crosshead [kg]
    u_c: float  #: Unbalance of the crank on the pin's side [kg*m]


@record
class Peer:
    """A mechanism that stands for its kind in a comparison at equal stroke, moving mass and gas."""

    label: str
    parameters: Any
    faces: Any = None
    closing: Any = None


@record
class GasFace:
    """A working face whose gas is followed in time."""

    input: str  #: Takes its force
    fires: float  #: Shaft angle at which it fires, within a four-stroke cycle [rad]
    throw: int = 0  #: Which coordinate turns it
    area: float | None = None  #: Where it is not that of the bore [m^2]
    sense: float = 1.0  #: 1 where it pushes along its travel, else -1 [-]


@record
class Alike:
    """What the mechanisms of a comparison have in common."""

    stroke: float  #: [m]
    mass: float  #: That moves with one piston [kg]
    area: float  #: Of a piston [m^2]
    period: float  #: Of the cycle [rad]
    lam: float  #: Crank radius over rod length [-]
    alpha_n: float  #: Pressure angle of teeth [rad]


def one_push(drive: DriveSeen, net: Pressures, area: float, phi: np.ndarray, period: float) -> dict[str, np.ndarray]:
    """Gas on the only piston: angles [rad], its area [m^2] and the period [rad] to its force by input [N]."""
    return {"F": net(phi) * area}


def one_face(turn: TurnSeen) -> list[tuple[np.ndarray, np.ndarray]]:
    """The only working face: the angle from its firing dead centre [rad], the speed of its piston [m/s]."""
    q = turn.drive.mechanism.coordinates[0]
    return [(turn.phi, turn.kinematics[f"dx_d{q}"] * turn.omega)]


def stroke_force(turn: TurnSeen, mass: float) -> float:
    """Amplitude of a mass [kg] that moves to and fro with the travel x: [N]."""
    return float(mass * np.ptp(turn.kinematics["x"]) / 2 * turn.omega**2)


def _alone(turn: TurnSeen, name: str, order: int) -> str:
    return "one cylinder cannot balance itself; a counterweight takes at most the part that turns with the crank"


@record
class CrankChain:
    """What the force chain asks a mechanism with a crank; what stands here by default holds for a single piston."""

    loads: Callable[[TurnSeen], Loads]
    rubbing: Callable[[TurnSeen, Loads], Sequence[Rubbing]]
    #: Mass that moves with one piston [kg]
    mass: Callable[[DriveSeen], float]
    #: The mechanism with one coordinate and every reaction, from its record and a closing rule; None: as it is built
    rigid: Callable[[Any, Any], Mechanism] | None = None
    overconstrained: bool = False  #: Whether reactions need a closing rule
    hinged: bool = False  #: Whether its crank takes a hinge, with the input M_h
    letters: Callable[[Mapping[str, float]], SliderCrank] | None = None  #: Of a slider crank
    #: Gas forces by input [N]
    pushes: Callable[[DriveSeen, Pressures, float, np.ndarray, float], dict[str, np.ndarray]] = one_push
    #: Of each working face the angle from its firing dead centre [rad] and the speed of its piston [m/s]
    faces: Callable[[TurnSeen], list[tuple[np.ndarray, np.ndarray]]] = one_face
    #: Which input each cylinder's gas drives, of its record and its faces
    cylinders: Callable[[Any, Any], tuple[GasFace, ...]] = lambda parameters, faces: (GasFace(input="F", fires=0.0),)
    #: Areas of the working faces, where they are not those of the gas [m^2]
    areas: Callable[[DriveSeen], Sequence[float]] | None = None
    #: Crank angles at which the faces fire [rad]
    fires: Callable[[DriveSeen], tuple[float, ...]] = lambda drive: (0.0,)
    #: Sense in which the end with the flywheel turns, 1 or -1 [-]
    sense: Callable[[Any], float] = lambda parameters: 1.0
    #: Both ends of a shaft whose throws all turn one way, where a pair of counterweights finds place [m]
    ends: Callable[[Any], tuple[float, float] | None] = lambda parameters: None
    #: Largest force of one cylinder's reciprocating mass [N], and the lever of its couple [m]
    inertia: Callable[[TurnSeen], float] | None = None
    lever: Callable[[Any], float] = lambda parameters: 1.0
    #: What to do about an order of a shaking force or couple that is left
    advice: Callable[[TurnSeen, str, int], str] = _alone
    #: Mechanisms that stand for its kind in a comparison
    peers: Callable[[Alike], tuple[Peer, ...]] = lambda alike: ()
    #: Numbers that only this mechanism has
    told: Callable[[TurnSeen], dict[str, Any]] | None = None
