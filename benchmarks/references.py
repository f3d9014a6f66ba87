"""The hand-written C of this folder, compiled with the same compiler and options as emitted code."""

import ctypes
import functools
import tempfile
from pathlib import Path

from mechsym.native import compiler, integrators
from mechsym.native.source import header

_FOLDER = Path(__file__).parent / "reference"


@functools.cache
def load(name: str) -> ctypes.CDLL:
    """Compile and load a reference.

    Parameters
    ----------
    name : str
        Stem of a C file in `benchmarks/reference`

    Returns
    -------
    library : ctypes.CDLL
        Loaded
    """
    with tempfile.TemporaryDirectory() as folder:
        for file in (*_FOLDER.glob("*.c"),):
            (Path(folder) / file.name).write_text(file.read_text(encoding="utf-8"), encoding="utf-8")
        (Path(folder) / "elementary.h").write_text(header("elementary.h"), encoding="utf-8")
        (Path(folder) / "numbers.h").write_text(integrators.dop853_numbers(), encoding="utf-8")
        target = Path(folder) / f"{name}.so"
        # everything in these files is for export
        options = tuple(o for o in compiler.flags("fast") if o != "-fvisibility=hidden" and not o.startswith("-D"))
        compiler.compile_file(compiler.find(), Path(folder) / f"{name}.c", target, options)
        return ctypes.CDLL(str(target))
