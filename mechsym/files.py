"""Writing results so that nothing half-written is ever seen."""

import contextlib
import csv
import dataclasses
import errno
import hashlib
import json
import math
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.display import heading

# what another place or name mends; any other failure (disk full, device broken) is the system's
_MENDABLE = (FileExistsError, FileNotFoundError, IsADirectoryError, NotADirectoryError, PermissionError)
# a path that names no file; any other failure to read one is the system's
_NO_FILE = (FileNotFoundError, IsADirectoryError, NotADirectoryError)
SUMMARY = "summary.json"
_folders: list[Path] = []  # folders whose files wait for each other
_waiting: dict[Path, str] = {}  # file: its temporary name, complete and on the disk


def make_folder(path: Path) -> Path:
    """Make a folder for results, before the work whose results it takes.

    Parameters
    ----------
    path : Path
        Folder; its parents are made when they are missing

    Raises
    ------
    BadInput
        It cannot be made, or nothing can be written into it
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=path).close()
    except _MENDABLE as error:
        raise _unwritable(path, error) from error
    return path


def try_folder(path: Path) -> Path:
    """Refuse a folder that could not take results, as `make_folder` does, and leave nothing behind."""
    missing = _missing(path)
    try:
        return make_folder(path)
    finally:
        _remove(missing)


def _missing(path: Path) -> list[Path]:
    return [p for p in (path, *path.parents) if not p.exists()]


def _remove(made: list[Path]) -> None:
    """Remove folders, the innermost first, as far as they are empty."""
    for folder in made:
        with contextlib.suppress(OSError):
            folder.rmdir()


@contextlib.contextmanager
def together(folder: Path) -> Iterator[None]:
    """Files written below `folder` in the block appear at its end all at once; a failed write or bad input drops them.

    Folders that were made for them go too where nothing else is in them. An interrupt keeps what is complete.
    """
    missing = _missing(folder)
    _folders.append(folder.absolute())
    try:
        yield
    except (OSError, MemoryError, BadInput):
        _drop()
        _remove(missing)
        raise
    finally:
        _folders.pop()
        appear()


def appear() -> None:
    """Move the files that wait for each other into place."""
    try:
        while _waiting:
            path = next(iter(_waiting))
            os.replace(_waiting[path], path)
            del _waiting[path]
    finally:
        _drop()


def _drop() -> None:
    while _waiting:
        Path(_waiting.popitem()[1]).unlink(missing_ok=True)


def read_text(path: Path | str, option: str = "", way_out: str = "", encoding: str = "utf-8") -> str:
    """Text of a file that the user names.

    Parameters
    ----------
    option : str
        What the path was given for, set before it in the message
    way_out : str
        What to give in its place

    Raises
    ------
    BadInput
        There is no such file, or no text in it
    OSError
        The system does not give it: no permission, device broken
    """
    said, more = f"{option} {path}".strip(), f"; {way_out}" if way_out else ""
    try:
        return Path(path).read_text(encoding=encoding)
    except UnicodeDecodeError as error:
        raise BadInput(f"{said}: not UTF-8 text (byte {error.start}){more}") from None
    except (*_NO_FILE, ValueError) as error:  # a path may hold a zero byte, which is a ValueError
        raise BadInput(f"{said}: cannot be read ({getattr(error, 'strerror', None) or error}){more}") from None
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            raise BadInput(f"{said}: cannot be read ({error.strerror}){more}") from None
        raise OSError(error.errno, error.strerror, str(path)) from None


def write_text(path: Path, text: str) -> Path:
    """Write `text` as UTF-8 with newline line ends to a temporary name beside `path` and move it into place."""
    return write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, data: bytes) -> Path:
    """Write bytes to a temporary name beside `path` and move it into place; its folder is made when it is missing."""
    return write_with(path, lambda part: part.write_bytes(data))


def write_with(path: Path, write: Callable[[Path], Any]) -> Path:
    """Let `write` fill a temporary name beside `path`, and move it into place when it is on the disk.

    Parameters
    ----------
    write : callable
        Writes the file whose path it is given
    """
    path = Path(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except _MENDABLE as error:
        raise _unwritable(path, error) from error
    try:
        write(Path(name))
        os.fsync(handle)
        os.chmod(name, 0o644)
        _place(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    finally:
        os.close(handle)
    return path


def _place(name: str, path: Path) -> None:
    target = path.absolute()
    if not any(target.is_relative_to(folder) for folder in _folders):
        os.replace(name, path)
        return
    if target in _waiting:
        Path(_waiting[target]).unlink(missing_ok=True)
    _waiting[target] = name


def write_summary(folder: Path, numbers: Mapping[str, Any]) -> Path:
    """Write `summary.json`: the numbers, and the files of this run in a folder by the digest of what is in them.

    Notes
    -----
    `run.id` is the digest of all of them: a folder whose files do not give it holds files of several runs.
    """
    root = folder.absolute()
    parts = {path: Path(part) for path, part in sorted(_waiting.items()) if path.is_relative_to(root)}
    digests = {p.relative_to(root).as_posix(): _digest(q.read_bytes()) for p, q in parts.items() if p.name != SUMMARY}
    run = {"id": _digest(json.dumps([to_json(numbers), digests]).encode())[:16], "files": digests}
    return write_text(folder / SUMMARY, to_json({**numbers, "run": run}) + "\n")


def _digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _unwritable(path: Path, error: OSError) -> BadInput:
    return BadInput(f"{path}: cannot be written ({error.strerror}); choose another folder with --out")


def write_csv(path: Path, columns: Mapping[str, Sequence[float] | np.ndarray]) -> Path:
    """Write equally long columns, SI units unless the column's name says otherwise.

    Parameters
    ----------
    columns : mapping of str to sequence
        Column name to values; all of one length
    """
    import io

    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*[_cells(values) for values in columns.values()], strict=True))
    return write_text(path, buffer.getvalue())


def write_quantities(
    path: Path, columns: Mapping[str, Sequence[float] | np.ndarray], units: Mapping[str, str] | None = None
) -> Path:
    """Write equally long columns with their units in the headings, `rho [m]`: SI, or what the user has chosen.

    Parameters
    ----------
    units : mapping of str to str, optional
        SI unit of columns whose name does not tell it
    """
    headed = (heading(name, values, asked=True, unit=(units or {}).get(name)) for name, values in columns.items())
    return write_csv(path, dict(headed))


def _cells(values: Sequence[float] | np.ndarray) -> list[Any]:
    return [_cell(v) for v in values]


_FLOATS = (float, np.floating)


def _cell(value: Any) -> Any:
    if not isinstance(value, _FLOATS):
        return value
    # a gap is an empty cell; only what is not a number differs from itself
    return "" if value != value else format(value, ".12g")


def to_json(value: Any) -> str:
    """JSON text of nested records, arrays and numbers; a number that is not finite becomes null.

    Parameters
    ----------
    value : object
        Mappings, sequences, arrays, numbers, text, booleans, None
    """
    return json.dumps(plain(value), indent=2, allow_nan=False)


def plain(value: Any) -> Any:
    """The same value in plain Python types, with null for what is not finite.

    Parameters
    ----------
    value : object
        Mappings, sequences, arrays, numbers, text, booleans, None

    Returns
    -------
    value : object
        dict, list, str, int, float, bool or None
    """
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        value = dataclasses.asdict(value)
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return value
