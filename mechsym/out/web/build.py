"""C to WebAssembly by the compiler of the extra web, and the page around it."""

import base64
import errno
import html
import importlib.util
import json
import math
import sys
import tempfile
from collections.abc import Callable, Sequence
from importlib import resources
from pathlib import Path

from mechsym.errors import BadInput, MissingExtra
from mechsym.files import Json
from mechsym.jobs.problem import Ready
from mechsym.mechanisms.turning import rules
from mechsym.native.compiler import NoCompiler, call, forecast
from mechsym.native.integrators import dop853_numbers
from mechsym.out.block import Block, Port, block_of
from mechsym.out.fmi.describe import variables
from mechsym.out.text.language_c import model
from mechsym.page import page as template
from mechsym.quantities import record
from mechsym.quantities.display import chosen
from mechsym.quantities.results import part, quantity, result
from mechsym.style import DARK, GRID, QUIET, SERIES, axis_unit

# without the C library of WASI, which takes half a minute to build for a handful of functions: see math.h
_OPTIONS = (
    "-target", "wasm32-freestanding", "-nostdlib", "-fno-builtin", "-mbulk-memory", "-I.", "-std=c99", "-O2", "-s",
    "-ffp-contract=off", "-Wl,--no-entry",
)  # fmt: skip
_FULL = (errno.EAGAIN, errno.ENOMEM)  # no more processes, or no memory for one: of the system, not of the compiler
# parameters that get a slider, with the range as shares of the start; others have a field
_SLIDERS = {
    "p0": (0.9, 1.1), "F0": (0.8, 1.2), "load_torque": (0.5, 1.5), "drive_1": (0.5, 2.0), "k1": (0.5, 2.0),
    "gas_scale": (0.5, 1.2),
}  # fmt: skip
_LETTER = (0.8, 1.25)


@result
class PageChecks:
    """The size of a page."""

    bytes: int = quantity("-")  #: Of the file


@result
class WrittenPage:
    """What `mechsym page` tells."""

    written: list[str] = part()
    checks: PageChecks = part()


def page(block: Block, scenes: Sequence[Json] = ()) -> str:
    """The text of an HTML file that simulates a block; at its head what turns.

    Raises MissingExtra: there is no compiler for WebAssembly that works.
    """
    room = resources.files("mechsym.out.web")
    code = base64.b64encode(webassembly(block)).decode("ascii")
    data = json.dumps(_data(block), separators=(",", ":"), sort_keys=True).replace("<", "\\u003c")
    text = (room / "page.html").read_text(encoding="utf-8")
    title = block.name.replace("&", "&amp;").replace("<", "&lt;")
    text = text.replace("{{title}}", title).replace("{{data}}", data).replace("{{code}}", code)
    for name in ("uplot.css", "uplot.js"):
        kept = resources.files("mechsym.templates") / name
        text = text.replace(f"{{{{{name}}}}}", kept.read_text(encoding="utf-8"))
    return text.replace("{{machine}}", template("machine.html", scenes=scenes, rules=rules()) if scenes else "")


def webassembly(block: Block) -> bytes:
    """The module of a block: exports reset, set, get, advance; imports what it needs of Math."""
    if importlib.util.find_spec("ziglang") is None:
        raise MissingExtra("a page that simulates needs the extra web: pip install 'mechsym[web]'")
    room = resources.files("mechsym.out")
    texts = (("core.h", "c"), ("math.h", "web"), ("page.c", "web"))
    sources = {"model.h": model(block), "method.h": dop853_numbers() + "\n"}
    sources |= {name: (room / folder / name).read_text(encoding="utf-8") for name, folder in texts}
    forecast(sum(map(len, sources.values())))
    with tempfile.TemporaryDirectory() as folder:
        for name, content in sources.items():
            (Path(folder) / name).write_text(content, encoding="utf-8")
        command = [sys.executable, "-m", "ziglang", "cc", *_OPTIONS, "page.c", "-o", "page.wasm"]
        file = Path(folder) / "page.wasm"
        try:
            call(command, "the page", file, Path(folder))
        except NoCompiler as error:
            if getattr(error.__cause__, "errno", None) in _FULL:
                raise error.__cause__ from None  # type: ignore[misc]
            raise MissingExtra(f"the extra web makes no page: {error}") from None
        code = file.read_bytes()
        if not code.startswith(b"\0asm"):
            raise MissingExtra("the extra web makes no WebAssembly; install it again")
        return code


