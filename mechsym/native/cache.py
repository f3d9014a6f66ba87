"""Shared objects kept in the user's cache directory, and loaded: through ctypes, or as a Python module.

A file is named <key>-<checksum>, in a folder named by the first two letters of the key, so that nobody reads thousands
of names to find one: the key is the hash of everything that decides its contents (source, options, compiler, processor,
Python), the checksum that of its own bytes. A file is made in a folder of its own and moved into
place, so a half-written one is never seen, and two processes that compile the same source at once do no harm: the
second replaces the file by an equally good one. A file whose bytes do not match its name is damaged and made again.
Beyond 256 MB the files used longest ago are removed.
"""

import atexit
import contextlib
import ctypes
import functools
import hashlib
import importlib.machinery
import importlib.util
import os
import shutil
import sysconfig
import tempfile
from pathlib import Path
from types import ModuleType

from mechsym.files import is_ours, user_cache
from mechsym.native import compiler
from mechsym.quantities import record
from mechsym.transaction import hidden, sweep_up

_LENGTH = 24
_MOST = 256 * 2**20  # bytes; a compiled function takes some tens of thousands


def directory() -> Path:
    """The cache directory; it need not exist."""
    return user_cache() / "native"


def key(source: str, options: tuple[str, ...], stamp: str) -> str:
    """Name of what a source compiles to."""
    parts = [source, *options, stamp, compiler.processor(), str(sysconfig.get_config_var("EXT_SUFFIX"))]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:_LENGTH]


def shared_object(source: str, mode: str) -> Path:
    """The shared object of a source, its contents checked; compiled when the cache has no sound one."""
    program, options = compiler.find(), compiler.flags(mode)
    name = key(source, options, program.stamp)
    folder = writable() / name[:2]
    sweep_up(folder)
    for path in sorted(folder.glob(f"{name}-*.so")):
        with contextlib.suppress(OSError):  # another process has removed it, or the disk does not give it
            if path.name == _named(name, path):
                os.utime(path)  # used today, see `_prune`
                return path
            path.unlink(missing_ok=True)
    own = hidden(folder / "build")
    text, binary = own / f"{name}.c", own / f"{name}.so"
    try:
        folder.mkdir(exist_ok=True, mode=0o700)
        own.mkdir(mode=0o700)
        text.write_text(source, encoding="utf-8")
        compiler.compile_file(program, text, binary, options)
        target = folder / _named(name, binary)
        os.replace(text, folder / text.name)
        os.replace(binary, target)
    except OSError as error:  # the disk
        raise compiler.NoCompiler(f"nothing compiled can be kept in {folder}: {error}") from None
    finally:
        shutil.rmtree(own, ignore_errors=True)
    _prune(folder.parent, target)
    return target


def _prune(folder: Path, newest: Path) -> None:
    """Remove what killed processes left, and what was used longest ago when the cache has grown too large."""
    for letters in folder.glob("??"):
        sweep_up(letters)
    files = []
    for path in _entries(folder):
        with contextlib.suppress(OSError):  # another process may have removed it
            status = path.stat()
            files += [(status.st_mtime, status.st_size, path)] if path.is_file() and path != newest else []
    size = sum(s for _, s, _ in files)
    for _, length, path in sorted(files) if size > _MOST else ():
        with contextlib.suppress(OSError):
            path.unlink(missing_ok=True)
        size -= length
        if size <= _MOST // 2:
            break


def _named(name: str, binary: Path) -> str:
    return f"{name}-{hashlib.sha256(binary.read_bytes()).hexdigest()[:_LENGTH]}.so"


def writable() -> Path:
    """The cache directory, made; a private one for this process where it cannot be written to or is not ours."""
    folder = directory()
    try:
        if not folder.is_dir():  # asking is cheaper than making what is there
            folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        status = folder.stat()
        # what others may write into is not a place to load code from
        if os.access(folder, os.W_OK | os.X_OK) and is_ours(status):
            return folder
    except OSError:
        pass
    return _private()


@functools.cache
def _private() -> Path:
    """Without a home that can be written to, the files live as long as the process."""
    folder = tempfile.mkdtemp(prefix="mechsym-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def _entries(folder: Path) -> list[Path]:
    return [*folder.glob("*.*"), *folder.glob("??/*")]  # the first: where earlier versions put them


def contents() -> list[Path]:
    """All files of the cache."""
    return sorted(p for p in _entries(directory()) if p.is_file())


def clear() -> int:
    """Remove everything from the cache; running processes keep what they have loaded."""
    files = contents()
    if directory().is_dir():
        shutil.rmtree(directory(), ignore_errors=True)
    return len(files)


def load(source: str, mode: str) -> ctypes.CDLL:
    """Compile a source when needed and load it; compiler and cache may be others than the last time, or none.

    Returns library: its `_name` is the path of the file. Raises NoCompiler: what the compiler made cannot be loaded,
    and is not kept.
    """
    return _loaded(source, mode, compiler.find(), directory())


@functools.lru_cache(maxsize=256)
def _loaded(source: str, mode: str, program: compiler.Compiler, _home: Path) -> ctypes.CDLL:
    path = shared_object(source, mode)
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        path.unlink(missing_ok=True)
        why = str(error).removeprefix(f"{path}: ")
        raise compiler.NoCompiler(
            f"{program.command[0]} made what cannot be loaded ({why}); name another in CC"
        ) from None


def forget() -> None:
    """Load anew what is asked for from now on."""
    _loaded.cache_clear()


@functools.lru_cache(maxsize=256)
def module(path: str) -> ModuleType | None:
    """A loaded shared object as a Python extension module; None when compiled without Python's headers."""
    loader = importlib.machinery.ExtensionFileLoader("mechsym_native", path)
    spec = importlib.util.spec_from_file_location("mechsym_native", path, loader=loader)
    assert spec is not None
    try:
        extension = importlib.util.module_from_spec(spec)
    except ImportError:
        return None
    loader.exec_module(extension)
    return extension


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
    program, reason = None, ""
    try:
        program = compiler.find()
    except compiler.NoCompiler as error:
        reason = str(error)
    files = contents()
    return Info(
        route="C" if program else "numpy",
        reason=reason,
        compiler=" ".join(program.command) if program else None,
        version=compiler.version(program) if program else None,
        flags={mode: compiler.flags(mode) for mode in compiler.MODES},
        processor=compiler.processor(),
        python_header=compiler.python_header(),
        cache=str(directory()),
        files=len(files),
        size=sum(p.stat().st_size for p in files),
    )
