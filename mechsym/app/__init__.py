"""The workbench in the browser: sliders from the records of a case, a verdict at once, runs by the commands.

sliders     which values of a case can be moved, and how far
answers     what is shown as a slider moves: the hinge with its limits, curves and moving picture
commands    the slow part: a command of mechsym in a process of its own, its result as rows
saving      the case with moved values as a text; report, drawing and FMU by their commands
uploads     a case from a stranger: what it may hold
door        who may speak to the server: the browser that has its address, no page from elsewhere
view        the page, panels its tabs, markup their tables and charts; server shows it; needs the extra `app`
"""

from mechsym.app.answers import Answer, Plotted, hinge_answer
from mechsym.app.commands import Run, run, tabs
from mechsym.app.server import check, serve
from mechsym.app.sliders import Slider, safe, sliders

__all__ = ["Answer", "Plotted", "Run", "Slider", "check", "hinge_answer", "run", "safe", "serve", "sliders", "tabs"]


def __dir__() -> list[str]:
    return __all__
