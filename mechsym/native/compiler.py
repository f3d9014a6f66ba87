"""Which C compiler there is, how it is called, and for which processor."""

import functools
import hashlib
import os
import platform
import shlex
import shutil
import subprocess
import sysconfig
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.quantities import record

# `strict` is IEEE arithmetic as written; the sums of both modes are in the order written, so that cancellation is safe
MODES = {
    "strict": ("-ffp-contract=off",),
    "fast": ("-ffp-contract=fast",),
}
_COMMON = ("-std=gnu11", "-O3", "-fPIC", "-shared", "-fvisibility=hidden", "-fno-math-errno", "-fno-trapping-math",
           # the few points after the last full vector are not worth a second vector loop to compile
           "--param", "vect-epilogues-nomask=0")  # fmt: skip


class NoCompiler(Exception):
    """There is no working C compiler; the message says what was tried and the way out."""


@record
class Compiler:
    """A C compiler."""

    command: tuple[str, ...]
    stamp: str  #: Changes when the program changes: path, size and time of its file


def find() -> Compiler:
    """The compiler named by CC, otherwise the first of gcc, clang, cc that is in PATH."""
    return _find(os.environ.get("CC", ""), os.environ.get("PATH", ""))


@functools.lru_cache(maxsize=8)
def _find(named: str, path: str) -> Compiler:
    tried = [shlex.split(named)] if named.strip() else [["gcc"], ["clang"], ["cc"]]
    for command in tried:
        found = shutil.which(command[0], path=path)
        if found:
            real = Path(found).resolve()
            status = real.stat()
            stamp = f"{real} {status.st_size} {status.st_mtime_ns}"
            return Compiler(command=(found, *command[1:]), stamp=stamp)
    names = ", ".join(c[0] for c in tried)
    raise NoCompiler(f"no C compiler found (tried {names}); install gcc or clang, or name one in the variable CC")


def flags(mode: str) -> tuple[str, ...]:
    """Options for a mode on this processor."""
    if mode not in MODES:
        raise BadInput(f"mode = {mode!r} is not an option; options are {', '.join(MODES)}")
    machine = platform.machine().lower()
    x86 = ("-march=native", "-mprefer-vector-width=512")
    target = x86 if machine in ("x86_64", "amd64", "i686") else ("-mcpu=native",)
    header = python_header()
    python = ("-DMS_PYTHON", f"-I{header}") if header else ()
    return (*_COMMON, *target, *MODES[mode], *python)


@functools.cache
def python_header() -> str | None:
    """Folder of Python.h.

    Returns
    -------
    folder : str or None
        None where Python's headers are not installed; scalar calls then go through ctypes
    """
    folder = sysconfig.get_paths()["include"]
    return folder if (Path(folder) / "Python.h").is_file() else None


@functools.cache
def processor() -> str:
    """Name and a short hash of the abilities of the processor; code compiled for one may not run on another.

    Returns
    -------
    text : str
        For example `Intel(R) Xeon(R) Processor 1a2b3c4d`
    """
    name, abilities = platform.processor() or platform.machine(), platform.version()
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    for line in lines:
        key, _, value = line.partition(":")
        if key.strip() in ("model name", "CPU part"):
            name = value.strip()
        if key.strip() in ("flags", "Features"):
            abilities = value.strip()
            break
    return f"{name} {hashlib.sha256(abilities.encode()).hexdigest()[:8]}"


def version(compiler: Compiler) -> str:
    """First line of what the compiler says of itself."""
    done = subprocess.run([*compiler.command, "--version"], capture_output=True, text=True, check=False)
    return (done.stdout.splitlines() or ["unknown"])[0]


def compile_file(compiler: Compiler, source: Path, target: Path, options: tuple[str, ...]) -> None:
    """Compile one C file into a shared object.

    Parameters
    ----------
    source, target : Path
        C file to read, shared object to write

    Raises
    ------
    NoCompiler
        The compiler failed; the message has its first line of complaint
    """
    command = [*compiler.command, *options, str(source), "-o", str(target), "-lm"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise NoCompiler(f"{compiler.command[0]} cannot be run: {error}; name another compiler in CC") from None
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if "error" in line] or done.stderr.splitlines() or ["no word"]
        raise NoCompiler(f"{compiler.command[0]} failed on {source.name}: {said[0].strip()}")
