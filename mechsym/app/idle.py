"""Sliders that a tab does not offer, because nothing that it shows depends on them, and why."""

from collections.abc import Callable, Mapping
from typing import Any

from mechsym.app.letters import rubbing, unread
from mechsym.cases import Case
from mechsym.cycle.friction import MechanismFriction
from mechsym.cycle.kinds import kind_of
from mechsym.mechanisms import roles_of
from mechsym.quantities.records import moved
from mechsym.quantities.records import unread as unread_keys


def idle(case: Case, tab: str) -> Mapping[str, str]:
    """Keys of a case that move nothing in a tab, each with the reason."""
    found = {f"{s}.{name}": why for s, data in case.sections.items() for name, why in unread_keys(data).items()}
    found |= {
        f"{s}.{name}": f"{key} tells it" for s, data in case.sections.items() for name, key in moved(data).items()
    }
    for section, names, tabs, reason in _RULES:
        data = case.sections.get(section)
        why = None if data is None or (tabs and tab not in tabs) else reason(case, data)
        if why is not None:
            found |= {f"{section}.{name}": why for name in names or vars(data) if name in vars(data)}
    if "friction" in case.sections and tab == "forces":
        acting = rubbing(case)
        found |= {f"friction.{n}": _NO_PLACE for n in vars(case.need("friction")) if n not in acting}
    return found | {f"parameters.{name}": why for name, why in unread(case, tab).items()}


Idle = Callable[[Case, Any], str | None]  # why a section of a case is not read


def _unless(field: str, value: str) -> Idle:
    """A reason while a choice of the same section is another one."""

    def reason(case: Case, data: object) -> str | None:
        chosen = getattr(data, field, value)
        return None if chosen == value else f"{field} is {chosen}"

    return reason


def _said(words: str) -> Idle:
    return lambda case, data: words


def _fuel(case: Case, data: object) -> str | None:
    kind = kind_of(data)
    given = kind.facts and getattr(data, kind.load)
    return "the mean pressure is given: it tells temperatures and fuel only" if given else None


def _no_friction(case: Case, data: Any) -> str | None:
    free = data.friction == "none" and "losses" not in case.sections
    return "the rollers have no friction" if free else None


def _schmidt(case: Case, data: object) -> str | None:
    return "kind is schmidt, without losses" if "cycle" in case.sections and kind_of(case.need("cycle")).ideal else None


def _opposed(case: Case, data: object) -> str | None:
    return "it acts on both ends of a slider" if "faces" in case.sections else None


def _measured(case: Case, data: object) -> str | None:
    measured = "cycle" in case.sections and kind_of(case.need("cycle")).measured
    return "the cycle is measured" if measured else None


def _no_joints(case: Case, data: object) -> str | None:
    """The cycle asks for the friction of the joints only where its mean pressure is made of it."""
    law = case.sections.get("friction_pressure")
    return None if isinstance(law, MechanismFriction) else "the cycle is without the friction of the joints"


def _anew(words: str) -> Idle:
    """A reason where rules size the parts anew; parts that a case gives are checked under all of its loads."""
    return lambda case, data: (
        words if roles_of(case.mechanism).rules and "part_crosshead" not in case.sections else None
    )


def _chosen(case: Case, data: object) -> str | None:
    return (
        None if "part_crosshead" in case.sections else "the part is sized anew, of the given one only masses are read"
    )


def _kept(case: Case, data: object) -> str | None:
    return "pins, guide and rod are checked" if "part_crosshead" in case.sections else None


def _fine(case: Case, data: Any) -> str | None:
    wanted = case.sections.get("sizing")
    return "sizing.speed_step is wider" if wanted and _REACH * data.step <= wanted.speed_step else None


def _weighed(case: Case, data: object) -> str | None:
    anew = roles_of(case.mechanism).rules == "slider crank" and "part_crosshead" not in case.sections
    return "sized parts weigh what they weigh" if anew else None


def _family(case: Case, data: object) -> str | None:
    return "the scavenging of the co-design tells it at each load" if case.need("codesign").scavenge else None


_REACH = 2.0  # as far as sliders go, times the value
_NO_PLACE = "the mechanism has no such place that rubs"

# section, keys (none: all of it), tabs (none: all of them), reason while it holds
_RULES: tuple[tuple[str, tuple[str, ...], tuple[str, ...], Idle], ...] = (
    ("scavenging", (), (), _unless("source", "turbocharger")),
    ("rollers", (), ("simulate",), _no_friction),
    ("limits", (), ("simulate",), _said("the tab hinge judges them")),
    ("cycle", ("c_v", "lhv", "R"), ("simulate", "codesign"), _fuel),
    ("cycle", ("T_evc",), ("simulate", "codesign"), _fuel),
    ("cycle", ("lhv",), ("size",), _fuel),
    ("cycle", ("octane",), ("simulate", "forces", "size", "hinge", "codesign"), _said("the tab cycle tells the knock")),
    ("cycle", ("clearance_share_hot", "clearance_share_cold"), (), _schmidt),
    ("cycle", ("p_back",), ("cycle",), _measured),
    ("stirling", (), (), _schmidt),
    ("operation", ("speed",), ("cycle",), _measured),
    ("friction", (), ("cycle",), _no_joints),
    ("rings", (), ("cycle",), _no_joints),
    ("closing", (), ("cycle",), _said("it shares out forces whose sum acts here")),
    ("chamber", ("back_pressure",), ("forces", "simulate"), _opposed),
    ("shaking", ("limit",), ("forces",), _said("it only judges")),
    ("friction", (), ("size",), _said("parts are sized without friction of the joints")),
    ("operation", ("speed",), ("size",), _anew("sized at the speeds of [speeds]")),
    ("speeds", ("step",), ("size",), _fine),
    ("cycle", ("p_s",), ("codesign",), _family),
    ("operation", ("speed",), ("codesign",), _said("designed at the speeds of [codesign]")),
    ("rollers", ("plane_offset",), ("codesign",), _said("the tab hinge judges it")),
    ("parameters", ("I1",), ("size",), _anew("the speed is held")),
    ("parameters", ("m1", "m2", "m3", "m4", "m5", "I01", "IC2"), ("size",), _weighed),
    ("parameters", ("m1", "I01"), ("size",), _kept),
    ("part_piston", ("ring_radial", "ring_axial", "land_top", "land"), ("size",), _chosen),
    ("part_cylinder", ("flange", "bolts", "thread_mm"), ("size",), _chosen),
    ("part_gears", ("shift",), ("size",), _chosen),
    ("part_crank", ("pin", "web_width"), ("size",), _chosen),
    ("part_masses", ("crankshaft",), ("size",), _chosen),
    ("startup", ("twist_limit",), ("simulate",), _said("the twist is told, and beside it the limit")),
)
