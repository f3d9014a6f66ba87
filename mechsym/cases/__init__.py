"""Case files: data sets in TOML with a unit and a source per line, read into checked records.

A case names its mechanism and has one section per record: `[parameters]` of the mechanism, `[operation]`, and
whatever its commands need (`[cycle]`, `[spring]`, ...). `schema.py` says which record each section becomes.
Numbers are SI; texts may carry a unit; a key may name its unit instead (`speed_rpm = 142`).
"""

import dataclasses
import difflib
import tomllib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from mechsym.cases import schema
from mechsym.errors import BadInput
from mechsym.quantities import parse, units

_HEAD = ("mechanism", "source", "about")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Case:
    """A data set for one mechanism.

    Parameters
    ----------
    name : str
        Name of a built-in case, or the file's stem
    file : str
        Where it was read, for messages
    mechanism, source, about : str
        Mechanism's name, the source's file stem, one line of text
    sections : mapping of str to record
        Section name to its checked record
    """

    name: str
    file: str
    mechanism: str
    source: str
    about: str
    sections: Mapping[str, Any]

    def need(self, section: str) -> Any:
        """The record of a section that the caller cannot do without.

        Parameters
        ----------
        section : str
            Name of the section

        Returns
        -------
        record : dataclass instance
            The section's record

        Raises
        ------
        BadInput
            The case has no such section
        """
        if section not in self.sections:
            raise BadInput(f"{self.file}: section [{section}] is missing; this command needs it (see 'mechsym cases')")
        return self.sections[section]


def names() -> list[str]:
    """Names of the built-in cases.

    Returns
    -------
    names : list of str
        Sorted names
    """
    return sorted(p.name.removesuffix(".toml") for p in _folder().iterdir() if p.name.endswith(".toml"))


def text(name: str) -> str:
    """The TOML text of a built-in case, or of a file.

    Parameters
    ----------
    name : str
        Name of a built-in case or a path

    Returns
    -------
    text : str
        Its text

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

    Returns
    -------
    case : Case
        Checked records by section

    Raises
    ------
    BadInput
        Names file, key, value and what is allowed
    """
    file, content = _read(name)
    try:
        tables = tomllib.loads(content)
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{file}: not valid TOML: {error}") from None
    head = {key: _head(tables, key, file) for key in _HEAD}
    sections = {k: dict(v) if isinstance(v, dict) else v for k, v in tables.items() if k not in _HEAD}
    for key, value in (overrides or {}).items():
        _override(sections, head["mechanism"], key, value)
    records = {key: _section(head["mechanism"], key, table, file) for key, table in sections.items()}
    return Case(name=Path(name).stem if name not in names() else name, file=file, sections=records, **head)


def _folder() -> Any:
    return resources.files("mechsym.cases")


def _read(name: str) -> tuple[str, str]:
    if name in names():
        return f"case {name}", (_folder() / f"{name}.toml").read_text(encoding="utf-8")
    path = Path(name)
    try:
        return str(path), path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "not UTF-8 text"
        raise BadInput(
            f"case {name!r} is neither built in ({', '.join(names())}) nor a readable file: {reason}"
        ) from None


def _head(tables: dict[str, Any], key: str, file: str) -> str:
    if not isinstance(tables.get(key), str):
        raise BadInput(f"{file}: key {key!r} is missing at the top; it is a text")
    return tables[key]


def _suggest(key: str, options: list[str]) -> str:
    near = difflib.get_close_matches(key, options, n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"{hint}allowed are {', '.join(options)}"


def _record_class(mechanism: str, section: str, table: Any, file: str) -> Any:
    if not isinstance(table, dict):
        raise BadInput(
            f"{file}: {section!r} stands at the top but is no section; {_suggest(section, schema.sections())}"
        )
    try:
        return schema.record(mechanism, section, table)
    except KeyError:
        raise BadInput(f"{file}: section [{section}] is not known; {_suggest(section, schema.sections())}") from None
    except BadInput as error:
        raise BadInput(f"{file}: [{section}] {error}") from None


def _section(mechanism: str, section: str, table: Any, file: str) -> Any:
    cls = _record_class(mechanism, section, table, file)
    fields = {f.name: f for f in dataclasses.fields(cls)}
    values = {}
    for key, value in table.items():
        if key == schema.selector(section) and key not in fields:
            continue
        name, value = _with_unit(key, value, fields)
        if name not in fields:
            raise BadInput(f"{file}: key {section}.{key} is not known; {_suggest(key, list(fields))}")
        values[name] = _value(fields[name], value, f"{section}.{key}", file)
    for name, field in fields.items():
        if name not in values and field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING:
            unit = field.metadata.get("unit")
            raise BadInput(f"{file}: key {section}.{name} is missing" + (f"; give it in {unit}" if unit else ""))
    try:
        return cls(**values)
    except BadInput as error:
        raise BadInput(f"{file}: [{section}] {error}") from None


def _with_unit(key: str, value: Any, fields: Mapping[str, Any]) -> tuple[str, Any]:
    stem, _, unit = key.rpartition("_")
    if key not in fields and stem in fields and unit in units() and "unit" in fields[stem].metadata:
        return stem, f"{value} {unit}"
    return key, value


def _value(field: Any, value: Any, key: str, file: str) -> Any:
    if "unit" in field.metadata:
        try:
            if isinstance(value, list):
                return tuple(parse(v, field.metadata["unit"], key) for v in value)
            return parse(value, field.metadata["unit"], key)
        except BadInput as error:
            raise BadInput(f"{file}: {error}") from None
    return tuple(value) if isinstance(value, list) else value


def _override(sections: dict[str, Any], mechanism: str, key: str, value: Any) -> None:
    section, dot, name = key.partition(".")
    if not dot:
        homes = [s for s, t in sections.items() if isinstance(t, dict) and key in _keys(mechanism, s, t)]
        # a key that the file gives in one section only is meant, although others may know it too
        homes = [s for s in homes if {key, key.rpartition("_")[0]} & sections[s].keys()] or homes
        if len(homes) != 1:
            raise BadInput(f"--set {key} {_why_not_one(sections, mechanism, key, homes)}")
        section, name = homes[0], key
    table = sections.setdefault(section, {})
    if not isinstance(table, dict):
        raise BadInput(f"--set {key}: {section!r} is no section; {_suggest(section, schema.sections())}")
    stem = name.rpartition("_")[0]
    table.pop(stem if stem in table and name not in table else name, None)
    for other in [k for k in table if k.rpartition("_")[0] == name and k.rpartition("_")[2] in units()]:
        table.pop(other)
    table[name] = value


def _why_not_one(sections: dict[str, Any], mechanism: str, key: str, homes: list[str]) -> str:
    if homes:
        return f"is in several sections ({', '.join(homes)}); write section.{key}"
    tables = {s: t for s, t in sections.items() if isinstance(t, dict)}
    bare = sorted({k for s, t in tables.items() for k in _keys(mechanism, s, t)})
    near = difflib.get_close_matches(key, bare, n=3)
    hint = f"did you mean {' or '.join(near)}? " if near else ""
    return f"is not known; {hint}give section.key, sections here are {', '.join(tables)}"


def _keys(mechanism: str, section: str, table: dict[str, Any]) -> set[str]:
    try:
        cls = schema.record(mechanism, section, table)
    except (KeyError, BadInput):
        return set(table)
    found = {f.name for f in dataclasses.fields(cls)}
    return found | {
        f"{f.name}_{u}" for f in dataclasses.fields(cls) if f.metadata.get("unit", "-") != "-" for u in units()
    }
