"""What a run, and the commands forces, size and codesign, say of one case, as numbers by name."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from mechsym.cases import Case
from mechsym.files import Json
from mechsym.quantities.results import Columns, names_of, some

if TYPE_CHECKING:
    from mechsym.forces.summary import ForceNumbers
from collections.abc import Mapping

from mechsym.mechanisms.shaft import ElasticShaft
from mechsym.quantities import results
from mechsym.quantities.results import part, units_of
from mechsym.simulate import Result
from mechsym.simulate.result import RunNumbers
from mechsym.torsion.twist import ShaftSection, sections


def forces(case: Case) -> "ForceNumbers":
    """Figures of `mechsym forces`."""
    from mechsym.forces.summary import summary
    from mechsym.jobs.forces import forces as run

    return summary(run(case), case.name, case.source)


def size(case: Case) -> Json:
    """Rows of `mechsym size` as component.quantity with its unit, and .limit and .safety_factor of a check."""
    from mechsym.jobs.size import size as sized

    found = sized(case)
    numbers: dict[str, object] = {"failing [-]": len(found.failing), "converged [-]": found.converged}
    for row in found.rows:
        name = f"{row['component']}.{row['quantity']}".replace(" ", "_")
        # one quantity may be held against several rules
        unit = f" [{row['unit'] or '-'}]"
        name = name if name + unit not in numbers else f"{name}.{row['rule']}".replace(" ", "_")
        numbers[name + unit] = row["value"]
        if row["limit"] is not None:
            numbers |= {f"{name}.limit{unit}": row["limit"], f"{name}.safety_factor [-]": row["safety_factor"]}
    return numbers


def codesign(case: Case) -> Columns:
    """Figures of `mechsym codesign`; of a list over speeds and loads the smallest and the largest value."""
    from mechsym.codesign.result import CoDesignNumbers, numbers_of
    from mechsym.jobs.codesign import codesign as design
    from mechsym.jobs.codesign import settings_of

    every = some(numbers_of(design(case, settings_of(case))), names_of(CoDesignNumbers))
    return Columns({name: _ends(value, every.units[name]) for name, value in every.items()}, every.units)


def _ends(value: object, unit: str) -> object:
    numbers = [v for v in value if isinstance(v, float | int)] if isinstance(value, Sequence) else []
    if len(numbers) < 2 or isinstance(value, str):
        return value
    return Columns({"min": min(numbers), "max": max(numbers)}, {"min": unit, "max": unit})


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
