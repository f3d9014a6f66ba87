"""Which C compiler there is, how it is called, and for which processor."""

import contextlib
import functools
import hashlib
import os
import platform
import shlex
import shutil
import signal
import subprocess
import sysconfig
from collections.abc import Sequence
from pathlib import Path

from mechsym import budget, interrupts
from mechsym.errors import BadInput
from mechsym.quantities import record

# `strict` is IEEE arithmetic as written; the sums of both modes are in the order written, so that cancellation is safe
MODES = {
    "strict": ("-ffp-contract=off",),
    "fast": ("-ffp-contract=fast",),
}
_PER_BYTE, _SPACE = 5e-5, 1e3  # of C: time [s] and memory [B] of a compiler at most, as seen of splines
_COMMON = ("-std=gnu11", "-O3", "-fPIC", "-shared", "-fvisibility=hidden", "-fno-math-errno", "-fno-trapping-math",
           # the few points after the last full vector are not worth a second vector loop to compile
           "--param", "vect-epilogues-nomask=0")  # fmt: skip


PATIENCE = 300.0  # the largest sources take some ten seconds [s]


class NoCompiler(Exception):
    """There is no working C compiler; the message says what was tried and the way out."""


@record
class Compiler:
    """A C compiler."""

    command: tuple[str, ...]
    stamp: str  #: Changes when the program changes, path, size and time of its file, or what CC says to it


def find() -> Compiler:
    """The compiler named by CC, otherwise the first of gcc, clang, cc that is in PATH."""
    return _find(os.environ.get("CC", ""), os.environ.get("PATH", ""))


@functools.lru_cache(maxsize=8)
def _find(named: str, path: str) -> Compiler:
    tried = [shlex.split(named)] if named.strip() else [["gcc"], ["clang"], ["cc"]]
    for command in tried:
        program = shutil.which(command[0], path=path)
        if program:
            real = Path(program).resolve()
            status = real.stat()
            stamp = " ".join([f"{real} {status.st_size} {status.st_mtime_ns}", *command[1:]])
            return Compiler(command=(program, *command[1:]), stamp=stamp)
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
    """Folder of Python.h; None where it is not installed: scalar calls then go through ctypes."""
    folder = sysconfig.get_paths()["include"]
    return folder if (Path(folder) / "Python.h").is_file() else None


@functools.cache
def processor() -> str:
    """Name and a short hash of the abilities of the processor; code compiled for one may not run on another.

    Returns text: for example `Intel(R) Xeon(R) Processor 1a2b3c4d`.
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

    source, target: C file to read, shared object to write; options: of `flags`, an optimisation that CC names is the
    one. Raises NoCompiler: the compiler failed; the message has its first line of complaint.
    """
    if any(word.startswith("-O") for word in compiler.command):
        options = tuple(word for word in options if not word.startswith("-O"))
    call([*compiler.command, *options, str(source), "-o", str(target), "-lm"], source.name, target)


def forecast(size: int, count: int = 1) -> None:
    """Refuse to compile what takes longer than its budget; `size` in bytes of C, for `count` platforms."""
    way_out = "keep fewer points of the diagram, or fewer cylinders"
    budget.require(f"compiling {size / 1e6:.2g} MB of C", count * _PER_BYTE * size, _SPACE * size, way_out)


def way_out(command: Sequence[str]) -> tuple[str, str]:
    """What to call a compiler that fails, and what to do: one that is a module of Python is none that CC could name."""
    if "-m" in command[:2]:
        module = command[2]
        return f"python -m {module}", f"install it anew: pip install --force-reinstall {module}"
    return command[0], "name another compiler in CC"


def call(command: Sequence[str], what: str, target: Path, folder: Path | None = None) -> None:
    """Let a compiler make `target` of `what`, in a folder; it ends in time, and with all processes that it started.

    Raises NoCompiler: it cannot be run, does not end, fails, or makes nothing.
    """
    name, other = way_out(command)
    try:
        process = subprocess.Popen(
            command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace",
            process_group=0 if os.name == "posix" else None,
        )  # fmt: skip
    except OSError as error:
        raise NoCompiler(f"{name} cannot be run: {error}; {other}") from error
    try:
        interrupts.groups.add(process.pid)
        _, said = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        raise NoCompiler(f"{name} did not end in {PATIENCE:g} s; {other}") from None
    finally:
        # end a process that runs still, and those that it started
        if process.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                if os.name == "posix":
                    os.killpg(process.pid, signal.SIGKILL)
                process.kill()
            process.wait()
        if process.stderr:
            process.stderr.close()
        interrupts.groups.discard(process.pid)
    if process.returncode:
        lines = [line for line in said.splitlines() if "error" in line] or said.splitlines() or ["no word"]
        raise NoCompiler(f"{name} failed on {what}: {lines[0].strip()}")
    if not target.is_file():
        raise NoCompiler(f"{name} says that it is done, and made nothing; {other}")
