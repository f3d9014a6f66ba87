"""Refusals name the line of the declaration: the first frame outside this package and sympy."""

import sys
from pathlib import Path
from types import FrameType
from typing import NoReturn

from mechsym.errors import BadInput

_HERE = str(Path(__file__).parent)


def place() -> str:
    """File and line, ``scotch.py:14``, of the declaration being read; of its mechanism where all of it is read."""
    frame = _declaring()
    if isinstance(frame, str):
        return frame
    return f"{Path(frame.f_code.co_filename).name}:{frame.f_lineno}"


def file_of_declaration() -> Path:
    """The file whose line is being read."""
    frame = _declaring()
    return Path() if isinstance(frame, str) else Path(frame.f_code.co_filename)


def _declaring() -> FrameType | str:
    """The frame of the line that is being read; the place of a mechanism where all of it is."""
    frame = sys._getframe(1)
    while frame.f_back and (frame.f_code.co_filename.startswith(_HERE) or "sympy" in frame.f_code.co_filename):
        if frame.f_code.co_name == "derive":  # of lagrange.py
            read = frame.f_locals["m"]
            return str(read.where[read.name])
        frame = frame.f_back
    return frame


def refuse(message: str, where: str = "") -> NoReturn:
    """Refuse a declaration in one line.

    message: what is wrong, what is allowed, the way out; where: file and line, where that is not the line that is being
    read.

    Raises
    ------
    BadInput
        With file and line in front
    """
    raise BadInput(f"{where or place()}: {message}")


def require_declaration(m: object, call: str) -> None:
    """Refuse a call that forgets the mechanism; `call` shows how it is written."""
    if not hasattr(m, "tape"):
        refuse(f"{m!r} is no mechanism; write {call}")
