"""Files that are read: each is told to the lists that are open, by which a result knows whether it still holds."""

import ast
import contextlib
import errno
import functools
import io
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files import digest, read_lists, refuse_waiting

# a path that names no file; any other failure to read one is the system's
_NO_FILE = (FileNotFoundError, IsADirectoryError, NotADirectoryError)
_CHANGED = "changed while it was read"  # the digest of nothing


@contextlib.contextmanager
def reads() -> Iterator[dict[str, str]]:
    """The files that are read in the block, as they were named, with the digest of what was in them.

    The digest of a file that is not there is empty; of one that changed meanwhile it is none that a file can have.
    """
    read: dict[str, str] = {}
    token = read_lists.set((*read_lists.get(), read))
    try:
        yield read
    finally:
        read_lists.reset(token)


def tell(read: Mapping[str, str]) -> None:
    """Add to the open lists what was read elsewhere, in another process."""
    for open_list in read_lists.get():
        for name, content in read.items():
            open_list[name] = content if open_list.get(name, content) == content else _CHANGED


def changed(read: Mapping[str, str]) -> list[str]:
    """The files of a list in which there is something else now."""
    return [name for name, content in read.items() if _content(name) != content]


def _content(name: str) -> str:
    try:
        return digest(Path(name).read_bytes())
    except (OSError, ValueError):
        return ""


def read_bytes(path: Path | str) -> bytes:
    """What is in a file that the user names."""
    refuse_waiting(Path(path))
    try:
        data = Path(path).read_bytes()
    except (OSError, ValueError):
        tell({str(path): ""})
        raise
    tell({str(path): digest(data)})
    return data


def read_text(path: Path | str, option: str = "", way_out: str = "", encoding: str = "utf-8") -> str:
    """Text of a file that the user names.

    option: what the path was given for, set before it in the message; way_out: what to give in its place. Raises
    BadInput: there is no such file, or no text in it. OSError: the system does not give it: no permission, device
    broken.
    """
    said, more = f"{option} {path}".strip(), f"; {way_out}" if way_out else ""
    try:
        return io.TextIOWrapper(io.BytesIO(read_bytes(path)), encoding=encoding).read()
    except UnicodeDecodeError as error:
        reason = f"not UTF-8 text (byte {error.start})"
        raise BadInput(f"{said}: {reason}{more}", reason=reason) from None
    except (*_NO_FILE, ValueError) as error:  # a path may hold a zero byte, which is a ValueError
        reason = getattr(error, "strerror", None) or str(error)
        raise BadInput(f"{said}: cannot be read ({reason}){more}", reason=reason) from None
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            raise BadInput(f"{said}: cannot be read ({error.strerror}){more}", reason=error.strerror or "") from None
        raise OSError(error.errno, error.strerror, str(path)) from None


def read_any_text(path: Path | str, most: int, option: str = "") -> str:
    """Text of a file, Latin-1 where it is no UTF-8. Raises BadInput: as `read_text`; over `most` characters; binary."""
    try:
        text = read_text(path, option, encoding="utf-8-sig")
    except BadInput:  # a file that is not there is refused again
        text = read_text(path, option, encoding="latin-1")
    if len(text) > most:
        raise BadInput(f"{option} {path} has {len(text)} characters; at most {most} are read".strip())
    if "\0" in text:
        raise BadInput(f"{option} {path} is no text".strip())
    return text


_TABLE = re.compile(rb"""["']([\w./ -]+\.csv)["']""")  # as a file names it


def imports_from(path: Path) -> Path:
    """The folder from which a Python file imports its neighbours: its own, or that of the package it is in."""
    folder = path.parent
    while (folder / "__init__.py").is_file():
        folder = folder.parent
    return folder


def sources(path: Path) -> dict[Path, bytes]:
    """A Python file, those beside it that it imports, directly or not, and tables that any of them names, with what is
    in them; of a package all."""
    texts: dict[Path, bytes] = {}
    folder, waiting = imports_from(path), [path]
    if folder != path.parent:
        waiting += sorted((folder / path.relative_to(folder).parts[0]).rglob("*.py"))
    while waiting:
        file = waiting.pop()
        if file not in texts:
            texts[file] = read_bytes(file)
            if file.suffix == ".py":
                tables = (file.parent / name.decode() for name in _TABLE.findall(texts[file]))
                waiting += [table for table in tables if table.is_file()]
            waiting += [neighbour for name in _imported(texts[file]) for neighbour in _beside(folder, name)]
    return dict(sorted(texts.items()))


def _beside(folder: Path, name: str) -> list[Path]:
    file = folder / f"{name}.py"
    return [file] if file.is_file() else sorted((folder / name).rglob("*.py"))


@functools.lru_cache(maxsize=256)
def _imported(text: bytes) -> frozenset[str]:
    """First parts of the names of modules that a file imports."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError):
        return frozenset()  # refused with its line when it runs
    names = {a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names}
    names |= {n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom) and n.module}
    return frozenset(name.partition(".")[0] for name in names) - {"mechsym"}
