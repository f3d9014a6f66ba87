"""Case files: data sets in TOML with a unit and a source per line, read into checked records.

A case names its mechanism and has one section per record: `[parameters]` of the mechanism, `[operation]`, and
whatever its commands need (`[cycle]`, `[spring]`, ...). `schema.py` says which record each section becomes,
`values.py` reads and replaces a value, `settings.py` has the small sections.
Numbers are SI; texts may carry a unit; a key may name its unit instead (`speed_rpm = 142`).
"""

import dataclasses
import functools
import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from mechsym.cases import schema
from mechsym.cases.doubts import acceptances, judged
from mechsym.cases.values import Place, convert, override, paths, place, without_unit
from mechsym.errors import BadInput, MissingSection, shown, suggest
from mechsym.files import read_text
from mechsym.mechanisms import own
from mechsym.plausible import Acceptance, Doubt
from mechsym.quantities import record

__all__ = ["Case", "load", "locate", "names", "text", "underlaid", "written"]
_HEAD = ("mechanism", "source", "about")


@record
class Case:
    """A data set for one mechanism."""

    name: str  #: Name of a built-in case, or the file's stem
    file: str  #: Where it was read, for messages
    #: Mechanism's name, the source's file stem, one line of text
    mechanism: str
    source: str
    about: str
    sections: Mapping[str, Any]  #: Section name to its checked record
    #: What `load` was given: name or path, and values that replace the file's
    path: str = ""
    overrides: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    doubts: tuple[Doubt, ...] = ()  #: What of its values is possible and not usual, accepted or not
    acceptances: Mapping[str, Acceptance] = dataclasses.field(default_factory=dict)  #: Section `[doubts]`, by code

    def need(self, section: str) -> Any:
        """The record of a section that the caller cannot do without.

        Raises
        ------
        BadInput
            The case has no such section
        """
        if section not in self.sections:
            why = f"section [{section}] is missing; this command needs it; see 'mechsym check' and 'mechsym cases'"
            raise MissingSection(f"{self.file}: {why}")
        return self.sections[section]


def names() -> list[str]:
    """Names of the built-in cases.

    Examples
    --------
    >>> "zotov-89" in names()
    True
    """
    return list(_built_in())


# a sweep asks at every point
@functools.lru_cache(maxsize=1)
def _built_in() -> tuple[str, ...]:
    return tuple(sorted(p.name.removesuffix(".toml") for p in _folder().iterdir() if p.name.endswith(".toml")))


def text(name: str) -> str:
    """The TOML text of a built-in case, or of a file.

    Parameters
    ----------
    name : str
        Name of a built-in case or a path

    Raises
    ------
    BadInput
        Neither a built-in name nor a readable file
    """
    return _read(name)[1]


def load(name: str, overrides: Mapping[str, Any] | None = None) -> Case:
    """Read a case and check every key, unit and range.

    Parameters
    ----------
    name : str
        Name of a built-in case or a path to a TOML file
    overrides : mapping, optional
        Values to replace, by dotted key; a bare key works if it is unique

    Raises
    ------
    BadInput
        Names file, key, value and what is allowed

    Examples
    --------
    >>> case = load("zotov-89", {"spring.p0": "8 MPa"})
    >>> case.mechanism, case.need("spring").p0
    ('crosshead', 8000000.0)
    """
    file, head, sections = _raw(name, overrides)
    try:
        accepted = acceptances(_tables(*_read(name)).get("doubts", {}))
        records = {key: _beside(_section(head["mechanism"], key, table), name) for key, table in sections.items()}
        found = judged(records, head["mechanism"])
    except BadInput as error:
        raise BadInput(f"{file}: {error}") from None
    short = Path(name).stem if name not in names() else name
    return Case(
        name=short, file=file, sections=records, path=name, overrides=overrides or {}, doubts=found,
        acceptances=accepted, **head,
    )  # fmt: skip


def _beside(found: Any, name: str) -> Any:
    """The record with its paths of files that lie beside the case file and not in the working folder."""
    written = {name: getattr(found, name) for name in paths(found.__class__)}
    if not any(written.values()):
        return found
    folder = Path(str(_folder())) if name in names() else Path(name).parent
    moved = {k: str(folder / v) for k, v in written.items() if v and not Path(v).exists() and (folder / v).exists()}
    return dataclasses.replace(found, **moved) if moved else found


def underlaid(case: Case, settings: Mapping[str, Any]) -> Case:
    """A case read again with settings below what the user has replaced.

    Parameters
    ----------
    settings : mapping
        Values to replace, by dotted key, where the user has not
    """
    return load(case.path, {**settings, **case.overrides})


def written(case: Case) -> Mapping[str, Any]:
    """The sections of a case as its file has them, with what is replaced, not read into records."""
    return _raw(case.path, case.overrides)[2]


