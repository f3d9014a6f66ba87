"""Python files that a case names: they run where they are the user's own, and elsewhere when he has said so.

A case looks like data and is passed on like data, and the mechanism that it names is a program. While a command runs,
a file is the user's own when

- it is typed: `mechsym eval ./x.py` is as `python ./x.py`,
- it lies in the working folder, or below it (below the home folder, where downloads lie, this does not count),
- its folder is known: by `--trust` with any command, or because `mechsym new` has written a mechanism there.

Folders are kept beside the cache, without those below them. Who calls the package from Python says himself what runs.
"""

import contextlib
import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files import is_ours, user_cache

_commands: list[tuple[frozenset[Path], bool]] = []  # files typed, and whether --trust was, of the command that runs


@contextlib.contextmanager
def guarded(words: Sequence[str], trusting: bool) -> Iterator[None]:
    """Refuse what `refuse_foreign` is asked for in the block; words: as typed; trusting: whether --trust is there."""
    _commands.append((frozenset(_typed(words)), trusting))
    try:
        yield
    finally:
        _commands.pop()


def _typed(words: Sequence[str]) -> Iterator[Path]:
    for word in words:
        for text in {word, word.partition("=")[2]}:
            stem, ending, _ = text.rpartition(".py")
            if ending:
                yield Path(stem + ending).resolve()


def refuse_foreign(path: Path) -> None:
    """Refuse to run a file that the user has neither written nor trusted.

    path: a Python file, resolved. Raises BadInput: a command runs, and the file is neither typed, nor below the working
    folder, nor in a folder that is known.
    """
    if not _commands:
        return
    if _commands[-1][1]:
        keep(path.parent)
    elif not is_trusted(path):
        way_out = f"read it, then say --trust once for all files of its folder, or work in {path.parent}"
        raise BadInput(f"mechanism {path} is a program from outside the working folder and is not run; {way_out}")


def is_trusted(path: Path) -> bool:
    """Whether a Python file, resolved, runs without a word while a command runs."""
    return bool(_commands) and (path in _commands[-1][0] or _at_hand(path) or path.parent in _known())


def _at_hand(path: Path) -> bool:
    here = Path.cwd().resolve()
    return path.parent == here or (path.is_relative_to(here) and not Path.home().resolve().is_relative_to(here))


def keep(folder: Path) -> None:
    """Know a folder from now on; where nothing can be kept, --trust holds for one command."""
    folder = folder.resolve()
    if folder in _known() or "\n" in str(folder):
        return
    with contextlib.suppress(OSError):
        _list().parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        descriptor = os.open(_list(), os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        with os.fdopen(descriptor, "ab") as file:
            file.write(os.fsencode(f"{folder}\n"))


def _list() -> Path:
    return user_cache() / "trusted"


def _known() -> set[Path]:
    try:
        status, lines = _list().stat(), _list().read_bytes().split(b"\n")
        # a list that others may write into says nothing
        return {Path(os.fsdecode(line)) for line in lines if line} if is_ours(status) else set()
    except OSError:
        return set()
