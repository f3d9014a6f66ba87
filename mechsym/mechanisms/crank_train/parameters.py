"""N throws on a torsionally elastic shaft with a flywheel at the load end: parameters and runtime mechanisms.

    [throw 1]--k1,c1--[throw 2]--k2,c2-- ... --kN,cN--[flywheel I_f] <- M (load, opposing)

                X (reference axis)         Each throw carries any number of cylinders. The pin of a cylinder stands at
                |  / cylinder, bank        the angle phi + phase from the reference axis, in the shaft's sense of
                | /                        rotation; bank is the angle of its axis from X towards Y. With sense = -1 a
        Y ------O                          throw turns the other way round (geared crank of an opposed-piston engine).

One throw is derived (derivations/crank_throw.py) and instantiated; `build` has the coordinates phi1..phiN, phi_f,
`build_rigid` the one coordinate phi. A value for all cylinders or throws may be given once.
"""

import math

from mechsym.errors import BadInput
from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_train.articulated import top
from mechsym.mechanisms.own import require
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Pure, Radian

Numbers = float | tuple[float, ...]
_PER_CYLINDER = ("phase", "bank", "firing", "r", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston", "z_rod",
                 "master", "knuckle", "knuckle_angle")  # fmt: skip
_PER_THROW = ("I0", "m0", "u0", "u_phase", "sense", "axis_x", "axis_y", "z", "k", "c")


@record
class CrankTrainParameters:
    """A crank train. Lists have one value a cylinder or one a throw; a single number holds for all."""

    throw: tuple[int, ...]  #: Throw of each cylinder, 1 to N from the free end
    phase: Numbers = quantity("rad", about="angle of the crank pin at phi = 0")
    bank: Numbers = quantity("rad", default=0.0, about="angle of the cylinder axis")
    #: Per cylinder: shaft angle at which it fires, within its cycle; empty where no gas acts [rad]
    firing: Numbers = quantity("rad", default=(), about="shaft angle at which the cylinder fires")
    r: Numbers = quantity("m", above=0, about="crank radius")
    l1: Numbers = quantity("m", low=0, about="crank pin to the rod's centre of mass")
    l2: Numbers = quantity("m", low=0, about="rod's centre of mass to piston pin")
    offset: Numbers = quantity("m", default=0.0, about="offset of the cylinder axis")
    m_rod: Numbers = quantity("kg", low=0, about="mass of the rod")
    m_piston: Numbers = quantity("kg", low=0, about="mass of the piston")
    I_rod: Numbers = quantity("kg*m^2", low=0, about="inertia of the rod about its centre of mass")
    z_rod: Numbers = quantity("m", default=0.0, about="position of the rod from the middle of its throw")
    #: Per cylinder, of articulated rods: number of the cylinder whose rod carries this one's, 0 for a crank pin
    master: Numbers = quantity("-", default=0.0, low=0, about="cylinder on whose rod this rod hangs; 0: the crank pin")
    knuckle: Numbers = quantity("m", default=0.0, low=0, about="crank pin to the knuckle pin of a rod that hangs")
    knuckle_angle: Numbers = quantity("rad", default=0.0, about="knuckle pin from the master rod's middle line")
    I0: Numbers = quantity("kg*m^2", above=0, about="inertia of the throw about the axis")
    m0: Numbers = quantity("kg", default=0.0, low=0, about="mass of the throw")
    u0: Numbers = quantity("kg*m", default=0.0, about="unbalance of the throw")
    u_phase: Numbers = quantity("rad", default=0.0, about="angle of the unbalance at phi = 0")
    #: Per throw: 1, or -1 for a crank that turns the other way round
    sense: Numbers = quantity("-", default=1.0, low=-1, high=1, about="1, or -1 for a counter-rotating crank")
    axis_x: Numbers = quantity("m", default=0.0, about="place of the throw's axis along X")
    axis_y: Numbers = quantity("m", default=0.0, about="place of the throw's axis along Y")
    z: Numbers = quantity("m", default=0.0, about="position of the throw along the shaft")
    #: Inertia of the flywheel with what turns with it [kg*m^2]
    I_f: float = quantity("kg*m^2", above=0, about="inertia of the flywheel")
    #: Per throw: stiffness [N*m/rad] and damping [N*m*s/rad] of the shaft from it to the next throw or the flywheel
    k: Numbers = quantity("N*m/rad", above=0, about="stiffness of the shaft towards the flywheel")
    c: Numbers = quantity("N*m*s/rad", default=0.0, low=0, about="damping of the shaft towards the flywheel")
    g: float = quantity("m/s^2", default=0.0, low=0, about="acceleration of free fall")
    #: Angle of the reference axis against the horizontal [rad]
    axis_tilt: float = quantity("rad", default=0.0, about="reference axis against the horizontal")

    def __post_init__(self) -> None:
        _check_lists(self)
        for i in range(len(self.throw)):
            require(CrankThrowParameters, {name: each(self, name)[i] for name in ("r", "l1", "l2", "offset")})
        _check_masters(self)


