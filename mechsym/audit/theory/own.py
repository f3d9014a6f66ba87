"""The theory of a mechanism from a file, or one that a package brings: every name of its declaration is a quantity."""

from functools import lru_cache
from pathlib import Path

from mechsym.audit.theory.drives import equations_theory
from mechsym.audit.theory.mechanisms import Results
from mechsym.audit.theory.record import Theory
from mechsym.cases.numbers import numbers, usual
from mechsym.derive import Mechanism, derive
from mechsym.derive.files import chosen
from mechsym.errors import BadInput
from mechsym.mechanisms.own import file_of


def own_theory(name: str, case: str) -> Theory:
    """The theory of a mechanism's declaration.

    Parameters
    ----------
    name : str
        `./FILE.py`, `./FILE.py:NAME`, or the name that a package brings
    case : str
        Case whose values set the scale of an error; empty takes one of this mechanism that lies beside the file
    """
    path, which = file_of(name)
    if not path.is_file():
        raise BadInput(f"--against {name}: there is no file {path}")
    data = case or usual(name)
    values = numbers(data, name) if data else {}
    return _theory(path.resolve(), which, data, tuple(values.items()), path.stat().st_mtime_ns)


@lru_cache(maxsize=8)
def _theory(path: Path, which: str, data: str, values: tuple[tuple[str, float], ...], _changed: int) -> Theory:
    try:
        equations = derive(chosen(path, which))
        return equations_theory(equations, dict(values), data, _named(equations.mechanism))
    except TypeError as error:
        raise BadInput(f"{path.name} cannot be a theory of the auditor: {error}") from None


def _named(m: Mechanism) -> Results:
    """All that the declaration names, links' angles and points included, besides what it puts out."""
    return {symbol.name: (symbol, m.units[symbol.name]) for symbol in m.tape.entries if symbol.name in m.units}
