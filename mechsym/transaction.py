"""Files that wait until all of a run are on the disk, and what happens to them where one cannot appear."""

import contextlib
import functools
import hashlib
import os
import re
import secrets
import shutil
from collections.abc import Sequence
from pathlib import Path

from mechsym.interrupts import whole

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

SUMMARY = "summary.json"


def missing(path: Path) -> list[Path]:
    """A folder and those above it that are not there, the innermost first."""
    return [p for p in (path, *path.parents) if not p.exists()]


def remove_empty(files: list[Path]) -> None:
    """Remove folders, the innermost first, as far as they are empty."""
    for folder in files:
        with contextlib.suppress(OSError):
            folder.rmdir()


class Transaction:
    """Files below a folder that wait, complete and on the disk, until they appear together; of one thread."""

    def __init__(self, folder: Path, outer: "Transaction | None") -> None:
        self.folder, self.outer = folder.resolve(), outer
        self.waiting: dict[Path, Path] = {}  # file: its temporary name
        self.stale: set[Path] = set()  # files of the run before that go when these appear
        self.made = missing(self.folder)  # folders that go with files that are dropped
        self.turn: int | None = None  # handle of the folder while it is this process's turn to write there

    def home(self, path: Path) -> "Transaction | None":
        """The innermost block for a file."""
        if path.is_relative_to(self.folder):
            return self
        return self.outer.home(path) if self.outer else None

    def all_waiting(self) -> dict[Path, Path]:
        """What waits here and in the blocks around this one."""
        return {**(self.outer.all_waiting() if self.outer else {}), **self.waiting}

    def add(self, path: Path, part: Path) -> None:
        """Let a file wait under its temporary name, in place of one that waits for the same path."""
        if path in self.waiting:
            self.waiting[path].unlink(missing_ok=True)
        self.waiting[path] = part

    def claim(self) -> None:
        """Wait until no other process writes into the folder, and keep others waiting until the files have appeared.

        What a summary says of a folder would else be of another run's files. Where the system has no such locks, as on
        Windows, two runs into one folder may mix, and the digests in the summary tell of it.
        """
        if self.outer is not None:
            self.outer.claim()
        elif self.turn is None and fcntl is not None:
            with contextlib.suppress(OSError):  # no folder yet, or a file system without locks
                self.turn = os.open(self.folder, os.O_RDONLY)
                fcntl.flock(self.turn, fcntl.LOCK_EX)

    def publish(self) -> None:
        """Move the files into place; those of an inner block go on waiting in the outer one."""
        if self.outer is not None:
            while self.waiting:
                self.outer.add(*self.waiting.popitem())
            self.outer.stale |= self.stale
            self.outer.made = [*self.made, *self.outer.made]
            return
        folders = {path.parent for path in self.waiting}
        if self.waiting or self.stale:
            self.claim()
        try:
            with whole(), _Undo() as undo:
                # the summary tells the others: it appears when they are on the disk
                self._move([path for path in self.waiting if path.name != SUMMARY], undo)
                for path in self.stale:
                    undo.keep(path)
                    path.unlink(missing_ok=True)
                self._move(list(self.waiting), undo)
            for path in self.stale:
                remove_empty([folder for folder in path.parents if folder.is_relative_to(self.folder)])
        finally:
            self.drop()
        for folder in folders:
            sweep_up(folder)

    def _move(self, paths: Sequence[Path], undo: "_Undo") -> None:
        for path in paths:
            undo.keep(path)
            self.waiting[path].replace(path)
            del self.waiting[path]
        for folder in {path.parent for path in paths}:
            sync_folder(folder)

    def drop(self) -> None:
        """Forget the files that wait, and the folders that hold nothing else."""
        try:
            while self.waiting:
                self.waiting.popitem()[1].unlink(missing_ok=True)
            self.stale.clear()
            remove_empty(self.made)
        finally:
            if self.turn is not None:
                os.close(self.turn)
                self.turn = None


class _Undo:
    """Files as they stood before others took their place, until all of those have."""

    def __init__(self) -> None:
        self.before: list[tuple[Path, Path | None]] = []  # file: another name of what it held, None where it was not

    def keep(self, path: Path) -> None:
        """Keep what a file holds under another name."""
        old = hidden(path) if path.exists() else None
        if old is not None:
            try:
                os.link(path, old)
            except OSError:  # a file system without links
                shutil.copy2(path, old)
        self.before.append((path, old))

    def __enter__(self) -> "_Undo":
        return self

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        for path, old in reversed(self.before):
            with contextlib.suppress(OSError):  # the others may still go back
                if old is None:
                    if kind is not None:
                        path.unlink(missing_ok=True)
                    continue
                if kind is not None:
                    old.replace(path)
                old.unlink(missing_ok=True)  # a link to what stands there already is not moved


def hidden(path: Path) -> Path:
    """A new temporary name beside a file, which says the machine and the process whose it is."""
    part = path.with_name(f".{path.name}.{_machine()}-{os.getpid()}-{secrets.token_hex(4)}")
    _parts.append(part)
    return part


_parts: list[Path] = []


def forget() -> None:
    """Remove all temporary files of this process, which ends."""
    for part in _parts:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


@functools.cache
def _machine() -> str:
    return hashlib.sha256(os.uname().nodename.encode()).hexdigest()[:4] if os.name == "posix" else "0000"


def sweep_up(folder: Path) -> None:
    """Remove temporary files and folders that processes of this machine left in a folder when they were killed."""
    try:
        names = [name for name in os.listdir(folder) if name.startswith(".")]
    except OSError:
        return
    for name in names:
        whose = _TEMPORARY.fullmatch(name)
        if whose and whose["machine"] == _machine() and not _lives(int(whose["process"])):
            with contextlib.suppress(OSError):
                remove = shutil.rmtree if (folder / name).is_dir() else os.unlink
                remove(folder / name)


_TEMPORARY = re.compile(r"\..+\.(?P<machine>[0-9a-f]{4})-(?P<process>\d+)-[0-9a-f]{8}")


def _lives(process: int) -> bool:
    if os.name != "posix":  # elsewhere the question would end it
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        pass
    return True


def sync_folder(folder: Path) -> None:
    """Put the names in a folder on the disk, where the system can."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
