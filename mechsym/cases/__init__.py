"""Case files: data sets in TOML with a unit and a source per line, read into checked records.

A case names its mechanism and has one section per record: `[parameters]` of the mechanism, `[operation]`, and
whatever its commands need (`[cycle]`, `[spring]`, ...). `schema.py` says which record each section becomes,
`values.py` reads and replaces a value, `settings.py` has the small sections.
Numbers are SI; texts may carry a unit; a key may name its unit instead (`speed_rpm = 142`).
"""

import dataclasses
import functools
import tomllib
from collections.abc import Mapping, Sequence
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from mechsym.cases import schema
from mechsym.cases.doubts import acceptances, judged
from mechsym.cases.laws import Records
from mechsym.cases.older import renewed
from mechsym.cases.values import Place, convert, flat, override, paths, place, without_unit
from mechsym.errors import BadInput, MissingSection, shown, suggest
from mechsym.files import Json
from mechsym.files.inputs import read_text
from mechsym.mechanisms import own
from mechsym.plausible import Acceptance, Doubt
from mechsym.quantities import record
from mechsym.quantities.records import Record

__all__ = ["Case", "beside", "load", "locate", "names", "text", "told_apart", "underlaid", "written"]
HEAD = ("mechanism", "source", "about")  # what stands above the sections of a file


class Sections(dict[str, Any]):
    """Section name to its checked record; it keeps the names of those that were asked for."""

    def __init__(self, records: Records, read: set[str]) -> None:
        super().__init__(records)
        self.read = read

    def __getitem__(self, name: str) -> Any:
        self.read.add(name)
        return super().__getitem__(name)

    def get(self, name: str, default: object = None) -> Any:
        """The record of a section, or a default; as `dict` has it."""
        return self[name] if name in self else default


@record
class Case:
    """A data set for one mechanism."""

    name: str  #: Name of a built-in case, or the file's stem
    file: str  #: Where it was read, for messages
    #: Mechanism's name, the source's file stem, one line of text
    mechanism: str
    source: str
    about: str
    sections: Records
    #: What `load` was given: name or path, and values that replace the file's
    path: str = ""
    overrides: Mapping[str, object] = dataclasses.field(default_factory=dict)
    doubts: tuple[Doubt, ...] = ()  #: What of its values is possible and not usual, accepted or not
    acceptances: Mapping[str, Acceptance] = dataclasses.field(default_factory=dict)  #: Section `[doubts]`, by code
    #: Sections that were asked for, of this case and of those made of it by `dataclasses.replace`
    read: set[str] = dataclasses.field(default_factory=set, compare=False, repr=False)

    def __post_init__(self) -> None:
        self.__dict__["sections"] = Sections(self.sections, self.read)

    def need(self, section: str) -> Any:
        """The record of a section that the caller cannot do without. Raises BadInput: the case has no such section."""
        if section not in self.sections:
            why = f"section [{section}] is missing; this command needs it; see 'mechsym check' and 'mechsym cases'"
            raise MissingSection(f"{self.file}: {why}")
        return self.sections[section]


def names() -> list[str]:
    """Names of the built-in cases.

    >>> "zotov-89" in names()
    True
    """
    return list(_built_in())


# a sweep asks at every point
@functools.lru_cache(maxsize=1)
def _built_in() -> tuple[str, ...]:
    return tuple(sorted(p.name.removesuffix(".toml") for p in _folder().iterdir() if p.name.endswith(".toml")))


def text(name: str) -> str:
    """The TOML text of a built-in case, or of a file. Raises BadInput: neither a built-in name nor readable."""
    return _read(name)[1]


def load(name: str, overrides: Mapping[str, object] | None = None) -> Case:
    """Read a case and check every key, unit and range.

    name: name of a built-in case or a path to a TOML file. overrides: mapping, optional, values to replace, by dotted
    key; a bare key works if it is unique. Raises BadInput: names file, key, value and what is allowed.

    >>> case = load("zotov-89", {"spring.p0": "8 MPa"})
    >>> case.mechanism, case.need("spring").p0
    ('crosshead', 8000000.0)
    """
    file, head, sections = _raw(name, overrides)
    try:
        tables, notes = renewed(_tables(*_read(name)))
        accepted = acceptances(tables.get("doubts", {}))
        # the points of a sweep differ in one section; a mechanism of the user's own may change its parameters
        one = _record_of if own.is_file(head["mechanism"]) else _record_once
        records = {}
        for key, table in sections.items():
            written = _Written(text=repr(table), values=table)
            records[key] = beside(one(head["mechanism"], key, written), name)
        doubts = judged(records, head["mechanism"])
    except BadInput as error:
        raise BadInput(f"{file}: {error}") from None
    short = Path(name).stem if name not in names() else name
    mechanism, source, about = (head[key] for key in HEAD)
    return Case(
        name=short, file=file, mechanism=mechanism, source=source, about=about, sections=records, path=name,
        overrides=overrides or {}, doubts=(*doubts, *notes), acceptances=accepted,
    )  # fmt: skip


