"""The theory of a mechanism from a file, or one that a package brings: every name of its declaration is a quantity."""

import tomllib
from functools import lru_cache
from pathlib import Path

from mechsym import cases
from mechsym.audit.theory.drives import equations_theory
from mechsym.audit.theory.record import Theory
from mechsym.cases.numbers import numbers
from mechsym.derive import derive
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
    return _theory(path.resolve(), which, case or _beside(path.resolve(), which), path.stat().st_mtime_ns)


def _beside(path: Path, which: str) -> str:
    """The first case beside a file that names it as its mechanism; empty where there is none."""
    for file in sorted(path.parent.glob("*.toml")):
        try:
            said = str(tomllib.loads(file.read_text(encoding="utf-8")).get("mechanism", ""))
        except (OSError, ValueError):
            continue
        found, named = file_of(said)
        if found.suffix == ".py" and (path.parent / found).resolve() == path and named in ("", which):
            return str(file)
    return ""


@lru_cache(maxsize=8)
def _theory(path: Path, which: str, case: str, _changed: int) -> Theory:
    if case:
        found = file_of(cases.load(case).mechanism)
        if found[0].resolve() != path or found[1] not in ("", which):
            raise BadInput(f"case {case} is of the mechanism {found[0].name}, not of {path.name}; name another")
    values = numbers(case) if case else {}
    try:
        return equations_theory(derive(chosen(path, which)), values, case)
    except TypeError as error:
        raise BadInput(f"{path.name} cannot be a theory of the auditor: {error}") from None
