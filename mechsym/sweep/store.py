"""Finished points of a sweep in a file beside its results, so that the same command goes on where it stopped.

    OUT/sweep.db    SQLite    chunk: first point, count, names and gaps (JSON), numbers, seconds of a point, host
                              point: a view of it, i, seconds, host    input: path, digest
                              about: what was swept, and who is writing

A store belongs to one sweep: values, axes, columns, program, and what was in the files that were read, for the sweep
(its key has them) and for its points (table `input`). Another sweep into the same folder begins anew and sets the store
aside as `sweep-<digits of what it belongs to>.db`, where it is found when its turn comes again.
Chunks of points are written whole, so that what is computed later is computed as in one go.
"""

import contextlib
import errno
import functools
import hashlib
import json
import os
import socket
import sqlite3
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files import inputs
from mechsym.quantities import record
from mechsym.sweep.outcomes import Outcomes
from mechsym.sweep.work import Done

NAME = "sweep.db"
_TABLES = """
create table if not exists about (name text primary key, value text not null);
create table if not exists chunk (
    first integer primary key, count integer not null, told text not null, numbers blob not null,
    seconds real, host text
);
create view if not exists point as with recursive every (i, stop, seconds, host) as (
    select first, first + count, seconds, host from chunk
    union all select i + 1, stop, seconds, host from every where i + 1 < stop
) select i, seconds, host from every;
create table if not exists input (path text primary key, digest text not null);
"""


@record
class Store:
    """An open store."""

    path: Path
    connection: sqlite3.Connection
    aside: Path | None = None  #: Where the store of another sweep went that was in the way


@contextlib.contextmanager
def opened(folder: Path, key: str, fresh: bool = False) -> Iterator[Store]:
    """The store of a sweep in its folder; nobody else writes it meanwhile.

    key: what is swept, see `identity`; a store of anything else is set aside. fresh: forget what is kept of this sweep.
    Raises BadInput: it is no store, or another process is writing it.
    """
    path = folder / NAME
    with _told(path):
        moved = None
        connection = _connected(path)
        try:
            if not _belongs(connection, key):
                moved = _set_aside(connection, path)
                connection = _connected(_brought_back(path, key))
            with connection:
                if fresh:
                    connection.executescript("delete from chunk; delete from input;")
                _note(connection, "key", key)
            yield Store(path=path, connection=connection, aside=moved)
            connection.execute("delete from about where name = 'writer'")
        finally:
            connection.close()


def _connected(path: Path) -> sqlite3.Connection:
    """A store that this process alone writes."""
    connection = sqlite3.connect(path, isolation_level=None)
    try:
        connection.execute("pragma journal_mode = wal")
        connection.execute("pragma synchronous = normal")
        connection.executescript(_TABLES)
        _taken(connection, path)
    except BaseException:
        connection.close()
        raise
    return connection


def _set_aside(connection: sqlite3.Connection, path: Path) -> Path | None:
    """Close the store of another sweep and give it a name of its own; nothing is lost of hours of work."""
    (count,) = connection.execute("select count(*) from point").fetchone()
    belongs_to = repr((_about(connection, "key"), _read(connection)))
    aside = path.with_stem(f"{path.stem}-{hashlib.sha256(belongs_to.encode()).hexdigest()[:8]}")
    connection.execute("delete from about where name = 'writer'")
    connection.execute("pragma wal_checkpoint(truncate)")  # a reader would keep the file beside it
    connection.close()
    path.replace(aside)
    if count:
        return aside
    aside.unlink()
    return None


def _brought_back(path: Path, key: str) -> Path:
    """The store of a sweep where it was set aside, in its place again."""
    for aside in sorted(path.parent.resolve().glob(f"{path.stem}-*{path.suffix}")):
        # nobody writes what lies aside, and looking at it is to leave nothing beside it
        with contextlib.closing(sqlite3.connect(f"{aside.as_uri()}?immutable=1", uri=True)) as connection:
            try:
                wanted = _about(connection, "key") == key and _belongs(connection, key)
            except sqlite3.DatabaseError:
                continue  # of an older version, or no store
        if wanted:
            aside.replace(path)
            break
    return path


