"""Machine code for generated functions: evaluation, integration and marching in emitted C, with a way without it.

tape.py       a CasADi function as plain instructions        kernels.py   equal parts rolled into loops
emit.py       C text                                         cache.py     compiled files, checked before use
evaluate.py   scalar and batch calls                         fallback.py  the same without a compiler
"""

from mechsym.native.evaluate import Compiled, compiled, compiled_all

__all__ = ["Compiled", "compiled", "compiled_all"]
