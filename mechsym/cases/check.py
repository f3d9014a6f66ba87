"""All problems of a case file at once, and what each command still lacks; no program of a stranger is run for it.

A case that is loaded stops at its first problem; someone who writes one wants to see them all; and what a case says
that nothing reads.
"""

import dataclasses
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path

from mechsym import cases, mechanisms
from mechsym.cases import HEAD, schema
from mechsym.cases.doubts import acceptances, judged
from mechsym.cases.facts import CaseFacts, facts_of
from mechsym.cases.keys import required, takes
from mechsym.cases.laws import Records
from mechsym.cases.needs import COMMANDS, in_words, lacking, read_by
from mechsym.cases.older import renewed
from mechsym.cases.values import convert, flat, without_unit
from mechsym.errors import BadInput, shown, suggest
from mechsym.files import Json
from mechsym.files.trust import is_trusted
from mechsym.mechanisms import own
from mechsym.plausible import Doubt
from mechsym.quantities import record
from mechsym.quantities.records import Record, check_value, moved, unread


@record
class CaseProblem:
    """What is wrong with one key."""

    key: str  #: Dotted; a section alone, or empty for the whole file
    why: str
    allowed: str = ""  #: What may stand there, or the way out


@record
class Checked:
    """What `mechsym check` finds."""

    problems: tuple[CaseProblem, ...]
    commands: Mapping[str, list[str]]  #: What each command lacks; empty where it can run
    reasons: Mapping[str, str]  #: The same in words, of those that cannot run
    skipped: tuple[str, ...] = ()  #: Sections that only the mechanism's own file could judge
    doubts: tuple[Doubt, ...] = ()  #: Sections and keys that nothing reads


def check_file(name: str, trust: bool = False) -> Checked:
    """Check a case.

    name: name of a built-in case or a path to a TOML file; trust: whether a mechanism file that the case names may be
    run to learn its letters; within a command those that are the user's own may. Raises BadInput: there is no such
    file.
    """
    text = cases.text(name)
    try:
        tables, notes = renewed(flat(tomllib.loads(text)))
    except (ValueError, RecursionError) as error:
        return Checked(problems=(CaseProblem(key="", why=f"not valid TOML: {error}"),), commands={}, reasons={})
    head, mechanism = list(_head(tables)), tables.get("mechanism")
    if isinstance(mechanism, str) and own.is_file(mechanism):
        mechanism = own.located(mechanism, Path(name).parent)
    elif mechanism not in mechanisms.names():
        mechanism = None
    sections = {k: v for k, v in tables.items() if k not in (*HEAD, "doubts")}
    if mechanism is not None and own.is_file(mechanism):
        sections.setdefault("parameters", {})
        trust = trust or is_trusted(own.file_of(mechanism)[0].resolve())
    untold = mechanism is None or (own.is_file(mechanism) and not trust)
    skipped = tuple(s for s in sections if s in schema.LETTERS) if untold else ()
    problems, records = [*head], dict[str, Record]()
    for section, table in sections.items():
        if section not in skipped:
            wrong, record = _section(mechanism or "", section, table)
            problems += wrong
            if record is not None:
                records[section] = record
    problems += _whole(tables.get("doubts", {}), records, mechanism or "")
    problems += [one for section, record in records.items() for one in _absent(section, cases.beside(record, name))]
    kind = sections["cycle"].get("kind", "") if isinstance(sections.get("cycle"), dict) else ""
    every = {name: records.get(name) for name in sections}
    facts = facts_of(mechanism or "", every, kind=str(kind), trust=trust)
    doubts = (*unused(facts, sections), *notes)
    commands = lacking(facts)
    reasons = {command: "; ".join(in_words(facts, missing)) for command, missing in commands.items() if missing}
    return Checked(problems=tuple(problems), commands=commands, reasons=reasons, skipped=skipped, doubts=doubts)


def _head(tables: Json) -> Iterator[CaseProblem]:
    for key in HEAD:
        mine = own.is_file(str(tables.get("mechanism"))) and key != "mechanism"
        if key not in tables and not mine:
            way = f'write {key} = ".." above the first section'
            yield CaseProblem(key=key, why="is missing at the top", allowed=way)
        elif key in tables and not isinstance(tables[key], str):
            yield CaseProblem(key=key, why=f"{shown(tables[key])} is not a text", allowed=f'write {key} = ".."')
    name = tables.get("mechanism")
    if isinstance(name, str) and not own.is_file(name) and name not in mechanisms.names():
        yield CaseProblem(key="mechanism", why=f"{name!r} is not known", allowed=suggest(name, mechanisms.names()))


def _section(mechanism: str, section: str, table: object) -> tuple[list[CaseProblem], Record | None]:
    """What is wrong with a section, and its record where nothing is."""
    if section not in schema.sections():
        return [CaseProblem(key=section, why="is no section", allowed=suggest(section, schema.sections()))], None
    if not isinstance(table, dict):
        return [CaseProblem(key=section, why=f"{shown(table)} is no section", allowed=f"[{section}] and keys")], None
    try:
        cls = schema.record(mechanism, section, table)
    except BadInput as error:
        where = f"{section}.{schema.selector(section) or ''}".rstrip(".")
        return [CaseProblem(key=where, why=error.why, allowed=error.way)], None
    wrong, values = _values(cls, section, table)
    if wrong:
        return wrong, None
    try:
        return [], cls(**values)
    except BadInput as error:  # what no key alone is to blame for
        return [CaseProblem(key=section, why=str(error))], None


