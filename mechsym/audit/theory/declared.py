"""Theories that anyone declares: a TOML file of letters and definitions, or a mechanism in a Python file.

angle = "phi"                       # runs over a turn; phid and phidd are its rates
small = ["lam"]                     # numbers that go to zero; rods = ["l"]: lengths that grow without limit
[letters]
r = "30 mm"                         # a value with its unit; "rad" alone: the value is 1
F = { unit = "N", value = 100.0, sign = "any", domain = [0.0, 200.0] }
[define]
s = "r*(1 - cos(phi))"              # language.py says what may stand here
[units]
s = "m"                             # only where dimensions do not tell it
[conditions]
"no friction" = ["mu"]              # what sources take for granted
[symbols]
"\\omega" = "phid"                  # letters of a paper (paper_rows.py): here the author's omega is phid
"""

import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mechsym.audit.reader import RESERVED
from mechsym.audit.theory.language import define
from mechsym.audit.theory.record import Letter, Theory
from mechsym.audit.theory.tape import TheoryTape
from mechsym.errors import BadInput
from mechsym.files import read_text
from mechsym.quantities import dimension, parse

_KEYS = ("name", "about", "source", "angle", "small", "rods", "letters", "define", "units", "conditions", "symbols")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_VALUE = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)?\s*(.*?)\s*$")


def read_theory(path: Path) -> Theory:
    """A theory from a TOML file; its name is the file's unless it says another."""
    return theory_of(read_text(path, "--theory"), path.stem, str(path))


def theory_of(text: str, stem: str, where: str) -> Theory:
    """A theory from the text of a TOML file."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{where}: not valid TOML: {error}") from None
    unknown = sorted(content.keys() - set(_KEYS))
    if unknown:
        raise BadInput(f"{where}: {unknown[0]!r} is not a key of a theory; keys are {', '.join(_KEYS)}")
    try:
        return _theory(content, str(content.get("name", stem)), where)
    except BadInput as error:
        raise BadInput(f"{where}: {error}") from None


def _theory(content: Mapping[str, Any], name: str, where: str) -> Theory:
    angle = content.get("angle", "")
    letters = _letters(_table(content, "letters"), angle)
    if angle and angle not in letters:
        letters |= {angle: Letter(unit="rad", value=1.0)}
    tape = TheoryTape({}, letters, angle, declared=True)
    for own, text in _table(content, "define").items():
        if not _NAME.fullmatch(own) or own in (*letters, *RESERVED):
            raise BadInput(f"define.{own}: a name of letters and digits that is no letter or function yet is needed")
        if not isinstance(text, (str, int, float)) or isinstance(text, bool):
            raise BadInput(f"define.{own} is a text in quotes, such as 'r*sin(phi)'")
        try:
            tape.base[own] = define(own, str(text), tape)
        except BadInput as error:
            raise BadInput(f"define.{own}: {error}") from None
    if not tape.base:
        raise BadInput("there is nothing in [define]; write a quantity, as x = 'r*(1 - cos(phi))'")
    units = _table(content, "units")
    for unit in units.values():
        dimension(str(unit))
    return Theory(
        name=name,
        letters=letters,
        tape=tape,
        results=tuple(tape.base),
        units={k: str(u) for k, u in units.items()},
        angle=angle,
        rods=_names(content, "rods", letters),
        small=_names(content, "small", letters),
        conditions={k: _among(v, f"conditions.{k}", letters) for k, v in _table(content, "conditions").items()},
        data=where,
    )


def _table(content: Mapping[str, Any], key: str) -> dict[str, Any]:
    found = content.get(key, {})
    if not isinstance(found, dict):
        raise BadInput(f"[{key}] must be a table")
    return found


def _names(content: Mapping[str, Any], key: str, letters: Mapping[str, Letter]) -> tuple[str, ...]:
    return _among(content.get(key, []), key, letters)


def _among(found: Any, key: str, letters: Mapping[str, Letter]) -> tuple[str, ...]:
    if not isinstance(found, list) or not all(isinstance(k, str) and k in letters for k in found):
        raise BadInput(f"{key} is a list of free letters; letters are {', '.join(letters)}")
    return tuple(found)


def _letters(table: Mapping[str, Any], angle: str) -> dict[str, Letter]:
    found = {}
    for own, about in table.items():
        if not _NAME.fullmatch(own) or own in RESERVED:
            raise BadInput(f"letters.{own}: a letter is a name of letters and digits, and not pi nor a function")
        found[own] = _letter(own, about)
    rates = {f"{angle}d": Letter(unit="rad/s", value=10.0), f"{angle}dd": Letter(unit="rad/s^2", value=3.0)}
    return found | {k: v for k, v in rates.items() if angle and k not in found}


def _letter(own: str, about: Any) -> Letter:
    if not isinstance(about, dict):
        return _short(own, about)
    unknown = sorted(about.keys() - {"unit", "value", "sign", "domain", "about"})
    if unknown or about.get("sign", "") not in ("", "any", "positive"):
        raise BadInput(
            f'letters.{own} has unit, value, sign ("any" or "positive"), domain and about; found {sorted(about)}'
        )
    unit, domain = str(about.get("unit", "-")), about.get("domain")
    dimension(unit)
    if domain is not None:
        if not isinstance(domain, list) or len(domain) != 2:
            raise BadInput(f"letters.{own}.domain is a list of two ends, as [0.0, 1.5]")
        low, high = (parse(end, unit, f"letters.{own}.domain") for end in domain)
        if not low < high:
            raise BadInput(f"letters.{own}.domain: the first end must be below the second")
        domain = (low, high)
    value = parse(about.get("value", sum(domain) / 2 if domain else 1.0), unit, f"letters.{own}.value")
    return Letter(unit=unit, value=value, sign=about.get("sign", ""), domain=domain)


def _short(own: str, about: Any) -> Letter:
    if isinstance(about, (int, float)) and not isinstance(about, bool):
        return Letter(unit="-", value=float(about))
    if not isinstance(about, str):
        raise BadInput(f"letters.{own} is a value with its unit, as '30 mm', or a table")
    match = _VALUE.fullmatch(about)
    unit = (match[2] if match else "") or "-"
    dimension(unit)
    return Letter(unit=_si(unit), value=parse(about, _si(unit), f"letters.{own}") if match and match[1] else 1.0)


def _si(unit: str) -> str:
    # the SI unit of the same dimension: parse gives values in it
    mass, length, time, kelvin = dimension(unit)
    if parse(f"1 {unit}" if unit != "-" else 1.0, unit) == 1.0 and unit not in ("deg", "rpm"):
        return unit
    if unit in ("deg", "rev"):
        return "rad"
    if unit == "rpm":
        return "rad/s"
    powers = zip(("kg", "m", "s", "K"), (mass, length, time, kelvin), strict=True)
    return "*".join(f"{u}^{p}" for u, p in powers if p) or "-"
