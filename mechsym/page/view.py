"""How a result shows itself: in a report, in a notebook and at the prompt, by one view.

A room says in its `shown.py` what of its results is worth seeing (`@shows(Design)`); a result that is `Shown` finds it
there when it is asked, so that physics needs no picture to be computed.
"""

import dataclasses
import functools
import importlib
import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from mechsym.errors import BadInput, suggest
from mechsym.page.finding import Finding
from mechsym.page.table import ResultTable
from mechsym.page.template import page
from mechsym.quantities import record
from mechsym.quantities.display import in_si, per_cent, quantity_text
from mechsym.quantities.records import Record
from mechsym.quantities.results import on_card
from mechsym.quantities.units import Scalar
from mechsym.style import svg

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_VIEWS: dict[type, Callable[[Any], "View"]] = {}
_SHORT = 400  # characters of a repr


@record
class Card:
    """One number with what it is."""

    name: str
    value: str  #: With its unit
    about: str = ""
    mark: str = ""  #: `yes` and `no` are coloured


def card(kind: type, name: str, value: Scalar | None, about: str = "", of: str = "") -> Card:
    """The card of a number of a result: word, unit and digits are those of its field, a share is told in per cent.

    value: number of the field `name` of the class `kind`, None where it is not known [its unit]; of: which of several.

    >>> from mechsym.quantities.results import quantity, result
    >>> @result
    ... class Wheel:
    ...     power_kw: float = quantity("kW", card="power")
    >>> card(Wheel, "power_kw", 0.25).value
    '250 W'
    """
    entry = on_card(kind, name)
    number, unit = in_si(math.nan if value is None else float(value), entry["unit"])
    shown = per_cent(number, entry["digits"]) if unit == "-" else quantity_text(number, unit, entry["digits"])
    return Card(name=f"{entry['card']} {of}".rstrip(), value=shown, about=about)


def cards(result: Record) -> tuple[Card, ...]:
    """The cards of a result: of each field that has a word for one and a number, in their order."""
    kind = type(result)
    numbers = {f.name: getattr(result, f.name) for f in dataclasses.fields(kind) if "card" in f.metadata}
    return tuple(card(kind, name, value) for name, value in numbers.items() if value is not None)


@record
class Picture:
    """A figure that is drawn when it is looked at."""

    name: str
    see: str  #: What to look for, one sentence
    draw: Callable[[], "Figure"]


@record
class View:
    """What of a result is worth seeing."""

    title: str
    cards: tuple[Card, ...]
    pictures: tuple[Picture, ...] = ()
    columns: Callable[[], Mapping[str, Any]] = dict  #: Equally long, by name
    findings: Callable[[], Iterable[Finding]] = tuple  #: What has to be known before its numbers


def shows(kind: type) -> Callable[[Callable[[Any], View]], Callable[[Any], View]]:
    """Say how results of a class are seen: `@shows(Design)` above a function from a design to its `View`."""

    def kept(view: Callable[[Any], View]) -> Callable[[Any], View]:
        _VIEWS[kind] = view
        return view

    return kept


class Shown:
    """A result that shows itself; what there is to see stands in `shown.py` beside its class."""

    @property
    def view(self) -> View:
        """Its cards, pictures and columns."""
        kind = type(self)
        if kind not in _VIEWS:
            importlib.import_module(f"{kind.__module__.rpartition('.')[0]}.shown")
        return _VIEWS[kind](self)

    def plot(self, name: str = "") -> "Figure":
        """One of its figures, the first without a name, of matplotlib: `figure.savefig("name.svg")` keeps it."""
        pictures = {picture.name: picture for picture in self.view.pictures}
        if not pictures:
            raise BadInput(f"{type(self).__name__} has no picture")
        if name and name not in pictures:
            raise BadInput(f"no picture {name!r}; {suggest(name, list(pictures))}")
        figure: Any = pictures[name or next(iter(pictures))].draw()
        # a notebook knows figures of pyplot only
        figure._repr_svg_ = functools.partial(svg, figure)  # on its own paper
        return figure

    def table(self) -> ResultTable:
        """Its curves or figures as columns with units."""
        return ResultTable(self.view.columns())

    def _repr_html_(self) -> str:
        view = self.view
        return page("cards.html", cards=view.cards, title=view.title)


class ShownFigures(dict[str, Any], Shown):
    """Figures by name that show themselves; a dictionary in all else."""

    def __repr__(self) -> str:
        text = f"{type(self).__name__}({', '.join(f'{k}={_value(v)}' for k, v in self.items())})"
        return text if len(text) <= _SHORT else f"{text[: _SHORT - 5]} ...)"


def _value(value: object) -> str:
    text = f"array{value.shape}" if hasattr(value, "shape") else repr(value)
    return text if len(text) < 60 else f"{type(value).__name__} of {len(value)}" if hasattr(value, "__len__") else "…"
