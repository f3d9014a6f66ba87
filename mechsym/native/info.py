"""What the native route would use on this machine."""

from mechsym.native import cache, compiler
from mechsym.quantities import record


@record
class Info:
    """State of the native route."""

    route: str  #: `C`, or `numpy` without a compiler
    reason: str  #: Why it is not C, else empty
    #: Path of the compiler and what it says of itself
    compiler: str | None
    version: str | None
    flags: dict[str, tuple[str, ...]]
    processor: str  #: Processor that code is compiled for
    #: Folder of Python.h; without it scalar calls go through ctypes and cost about a microsecond
    python_header: str | None
    cache: str
    #: Files in it and their size [byte]
    files: int
    size: int


def info() -> Info:
    """Look for a compiler and at the cache."""
    found, reason = None, ""
    try:
        found = compiler.find()
    except compiler.NoCompiler as error:
        reason = str(error)
    files = cache.contents()
    return Info(
        route="C" if found else "numpy",
        reason=reason,
        compiler=" ".join(found.command) if found else None,
        version=compiler.version(found) if found else None,
        flags={mode: compiler.flags(mode) for mode in compiler.MODES},
        processor=compiler.processor(),
        python_header=compiler.python_header(),
        cache=str(cache.directory()),
        files=len(files),
        size=sum(p.stat().st_size for p in files),
    )
