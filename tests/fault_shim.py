"""What stands between Python and the system, and lets the n-th call fail: `faults.c`, and the same in Python."""

import ctypes
import errno
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
SOURCE = Path(__file__).with_name("faults.c")
DOES = ("once", "full", "kill", "interrupt")


class Faults:
    """The library between Python and the system."""

    def __init__(self):
        self.library = ctypes.CDLL(None)
        self.library.faults_kind.restype = ctypes.c_char_p
        self.tell_type = ctypes.CFUNCTYPE(None, ctypes.c_long, ctypes.c_int)
        self.told = None

    def tell(self, function):
        self.told = self.tell_type(function) if function else None  # kept alive
        self.library.faults_tell(self.told)

    def want(self, at, does):
        self.library.faults_want(ctypes.c_long(at), DOES.index(does))

    @property
    def kind(self):
        return self.library.faults_kind().decode() if self.library.faults_fired() else ""

    def asks(self, word):
        return bool(self.library.faults_ask(word.encode()))


def preloaded(folder, *words):
    """Python with the library loaded before all others."""
    library = Path(folder) / "faults.so"
    subprocess.run(["gcc", "-O1", "-shared", "-fPIC", str(SOURCE), "-o", str(library), "-ldl"], check=True)
    environment = {"LD_PRELOAD": str(library), "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run([sys.executable, *words], cwd=ROOT, check=False, env=os.environ | environment).returncode


def patched(faults):
    """Let processes, compilers and solvers fail in their turn too."""
    import casadi
    import scipy.integrate
    import scipy.sparse.linalg

    from mechsym.native import compiler

    def failing(owner, name, word, error):
        function = getattr(owner, name)

        def shim(*args, **options):
            if faults.asks(word):
                raise error()
            return function(*args, **options)

        setattr(owner, name, shim)

    def broken(command, what, target, folder=None, call=compiler.call):
        call(command, what, target, folder)
        if faults.asks("compile"):
            target.write_bytes(target.read_bytes()[:100])

    compiler.call = broken
    failing(subprocess.Popen, "__init__", "fork", lambda: OSError(errno.EAGAIN, os.strerror(errno.EAGAIN)))
    for owner, name in ((casadi, "nlpsol"), (casadi, "qpsol"), (casadi, "conic"), (casadi, "rootfinder"),
                        (casadi, "integrator"), (scipy.sparse.linalg, "splu"),
                        (scipy.integrate.OdeSolver, "__init__")):  # fmt: skip
        failing(owner, name, "solver", MemoryError)
