"""A case from an upload, which anybody may have written: numbers, choices and plain words only, nothing that is read.

It may not name a file, a mechanism of somebody's own, or a table of materials; another case only where it is built in.
"""

import re
import secrets
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path

from mechsym import cases, mechanisms
from mechsym.cases.keys import keys
from mechsym.errors import BadInput
from mechsym.files import Json

LARGEST = 100_000  # bytes
_WORDS = re.compile(r"[A-Za-z0-9][A-Za-z0-9 _+-]*")
_NUMBER = re.compile(r"[-+]?\d[\d.]*(?:[eE][-+]?\d+)?(?: ?[A-Za-z%°][A-Za-z0-9%°*/^() -]*)?")
_FORMULA = re.compile(r"[A-Za-z0-9_ =.,+*/()-]{1,200}")
_SAID = ("name", "about", "source", "why")  # text for people
_WAY = "a case from an upload holds numbers, choices and built-in names only; start the workbench with it instead"

_kept: dict[str, str] = {}
_folder = tempfile.TemporaryDirectory(prefix="mechsym-uploads-")


def keep(data: bytes) -> str:
    """Take a case in: its name for this browser alone. Raises BadInput: too large, no case, or names files."""
    name = f"upload-{secrets.token_hex(8)}"
    path = Path(_folder.name) / f"{name}.toml"
    path.write_text(harmless(data), encoding="utf-8")
    try:
        cases.load(str(path))
    except BadInput as refused:
        path.unlink()
        raise BadInput(str(refused).replace(str(path), "the upload")) from None
    _kept[name] = str(path)
    return name


def kept(name: str) -> str | None:
    """The file of a case that was taken in, or None."""
    return _kept.get(name)


def harmless(data: bytes) -> str:
    """The text of a case that names nothing to be read; else why not."""
    if len(data) > LARGEST:
        raise BadInput(f"the upload has {len(data)} bytes; allowed are {LARGEST}")
    try:
        text = data.decode("utf-8")
        given = tomllib.loads(text)
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise BadInput(f"the upload is not TOML in UTF-8: {error}") from None
    if given.get("mechanism") not in mechanisms.names():
        raise BadInput(f"mechanism {given.get('mechanism')!r} is not built in; {_WAY}")
    rows = {f"{row['section']}.{row['key']}": row for row in keys(None)}
    for place, value in _texts("", {k: v for k, v in given.items() if k != "mechanism"}):
        if not _allowed(place, value, rows):
            raise BadInput(f"{place} = {value!r} is not allowed; {_WAY}")
    return text


def _texts(place: str, value: object) -> Iterator[tuple[str, str]]:
    """Every text of a table under its dotted place; elements of lists under that of their list."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _texts(f"{place}.{key}" if place else key, inner)
    elif isinstance(value, list):
        for inner in value:
            yield from _texts(place, inner)
    elif isinstance(value, str):
        yield place, value


def _allowed(place: str, value: str, rows: Mapping[str, Json]) -> bool:
    row = rows.get(place, {"kind": "text", "options": None})
    known = value in (row["options"] or ())
    if row["kind"] in ("file", "case"):
        return not value or known or row["kind"] == "case" and value in cases.names()
    if place == "codesign.scavenge":  # read by a parser of its own, letters and numbers
        return bool(_FORMULA.fullmatch(value))
    if place == "sizing.settings":
        # bare keys could name a file; a dotted one is judged as if it stood in its section
        key, _, text = value.partition("=")
        return "." in key and _allowed(key.strip(), text.strip(), rows)
    said = place in _SAID[:3] or (place.startswith("doubts.") and place.endswith(".why"))
    return said or known or not value or bool(_WORDS.fullmatch(value)) or bool(_NUMBER.fullmatch(value))
