"""mechsym: exact equations of motion, verified machine code, elastic hinges and guides.

The public interface is the modules that `__all__` names. Each is imported on first use, so `import mechsym` is light:

    from mechsym import cases, jobs

    result = jobs.hinge(cases.load("zotov-89"))
"""

import importlib
from pathlib import Path
from typing import Any

__version__ = "1.0.0"  # its one home: packages, pages, units and `mechsym --version` read it here
__all__ = [
    # ground: errors with the way out, units, files, periodic curves, what pictures and pages share
    "errors", "quantities", "files", "periodic", "style", "page",
    # mechanisms: declared and derived, expressions to other systems, as functions of numbers, as compiled C
    "derive", "convert", "mechanisms", "native",
    # physics, each room from records and numbers
    "cycle", "sizing", "machine", "simulate", "hinge", "torsion", "forces", "optimise", "proof", "codesign",
    # data files, one page a command, all of a case on one page, and at many points
    "cases", "jobs", "report", "sweep",
    # published formulas and numbers, and what other programs read
    "audit", "papers", "out",
]  # fmt: skip

# in a clone generated/ and derivations/ stand beside the package; what is installed has them inside
if not (Path(__file__).parent / "generated").is_dir():
    __path__.append(str(Path(__file__).parents[1]))


def __getattr__(name: str) -> Any:
    if name in __all__:
        return importlib.import_module(f"mechsym.{name}")
    raise AttributeError(f"module 'mechsym' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