def _values(cls: type[Record], section: str, table: Json) -> tuple[list[CaseProblem], Json]:
    fields = {f.name: f for f in dataclasses.fields(cls)}
    wrong: list[CaseProblem] = []
    values: Json = {}
    for key, raw in table.items():
        if key == schema.selector(section) and key not in fields:
            continue
        name, value = without_unit(key, raw, fields)
        where = f"{section}.{key}"
        if name not in fields:
            wrong.append(CaseProblem(key=where, why="is not known", allowed=schema.instead(key, fields)))
            continue
        if name in values:
            twice = "is given twice, once with its unit in the key"
            wrong.append(CaseProblem(key=where, why=twice, allowed="keep one"))
        try:
            values[name] = convert(fields[name], value, name)
            check_value(fields[name], values[name])
        except BadInput as error:
            wrong.append(CaseProblem(key=where, why=str(error), allowed=takes(fields[name])))
            values.setdefault(name, None)
    missing = [f for n, f in fields.items() if n not in values and required(f)]
    wrong += [CaseProblem(key=f"{section}.{f.name}", why="is missing", allowed=takes(f)) for f in missing]
    return wrong, values


def _whole(doubts: object, records: Records, mechanism: str) -> list[CaseProblem]:
    """What is wrong only when keys are seen together: doubts that are no doubts, nonsense."""
    problems = []
    try:
        acceptances(doubts)
    except BadInput as error:
        problems.append(CaseProblem(key="doubts", why=str(error)))
    try:
        judged(records, mechanism)
    except BadInput as error:
        problems.append(CaseProblem(key=error.key, why=str(error)))
    if "motion" in records and mechanism and not problems:
        problems += _moved(records, mechanism)
    return problems


def _absent(section: str, record: Record) -> Iterator[CaseProblem]:
    """Files and cases that a section names and that are not there."""
    for field in dataclasses.fields(record):
        named, to = getattr(record, field.name), field.metadata.get("to")
        if not to or not named or named in field.metadata["words"] or Path(named).exists():
            continue
        if to == "file" or named not in cases.names():
            way = "paths count from this folder or from that of the case"
            yield CaseProblem(key=f"{section}.{field.name}", why=f"there is no {to} {named}", allowed=way)


def _moved(records: Records, mechanism: str) -> list[CaseProblem]:
    """What of a section `[motion]` no coordinate can follow."""
    from mechsym.forces.driven import DrivenMotion

    units, section = mechanisms.listing(mechanism)["coordinates"], records["motion"]
    try:
        DrivenMotion(section, units, {})
    except BadInput as error:
        return [CaseProblem(key="motion", why=str(error))]
    return []


def unused(case: CaseFacts, written: Json) -> tuple[Doubt, ...]:
    """Doubts about what a case says and nothing reads. written: sections with the keys that the case gives."""
    lacks, read = lacking(case), set().union(*read_by(case).values())
    others = {name: COMMANDS[name].reads(case) for name, missing in lacks.items() if missing}
    doubts = []
    broken = any(record is None for name, record in case.sections.items() if name not in schema.LETTERS)
    # what a section with an error would have others read is not known
    for section in set() if broken else case.sections.keys() - read - {"report"}:
        wanted = [f"{name} lacks {'; '.join(lacks[name])}" for name, all_of in others.items() if section in all_of]
        reason = f": {wanted[0]}" if wanted else ""
        why = f"no command that can run on this case reads it{reason}; leave it out, or mend the case"
        doubts.append(doubt(f"[{section}]", len(written.get(section) or ()), why))
    for section in read & case.sections.keys():
        doubts += _keys(section, case.sections[section], written.get(section) or {})
    return tuple(sorted(doubts, key=lambda one: one.quantity))


def _keys(section: str, record: object, written: Json) -> Iterator[Doubt]:
    """Keys that the choices of their own section leave unread; one that says what is usual harms nobody."""
    if not dataclasses.is_dataclass(record) or isinstance(record, type):
        return
    fields = {field.name: field for field in dataclasses.fields(record)}
    given = {without_unit(key, 0.0, fields)[0] for key in written}
    for name, key in moved(record).items():
        if name in given:
            yield doubt(f"{section}.{name}", 1, f"it is not read any more: {key} tells it; leave it out")
    for name, chosen in unread(record).items():
        if name in given and getattr(record, name) != fields[name].default:
            yield doubt(
                f"{section}.{name}", 1, f"it is not read while {section}.{chosen}; leave it out, or change that"
            )


def doubt(what: str, keys: int, why: str) -> Doubt:
    """A doubt about keys that a case has and that are not read."""
    return Doubt(code="unused", quantity=f"unread keys: {what}", value=float(keys), usual="0", why=why)
