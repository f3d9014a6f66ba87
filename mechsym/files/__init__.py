"""Files: results are written so that nothing half-written is ever seen.

inputs.py   files that are read, told to the results that hang on them
tables.py   tables of the user's, refused with their line        trust.py   which Python files a command runs
"""

import contextlib
import contextvars
import csv
import dataclasses
import errno
import hashlib
import io
import json
import math
import os
import re
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from mechsym.errors import BadInput, MissingExtra
from mechsym.quantities.display import heading
from mechsym.transaction import SUMMARY as SUMMARY
from mechsym.transaction import Transaction, hidden, missing, remove_empty, sweep_up, sync_folder

if TYPE_CHECKING:
    import xarray

# what another place or name mends; any other failure (disk full, device broken) is the system's
_MENDABLE = (FileExistsError, FileNotFoundError, IsADirectoryError, NotADirectoryError, PermissionError)
Json = dict[str, Any]  # what JSON has by name: numbers, texts, lists and more of the same


def is_ours(status: os.stat_result) -> bool:
    """Whether nobody else may write into a file or a folder."""
    return not hasattr(os, "getuid") or (status.st_uid == os.getuid() and not status.st_mode & 0o022)


def user_cache() -> Path:
    """What the program keeps for a user, under XDG_CACHE_HOME or what the platform has; it need not exist."""
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
    return (Path(named) if os.path.isabs(named) else base) / "mechsym"


