"""Refusals name the line of the declaration: the first frame outside this package and sympy."""

import sys
from pathlib import Path
from typing import NoReturn

from mechsym.errors import BadInput

_HERE = str(Path(__file__).parent)


def place() -> str:
    """File and line of the declaration that is being read.

    Returns
    -------
    place : str
        For example ``scotch.py:14``
    """
    frame = sys._getframe(1)
    while frame.f_back and (frame.f_code.co_filename.startswith(_HERE) or "sympy" in frame.f_code.co_filename):
        frame = frame.f_back
    return f"{Path(frame.f_code.co_filename).name}:{frame.f_lineno}"


def refuse(message: str, where: str = "") -> NoReturn:
    """Refuse a declaration in one line.

    Parameters
    ----------
    message : str
        What is wrong, what is allowed, the way out
    where : str
        File and line, where that is not the line that is being read

    Raises
    ------
    BadInput
        With file and line in front
    """
    raise BadInput(f"{where or place()}: {message}")
