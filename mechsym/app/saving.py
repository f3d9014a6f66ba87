"""A case with moved values as a text that loads, and files that the commands make of it."""

import re
import sys
import tempfile
from asyncio import create_subprocess_exec, subprocess
from collections.abc import Mapping
from pathlib import Path

from mechsym import cases
from mechsym.app.commands import words
from mechsym.errors import BadInput

#: file to download: command, its option, and the file that it writes there
FILES = {
    "report": ("hinge", "--out", "report.html"),
    "DXF": ("guide", "--dxf", "guide.dxf"),
    "sheet": ("guide", "--sheet", "guide.pdf"),
    "FMU": ("fmu", "--out", "engine.fmu"),
}


def case_text(name: str, values: Mapping[str, float]) -> str:
    """The text of a case with other values by section.name [SI] in their lines, its comments as they are."""
    wanted, text = cases.load(name, values), cases.text(name)
    for key, value in values.items():
        section, _, field = key.partition(".")
        text = _changed(text, section, field, value)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "changed.toml"
        file.write_text(text, encoding="utf-8")
        loaded = cases.load(str(file))
    for key in values:
        section, _, field = key.partition(".")
        if getattr(loaded.sections[section], field) != getattr(wanted.sections[section], field):
            raise BadInput(f"{key} could not be written into the text of {name}; use --set {key}={values[key]!r}")
    return text


async def file_of(kind: str, name: str, values: Mapping[str, float]) -> tuple[str, bytes]:
    """A file of `FILES` for a case, made by its command: the end of its name and what is in it."""
    command, option, target = FILES[kind]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / target
        line = [*words(command, name, values), option, folder if kind == "report" else str(file)]
        process = await create_subprocess_exec(
            sys.executable, "-m", "mechsym", *line, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )  # fmt: skip
        out, said = await process.communicate()
        if not file.exists():
            why = (said or out).decode().strip()
            raise BadInput(why.splitlines()[-1] if why else f"mechsym {command} wrote nothing")
        return target, file.read_bytes()


def _changed(text: str, section: str, field: str, value: float) -> str:
    """The text with `field = value` in its section, in place of the line that gives it with or without a unit."""
    start = re.search(rf"^\[{re.escape(section)}\][^\n]*\n", text, re.M)
    if start is None:
        return f"{text.rstrip()}\n\n[{section}]\n{field} = {value!r}\n"
    end = re.search(r"^\[", text[start.end() :], re.M)
    stop = start.end() + end.start() if end else len(text)
    body = text[start.end() : stop]
    line = re.compile(rf"^{re.escape(field)}(?:_[a-zA-Z0-9_]+)?\s*=\s*(\"[^\"\n]*\"|[^#\n]*?)(\s*#[^\n]*)?$", re.M)
    exact = re.compile(rf"^{re.escape(field)}\s*=", re.M)
    if exact.search(body):
        line = re.compile(rf"^{re.escape(field)}\s*=\s*(\"[^\"\n]*\"|[^#\n]*?)(\s*#[^\n]*)?$", re.M)
    if not line.search(body):
        return f"{text[: start.end()]}{field} = {value!r}\n{text[start.end() :]}"
    body = line.sub(lambda match: f"{field} = {value!r}{match.group(2) or ''}", body, count=1)
    return text[: start.end()] + body + text[stop:]