def _belongs(connection: sqlite3.Connection, key: str) -> bool:
    """Whether a store is empty, or of this sweep and of files that are as they were."""
    return _about(connection, "key") in ("", key) and not inputs.changed(_read(connection))


def _read(connection: sqlite3.Connection) -> dict[str, str]:
    return dict(connection.execute("select path, digest from input order by path").fetchall())


def known(store: Store) -> Iterator[tuple[Sequence[int], Outcomes]]:
    """Points that are finished, a chunk at a time: their numbers, and what came out."""
    with _told(store.path):
        for first, count, text, numbers in store.connection.execute(
            "select first, count, told, numbers from chunk order by first"
        ):
            yield range(first, first + count), Outcomes.unpacked(count, text, numbers)


def files_read(store: Store) -> dict[str, str]:
    """Files that the finished points hang on, see `inputs.reads`."""
    with _told(store.path):
        return _read(store.connection)


def keep(store: Store, done: Done, outcomes: Outcomes) -> None:
    """Write what is kept of the points of a chunk in one go, and the files that they read."""
    first, count = done.members[0], len(done.members)
    row = (first, count, *outcomes.packed(), done.seconds, done.host)
    with _told(store.path), store.connection:
        store.connection.execute("begin immediate")
        # points of a chunk that were given up one by one are computed once more with all of it
        store.connection.execute("delete from chunk where first >= ? and first < ?", (first, first + count))
        store.connection.execute("insert into chunk values (?, ?, ?, ?, ?, ?)", row)
        store.connection.executemany("insert or ignore into input values (?, ?)", done.reads.items())


def identity(read: Mapping[str, str], **of: object) -> str:
    """A key that changes with whatever could change a result: program, files that were read for it, and axes `of`."""
    contents = sorted((Path(name).name, content) for name, content in read.items())  # a folder may move
    return hashlib.sha256(json.dumps([program(), contents, of], sort_keys=True).encode()).hexdigest()


@functools.lru_cache(maxsize=1)
def program() -> str:
    """A key of every line of the program, and the libraries that compute."""
    from importlib.metadata import version

    root = Path(__file__).parents[1]
    digest = hashlib.sha256(" ".join(map(version, ("numpy", "scipy", "casadi"))).encode())
    for path in sorted(p for p in root.rglob("*") if p.suffix in (".py", ".toml", ".c", ".h")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _taken(connection: sqlite3.Connection, path: Path) -> None:
    """Refuse a store that a living process is writing, and say that this one is."""
    with connection:
        connection.execute("begin immediate")
        host, _, process = (_about(connection, "writer") or " 0").rpartition(" ")
        if host == socket.gethostname() and int(process) != os.getpid() and _lives(int(process)):
            raise BadInput(f"{path}: process {process} is writing it; wait for it, or choose another folder with --out")
        _note(connection, "writer", f"{socket.gethostname()} {os.getpid()}")


def _lives(process: int) -> bool:
    if os.name != "posix":  # elsewhere there is no harmless signal
        return False
    try:
        os.kill(process, 0)
        # one that has ended may wait to be asked how, as in a container whose first process reaps late
        stat = Path(f"/proc/{process}/stat").read_text(encoding="latin-1")
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return stat.rpartition(")")[2].split()[0] not in "ZX"


def _about(connection: sqlite3.Connection, name: str) -> str:
    row = connection.execute("select value from about where name = ?", (name,)).fetchone()
    return "" if row is None else str(row[0])


def _note(connection: sqlite3.Connection, name: str, value: str) -> None:
    connection.execute("insert or replace into about values (?, ?)", (name, value))


@contextlib.contextmanager
def _told(path: Path) -> Iterator[None]:
    """Errors of SQLite as bad input, or as the system's."""
    try:
        yield
    except sqlite3.OperationalError as error:
        if error.sqlite_errorcode in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
            why = f"another process holds it ({error}); wait for it, or choose another --out"
            raise BadInput(f"{path}: {why}") from None
        raise OSError(errno.EIO, str(error), str(path)) from error
    except sqlite3.DatabaseError as error:
        why = f"no store of a sweep ({error}); remove it, or choose another folder with --out"
        raise BadInput(f"{path}: {why}") from None