def _check_lists(p: CrankTrainParameters) -> None:
    if not p.throw or sorted(set(p.throw)) != list(range(1, max(p.throw) + 1)):
        raise BadInput(f"throw = {list(p.throw)} must name the throws 1 to N, each at least once")
    for name in (*_PER_CYLINDER, *_PER_THROW):
        value = getattr(p, name)
        wanted = len(p.throw) if name in _PER_CYLINDER else max(p.throw)
        if isinstance(value, tuple) and len(value) != wanted and not (name == "firing" and not value):
            what = "cylinder" if name in _PER_CYLINDER else "throw"
            raise BadInput(f"{name} has {len(value)} values; give one number for all, or one a {what}: {wanted}")
    if set(each(p, "sense")) - {1.0, -1.0}:
        raise BadInput(f"sense = {p.sense} is not an option; options are 1 and -1")


def _check_masters(p: CrankTrainParameters) -> None:
    """Refuse a rod that hangs on none, on one that hangs itself, or on that of another crank pin."""
    masters = each(p, "master")
    for i, number in enumerate(masters, 1):
        if not number:
            continue
        m = int(number) - 1
        if m != number - 1 or m >= len(masters) or masters[m]:
            carry = ", ".join(str(k) for k, other in enumerate(masters, 1) if not other)
            raise BadInput(f"master of cylinder {i} = {number:g} is no rod on a crank pin; those are {carry}")
        pins = [(p.throw[k], each(p, "phase")[k]) for k in (i - 1, m)]
        if pins[0] != pins[1]:
            raise BadInput(
                f"the rod of cylinder {i} hangs on that of cylinder {m + 1}: give both the same throw and phase"
            )


def hung_letters(p: CrankTrainParameters, i: int) -> dict[str, float]:
    """Letters of the rod of a cylinder, by its index from 0, that hangs on another's, but for `top`."""
    m, sense = int(each(p, "master")[i]) - 1, each(p, "sense")[p.throw[i] - 1]
    own = {name: each(p, name)[i] for name in ("l1", "l2", "offset", "m_rod", "I_rod", "m_piston")}
    bank = each(p, "bank")[m]
    return own | {
        "r": each(p, "r")[m], "l": each(p, "l1")[m] + each(p, "l2")[m], "offset_m": each(p, "offset")[m],
        "a": each(p, "knuckle")[i], "kappa": sense * each(p, "knuckle_angle")[i],
        "v": sense * (each(p, "bank")[i] - bank), "g": p.g, "axis_tilt": tilt(p, bank, sense),
    }  # fmt: skip


def tilt(p: CrankTrainParameters, bank: Radian, sense: Pure) -> Radian:
    """Angle of a cylinder's axis against the horizontal, in the sense of its throw."""
    turned = p.axis_tilt + bank
    return turned if sense > 0 else math.pi - turned  # mirrored, so is gravity


def each(parameters: CrankTrainParameters, name: str) -> tuple[float, ...]:
    """Values of a letter that is given per cylinder or throw, for every one of them [unit of the letter]."""
    value = getattr(parameters, name)
    count = len(parameters.throw) if name in _PER_CYLINDER else max(parameters.throw)
    return value if isinstance(value, tuple) else (value,) * count


def local_shift(parameters: CrankTrainParameters) -> tuple[Radian, ...]:
    """What makes of a shaft angle each cylinder's own (0: its crank points to its head): phase - sense * bank."""
    rows = zip(parameters.throw, each(parameters, "phase"), each(parameters, "bank"), strict=True)
    return tuple(phase - each(parameters, "sense")[k - 1] * bank for k, phase, bank in rows)


def dead_centre(parameters: CrankTrainParameters) -> tuple[Radian, ...]:
    """Each cylinder's own crank angle at top dead centre, 0 without offset of a rod on a crank pin."""
    lengths = (each(parameters, name) for name in ("r", "l1", "l2", "offset"))
    own = [math.asin(offset / (r + l1 + l2)) for r, l1, l2, offset in zip(*lengths, strict=True)]
    for i, number in enumerate(each(parameters, "master")):
        if number:
            letters = hung_letters(parameters, i)
            own[i] = top(letters)[0] - letters["v"]
    return tuple(own)
