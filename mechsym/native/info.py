"""What the native route would use on this machine."""

import dataclasses

from mechsym.native import cache, compiler


@dataclasses.dataclass(frozen=True, kw_only=True)
class Info:
    """State of the native route.

    Parameters
    ----------
    route : str
        `C`, or `numpy` without a compiler
    reason : str
        Why it is not C, else empty
    compiler, version : str or None
        Path of the compiler and what it says of itself
    flags : mapping of str to tuple of str
        Options in each mode
    processor : str
        Processor that code is compiled for
    python_header : str or None
        Folder of Python.h; without it scalar calls go through ctypes and cost about a microsecond
    cache : str
        Cache directory
    files, size : int
        Files in it and their size [byte]
    """

    route: str
    reason: str
    compiler: str | None
    version: str | None
    flags: dict[str, tuple[str, ...]]
    processor: str
    python_header: str | None
    cache: str
    files: int
    size: int


def info() -> Info:
    """Look for a compiler and at the cache.

    Returns
    -------
    info : Info
        State of the native route
    """
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
