"""What the words in front of an equation call what it gives: `The stress of a bar is`, `the rod carries`."""

import re
from collections.abc import Sequence

from mechsym.audit.read.clause import Clause
from mechsym.audit.read.phrases import FUSED, NO_NAMES, PLURALS, Piece, pieces
from mechsym.audit.read.units import KINDS

# prepositions that tell what a quantity is of
_OF_IT = frozenset("of on in at along between about around against through over per".split())
_EMPTY = frozenset(  # words in front of a name that say nothing of it
    "required corresponding necessary needed desired respective associated sought following so-called said same usual"
    " present above".split()
)
_NEAR = 400  # characters that a sentence may refer to
_AT_DEAD_CENTRE = re.compile(r"\bat (?:the )?(top|bottom) dead cent(?:re|er)\b", re.IGNORECASE)
_TWO_MASSES = re.compile(r"\bpoint masses\b|\btwo masses\b")
_PIN = re.compile(r"(?:[a-z]+ )+(?:pin|end)")
_LEFT = re.compile(r"\bwhat (?:is left|remains) of\b|\bthe (?:rest|remainder) of\b", re.IGNORECASE)
_UNITS = frozenset("unit metre meter kilogram mass volume area length mole cycle degree".split())
_STRAINS = {"bent": "bending stress", "twisted": "torsional stress", "sheared": "shear stress"}
_PRESSES = frozenset("press push pull act resist".split())
_SWINGS = frozenset("swing vibrate oscillate sound".split())
_BEARS = frozenset("carry bear transmit".split())
_YIELDS = frozenset("take provide supply give".split())  # a force, if it is a wall
_WALL = re.compile(r"\b(?:guide|liner|wall)s?\b|\bcylinder\b")


def subject(before: str, alone: bool) -> tuple[str, str]:
    """What the sentence in front of an equation says that it gives, and the same with what it is of; empty for nothing.

    before: the text up to the equation. alone: whether it gives one thing.
    """
    clause = Clause(before)
    if _LEFT.search(clause.plain):
        return "", ""  # of a quantity another one is left
    if alone and (said := _mass_at_pin(clause, before)):
        return said, said
    if alone and (said := _by_verb(clause)):
        return said, ""
    at = clause.subject()
    if at is None or clause.parts[at].lettered:
        return "", ""
    name = _name(clause, at)
    if name == "force" and (who := _presses(clause, at)):
        name = who
    whole = _whole(clause, at, name) if name else ""
    refers = not alone or clause.parts[at].words == ("that",)
    return "" if refers else name, whole


def _name(clause: Clause, at: int) -> str:
    # what a phrase calls a quantity; empty where that is no name of one
    words = [w for w in clause.parts[at].words if w.lower() not in _EMPTY]
    plain, behind = " ".join(words), _behind(clause, at)
    if words == ["it"] and re.search(r"\bin (?:hertz|Hz)\b", clause.plain, re.IGNORECASE):
        return "natural frequency in hertz"
    if not words or len(words) == 1 and words[0].lower() in NO_NAMES:
        return _head_before(clause) if words == ["that"] and behind[:1] == ["of"] else ""
    if words[-1] in ("one", "ones"):  # the tangential force, and the radial one
        before = _free(pieces(clause.earlier[-_NEAR:].partition(" ")[2])) or clause.parts[:at]
        heads = [PLURALS.get(p.head, p.head) for p in before if p.words and p.kind == "thing"]
        return f"{' '.join(words[:-1])} {heads[-1]}" if heads and heads[-1] in (*KINDS, "speed") else ""
    if "per" in behind and _UNITS & {*behind[behind.index("per") :]}:
        return ""
    if fused := FUSED.match(" ".join([words[-1], *behind])):
        plain = " ".join([*words[:-1], fused[0]])
    if behind[:2] in (["in", "hertz"], ["in", "Hz"]):
        plain += " in hertz"
    done = clause.parts[at + 1 : at + 2]
    if done and done[0].kind == "done" and clause.kind(at + 2) in ("", "is", "comma") and done[0].words[0] != "is":
        plain += f" {done[0].head}"  # the heat rejected is
    if plain == "moment" and behind[:1] == ["about"]:
        return "torque"
    if words[-1] in ("half", "third", "twice", "part", "double"):
        return ""
    if plain == "ratio":
        return "" if {"and", "to"} & {*behind} or not behind else " ".join([plain, *behind])
    if place := _AT_DEAD_CENTRE.search(clause.plain):
        return f"{plain} at {place[1].lower()} dead centre"
    beside = clause.kind(at - 1) == "thing" and not clause.is_governed(at - 1) and at == len(clause.parts) - 1
    if plain == "force" and beside:  # the guide carries .., and the rod the force
        return f"force on the {' '.join(clause.parts[at - 1].words)}"
    return plain


