"""Mechanism files of the user's own: run the file, find what it declares, derive it, check it by differentiation."""

import contextlib
import importlib.util
import inspect
import sys
import traceback
from pathlib import Path
from types import ModuleType
from typing import Any

from mechsym.derive.autodiff import disagreement
from mechsym.derive.declare import Declaration
from mechsym.derive.emit import module_text
from mechsym.derive.lagrange import derive
from mechsym.derive.listing import listing
from mechsym.errors import BadInput, suggest


def run(path: Path) -> ModuleType:
    """Run a mechanism file; what it refuses or raises becomes one line with file and line.

    Parameters
    ----------
    path : Path
        A Python file

    Returns
    -------
    module : module
        What it defines

    Raises
    ------
    BadInput
        It cannot be read or run
    """
    if not path.is_file():
        raise BadInput(f"{path} is no file; give a Python file that declares a mechanism (see 'mechsym new mechanism')")
    spec = importlib.util.spec_from_file_location(f"mechsym_own_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise BadInput(f"{path} is no Python file; its name must end in .py")
    module = importlib.util.module_from_spec(spec)
    kept = list(sys.path)
    sys.path.insert(0, str(path.parent))  # helpers beside it
    try:
        with contextlib.redirect_stdout(sys.stderr):  # what it prints is no result
            spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        raise _refusal(path, error) from None
    finally:
        sys.path[:] = kept
    return module


def _refusal(path: Path, error: BaseException) -> BadInput:
    """What a file raised, in one line with its place."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if Path(f.filename) == path]
    line = error.lineno if isinstance(error, SyntaxError) else frames[-1].lineno if frames else None
    place = f"{path.name}:{line}: "
    text = " ".join(str(error).split()) or "no message"
    if isinstance(error, BadInput):
        return BadInput(text if text.startswith(f"{path.name}:") else place + text)
    return BadInput(f"{place}{type(error).__name__}: {text}")


def declared_in(path: Path) -> dict[str, Declaration]:
    """The mechanisms of a file: what its functions without arguments return, or what stands in it.

    Parameters
    ----------
    path : Path
        A Python file

    Returns
    -------
    mechanisms : dict of str to Declaration
        By name, in the order of the file

    Raises
    ------
    BadInput
        It declares none, or two of one name
    """
    module = run(path)
    found: list[Declaration] = [v for v in vars(module).values() if isinstance(v, Declaration)]
    for name, value in vars(module).items():
        if inspect.isfunction(value) and value.__module__ == module.__name__ and _bare(name, value):
            try:
                with contextlib.redirect_stdout(sys.stderr):
                    made = value()
            except (Exception, SystemExit) as error:
                raise _refusal(path, error) from None
            found += [made] if isinstance(made, Declaration) else []
    by_name = {m.name: m for m in found}
    if not found:
        raise BadInput(f"{path} declares no mechanism; write a function that makes one and returns it")
    if len(by_name) < len(found):
        raise BadInput(f"{path} declares two mechanisms of one name ({', '.join(m.name for m in found)})")
    return by_name


def _bare(name: str, function: Any) -> bool:
    if name.startswith("_") or name.startswith("test"):
        return False
    return all(p.default is not p.empty for p in inspect.signature(function).parameters.values())


def chosen(path: Path, name: str = "") -> Declaration:
    """The mechanism of a file, by name where there are several.

    Parameters
    ----------
    path : Path
        A Python file
    name : str
        Name of the mechanism

    Returns
    -------
    mechanism : Declaration
        Its declaration

    Raises
    ------
    BadInput
        None of that name, or several and no name
    """
    found = declared_in(path)
    if not name and len(found) > 1:
        raise BadInput(f"{path} declares {', '.join(found)}; choose one: {path.name}:{next(iter(found))}")
    if name and name not in found:
        raise BadInput(f"{path} declares no mechanism {name!r}; {suggest(name, found)}")
    return found[name] if name else next(iter(found.values()))


def build(path: Path, name: str, source_hash: str) -> tuple[str, dict[str, Any]]:
    """Generated code and listing of a mechanism in a file, after the check against T - V.

    Parameters
    ----------
    path : Path
        A Python file
    name : str
        Name of the mechanism, empty where there is one
    source_hash : str
        For the header

    Returns
    -------
    code : str
        Text of the generated module
    listing : dict
        See `mechsym.derive.listing`; `checked` says how many random states agreed

    Raises
    ------
    BadInput
        The declaration is refused, or its equations differ from those of T - V
    """
    declaration = chosen(path, name)
    equations = derive(declaration)
    states, wrong = disagreement(equations)
    if wrong > 1e-8:
        raise BadInput(
            f"{path.name}: the equations differ from those of T - V by {wrong:.1g} (relative): what is declared is not "
            "one mechanism; declare it in smaller steps and see which joint, angle or force brings the difference"
        )
    code = module_text(equations, path.name, source_hash)
    return code, listing(equations) | {"checked": states}
