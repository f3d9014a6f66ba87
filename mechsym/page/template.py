"""Pages as text: the templates of `mechsym/templates`, numbers in the units that the user has chosen."""

import functools
import re
from typing import TYPE_CHECKING

import mechsym
from mechsym.quantities.display import figure, key_words, quantity_text, ratio_text
from mechsym.style import significant

if TYPE_CHECKING:
    import jinja2

_KEYED = re.compile(r"[A-Za-z][\w.]*(?= ?=)")  # a key before its value
_NAMED = re.compile(r"(?<![\w./\\])[A-Za-z]\w*_\w+(?![\w(/]|\.[a-z])")  # a key, no file
_SYMBOL = 3  # letters before its index
_TIMES = re.compile(r"(?<=[a-zA-Z])\*(?=[a-zA-Z])")


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

    made = jinja2.Environment(
        loader=jinja2.PackageLoader("mechsym", "templates"),
        undefined=jinja2.StrictUndefined,
        autoescape=True,
        trim_blocks=True,
    )
    made.globals["version"] = mechsym.__version__
    made.filters |= {
        "sig": significant, "figure": figure, "ratio": ratio_text, "percent": _percent, "plain": pretty,
        "pretty": typeset,
        "words": key_words, "places": lambda text: _KEYED.sub(lambda found: key_words(found[0]), str(text)),
        "quantity": lambda value, unit, digits=5: typeset(quantity_text(value, unit, digits)),
    }  # fmt: skip
    return made


def _percent(share: float | None, digits: int = 3) -> str:
    """A share as per cent; round-off is 0."""
    if share is None:
        return "–"
    return "0 %" if abs(share) < 1e-9 else f"{figure(100 * share, digits)} %"


def typeset(text: object) -> str:
    """Text of a page: units as a book sets them, symbols with their index, other keys as what is typed."""
    from markupsafe import Markup, escape

    return Markup(_NAMED.sub(_set, str(escape(pretty(text)))))  # noqa: S704 escaped before


def _set(found: re.Match[str]) -> str:
    base, _, index = found[0].partition("_")
    return f"{base}<sub>{index.replace('_', ' ')}</sub>" if len(base) <= _SYMBOL else f"<code>{found[0]}</code>"


def pretty(text: object) -> str:
    """Units as a book sets them: `kN*m` as kN m, `kg*m^2` as kg m².

    >>> pretty("37810 kg*m^2")
    '37810 kg m²'
    """
    found = _TIMES.sub(" ", str(text)).replace("^2", "²").replace("^3", "³").replace("^4", "⁴")
    return found.replace("1e-9", "1e\u20119")  # a hyphen that does not break
