"""Mechanism files of the user's own: run the file, find what it declares, derive it, check it by differentiation."""

import contextlib
import importlib
import importlib.util
import inspect
import re
import sys
import traceback
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from mechsym.derive.declare import Declaration
from mechsym.derive.emit import module_text
from mechsym.derive.lagrange import derive
from mechsym.derive.linkage import BY_CONSTRAINT, Link
from mechsym.derive.listing import Listing, listing
from mechsym.derive.methods import declaration_of, is_method
from mechsym.derive.printer import UnsupportedNode
from mechsym.derive.textbook import disagreement
from mechsym.errors import BadInput, suggest
from mechsym.files.inputs import imports_from, sources


def run(path: Path) -> ModuleType:
    """Run a mechanism file; what it refuses or raises becomes one line with file and line.

    path: a Python file. Returns module: what it defines.

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
    try:
        with _imports_beside(path), contextlib.redirect_stdout(sys.stderr):  # what it prints is no result
            spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        raise _refusal(path, error) from None
    return module


@contextlib.contextmanager
def _imports_beside(path: Path) -> Iterator[None]:
    """Helpers beside a file are read anew: they may have changed, and another file may have some of the same name."""
    folder = imports_from(path)
    helpers = {file.relative_to(folder).parts[0].removesuffix(".py") for file in sources(path)}

    def loaded() -> dict[str, ModuleType]:
        return {name: module for name, module in sys.modules.items() if name.partition(".")[0] in helpers}

    before, paths, writes = loaded(), list(sys.path), sys.dont_write_bytecode
    for name in before:
        del sys.modules[name]
    sys.path.insert(0, str(folder))
    sys.dont_write_bytecode = True  # a second edit within a second would not be seen
    importlib.invalidate_caches()
    try:
        yield
    finally:
        sys.path[:], sys.dont_write_bytecode = paths, writes
        for name in loaded():
            del sys.modules[name]
        sys.modules.update(before)


def _refusal(path: Path, error: BaseException) -> BadInput:
    """What a file raised, in one line with its place."""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if Path(f.filename) == path.resolve()]
    line = error.lineno if isinstance(error, SyntaxError) else frames[-1].lineno if frames else None
    place = f"{path.name}:{line}: " if line else f"{path.name}: "
    # methods by the names that a file calls
    text = re.sub(r"\b[A-Z]\w+\.(?=\w+\(\))", "", " ".join(str(error).split())) or "no message"
    if isinstance(error, BadInput):
        return BadInput(text if text.startswith(f"{path.name}:") else place + text)
    return BadInput(f"{place}{type(error).__name__}: {text}{_way_out(error)}")


def _way_out(error: BaseException) -> str:
    """How a part of a declaration is called, where a file calls it otherwise."""
    if isinstance(error, AttributeError) and isinstance(error.obj, (Declaration, Link)):
        kind = type(error.obj)
        return f"; {suggest(str(error.name), [n for n in dir(kind) if not n.startswith('_')])}"
    if isinstance(error, TypeError) and "expression to float" in str(error):
        return "; take sin, cos, sqrt and pi from mechsym.derive, not from math"
    owner, dot, name = str(error).partition("()")[0].rpartition(".")
    called = getattr(Link if owner == "Link" else Declaration, name, None)
    if not isinstance(error, TypeError) or not dot or called is None:
        return ""
    _, *parameters = inspect.signature(called).parameters.values()
    shown = inspect.Signature([p.replace(annotation=p.empty) for p in parameters])
    return f"; write {'Mechanism' if name == '__init__' else name}{shown}"


def declared_in(path: Path, wanted: str = "") -> dict[str, Declaration]:
    """The mechanisms of a file: what its functions without arguments return, or what stands in it.

    path: a Python file; wanted: name of the one that is needed, beside which others may be refused. Returns mechanisms:
    by name, in the order of the file.

    Raises
    ------
    BadInput
        It declares none, or two of one name, or what it declares is refused
    """
    module, refused, strays = run(path), list[BadInput](), list[str]()
    units = getattr(module, "units", {})
    declared = [d for name, value in vars(module).items() if (d := _declaration(path, name, value, units))]
    for name, value in vars(module).items():
        if name.startswith(("_", "test")) or not inspect.isfunction(value) or value.__module__ != module.__name__:
            continue
        if all(p.default is not p.empty for p in inspect.signature(value).parameters.values()):
            try:
                with contextlib.redirect_stdout(sys.stderr):
                    returned = value()
            except (Exception, SystemExit) as error:
                refused.append(_refusal(path, error))
                continue
            declared += [d] if (d := _declaration(path, name, returned, units)) else []
            strays += [] if d else [f"{value.__code__.co_firstlineno}: {name}() returns {_kind(returned)}"]
    by_name = {m.name: m for m in declared}
    if refused and wanted not in by_name:
        raise refused[0]
    if not declared:
        if strays:
            raise BadInput(f"{path.name}:{', '.join(strays)}, no mechanism; end it with `return m`")
        raise BadInput(f"{path} declares no mechanism; write a function that makes one and returns it")
    if len(by_name) < len(declared):
        raise BadInput(f"{path} declares two mechanisms of one name ({', '.join(m.name for m in declared)})")
    return by_name


def _kind(value: object) -> str:
    return "nothing" if value is None else f"a {type(value).__name__}"


def _declaration(path: Path, name: str, value: object, units: object) -> Declaration | None:
    """What a value of a file declares: a mechanism, or a model of sympy under the name that it has in the file."""
    if not is_method(value):
        return value if isinstance(value, Declaration) else None
    try:
        return declaration_of(name, value, units if isinstance(units, dict) else {})
    except BadInput as error:
        raise _refusal(path, error) from None


def chosen(path: Path, name: str = "") -> Declaration:
    """The mechanism of a file, by name where there are several.

    path: a Python file.

    Raises
    ------
    BadInput
        None of that name, or several and no name
    """
    declared = declared_in(path, name)
    if not name and len(declared) > 1:
        raise BadInput(f"{path} declares {', '.join(declared)}; choose one: {path.name}:{next(iter(declared))}")
    if name and name not in declared:
        raise BadInput(f"{path} declares no mechanism {name!r}; {suggest(name, declared)}")
    return declared[name] if name else next(iter(declared.values()))


def explained(path: Path, name: str) -> list[str]:
    """How the loops of a mechanism in a file are closed, a line each, in order."""
    return chosen(path, name).explained()


def build(path: Path, name: str, source_hash: str, by_constraint: bool = False) -> tuple[str, Listing]:
    """Generated code and listing of a mechanism in a file, after the check against T - V.

    path: a Python file; name: name of the mechanism, empty where there is one; source_hash: for the header;
    by_constraint: whether its loops close by constraint, whatever closed form there is. Returns code: str, text of the
    generated module. listing: see `mechsym.derive.listing`; `checked` says how many random states agreed.

    Raises
    ------
    BadInput
        The declaration is refused, or its equations differ from those of T - V
    """
    held = BY_CONSTRAINT.set(by_constraint)
    try:
        declaration = chosen(path, name)
    finally:
        BY_CONSTRAINT.reset(held)
    try:
        equations = derive(declaration)
        code = module_text(equations, path.name, source_hash)
    except UnsupportedNode as error:
        raise BadInput(f"{declaration.where[declaration.name]}: {error}") from None
    states, wrong = disagreement(equations)
    if wrong > 1e-8:
        raise BadInput(
            f"{path.name}: the equations differ from those of T - V by {wrong:.1g} (relative): what is declared is not "
            "one mechanism; declare it in smaller steps and see which joint, angle or force brings the difference"
        )
    return code, {**listing(equations), "checked": states}
