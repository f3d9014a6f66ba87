"""Mechanisms of the user's own: `./scotch.py`, `./scotch.py:NAME`, or a name that an installed package brings.

The code of a file is derived once and kept in the user's cache by the content of the file, of all that it imports from
beside it (see `mechsym.files.inputs.sources`) and of the derivation core; sympy is needed only then. The record of
parameters is made from the declaration.
A package brings mechanisms by the entry point group `mechsym.mechanisms`: name = "package.module", a module with a
declaration. Such a file runs as code of the user's own.
"""

import contextlib
import dataclasses
import functools
import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, TypedDict

from mechsym.errors import BadInput, MissingExtra
from mechsym.files import write_bytes, write_text
from mechsym.files.inputs import sources
from mechsym.files.trust import refuse_foreign
from mechsym.mechanisms.amounts import amount
from mechsym.quantities import check, quantity, record
from mechsym.quantities.records import Field, Record

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing

_GROUP = "mechsym.mechanisms"
_HELD = "+constraint"  # behind which of a file's mechanisms: its loops close by constraint
_CODE = re.compile(r"[^_].*\.py")


@record
class Own:
    """A mechanism read from a file."""

    name: str  #: In its declaration
    path: Path  #: File that declares it
    which: str  #: Which of its mechanisms; empty where there is one
    code: str  #: Text of the generated module
    listing: "Listing"  #: See `mechsym.derive.listing`
    module: ModuleType
    parameters: type[Record]  #: Class of its record of parameters


class Derived(TypedDict):
    """What is kept of a declaration."""

    code: str
    listing: "Listing"


def is_file(name: str) -> bool:
    """Whether a mechanism is named by a file, or brought by another package."""
    return name.partition(".py:")[0].endswith(".py") or ".py:" in name or _brought(name) is not None


@functools.cache
def packaged() -> tuple[str, ...]:
    """Names of the mechanisms that the package has, generated or assembled."""
    generated = {
        p.name.removesuffix(".py") for p in resources.files("mechsym.generated").iterdir() if _CODE.fullmatch(p.name)
    }
    assembled = {p.parent.name for p in Path(__file__).parent.glob("*/__init__.py")}
    return tuple(sorted(generated | assembled))


@functools.lru_cache(maxsize=1)
def brought() -> dict[str, str]:
    """Names that installed packages bring, with their files."""
    import importlib.metadata

    files = {}
    for entry in importlib.metadata.entry_points(group=_GROUP):
        spec = importlib.util.find_spec(entry.value.partition(":")[0])
        if spec is not None and spec.origin:
            files[entry.name] = f"{spec.origin}:{entry.attr}" if entry.attr else spec.origin
    return files


def _brought(name: str) -> str | None:
    # what this package has goes first: a look at all that is installed takes longer than an evaluation
    return None if name in packaged() else brought().get(name)


def located(name: str, folder: Path) -> str:
    """A mechanism's name in a case file of a folder as a name that holds in the working folder."""
    if _brought(name) or not is_file(name):
        return name
    path, colon, which = _parts(name)
    return f"{path if path.is_absolute() else folder / path}{colon}{which}"


def _parts(name: str) -> tuple[Path, str, str]:
    name = _brought(name) or name
    head, colon, which = name.rpartition(":")
    if colon and head.endswith(".py"):
        return Path(head), colon, which
    return Path(name), "", ""


def quantity_of(name: str, output: str) -> str:
    """An output of a mechanism as it is typed after --against."""
    return f"{name}{':' if is_file(name) else '.'}{output}"


def file_of(name: str) -> tuple[Path, str]:
    """File of a mechanism, and which of its mechanisms is meant, empty where there is one."""
    path, _, which = _parts(name)
    return path, which


def by_constraint(name: str) -> str:
    """The same mechanism with loops that close by constraint, so that no dead point ends its motion."""
    path, which = file_of(name)
    return f"{path}:{which}{_HELD}"


def load(name: str) -> Own:
    """The mechanism of a file.

    Raises BadInput: the file cannot be read, or its declaration is refused. MissingExtra: it is not in the cache and
    sympy is not installed.
    """
    path, _, which = _parts(name)
    if not path.is_file():
        raise BadInput(f"mechanism {name!r}: there is no file {path}; paths count from the case file or this folder")
    return _load(path.resolve(), which, _key(path.resolve(), which))


def content(name: str) -> str:
    """Digest of the sources of a mechanism, for what goes by its name; empty where the package has it."""
    path, which = file_of(name)
    return _key(path.resolve(), which) if is_file(name) and path.is_file() else ""


def _key(path: Path, which: str) -> str:
    named = path.name.encode(), which.encode()  # the stamp of the code names the file
    return hashlib.sha256(b"\0".join([*named, _core(), *sources(path).values()])).hexdigest()[:24]


@functools.lru_cache(maxsize=1)
def _core() -> bytes:
    return b"\0".join(p.read_bytes() for p in sorted((Path(__file__).parents[1] / "derive").glob("*.py")))


