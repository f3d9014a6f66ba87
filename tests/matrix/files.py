"""Records as files: one JSON file a case and command, short values side by side, so that a change reads well."""

import json
from pathlib import Path
from typing import Any

from matrix.entries import Entry

WIDTH = 120


def kept(folder: Path, entry: Entry) -> Path:
    return folder / f"{entry.name}.json"


def read(folder: Path, entry: Entry) -> dict[str, Any]:
    return json.loads(kept(folder, entry).read_text(encoding="utf-8"))


def write(folder: Path, entry: Entry, record: dict[str, Any]) -> None:
    path = kept(folder, entry)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(_shown(record) + "\n", encoding="utf-8")


def _shown(value: Any, indent: str = "") -> str:
    """JSON, on one line where it is short."""
    flat = json.dumps(value, ensure_ascii=False)
    if len(indent) + len(flat) <= WIDTH or not isinstance(value, dict | list):
        return flat
    inner = f"{indent} "
    if isinstance(value, list):
        return "[\n" + ",\n".join(inner + _shown(v, inner) for v in value) + f"\n{indent}]"
    lines = (f"{inner}{json.dumps(k, ensure_ascii=False)}: {_shown(v, inner)}" for k, v in value.items())
    return "{\n" + ",\n".join(lines) + f"\n{indent}}}"