def make_folder(path: Path) -> Path:
    """Make a folder for results, before the work whose results it takes.

    path: folder; its parents are made when they are missing. Raises BadInput: it cannot be made, or nothing can be
    written into it.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=path).close()
    except _MENDABLE as error:
        raise _unwritable(path, error) from error
    return path


def try_folder(path: Path) -> Path:
    """Refuse a folder that could not take results, as `make_folder` does, and leave nothing behind."""
    new = missing(path)
    try:
        return make_folder(path)
    finally:
        remove_empty(new)


_open: contextvars.ContextVar[Transaction | None] = contextvars.ContextVar("open", default=None)


@contextlib.contextmanager
def together(folder: Path) -> Iterator[None]:
    """Files written below `folder` in the block appear at its end all at once; any exception drops them.

    An interrupt drops them too: what `publish` was told of stays. A block inside another gives its files to that one.
    """
    sweep_up(folder)  # a run that is refused leaves nothing of a killed one either
    block = Transaction(folder, _open.get())
    token = _open.set(block)
    try:
        yield
        block.publish()
    except BaseException:
        block.drop()
        raise
    finally:
        _open.reset(token)


def publish() -> None:
    """Move the files that wait for each other into place: they are complete, whatever happens later."""
    block = _open.get()
    if block is not None:
        block.publish()


#: Lists of the files that are read, each by name with its digest, which `mechsym.files.inputs` opens and fills
read_lists: contextvars.ContextVar[tuple[dict[str, str], ...]] = contextvars.ContextVar("read_lists", default=())


def refuse_waiting(path: Path) -> None:
    """Refuse to read a file that waits to appear: what is on the disk is older."""
    block = _open.get()
    if block is not None and _true(path) in block.all_waiting():
        raise RuntimeError(f"{path} waits to appear, and what is on the disk is older: use what was written")


def write_text(path: Path, text: str) -> Path:
    """Write `text` as UTF-8 with newline line ends to a temporary name beside `path` and move it into place."""
    return write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, data: bytes | memoryview) -> Path:
    """Write bytes to a temporary name beside `path` and move it into place; its folder is made when it is missing."""
    return write_with(path, lambda part: part.write_bytes(data))


def write_with(path: Path, write: Callable[[Path], Any]) -> Path:
    """Let `write` fill a temporary name beside `path`, and move it into place when it is on the disk."""
    path = Path(path)
    # refuse to write over a file that was read: a result would take the place of what it comes from
    names = (name for read in read_lists.get() for name in read if Path(name).name == path.name)
    if any(_true(Path(name)) == _true(path) for name in names):
        raise BadInput(f"{path} was read for this and would be written over; give another folder with --out")
    block = _open.get()
    home = block.home(_true(path)) if block else None
    part = hidden(path)
    try:
        if home:
            home.made = [*missing(path.parent), *home.made]
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        # who may read it is for the umask to say, as of any other file
        handle = os.open(part, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o666)
    except _MENDABLE as error:
        raise _unwritable(path, error) from error
    try:
        write(part)
        os.fsync(handle)
        if home:
            home.add(_true(path), part)
        else:
            part.replace(path)
            sync_folder(path.parent)
            sweep_up(path.parent)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
    finally:
        os.close(handle)
    return path


def _true(path: Path) -> Path:
    """The one absolute path of a name in a folder, whichever way the folder was named."""
    return path.parent.resolve() / path.name


def write_summary(folder: Path, numbers: Mapping[str, Any], command: str, read: Mapping[str, str]) -> Path:
    """Write `summary.json`: the numbers, and the files of this run in a folder by the digest of what is in them.

    What the run of the same command before left there, as its summary tells, goes when the files of this one appear.
    `run.id` is the digest of all of them: a folder whose files do not give it holds files of several runs. `run.beside`
    has the files that other commands left in the folder, `run.inputs` those that were `read` for it.
    """
    root, block = folder.resolve(), _open.get()
    if block:
        block.claim()  # what is told of the folder here still holds when the files appear
    parts = {p: part for p, part in sorted(block.all_waiting().items()) if p.is_relative_to(root)} if block else {}
    digests = {p.relative_to(root).as_posix(): _digest_of(q) for p, q in parts.items() if p.name != SUMMARY}
    before = _left(root)
    if block:
        block.stale |= {root / name for name in before.pop(command, {}).keys() - digests.keys()}
    beside = {name: {f: d for f, d in files.items() if f not in digests} for name, files in before.items()}
    run = {"id": digest(json.dumps([to_json(numbers), digests]).encode())[:16], "command": command, "files": digests}
    run |= {"inputs": {name: content for name, content in sorted(read.items()) if content}}
    run |= {"beside": {name: files for name, files in beside.items() if files}} if any(beside.values()) else {}
    return write_text(folder / SUMMARY, to_json({**numbers, "run": run}) + "\n")


def _left(root: Path) -> dict[str, dict[str, str]]:
    """Files by command that earlier runs left in a folder and nobody has changed since, with their digests."""
    try:
        run = json.loads((root / SUMMARY).read_text(encoding="utf-8"))["run"]
        listed = {**run.get("beside", {}), run["command"]: run["files"]}
        return {name: {f: d for f, d in files.items() if _is(root, f, d)} for name, files in listed.items()}
    except (OSError, ValueError, TypeError, KeyError, AttributeError):  # no summary, or none of ours
        return {}


def _is(root: Path, name: str, content: str) -> bool:
    path = (root / name).resolve()
    return path.is_relative_to(root) and path.is_file() and _digest_of(path) == content


def digest(data: bytes) -> str:
    """What tells a content from any other."""
    return hashlib.sha256(data).hexdigest()


def _digest_of(file: Path) -> str:
    """The digest of what is in a file, which may be larger than what memory is left."""
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()


def _unwritable(path: Path, error: OSError) -> BadInput:
    return BadInput(f"{path}: cannot be written ({error.strerror}); choose another folder with --out")


def write_csv(path: Path, columns: Mapping[str, Sequence[object] | np.ndarray]) -> Path:
    """Write equally long columns by name, in SI units unless the name says otherwise."""

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            rows = {len(values) for values in columns.values()}
            if len(rows) > 1:
                raise ValueError(f"{path}: columns of {sorted(rows)} rows")
            for start in range(0, max(rows, default=0), _ROWS):
                _write_rows(file, writer, [values[start : start + _ROWS] for values in columns.values()])

    return write_with(path, write)


_ROWS = 10_000  # of a table that are text at a time


def _write_rows(file: IO[str], writer: Any, columns: Sequence[Sequence[object] | np.ndarray]) -> None:
    cells, formats, words = [], [], set()
    for values in columns:
        whole = isinstance(values, np.ndarray) and values.dtype.kind == "f" and bool(np.isfinite(values).all())
        cells.append(np.asarray(values).tolist() if whole else _cells(values))
        formats.append("%.12g" if whole else "%s")
        words |= set() if whole else {*cells[-1]}
    if len(columns) > 1 and all(isinstance(word, str) and not _QUOTED.search(word) for word in words):
        # what csv writes, a row at a time
        row = ",".join(formats) + "\n"
        file.writelines(row % values for values in zip(*cells, strict=True))
    else:
        writer.writerows(zip(*map(_cells, columns), strict=True))


def write_quantities(
    path: Path, columns: Mapping[str, Sequence[float] | np.ndarray], units: Mapping[str, str] | None = None
) -> Path:
    """Write equally long columns with their units in the headings, `rho [m]`: SI, or what the user has chosen.

    units: SI unit of columns that do not know theirs and whose name does not tell it.
    """
    known = units or getattr(columns, "units", {})
    headed = (heading(name, values, asked=True, unit=known.get(name)) for name, values in columns.items())
    return write_csv(path, dict(headed))


def write_netcdf(path: Path, data: "xarray.Dataset") -> Path:
    """Write a data set of xarray as netCDF. Raises MissingExtra: xarray or h5netcdf is not installed."""
    try:
        import h5netcdf  # type: ignore[import-untyped,unused-ignore]
        from xarray.backends import H5NetCDFStore
    except ImportError as error:
        raise without_netcdf(error) from None

    # words are kept by reference: sixteen bytes each, and their own place
    variables = data.variables.values()
    size = sum(v.nbytes + 40 * v.size * (v.dtype.kind not in "biuf") for v in variables) + _BESIDE

    def write(part: Path) -> None:
        with _Reserved(part, size) as disk, h5netcdf.File(disk, "w") as file:
            data.dump_to_store(H5NetCDFStore(file))

    return write_with(path, write)


_BESIDE = 1_000_000  # what a netCDF file has beside its numbers [byte]


class _Reserved(io.FileIO):
    """A file whose place on the disk is taken before it is written, and that looks as long as what is written.

    Where the disk is full later HDF5 goes on without a word, or takes the process with it.
    """

    def __init__(self, path: Path, size: int) -> None:
        super().__init__(path, "r+b")
        self._end = 0
        try:
            if hasattr(os, "posix_fallocate"):
                os.posix_fallocate(self.fileno(), 0, size)
        except OSError:
            super().close()
            raise

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """To a place, from the end of what is written."""
        return super().seek(offset + self._end) if whence == os.SEEK_END else super().seek(offset, whence)

    def readinto(self, buffer: Any) -> int | None:
        """Nothing beyond what is written."""
        return super().readinto(memoryview(buffer).cast("B")[: max(0, self._end - self.tell())])

    def write(self, data: Any) -> int:
        """All of it."""
        left = memoryview(data).cast("B")
        size = len(left)
        while len(left):
            left = left[super().write(left) :]
        self._end = max(self._end, self.tell())
        return size

    def truncate(self, size: int | None = None) -> int:
        """The end of what is written."""
        self._end = self.tell() if size is None else size
        return self._end

    def close(self) -> None:
        """Give back what was not needed."""
        if not self.closed:
            super().truncate(self._end)
        super().close()


def without_netcdf(error: ImportError) -> MissingExtra:
    """What is said where a library of netCDF is not installed."""
    return MissingExtra(f"netCDF needs xarray and h5netcdf ({error}); install them with pip install 'mechsym[netcdf]'")


_FLOATS = (float, np.floating)
_QUOTED = re.compile(r'[,"\r\n]')  # what csv sets between quotes


def _cells(values: Sequence[object] | np.ndarray) -> list[object]:
    # Python's own numbers are written faster than numpy's; a gap, which differs from itself, is an empty cell
    plainly = values.tolist() if isinstance(values, np.ndarray) else values
    return [("" if v != v else format(v, ".12g")) if isinstance(v, _FLOATS) else v for v in plainly]


def to_json(value: object) -> str:
    """JSON text of nested records, arrays and plain values; a number that is not finite becomes null."""
    return json.dumps(plain(value), indent=2, allow_nan=False)


def plain(value: object) -> Any:
    """The same value in plain Python types, with null for what is not finite.

    value: mappings, sequences, arrays, numbers, text, booleans, None. Returns value: dict, list, str, int, float, bool
    or None.
    """
    if isinstance(value, float):  # most values of long lists: first
        return float(value) if math.isfinite(value) else None
    if value is None or isinstance(value, (str, bool)):
        return value
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        from mechsym.quantities.results import tell  # most commands write plain values

        value = tell(value)
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        return int(value)
    return plain(float(value)) if isinstance(value, np.floating) else value