def _behind(clause: Clause, at: int) -> list[str]:
    # the words behind a phrase up to a verb, a comma or a letter
    words: list[str] = []
    for part in clause.parts[at + 1 :]:
        if part.kind not in ("thing", "of", "at", "and", "done") or part.words[:1] == ("is",):
            break
        words += part.phrase or (part.kind,)
        if part.lettered:
            break
    return words


def _whole(clause: Clause, at: int, name: str) -> str:
    # a name with what it is of, and where
    parts, k = clause.parts, at + 1
    own = " ".join(w for w in parts[at].words if w.lower() not in _EMPTY)
    words = [own if name.startswith(own) else name]
    while k + 1 < len(parts) and parts[k + 1].kind == "thing":
        join = parts[k].head or parts[k].kind
        place = parts[k].kind == "at"
        if parts[k].kind not in ("of", "at", "and") or place and (join not in _OF_IT or parts[k + 1].lettered):
            break
        words += [join, *parts[k + 1].phrase]
        k += 2
    if at > 2 and parts[at - 1].kind == "at" and parts[at - 2].kind == "moves":  # the node lies at the distance
        front = clause.in_front(at - 2)
        words = [*(parts[front].words if front is not None else ()), *words]
    whose = parts[at].owner or (" ".join(parts[at - 2].words) if at > 1 and parts[at - 1].words == ("whose",) else "")
    whole = " ".join([whose, *words] if whose else words)
    return whole if name in whole else name


def _head_before(clause: Clause) -> str:
    # the force of first order .., and that of second order
    parts = pieces(f"{clause.earlier} {clause.plain.rpartition('that of')[0]}"[-_NEAR:].partition(" ")[2])
    heads = [" ".join(p.words) for p in _free(parts, of_it=True)]
    return heads[-1] if heads else ""


def _free(parts: Sequence[Piece], of_it: bool = False) -> list[Piece]:
    # phrases that no preposition governs, and of which something is told
    return [
        p
        for front, p, behind in zip([None, *parts], parts, [*parts[1:], None], strict=False)
        if p.kind == "thing" and p.words and p.head not in NO_NAMES
        and not (front and front.kind in ("of", "at")) and (not of_it or behind and behind.kind == "of")
    ]  # fmt: skip


def _mass_at_pin(clause: Clause, before: str) -> str:
    # the rod is replaced by two masses, one at the crank pin
    if not _TWO_MASSES.search(before[-_NEAR:]):
        return ""
    for front, part in zip(clause.parts, clause.parts[1:], strict=False):
        if front.words == ("at",) and _PIN.fullmatch(where := " ".join(part.words).lower()):
            return f"mass at the {where}"
    return ""


