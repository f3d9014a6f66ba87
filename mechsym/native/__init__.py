"""Machine code for generated functions: evaluation, integration and marching in emitted C, with a way without it.

tape.py       a CasADi function as plain instructions, and cheaper forms of it
kernels.py    equal parts rolled into loops                  source.py    C text
evaluate.py   scalar and batch calls, derivatives; the same without a compiler
cache.py      compiled files, checked before use             arc.py       motion along the arc length of each angle
adams.py      steps that look back, in lanes                 c/adams.h    their control
integrate.py  runs in time: DOP853 in lanes, collocation; runs.py says what they take and give
march.py      a recurrence over stages, and equal Runge-Kutta steps at many designs, in many lanes
c/*.h         what does not depend on the program: elementary functions, methods, step control
"""

from mechsym.quantities import lazily

_NAMES = {
    "Breaks": "mechsym.native.runs:Breaks",
    "Compiled": "mechsym.native.evaluate:Compiled",
    "Level": "mechsym.native.runs:Level",
    "Outcome": "mechsym.native.runs:Outcome",
    "Runs": "mechsym.native.runs:Runs",
    "Table": "mechsym.native.runs:Table",
    "compiled": "mechsym.native.evaluate:compiled",
    "compiled_all": "mechsym.native.evaluate:compiled_all",
    "folder": "mechsym.native.march:folder",
    "marcher": "mechsym.native.march:marcher",
}
__all__ = sorted(_NAMES)
__getattr__ = lazily(__name__, _NAMES)
