"""Machine code for generated functions: evaluation, integration and marching in emitted C, with a way without it.

tape.py       a CasADi function as plain instructions        kernels.py   equal parts rolled into loops
emit.py       C text                                         cache.py     compiled files, checked before use
evaluate.py   scalar and batch calls                         fallback.py  the same without a compiler
integrate.py  runs in time: DOP853 in lanes, collocation     fold.py      equal Runge-Kutta steps at many designs
march.py      a recurrence over stages in many lanes         external.py  functions with derivatives for CasADi
c/*.h         what does not depend on the program: elementary functions, methods, step control
"""

from mechsym.native.evaluate import Compiled, compiled, compiled_all
from mechsym.native.fold import folder
from mechsym.native.march import marcher
from mechsym.native.runs import Breaks, Level, Outcome, Runs, Table

__all__ = [
    "Breaks", "Compiled", "Level", "Outcome", "Runs", "Table", "compiled", "compiled_all", "folder", "marcher",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__