def beside(record: Record, name: str) -> Record:
    """The record with its paths of files that lie beside the case file and not in the working folder."""
    written = {name: getattr(record, name) for name in paths(record.__class__)}
    if not any(written.values()):
        return record
    folder = Path(str(_folder())) if name in names() else Path(name).parent
    moved = {k: str(folder / v) for k, v in written.items() if v and not Path(v).exists() and (folder / v).exists()}
    return dataclasses.replace(record, **moved) if moved else record


def told_apart(loaded: Sequence[Case]) -> list[Case]:
    """Cases by their names, files of one name by as much of their paths as tells them apart.

    Whoever keys by name would else lose one of two engines.
    """
    ways = [(case.name,) if case.path == case.name else (*Path(case.path).resolve().parent.parts, case.name)
            for case in loaded]  # fmt: skip
    for length in range(1, max(map(len, ways)) + 1):
        called = ["/".join(way[-length:]) for way in ways]
        if len(set(called)) == len(set(ways)):
            break
    return [dataclasses.replace(case, name=name) for case, name in zip(loaded, called, strict=True)]


def underlaid(case: Case, settings: Mapping[str, object]) -> Case:
    """A case read again with values by dotted key below what the user has replaced."""
    return dataclasses.replace(load(case.path, {**settings, **case.overrides}), read=case.read)


def written(case: Case) -> Json:
    """The sections of a case as its file has them, with what is replaced, not read into records."""
    return _raw(case.path, case.overrides)[2]


def locate(name: str, key: str, overrides: Mapping[str, object] | None = None, option: str = "--set") -> Place:
    """Where a key belongs in a case, and in which unit its value is.

    name: name of a built-in case or a path to a TOML file. key: dotted key; a bare key works if it is unique. option:
    where the key was written, for messages. Raises BadInput: unknown or ambiguous key.

    >>> place = locate("zotov-89", "p0")
    >>> place.section, place.field, place.unit
    ('spring', 'p0', 'Pa')
    """
    file, head, sections = _raw(name, overrides)
    try:
        return place(sections, head["mechanism"], key, option)
    except BadInput as error:
        raise BadInput(f"{file}: {error}") from None


def _raw(name: str, overrides: Mapping[str, object] | None) -> tuple[str, dict[str, str], Json]:
    """File, head and sections of a case with what is replaced, not yet checked."""
    file, content = _read(name)
    tables, _ = renewed(_tables(file, content))
    usual = {"source": "own", "about": ""} if own.is_file(str(tables.get("mechanism"))) else {}
    head = {}
    for key in HEAD:
        if key not in usual | tables:
            raise BadInput(f'{file}: key {key} is missing at the top; write {key} = "..." above the first section')
        head[key] = (usual | tables)[key]
        if not isinstance(head[key], str):
            raise BadInput(f"{file}: key {key} = {shown(head[key])} at the top is not a text")
    head["mechanism"] = own.located(head["mechanism"], Path(name).parent)
    sections = {k: dict(v) if isinstance(v, dict) else v for k, v in tables.items() if k not in (*HEAD, "doubts")}
    if own.is_file(head["mechanism"]):
        sections.setdefault("parameters", {})  # its letters may all have values of their own
    for key, value in (overrides or {}).items():
        override(sections, head["mechanism"], key, value)
    return file, head, sections


def _folder() -> Traversable:
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
        why = f"case {shown(name, 300)} is neither built in nor a readable file ({error.reason})"
        raise BadInput(why, f"{suggest(name, names())} and paths", reason=error.reason) from None


# the points of a sweep read one file; `_raw` copies the sections before it changes them
@functools.lru_cache(maxsize=8)
def _tables(file: str, content: str) -> Json:
    try:
        return flat(tomllib.loads(content))
    except RecursionError:
        raise BadInput(f"{file}: not valid TOML: nested too deeply; a case has sections of keys and values") from None
    except ValueError as error:
        raise BadInput(f"{file}: not valid TOML: {error}; see 'mechsym cases zotov-89' for one that is") from None


@record
class _Written:
    """The keys of a section, equal where they are written alike."""

    text: str
    values: Any = dataclasses.field(compare=False)


def _record_of(mechanism: str, section: str, written: _Written) -> Record:
    table = written.values
    if section not in schema.sections():
        raise BadInput(f"section [{section}] is not known; {suggest(section, schema.sections())}")
    if not isinstance(table, dict):
        raise BadInput(f"{section} = {shown(table)} is no section; write [{section}] and its keys below it")
    try:
        cls = schema.record(mechanism, section, table)
    except BadInput as error:
        raise BadInput(f"[{section}] {error}") from None
    values = _values(cls, section, table)
    try:
        return cls(**values)
    except BadInput as error:
        raise BadInput(f"[{section}] {error}") from None


_record_once = functools.lru_cache(maxsize=256)(_record_of)


def _values(cls: type[Record], section: str, table: Json) -> Json:
    fields = {f.name: f for f in dataclasses.fields(cls)}
    values: Json = {}
    for key, raw in table.items():
        if key == schema.selector(section) and key not in fields:
            continue
        name, value = without_unit(key, raw, fields)
        if name not in fields:
            raise BadInput(f"key {section}.{key} is not known; {schema.instead(key, fields)}")
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