def _by_verb(clause: Clause) -> str:
    # what a verb says without a name: what carries bears a force, what swings has a frequency
    parts = clause.parts
    if parts and parts[0].kind == "done" and parts[0].head in _STRAINS and parts[-1].head == "stress":
        return _STRAINS[parts[0].head]  # bent by the stress
    verbs = [k for k, p in enumerate(parts) if p.kind in ("gives", "moves") or p.kind == "done" and p.words[0] == "is"]
    if not verbs:
        return ""
    at = verbs[-1]
    verb, behind = parts[at], parts[at + 1 :]
    front = clause.in_front(at - (verb.kind == "done"))
    who = parts[front] if front is not None else behind[0] if behind and behind[0].kind == "thing" else None
    ends = not behind or behind[-1].kind == "at" and behind[-1].head in ("with", "by")
    if verb.kind == "done":
        if verb.head in _STRAINS and (verb.head == "sheared" and ends or behind and behind[-1].head == "stress"):
            return _STRAINS[verb.head]
        return f"force on the {' '.join(who.words)}" if verb.head in ("loaded", "pressed") and ends and who else ""
    if verb.head == "store" and not behind:
        return "stored energy"
    if not ends or who is None:
        return ""
    if not behind and verb.head in ("get", "receive") and who.head in ("shaft", "coupling", "flange"):
        return "effective power"
    if not behind and (verb.head in _BEARS or verb.head in _YIELDS and _WALL.search(" ".join(who.words))):
        return f"force on the {' '.join(who.words)}"
    if verb.head in _SWINGS and behind and behind[-1].head == "with":
        return "natural frequency"
    if verb.head in _PRESSES and behind:
        against = " ".join(" ".join(p.words) for p in behind if p is not who)
        return "side force" if verb.head == "press" and _WALL.search(against) else _force_of(who)
    return ""


def _presses(clause: Clause, at: int) -> str:
    # the gas pushes the piston with the force
    verbs = [k for k in range(at) if clause.kind(k) == "moves" and clause.parts[k].head in _PRESSES]
    front = clause.in_front(verbs[-1]) if verbs and clause.parts[at - 1].words == ("with",) else None
    return _force_of(clause.parts[front]) if front is not None else ""


def _force_of(who: Piece) -> str:
    words = [w for w in who.words if w != "pressure" and w not in NO_NAMES][-2:]
    return " ".join([*words[:-1], PLURALS.get(words[-1], words[-1]), "force"]) if words else ""


def behind(after: str) -> str:
    """What the words behind an equation call what it gives: `is the relative eccentricity`; empty where they do not."""
    if not (match := re.match(r"\s*(?:is|denotes)\s+(?:called\s+)?(?=(?:the|an?)\s)", after)):
        return ""
    parts = pieces(re.split(r"[.;:](?:\s|$)", after[match.end() :])[0])
    return " ".join(parts[0].words) if parts and parts[0].kind == "thing" and not parts[0].lettered else ""


def shared(before: str) -> str:
    """What a sentence calls each of several things that equations give: `The base diameters are`."""
    clause = Clause(before)
    at = clause.subject()
    words = clause.parts[at].words if at is not None else ()
    if not words or words[-1] not in PLURALS or at is None or clause.parts[at].lettered:
        return ""
    whose = clause.parts[at - 2].words if at > 1 and clause.parts[at - 1].words == ("whose",) else ()
    return " ".join([*(w.removesuffix("s") for w in whose), *words[:-1], PLURALS[words[-1]]])


def listed(before: str, count: int) -> list[str]:
    """What a sentence says that several equations give, one name for each: `The side force and the torque are`."""
    clause = Clause(before)
    parts = clause.parts
    verbs = [k for k, p in enumerate(parts) if p.kind in ("is", "gives", "moves", "that")]
    if (
        not parts
        or parts[-1].kind not in ("thing", "is")
        or len(verbs) > 1
        or any(parts[k].kind != "is" for k in verbs)
    ):
        return []
    names = [p for k, p in enumerate(parts) if p.kind == "thing" and not (k and parts[k - 1].kind in ("at", "of"))]
    heads = [" ".join(p.words) for p in names if not p.lettered]
    if len(heads) != count or len(names) != count:
        return []
    kind = PLURALS.get(names[-1].head)
    if kind and count == 2 and len(names[0].words) == 1:  # the tangential and radial forces
        return [f"{heads[0]} {kind}", f"{' '.join(names[1].words[:-1])} {kind}"]
    return heads
