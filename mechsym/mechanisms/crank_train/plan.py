"""What a crank train answers for: how it is put together, its roles, its proportions, what one cylinder sees."""

from mechsym.errors import BadInput
from mechsym.mechanisms.crank_throw import NAME as THROW
from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_train.assembly import build, build_rigid, listing
from mechsym.mechanisms.crank_train.firing import refuse_wrong_firing
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.crank_train.roles import roles
from mechsym.mechanisms.crank_train.spacing import pitch, span, unequal
from mechsym.mechanisms.plan import AssembledMechanism
from mechsym.mechanisms.proportions import Proportions, Reciprocating
from mechsym.mechanisms.train_drawing import crank_train
from mechsym.quantities.records import Record


def _alone(p: CrankTrainParameters) -> tuple[str, Record]:
    """The first cylinder whose rod is on a crank pin, on a shaft of its own."""
    if any(each(p, "offset")):
        raise BadInput(
            f"offset = {max(each(p, 'offset'), key=abs):g} m: the cycles of a crank train know dead centres half a "
            "turn apart; set offset = 0 or leave [cycle] out"
        )
    first = next(i for i, master in enumerate(each(p, "master")) if not master)
    letters = {n: each(p, n)[first] for n in ("r", "l1", "l2", "offset", "m_rod", "I_rod", "m_piston")}
    return THROW, CrankThrowParameters(**letters, I0=each(p, "I0")[p.throw[first] - 1])


def _proportions(p: CrankTrainParameters) -> Proportions:
    masses = p.m_piston if isinstance(p.m_piston, tuple) else (p.m_piston,)
    named = ("m_piston",) if not masses[1:] else tuple(f"m_piston[{i}]" for i in range(len(masses)))
    moving = tuple(Reciprocating(letters=letters, mass=mass) for letters, mass in zip(named, masses, strict=True))
    r, l1, l2, m0, m_rod, piston = (max(each(p, letter)) for letter in ("r", "l1", "l2", "m0", "m_rod", "m_piston"))
    return Proportions(
        stroke=2 * r, rod_ratio=(l1 + l2) / r, moving=moving, mass=m0 + m_rod + piston,
        shafts={"I0": max(each(p, "I0")), "I_f": p.I_f},
        parts={"I_rod": (max(each(p, "I_rod")), m_rod * (l1 + l2) ** 2)},
        unbalances={"u0": max(each(p, "u0"), key=abs)}, pistons=len(p.throw), pitch=pitch(p), span=span(p),
        unequal=unequal(p),
    )  # fmt: skip


PLAN = AssembledMechanism(
    theory=THROW, parameters=CrankTrainParameters, build=build, rigid=lambda p, guesses: build_rigid(p),
    listing=listing, parts=roles, alone=_alone, proportions=_proportions, require_firing=refuse_wrong_firing,
    shapes=crank_train,
)  # fmt: skip
