"""Pages as text: the templates of `mechsym/templates`, numbers in the units that the user has chosen."""

import functools
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING
from unicodedata import lookup
from xml.etree import ElementTree

import numpy as np

import mechsym
from mechsym.files import Json
from mechsym.quantities.display import figure, key_words, quantity_text, ratio_text, residual_text
from mechsym.style import significant

if TYPE_CHECKING:
    import jinja2

_KEYED = re.compile(r"([A-Za-z][\w.]*) ?= ?")  # a key before its value
_NAMED = re.compile(  # a key, no file
    r"(?<![\w./\\])[A-Za-z]\w*_\w+(?![\w(/]|\.[a-z])"
    r"|(?<![\w./\\-])[a-z_]{3,}\.(?!(?:csv|json|toml|py|svg|html|md|dxf|fmu)\b)[A-Za-z]\w*(?![\w(/-]|\.\w)"
)
_SYMBOL = 3  # letters before its index
_GREEK = {name: lookup(f"GREEK SMALL LETTER {name}") for name in
          "alpha beta gamma delta zeta eta theta mu rho sigma tau phi chi omega".split()}  # fmt: skip
_LETTER = re.compile(rf"(?<![\w./\\-])({'|'.join(_GREEK)})(_?\w*)(?![\w(/=-]|\.[a-z])")
_TIMES = re.compile(r"(?<=[a-zA-Z])\*(?=[a-zA-Z])")
_TWICE = re.compile(r"\b(k?J|W|N|kg)/(kg|m²|m)/(K⁴?|s)")
_LINE = 70  # letters of an equation that stand on one line


def page(name: str, **values: object) -> str:
    """A page that opens offline, from a file of `mechsym/templates`; a value that it lacks is an error.

    >>> page("cards.html", cards=(), title="Empty").startswith('<div class="mechsym">')
    True
    """
    text = str(_environment().get_template(name).render(**values))
    return text.replace("</body>", page("live.html") + "</body>") if " data-panels=" in text else text


@functools.lru_cache(maxsize=1)
def _environment() -> "jinja2.Environment":
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("mechsym", "templates"),
        undefined=jinja2.StrictUndefined,
        autoescape=True,
        trim_blocks=True,
    )
    environment.globals["version"] = mechsym.__version__
    environment.policies["json.dumps_kwargs"] = {"sort_keys": True, "separators": (",", ":")}
    environment.filters |= {
        "sig": significant, "figure": figure, "ratio": ratio_text, "residual": residual_text, "percent": _percent,
        "plain": pretty, "pretty": typeset, "pieces": pieces,
        "words": key_words, "places": lambda text, said: _KEYED.sub(lambda match: f"{said(match[1])} = ", str(text)),
        "packed": packed,
        "quantity": lambda value, unit, digits=5: typeset(quantity_text(value, unit, digits)),
    }  # fmt: skip
    return environment


def packed(scenes: Sequence[Json]) -> list[Json]:
    """Scenes of a page in few letters: places by frame as steps from the frame before, equal ones once.

    A shape that only shifts has one pair a frame in place of all its corners.
    """
    return [_packed_scene(scene) for scene in scenes]


def _packed_scene(scene: Json) -> Json:
    shown, places = scene | {"shapes": [_packed_shape(shape) for shape in scene["shapes"]]}, list[list[int]]()
    if "loads" not in scene:
        return shown
    loads = []
    for load in scene["loads"]:
        ends = {key: _steps(load[key], 1) for key in ("at", "to")}
        places += [steps for steps in ends.values() if steps not in places]
        loads.append(load | {key: places.index(steps) for key, steps in ends.items()})
    return shown | {"loads": loads, "places": places}


def _packed_shape(shape: Json) -> Json:
    if not shape["moves"]:
        return shape
    by = np.reshape(np.array(shape["moves"]) - shape["at"], (len(shape["moves"]), -1, 2))
    only_shifts = by.shape[1] > 1 and np.ptp(by, axis=1).max() <= 0.11  # a rounded place is off by half a tenth
    return shape | {"moves": _steps(by.mean(axis=1) if only_shifts else shape["moves"]), "shifts": bool(only_shifts)}


def _steps(frames: Sequence[Sequence[float]], part: int = 10) -> list[int]:
    """Whole parts of a pixel, frame after frame."""
    parts = np.round(part * np.array(frames)).astype(int)
    return np.diff(parts, axis=0, prepend=0 * parts[:1]).ravel().tolist()


def _percent(share: float | None, digits: int = 3) -> str:
    """A share as per cent; round-off is 0."""
    if share is None:
        return "–"
    return "0 %" if abs(share) < 1e-9 else f"{figure(100 * share, digits)} %"


def typeset(text: object) -> str:
    """Text of a page: units as a book sets them, symbols with their index, other keys as what is typed."""
    from markupsafe import Markup, escape

    return Markup(_NAMED.sub(_set, _LETTER.sub(_letter, str(escape(pretty(text))))))  # noqa: S704 escaped before


def _letter(match: re.Match[str]) -> str:
    """A Greek letter with its index; a word that only begins as one stays."""
    index = match[2].lstrip("_")
    if match[2] and not (index.isdigit() or match[2][0] == "_" and len(index) <= _SYMBOL):
        return match[0]
    return _GREEK[match[1]] + (f"<sub>{index}</sub>" if index else "")


def _set(match: re.Match[str]) -> str:
    base, _, index = match[0].partition("_")
    if "." in match[0] or len(base) > _SYMBOL:
        return f"<code>{match[0]}</code>"
    return f"{base}<sub>{index.replace('_', ' ')}</sub>"


def pieces(mathml: str) -> list[str]:
    """An equation in pieces between which a line may break: a long one before each sign between the terms of a side.

    >>> pieces("<mrow><mi>x</mi><mo>=</mo><mn>2</mn><mo>-</mo><mi>y</mi></mrow>")
    ['<mrow><mi>x</mi><mo>=</mo><mn>2</mn><mo>−</mo><mi>y</mi></mrow>']
    """
    whole = mathml.replace("<mo>-</mo>", "<mo>\u2212</mo>")
    if len(re.sub(r"<[^>]*>|&\w+;", "", whole)) < _LINE:
        return [whole]
    rows: list[str] = [""]
    for side in ElementTree.fromstring(whole.replace("&InvisibleTimes;", "\u2062")):  # noqa: S314 written by ourselves
        signs = [one.text for one in side if one.tag == "mo"]
        for one in side if side.tag == "mrow" and {"+", "\u2212"} & {*signs} else (side,):
            if one.tag == "mo" and one.text in ("+", "\u2212", "="):
                rows.append("")
            rows[-1] += ElementTree.tostring(one, "unicode")
    return [f"<mrow>{row}</mrow>" for row in rows if row]


def pretty(text: object) -> str:
    """Units as a book sets them: `kN*m` as kN m, `kg*m^2` as kg m².

    >>> pretty("37810 kg*m^2")
    '37810 kg m²'
    """
    words = _TIMES.sub(" ", str(text)).replace("^2", "²").replace("^3", "³").replace("^4", "⁴")
    words = _TWICE.sub(r"\1/(\2 \3)", words)
    return words.replace("1e-9", "1e\u20119")  # a hyphen that does not break
