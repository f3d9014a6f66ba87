"""Finished points of a sweep in a file beside its results, so that the same command goes on where it stopped.

    OUT/sweep.db    SQLite    point: i, row (JSON), seconds, host    about: what was swept, and who is writing

A store belongs to one sweep: case text, values, axes, columns and program. Another sweep into the same folder begins
anew and sets the store aside as `sweep-<first digits of its key>.db`, where it is found when its turn comes again.
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
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.sweep.outcomes import Gap, Outcome

NAME = "sweep.db"
_TABLES = """
create table if not exists about (name text primary key, value text not null);
create table if not exists point (i integer primary key, row text not null, seconds real, host text);
"""


@record
class Store:
    """An open store."""

    path: Path
    connection: Any  #: sqlite3.Connection
    aside: Path | None = None  #: Where the store of another sweep went that was in the way


@contextlib.contextmanager
def opened(folder: Path, key: str, fresh: bool = False) -> Iterator[Store]:
    """The store of a sweep in its folder; nobody else writes it meanwhile.

    Parameters
    ----------
    key : str
        What is swept, see `identity`; a store of anything else is set aside
    fresh : bool
        Forget what is kept of this sweep

    Raises
    ------
    BadInput
        It is no store, or another process is writing it
    """
    path = folder / NAME
    with _told(path):
        moved = None
        connection = _connected(path)
        try:
            if _about(connection, "key") not in ("", key):
                moved = _set_aside(connection, path)
                connection = _connected(_brought_back(path, key))
            with connection:
                if fresh:
                    connection.execute("delete from point")
                _note(connection, "key", key)
            yield Store(path=path, connection=connection, aside=moved)
            connection.execute("delete from about where name = 'writer'")
        finally:
            connection.close()


def _connected(path: Path) -> Any:
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


def _set_aside(connection: Any, path: Path) -> Path | None:
    """Close the store of another sweep and give it a name of its own; nothing is lost of hours of work."""
    other, (count,) = _about(connection, "key"), connection.execute("select count(*) from point").fetchone()
    connection.execute("delete from about where name = 'writer'")
    connection.execute("pragma wal_checkpoint(truncate)")  # a reader would keep the file beside it
    connection.close()
    aside = _aside(path, other)
    path.replace(aside)
    if count:
        return aside
    aside.unlink()
    return None


def _brought_back(path: Path, key: str) -> Path:
    if _aside(path, key).exists():
        _aside(path, key).replace(path)
    return path


def _aside(path: Path, key: str) -> Path:
    return path.with_stem(f"{path.stem}-{key[:8]}")


def known(store: Store) -> dict[int, Outcome]:
    """Points that are finished, by index."""
    with _told(store.path):
        rows = store.connection.execute("select i, row from point").fetchall()
    return {i: _outcome(json.loads(text)) for i, text in rows}


def keep(store: Store, members: Sequence[int], found: Sequence[Outcome], seconds: float, host: str) -> None:
    """Write the points of a chunk in one go.

    Parameters
    ----------
    seconds : float
        What one of them took of a processor [s]
    """
    rows = [(i, _text(outcome), seconds, host) for i, outcome in zip(members, found, strict=True)]
    with _told(store.path), store.connection:
        store.connection.execute("begin immediate")
        store.connection.executemany("insert or replace into point values (?, ?, ?, ?)", rows)


def identity(case: cases.Case, **of: Any) -> str:
    """A key that changes with whatever could change a result: program, case, files that it reads, and axes `of`."""
    digest = hashlib.sha256(program().encode())
    digest.update(cases.text(case.path).encode())
    for path in _files(case):
        digest.update(path.read_bytes())
    digest.update(json.dumps({k: v for k, v in of.items()}, sort_keys=True).encode())
    return digest.hexdigest()


def _files(case: cases.Case) -> list[Path]:
    """Files that the case reads: measured diagrams, another case, a mechanism of the user's own."""
    named = [case.mechanism.partition(".py:")[0] + ".py" if ".py" in case.mechanism else ""]
    for section in case.sections.values():
        named += [v for v in vars(section).values() if isinstance(v, str) and Path(v).suffix]
    return sorted({Path(name) for name in named if name and Path(name).is_file()})


@functools.lru_cache(maxsize=1)
def program() -> str:
    """A key of every line of the program, and the libraries that compute."""
    from importlib.metadata import version

    root = Path(__file__).parents[1]
    digest = hashlib.sha256(" ".join(map(version, ("numpy", "scipy", "casadi"))).encode())
    for path in sorted(p for p in root.rglob("*") if p.suffix in (".py", ".toml", ".c", ".h")):
        digest.update(path.read_bytes())
    return digest.hexdigest()


def _taken(connection: Any, path: Path) -> None:
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
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return not _only_waited_for(process)


def _only_waited_for(process: int) -> bool:
    """Whether a process has ended and nobody has asked yet how, as in a container whose first process reaps late."""
    try:
        stat = Path(f"/proc/{process}/stat").read_text(encoding="latin-1")
    except OSError:
        return False
    return stat.rpartition(")")[2].split()[0] in "ZX"


def _about(connection: Any, name: str) -> str:
    row = connection.execute("select value from about where name = ?", (name,)).fetchone()
    return "" if row is None else str(row[0])


def _note(connection: Any, name: str, value: str) -> None:
    connection.execute("insert or replace into about values (?, ?)", (name, value))


@contextlib.contextmanager
def _told(path: Path) -> Iterator[None]:
    """Errors of SQLite as bad input, or as the system's."""
    try:
        yield
    except sqlite3.OperationalError as error:
        if "locked" in str(error):
            raise BadInput(
                f"{path}: another process holds it ({error}); wait for it, or choose another --out"
            ) from None
        raise OSError(errno.EIO, str(error), str(path)) from error
    except sqlite3.DatabaseError as error:
        raise BadInput(
            f"{path}: no store of a sweep ({error}); remove it, or choose another folder with --out"
        ) from None


def _text(outcome: Outcome) -> str:
    if isinstance(outcome, Gap):
        return json.dumps({"gap": outcome.reason, "of_input": outcome.of_input})
    return json.dumps({"row": outcome})


def _outcome(stored: dict[str, Any]) -> Outcome:
    if "gap" in stored:
        return Gap(reason=stored["gap"], of_input=stored["of_input"])
    return dict(stored["row"])
