"""What a run in time tells at a point of a sweep."""

from collections.abc import Mapping

from mechsym.mechanisms.shaft import ElasticShaft
from mechsym.quantities import results
from mechsym.quantities.results import Columns, part, units_of
from mechsym.simulate import Result
from mechsym.simulate.result import RunNumbers
from mechsym.torsion.twist import ShaftSection, sections

_PEAKS = ("twist_peak", "torque_peak")


@results.result
class SweptRun:
    """A run at a point of a sweep."""

    numbers: RunNumbers = part(inline=True)
    peaks: Columns = part(inline=True)  #: Largest of all sections of an elastic shaft
    twist: Mapping[str, ShaftSection] = part()


def swept(shaft: ElasticShaft | None, result: Result, numbers: RunNumbers) -> SweptRun:
    """A finished run with its numbers and the twist of its shaft."""
    twists = () if shaft is None else sections(shaft, result, result.t[-1] - numbers.window)
    peaks = {name: max(getattr(section, name) for section in twists) for name in (_PEAKS if twists else ())}
    return SweptRun(
        numbers=numbers,
        peaks=Columns(peaks, units_of(ShaftSection)),
        twist={section.section: section for section in twists},
    )
