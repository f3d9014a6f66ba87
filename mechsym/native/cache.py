"""Shared objects kept in the user's cache directory.

A file is named <key>-<checksum>, in a folder named by the first two letters of the key, so that nobody reads thousands
of names to find one: the key is the hash of everything that decides its contents (source, options, compiler, processor,
Python), the checksum that of its own bytes. A file is made in a folder of its own and moved into
place, so a half-written one is never seen, and two processes that compile the same source at once do no harm: the
second replaces the file by an equally good one. A file whose bytes do not match its name is damaged and made again.
Beyond 256 MB the files used longest ago are removed.
"""

import contextlib
import hashlib
import os
import shutil
import sys
import sysconfig
import tempfile
from pathlib import Path

from mechsym.native import compiler

_LENGTH = 24
_MOST = 256 * 2**20  # bytes; a compiled function takes some tens of thousands


def directory() -> Path:
    """The cache directory; it need not exist.

    Returns
    -------
    path : Path
        XDG_CACHE_HOME/mechsym/native, or what the platform has instead
    """
    home = Path.home()
    match sys.platform:
        case "win32":
            base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
        case "darwin":
            base = home / "Library" / "Caches"
        case _:
            base = home / ".cache"
    named = os.environ.get("XDG_CACHE_HOME", "")
    # the standard says to ignore a relative path
    return (Path(named) if os.path.isabs(named) else base) / "mechsym" / "native"


def key(source: str, options: tuple[str, ...], stamp: str) -> str:
    """Name of what a source compiles to."""
    parts = [source, *options, stamp, compiler.processor(), str(sysconfig.get_config_var("EXT_SUFFIX"))]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:_LENGTH]


def shared_object(source: str, mode: str) -> Path:
    """The shared object of a source, compiled when the cache has no sound one.

    Returns
    -------
    path : Path
        File whose contents have been checked
    """
    program, options = compiler.find(), compiler.flags(mode)
    name = key(source, options, program.stamp)
    folder = writable() / name[:2]
    for path in sorted(folder.glob(f"{name}-*.so")):
        if path.name == _named(name, path):
            os.utime(path)  # used today, see `_prune`
            return path
        path.unlink(missing_ok=True)
    return _build(source, program, options, name, folder)


def _build(source: str, program: compiler.Compiler, options: tuple[str, ...], name: str, folder: Path) -> Path:
    folder.mkdir(exist_ok=True, mode=0o700)
    with tempfile.TemporaryDirectory(dir=folder, prefix="build-") as made:
        text, binary = Path(made) / f"{name}.c", Path(made) / f"{name}.so"
        text.write_text(source, encoding="utf-8")
        compiler.compile_file(program, text, binary, options)
        target = folder / _named(name, binary)
        os.replace(text, folder / text.name)
        os.replace(binary, target)
    _prune(folder.parent, target)
    return target


def _prune(folder: Path, kept: Path) -> None:
    """Remove what was used longest ago when the cache has grown too large."""
    found = []
    for path in _entries(folder):
        with contextlib.suppress(OSError):  # another process may have removed it
            status = path.stat()
            found += [(status.st_mtime, status.st_size, path)] if path.is_file() and path != kept else []
    size = sum(s for _, s, _ in found)
    for _, length, path in sorted(found) if size > _MOST else ():
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
        if os.access(folder, os.W_OK | os.X_OK) and _ours(folder):
            return folder
    except OSError:
        pass
    return Path(_private())


def _ours(folder: Path) -> bool:
    # what others may write into is not a place to load code from
    if not hasattr(os, "getuid"):
        return True
    status = folder.stat()
    return status.st_uid == os.getuid() and not status.st_mode & 0o022


_PRIVATE: list[str] = []


def _private() -> str:
    # without a home that can be written to, the files live as long as the process
    if not _PRIVATE:
        import atexit

        _PRIVATE.append(tempfile.mkdtemp(prefix="mechsym-"))
        atexit.register(shutil.rmtree, _PRIVATE[0], ignore_errors=True)
    return _PRIVATE[0]


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
