"""mechsym: exact equations of motion, verified machine code, elastic hinges and guides.

The public interface is the modules that `__all__` names. Each is imported on first use, so `import mechsym` is light:

    from pathlib import Path
    from mechsym import cases, design, report

    found = design.design(cases.load("zotov-89"))
    report.write(found, Path("demo"))
"""

import importlib
from typing import Any

__all__ = [
    # data: case files, units, errors
    "cases", "errors", "files", "quantities",
    # mechanisms: declared and derived, and as functions of numbers
    "derive", "mechanism", "mechanisms", "native",
    # engine cycles and measured diagrams, forces, loads
    "assembly", "cycle", "engine", "forces", "loads",
    # hinge and guide, one after the other
    "hinge", "balance", "springs", "arrangement", "guide", "rollers", "turn", "feasibility", "offers", "retune",
    # motion in time and steady motion
    "simulate", "steadiness", "trials", "torsion",
    # the whole job and what is made of it
    "design", "optimise", "report", "sizing", "summary", "sweep",
    # published formulas and numbers
    "audit", "reproduce",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    if name in __all__:
        return importlib.import_module(f"mechsym.{name}")
    if name == "__version__":
        from importlib.metadata import version

        return version("mechsym")
    raise AttributeError(f"module 'mechsym' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__, "__version__"])
