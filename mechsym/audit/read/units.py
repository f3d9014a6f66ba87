"""Units as papers print them, and what is measured in one by its name."""

import re

from mechsym.errors import BadInput
from mechsym.quantities import dimension

_MARKS = (
    (re.compile(r"\\(?:mathrm|text|textrm|mathbf|mathit|rm|textsuperscript|unit|mbox|operatorname)\b"), " "),
    (re.compile(r"\\(?:cdot|times)\b|[·⋅∙×]"), "*"),
    (re.compile(r"\\(?:degree|circ|deg)\b"), "deg"),
    (re.compile(r"\\frac\s*\{([^{}]*)\}\s*\{([^{}]*)\}"), r"\1/(\2)"),
    (re.compile(r"\\(?:q?quad|[,;:! ])|[~$\\{}]"), " "),
    (re.compile(r"<[^<>]*>"), ""),
    (re.compile(r"\s*([*/^])\s*"), r"\1"),
    (re.compile(r"(?<=[A-Za-z\d])\.(?=[A-Za-z])"), "*"),
    (re.compile(r"\^\(?\s*(-?\d)\s*\)?"), r"^\1"),
    (re.compile(r"\b1/(?=[A-Za-z])"), "-/"),
)
_RUSSIAN = {
    "Н": "N", "м": "m", "кг": "kg", "с": "s", "Па": "Pa", "рад": "rad", "мм": "mm", "Дж": "J", "Вт": "W", "К": "K",
}  # fmt: skip
_SPELLED = {
    "r/min": "rpm", "min-1": "rpm", "min^-1": "rpm", "min⁻¹": "rpm", "rev/min": "rpm", "-/min": "rpm", "U/min": "rpm",
    "Nm": "N*m", "kWh": "kW*h", "sec": "s", "°": "deg", "degrees": "deg", "rad.": "rad",
    "–": "-", "—": "-", "--": "-", "-": "-", "[-]": "-",
}  # fmt: skip
PURE = (0, 0, 0, 0)
#: What a quantity is measured in by what it is called, where its table says nothing
KINDS = {
    "power": "W", "torque": "N*m", "force": "N", "pressure": "Pa", "work": "J", "energy": "J", "heat": "J",
    "temperature": "K", "mass": "kg", "volume": "m^3", "area": "m^2", "velocity": "m/s", "acceleration": "m/s^2",
    "efficiency": "-", "ratio": "-", "factor": "-", "number": "-", "length": "m", "radius": "m", "diameter": "m",
    "width": "m", "distance": "m", "thickness": "m", "height": "m", "stroke": "m", "bore": "m",
    "lift": "m", "travel": "m", "module": "m", "way": "m", "eccentricity": "m", "arm": "m", "irregularity": "-",
    "stress": "Pa", "time": "s", "thrust": "N", "angular velocity": "rad/s", "angular speed": "rad/s",
    "angular acceleration": "rad/s^2", "piston speed": "m/s", "shear modulus": "Pa", "young modulus": "Pa",
    "elasticity": "Pa", "density": "kg/m^3", "power density": "", "energy density": "", "frequency": "Hz",
    "mass flow": "kg/s", "fuel flow": "kg/s", "twist": "rad", "torsional stiffness": "N*m",
}  # fmt: skip
#: Words that change what the next one is measured in
OTHERS = re.compile(
    "per|unit|specific|by|relative|(?:non)?dimension(?:less|al)|normali[sz]ed|scaled|molar|section|internal|moment|polar"
    "|linear|areal|flux|current|charge|probability|spectral|generali[sz]ed|cent(?:er|re)s?|vector|array"
)

#: Words between what something is and what it is of
PREPOSITIONS = tuple(
    "of at in by for on along from due to with under over below above between about onto into upon".split()
)
_PREPOSITION = re.compile(rf"\b(?:{'|'.join(PREPOSITIONS)}|and|or)\b|[,;($/]")
_DONE = re.compile(r"\s+(?:acting|exerted|applied|added|transmitted|delivered|absorbed|required|needed|lost)\s*$")
_RATIO = re.compile(
    r"\b(?:coefficient|ratio|share|fraction|percentage|displacement|position|deflection|motion|coordinate)s? of\b",
    re.IGNORECASE,
)


def unit_of(text: str) -> str | None:
    r"""A unit as the program writes it, None where the text is none: `\text{N}\cdot\text{m}` is `N*m`.

    >>> unit_of("J/(kg.K)"), unit_of(r"\text{kg}\cdot\text{m}^2"), unit_of("x + 1")
    ('J/kg/K', 'kg*m^2', None)
    """
    for pattern, instead in _MARKS:
        text = pattern.sub(instead, text)
    text = "".join(" ".join(text.split()).split(" ") if re.search(r"[*/^]\s|\s[*/^]", text) else [text.strip()])
    text = _SPELLED.get(text, text)
    text = re.sub(r"[А-Яа-я]+", lambda m: _RUSSIAN.get(m[0], m[0]), text)
    text = re.sub(r"/\(([^()]*)\)", lambda m: "/" + re.sub(r"[* ]", "/", m[1].strip()), text)
    text = re.sub(r"\bkWh\b", "kW*h", text).replace("g/kW*h", "g/kW/h").replace("(", "").replace(")", "")
    text = re.sub(r"(?<=[A-Za-z])([23])\b", r"^\1", text) if "^" not in text else text
    try:
        dimension(text)
    except BadInput:
        return None
    return text if text.strip() else None


