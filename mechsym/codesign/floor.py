"""A design beside its bound: all inertia that turns, what no guide does without, and where a flywheel went."""

import dataclasses

import numpy as np

from mechsym.codesign.certificate import Proof, Terms, enclosed, proofs, swing_per_inertia
from mechsym.codesign.rank import MOST, Bound
from mechsym.codesign.running import added_inertia
from mechsym.codesign.task import CoDesign
from mechsym.errors import BadInput
from mechsym.hinge.springs.face import affine_energy
from mechsym.plausible import Doubt
from mechsym.quantities import RPM, quantity, record
from mechsym.quantities.display import figure, quantity_text

PROVEN = "proven"
_LOSSY = "an estimate, proven without friction and heat only"
_CLOSE = 1e-3  # by which balls may hold less than doubles [-]
_FINE = 720  # angles of a turn
_MOVED = 0.1  # share of the flywheel saved by free hardware that may go into the rollers without a word


@record
class Floor:
    """What turns in a design, and the least that has to."""

    total_inertia: float = quantity("kg*m^2", about="largest of engine, flywheel and rollers together over the turn")
    rollers: float = quantity("kg*m^2", about="mean inertia of the rollers, I_h")
    ripple: float = quantity("-", about="that the bound is for: asked, or of the design where that is more")
    terms: Terms  #: of this design's rollers and springs
    proofs: tuple[Proof, ...]  #: for 1, 2, 3 springs
    estimate: tuple[float, ...]  #: D_r by the ripple, for 1, 2, 3 springs [kg*m^2]
    assumes: tuple[str, ...]  #: what the proof holds for
    proven: bool  #: of this design, in balls
    kind: str  #: `proven`, or what it is instead and why


def floor(design: CoDesign, bound: Bound, ripple: np.ndarray) -> Floor:
    """The bound with the terms of a design's own hardware; `ripple` [-] is what it has at each point, nan for none."""
    points = design.task.points
    phi = np.arange(round(_FINE * points[0].period / (2 * np.pi))) * 2 * np.pi / _FINE
    rollers = sum(added_inertia(track, phi) for track in design.tracks)
    total = points[0].inertia(phi) + design.flywheel + rollers
    kept = float(np.nanmax(np.append(ripple, design.task.ripple)))
    terms = Terms(rollers=float(np.ptp(rollers)), ambient=float(np.ptp(_ambient(design, phi))))
    q = swing_per_inertia(kept)
    found = list(proofs(points, bound.phi, q, terms, MOST))
    kind = _in_balls(design, bound, q, terms, found) if design.task.losses is None else _LOSSY
    return Floor(
        total_inertia=float(total.max()),
        rollers=float(np.mean(rollers)),
        ripple=kept,
        terms=terms,
        proofs=tuple(found),
        estimate=tuple(swing / kept for swing in bound.swing),
        assumes=_assumes(design, kept, terms),
        proven=kind == PROVEN,
        kind=kind,
    )


def _in_balls(design: CoDesign, bound: Bound, q: float, terms: Terms, found: list[Proof]) -> str:
    """What the bound of a design's springs is; where balls prove it, the proof is what they prove."""
    place = design.task.springs - 1
    if not found[place].points:
        return PROVEN  # that nothing is proven
    try:
        proven = enclosed(design.task.points, bound.phi, q, terms, found[place].points)
    except BadInput as error:  # MissingExtra too
        return f"computed in doubles and not proven ({error})"
    if proven < (1 - _CLOSE) * found[place].total_inertia:
        return "computed in doubles and not proven (balls hold less)"
    found[place] = dataclasses.replace(found[place], total_inertia=min(proven, found[place].total_inertia))
    return PROVEN


def rollers_inertia(design: CoDesign) -> float:
    """Mean inertia that the rollers of a design add to the shaft [kg*m^2]."""
    phi = np.arange(_FINE) * design.task.points[0].period / _FINE
    return float(np.mean(sum(added_inertia(track, phi) for track in design.tracks)))


def _ambient(design: CoDesign, phi: np.ndarray) -> np.ndarray:
    """Energy of the springs at no excess pressure [J]: what the pressure outside adds."""
    hardware = ((track.hardware, track.z(phi)) for track in design.tracks)
    return np.asarray(sum(affine_energy(h.spring, z)[0] for h, z in hardware))


def _assumes(design: CoDesign, ripple: float, terms: Terms) -> tuple[str, ...]:
    loads = sorted({point.law for point in design.task.points})
    words = {"propeller": "a load with the square of the speed", "constant": "a constant load, its mean speed governed"}
    return (
        f"ripple at most {figure(100 * ripple, 4)} % by the mean speed, {' or '.join(words[law] for law in loads)}",
        f"rollers whose inertia varies over the turn by at most {quantity_text(terms.rollers, 'kg*m^2', 3)}, as here",
        f"gas springs with energy affine in their excess pressure, to which the pressure outside adds at most "
        f"{quantity_text(terms.ambient, 'J', 3)}, as here",
        "any shapes, any positive pressures; no friction, no heat",
    )


def proving(found: Floor, design: CoDesign) -> tuple[float, ...]:
    """Speeds [rpm] of the points that prove the bound for the design's number of springs."""
    return tuple(design.task.points[k].omega / RPM for k in found.proofs[design.task.springs - 1].points)


def hidden(design: CoDesign, given: CoDesign | None) -> tuple[Doubt, ...]:
    """A doubt where free hardware has the flywheel on its rollers; `given` is the design with the case's hardware."""
    if given is None or {design.status, given.status} != {"optimal"} or given.flywheel <= design.flywheel:
        return ()
    moved = rollers_inertia(design) - rollers_inertia(given)
    share = moved / (given.flywheel - design.flywheel)
    if share <= _MOVED:
        return ()
    why = (
        f"of {quantity_text(given.flywheel - design.flywheel, 'kg*m^2', 4)} that the free hardware takes off the "
        f"flywheel the rollers turn {quantity_text(moved, 'kg*m^2', 4)} more: inertia has moved, not gone"
    )
    name = "moved_to_rollers"
    return (Doubt(code=name, quantity=name, value=share, usual=f"at most {_MOVED:g}", why=why),)