def _data(block: Block) -> Json:
    rows = variables(block)
    # the speed that people ask for: of the shaft whose standstill ends a run, else of the first coordinate
    ends = [stop.of for stop in block.stops if stop.name == "stall"]
    speed = next((s for s in block.states if s.name in ends), block.states[len(block.states) // 2])
    letters = [p for p in block.parameters if not p.about and p.name not in _SLIDERS]  # of the declaration itself
    places = block.states[: len(block.states) // 2]
    turned_on = speed.start if speed.unit == "rad/s" else 0.0
    moves = [s for s in places if s.name != speed.name[:-1] or not turned_on]  # what turns on and on is no curve
    if any(p.name.startswith("gas") for p in block.parameters):
        letters = moves = []  # an engine turns by its gas; fields take its letters
    sliders = [_slider(p, *_SLIDERS[p.name]) for p in block.parameters if p.name in _SLIDERS and p.start]
    sliders += [_slider(p, *_LETTER) for p in letters if p.start]
    if speed.start:  # an elastic shaft starts without twist
        alike = [s.name for s in block.states if s.unit == speed.unit and s.start == speed.start]
        sliders.append(_slider(speed, 0.9, 1.1) | {"about": "speed at the start", "sets": alike})
    # how numbers are shown, in the units that the user chose: by SI unit the factor on a value, and its unit
    sizes = {"s": 0.0, "m": 0.0}
    for port in (*block.states, *block.parameters, *block.outputs):
        sizes[port.unit] = max(sizes.get(port.unit, 0.0), abs(port.start))
    # crank angle after which all curves begin again: a measured four-stroke cycle has two turns and no kinks
    curves = (abs((c.poly.x[-1] - c.poly.x[0]) / c.ratio) for c in block.curves if c.periodic)
    period = max([2 * math.pi, *(k.period for k in block.kinks), *map(float, curves)])

    def palette(of: Callable[[str], str]) -> Json:
        return {"quiet": of(QUIET), "grid": of(GRID), "series": [of(colour) for colour in SERIES]}

    return {
        "name": block.name,
        "about": block.about,
        "references": {v.port.name: v.reference for v in rows},
        "units": {v.port.name: v.port.unit for v in rows},
        "shown": {unit: axis_unit(unit, size) for unit, size in sizes.items()},
        "chosen": bool(chosen()),
        "angle": speed.name[:-1],
        "speed": speed.name,
        "speed_unit": speed.unit,
        "speed_of": f"Speed of {speed.name[:-1]}" if len(places) > 1 and moves else "Speed",
        "moves": [{"unit": unit, "names": [s.name for s in moves if s.unit == unit]} for unit in ("rad", "m")],
        "start_speed": turned_on,
        "sliders": sliders,
        "fields": [{"name": p.name, "unit": p.unit, "start": p.start, "about": p.about} for p in block.parameters],
        "acting": _acting(block),
        "palette": {"light": palette(lambda colour: colour), "dark": palette(DARK.__getitem__)},
        "gas": [p.name for p in block.parameters if p.name.startswith("gas") and p.name.endswith("_scale")],
        "period": period,
        # twenty turns from that speed, or the time of the run it was made from [s]
        "t_end": 20 * 2 * math.pi / turned_on if turned_on else block.t_end,
    }


def _acting(block: Block) -> list[dict[str, str]]:
    """What acts on the machine, for people: a part's name, and the unit of the input that it acts on."""
    units = {port.name: port.unit for port in block.inputs}
    parts = {p.name: p.name.partition("_on_") for p in block.outputs if "_on_" in p.name}
    named = [who for who, _, _ in parts.values()]
    rows = []
    for name, (who, _, on) in parts.items():
        label = (name if named.count(who) > 1 else who).replace("_", " ")
        rows.append({"name": name, "label": label, "unit": units.get(on, "N*m")})
    return rows


def _slider(port: Port, low: float, high: float) -> Json:
    ends = sorted((port.start * low, port.start * high))
    return {
        "name": port.name, "unit": port.unit, "start": port.start, "low": ends[0], "high": ends[1],
        "about": port.about or port.name, "sets": [port.name],
    }  # fmt: skip


_END = "</body>"
# as high as what it shows, which changes with the width of the page
_FIT = "const b=this.contentDocument.body;new ResizeObserver(()=>{this.style.height=b.scrollHeight+48+'px'}).observe(b)"


@record
class LiveRun:
    """A run that a report is to carry."""

    name: str
    about: str
    ready: Callable[[], Ready]  #: makes it ready, or refuses


def with_live(text: str, runs: Sequence[LiveRun]) -> str:
    """The text of a report with a section for each run at its end."""
    head, end, tail = text.rpartition(_END)
    return "".join([head, *map(section, runs), end, tail])


def section(run: LiveRun) -> str:
    """A section in which a machine simulates; where it cannot, what is missing."""
    name = html.escape(run.name)
    title = f'<h2 id="live-{name}">Try it: {name} simulates here</h2>'
    try:
        inner = page(block_of(run.name, run.about, run.ready()))
    except (MissingExtra, BadInput) as missing:
        return f'{title}<p class="note">Not in this report: {html.escape(str(missing))}</p>\n'
    frame = f'<iframe title="{name} simulates" srcdoc="{html.escape(inner)}"'
    return f'{title}{frame} style="width:100%;height:56rem;border:0" onload="{_FIT}"></iframe>\n'