_PLACES = {"upstream", "downstream", "inside", "outside", "above", "below", "ahead", "behind"}


def usual_unit(letter: str, meaning: str, indexed: bool = False) -> str:
    """What a letter is measured in by its name; indexed: whether some letter of the text is a diameter d_i."""
    words = re.findall(r"[a-z]+", re.split(r"\b(?:that|which)\b", meaning.lower().replace("'s", ""))[0])
    while len(words) > 1 and words[-1] in _PLACES:
        words.pop()
    called = "number" if words[:2] == ["number", "of"] else words[-1] if words else ""
    called = " ".join(words[-2:]) if " ".join(words[-2:]) in KINDS else called
    step = not indexed and re.match("(?:d(?!elta)|delta|Delta)[A-Za-z]", letter)
    changed = step or _RATIO.search(meaning) or any(OTHERS.fullmatch(word) for word in words)
    unit = "" if changed else KINDS.get(called, "")
    of_mass = re.search(r"\bmoment of inertia$", meaning) and not re.search(r"\b(?:area|polar|second)\b", meaning)
    if of_mass and letter.startswith(("J", "Theta")):
        unit = "kg*m^2"  # an I may be one of an area
    # small letters of work and heat are often those of a kilogram
    return "" if unit == "J" and letter[0].islower() else unit


_TURNS = re.compile(r"\b(?:revolutions|turns) (?:per|a) (minute|second)\b")


def of_turns(meaning: str) -> str:
    """The unit of what counts turns in a minute or a second; empty for all else."""
    counted = _TURNS.search(meaning)
    return {"minute": "rpm", "second": "-/s"}[counted[1]] if counted else ""


def head_of(meaning: str) -> str:
    """What something is, without what it is of or does: the force of the force acting on the mass."""
    return _DONE.sub("", _PREPOSITION.split(meaning.lower())[0])


def defined_unit(letter: str, meaning: str, indexed: bool = False) -> str:
    """What a letter is measured in by what a list says that it is: the head of that, where it is of something."""
    head = head_of(meaning)
    words = re.findall(r"[a-z]+", head)
    # the amplitude of a force is one
    known = words and words[-1] in KINDS
    return usual_unit(letter, head if known else re.split(r"\s(?:at|in|during)\s", meaning)[0], indexed)


_OPEN = ("m/s^2", "s^2/m", "-/kg")  # what a name leaves open: a weight, of a kilogram
#: By width or area, in a time, of an angle
_OPEN_OF = {
    "N": ("m", "-/m"),
    "m/s": ("-/m",),
    "m/s^2": ("-/m",),
    "J": ("-/m", "-/m^2", "-/s"),
    "W": ("-/m", "-/m^2"),
    "kg": ("-/m", "-/m^2", "-/s"),
    "m^3": ("-/m", "-/s"),
}
#: Names with an `of`, and of pure numbers: what they are measured in, the first where the table says anything else
_FIXED = (
    (re.compile(r"\bmoments? of inertia\b"), ("kg*m^2", "m^4")),
    (re.compile(r"\bsecond moment of area\b"), ("m^4",)),
    (re.compile(r"^[^,;(]*\b(?:efficiency|exponent)\s*$"), ("-",)),
)


def misnamed(letter: str, meaning: str, unit: str) -> str:
    """The unit of what is never measured in the one that the table has; empty where it is, or may be."""
    meaning, printed = meaning.lower(), tuple(dimension(unit or "-"))
    head = head_of(meaning)
    units = next((units for pattern, units in _FIXED if pattern.search(meaning)), ())
    if not units:
        usual = usual_unit(letter, head)
        several = sum(word in KINDS for word in re.findall("[a-z]+", head)) > 1  # a pressure force
        units = () if usual in ("", "-") or several else (usual,)
    weight = unit == "g" and units[:1] == ("m/s^2",)  # an acceleration in those of falling
    if not units or not unit or printed == PURE or weight or re.search(r"\bper\b", meaning):
        return ""
    over = [tuple(a - b for a, b in zip(printed, dimension(u), strict=True)) for u in units]
    left_open = {tuple(dimension(by)) for by in ("-", *_OPEN, *_OPEN_OF.get(units[0], ()))}
    return "" if any(o in left_open for o in over) else units[0]