def locate(name: str, key: str, overrides: Mapping[str, Any] | None = None, option: str = "--set") -> Place:
    """Where a key belongs in a case, and in which unit its value is.

    Parameters
    ----------
    name : str
        Name of a built-in case or a path to a TOML file
    key : str
        Dotted key; a bare key works if it is unique
    option : str
        Where the key was written, for messages

    Raises
    ------
    BadInput
        Unknown or ambiguous key

    Examples
    --------
    >>> found = locate("zotov-89", "p0")
    >>> found.section, found.field, found.unit
    ('spring', 'p0', 'Pa')
    """
    file, head, sections = _raw(name, overrides)
    try:
        return place(sections, head["mechanism"], key, option)
    except BadInput as error:
        raise BadInput(f"{file}: {error}") from None


def _raw(name: str, overrides: Mapping[str, Any] | None) -> tuple[str, dict[str, str], dict[str, Any]]:
    """File, head and sections of a case with what is replaced, not yet checked."""
    file, content = _read(name)
    tables = _tables(file, content)
    usual = {"source": "own", "about": ""} if own.is_file(str(tables.get("mechanism"))) else {}
    head = {key: _head(usual | tables, key, file) for key in _HEAD}
    head["mechanism"] = own.located(head["mechanism"], Path(name).parent)
    sections = {k: dict(v) if isinstance(v, dict) else v for k, v in tables.items() if k not in (*_HEAD, "doubts")}
    for key, value in (overrides or {}).items():
        override(sections, head["mechanism"], key, value)
    return file, head, sections


def _folder() -> Any:
    return resources.files("mechsym.cases")


@functools.lru_cache(maxsize=32)
def _built_in_text(name: str) -> str:
    return (_folder() / f"{name}.toml").read_text(encoding="utf-8")


def _read(name: str) -> tuple[str, str]:
    if name in names():
        return f"case {name}", _built_in_text(name)
    try:
        return str(Path(name)), read_text(name)
    except BadInput as error:
        reason = str(error).rpartition(": ")[2].removeprefix("cannot be read (").removesuffix(")")
        why = f"case {shown(name, 300)} is neither built in nor a readable file ({reason})"
        raise BadInput(f"{why}; {suggest(name, names())} and paths") from None


# the points of a sweep read one file; `_raw` copies the sections before it changes them
@functools.lru_cache(maxsize=8)
def _tables(file: str, content: str) -> dict[str, Any]:
    try:
        return tomllib.loads(content)
    except RecursionError:
        raise BadInput(f"{file}: not valid TOML: nested too deeply; a case has sections of keys and values") from None
    except ValueError as error:
        raise BadInput(f"{file}: not valid TOML: {error}; see 'mechsym cases zotov-89' for one that is") from None


def _head(tables: dict[str, Any], key: str, file: str) -> str:
    if key not in tables:
        raise BadInput(f'{file}: key {key} is missing at the top; write {key} = "..." above the first section')
    if not isinstance(tables[key], str):
        raise BadInput(f"{file}: key {key} = {shown(tables[key])} at the top is not a text")
    return tables[key]


def _section(mechanism: str, section: str, table: Any) -> Any:
    # the points of a sweep differ in one section; a mechanism of the user's own may change its parameters
    return (_made if own.is_file(mechanism) else _kept)(mechanism, section, _Written(table, repr(table)))


class _Written:
    """The keys of a section, equal where they are written alike."""

    def __init__(self, values: Any, text: str) -> None:
        self.values, self.text = values, text

    def __hash__(self) -> int:
        return hash(self.text)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Written) and self.text == other.text


def _made(mechanism: str, section: str, written: _Written) -> Any:
    table = written.values
    cls = _record_class(mechanism, section, table)
    values = _values(cls, section, table)
    try:
        return cls(**values)
    except BadInput as error:
        raise BadInput(f"[{section}] {error}") from None


_kept = functools.lru_cache(maxsize=256)(_made)


def _record_class(mechanism: str, section: str, table: Any) -> Any:
    if section not in schema.sections():
        raise BadInput(f"section [{section}] is not known; {suggest(section, schema.sections())}")
    if not isinstance(table, dict):
        raise BadInput(f"{section} = {shown(table)} is no section; write [{section}] and its keys below it")
    try:
        return schema.record(mechanism, section, table)
    except BadInput as error:
        raise BadInput(f"[{section}] {error}") from None


def _values(cls: Any, section: str, table: dict[str, Any]) -> dict[str, Any]:
    fields = {f.name: f for f in dataclasses.fields(cls)}
    values: dict[str, Any] = {}
    for key, raw in table.items():
        if key == schema.selector(section) and key not in fields:
            continue
        name, value = without_unit(key, raw, fields)
        if name not in fields:
            raise BadInput(f"key {section}.{key} is not known; {suggest(key, fields)}")
        if name in values:
            raise BadInput(f"key {section}.{name} is given twice, once with its unit in the key; keep one")
        values[name] = convert(fields[name], value, f"{section}.{key}")
    for name, field in fields.items():
        if name not in values and field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING:
            unit = field.metadata.get("unit")
            raise BadInput(f"key {section}.{name} is missing" + (f"; give it in {unit}" if unit else ""))
    return values


def __dir__() -> list[str]:
    return __all__
