"""Units at the border, records that check themselves, and code named by a text.

units.py     "142 rpm" or "5 MPa" to SI; a wrong dimension is refused
records.py   frozen records whose fields carry unit and range
results.py   what is told of a result, with units: `quantity`, `part`, `computed`; one teller
ranges.py    lists and ranges as options take them: `3..8 MPa:11`, `80,85 rpm`
by_name.py   `load("module:name")` when it is wanted; `lazily` for the names of a room

    @record
    class Spring:
        p0: float = quantity("Pa", above=0, about="initial excess pressure")
        stage: str = choice("low", "high", default="low")
        area: float  #: of the piston [m^2]; a result needs no range, only its unit
"""

from mechsym.quantities.by_name import lazily, load
from mechsym.quantities.records import allowed, check, choice, quantity, record, reference
from mechsym.quantities.units import RPM, dimension, parse, units

__all__ = ["RPM", "allowed", "check", "choice", "dimension", "lazily", "load", "parse", "quantity", "record"]
__all__ += ["reference", "units"]


def __dir__() -> list[str]:
    return __all__