@functools.lru_cache(maxsize=32)
def _load(path: Path, which: str, key: str) -> Own:
    from mechsym.native import cache  # who runs no file of his own does not load it

    folder = cache.writable()
    stored = _stored(folder, key)
    if stored is None:
        stored = _derived(path, which, key)
        data = json.dumps(stored, ensure_ascii=False).encode()
        write_bytes(folder / f"derived-{key}-{_digest(data)}.json", data)
    listing = stored["listing"]
    return Own(
        name=listing["name"],
        path=path,
        which=which,
        code=stored["code"],
        listing=listing,
        module=_module(path, stored["code"]),
        parameters=record_of(listing),
    )


def explained(name: str) -> list[str]:
    """How the loops of a mechanism are closed, a line each."""
    from mechsym.derive import files

    path, which = file_of(name)
    permit(path.resolve())
    return files.explained(path, which)


def write(mechanism: Own, folder: Path | None) -> list[Path]:
    """Write code and listing to a folder; without one they are in the cache, which is named."""
    if folder is None:
        from mechsym.native import cache

        return sorted(cache.writable().glob(f"derived-{_key(mechanism.path, mechanism.which)}-*.json"))
    listing = json.dumps(dict(mechanism.listing), indent=1, ensure_ascii=False) + "\n"
    files = {f"{mechanism.name}.py": mechanism.code, f"{mechanism.name}.json": listing}
    return [write_text(folder / name, text) for name, text in files.items()]


def differences(name: str, folder: Path | None) -> dict[str, str]:
    """Files in a folder, or in the cache, that differ from what the declaration gives, with the difference."""
    import difflib

    path, _, which = _parts(name)
    stored = load(name)
    fresh = _derived(path.resolve(), which, _key(path.resolve(), which))["code"]
    file = None if folder is None else folder / f"{stored.name}.py"
    text = stored.code if file is None else file.read_text(encoding="utf-8") if file.is_file() else ""
    if text == fresh:
        return {}
    lines = difflib.unified_diff(text.splitlines(), fresh.splitlines(), str(file or "cache"), "derived", lineterm="")
    return {str(file or f"cache of {name}"): "\n".join(lines)}


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:24]


def _stored(folder: Path, key: str) -> "Derived | None":
    for file in folder.glob(f"derived-{key}-*.json"):
        with contextlib.suppress(OSError):  # another process has removed it, or the disk does not give it
            data = file.read_bytes()
            if file.stem.endswith(_digest(data)):
                return json.loads(data)
            file.unlink(missing_ok=True)
    return None


def permit(path: Path) -> None:
    """Refuse a file that may not be run, see `mechsym.files.trust`; what an installed package brings, may."""
    if path not in {_parts(name)[0].resolve() for name in brought()}:
        refuse_foreign(path)


def _derived(path: Path, which: str, key: str) -> "Derived":
    permit(path)
    try:
        from mechsym.derive import files
    except ModuleNotFoundError as error:
        raise MissingExtra(
            f"deriving {path.name} needs sympy ({error}), which belongs to mechsym: pip install 'sympy==1.14.0'"
        ) from None
    code, listing = files.build(path, which.removesuffix(_HELD), key[:16], which.endswith(_HELD))
    return {"code": code, "listing": listing}


def _module(path: Path, code: str) -> ModuleType:
    module = ModuleType(f"mechsym_derived_{path.stem}")
    exec(compile(code, f"<derived from {path.name}>", "exec"), module.__dict__)
    return module


@functools.lru_cache(maxsize=32)
def _class(text: str) -> type[Record]:
    """The record of a mechanism's parameters, made from the letters, units and ranges of its declaration."""
    listing = json.loads(text)
    ranges = listing.get("ranges", {})
    fields = {letter: quantity(unit, **ranges.get(letter, {})) for letter, unit in listing["parameters"].items()}
    stem = listing["name"].title().replace("_", "")
    return letters_class(f"{stem}Parameters", fields, listing.get("requires", ()))


def record_of(listing: "Listing") -> type[Record]:
    """The record of a mechanism's parameters, by what is stored of its declaration."""
    return _class(json.dumps(dict(listing)))


def letters_class(name: str, fields: Mapping[str, Field], requires: Sequence[Mapping[str, str]] = ()) -> type[Record]:
    """A record of numbers by letter, checked when it is made."""
    rows = [(letter, float, field) for letter, field in fields.items()]

    def checked(numbers: Record) -> None:
        check(numbers)
        require(type(numbers), vars(numbers))

    known = {"__post_init__": checked, "requires": tuple(requires)}
    return dataclasses.make_dataclass(name, rows, frozen=True, kw_only=True, namespace=known)


def require(record: type[Record], letters: Mapping[str, float]) -> None:
    """Refuse numbers of a record that a declaration refuses: where an expression is not above another."""
    for required in vars(record)["requires"]:
        value, least = (amount(required[side], letters) for side in ("value", "above"))
        if not value > least:
            size, bound = (re.sub(r"Abs\((\w+)\)", r"|\1|", required[side]) for side in ("value", "above"))
            than = f"{least:g} {required['unit']}" if bound == "0" else f"{bound} = {least:g} {required['unit']}"
            raise BadInput(
                f"{required['what']}: {size} = {value:g} {required['unit']}, needs more than {than}; {required['way']}"
            )
