"""The page of the workbench: sliders to the left, what they do to the right. Each browser has a state of its own."""

import asyncio
import json
from functools import partial
from typing import Any
from urllib.parse import urlencode

from mechsym import cases
from mechsym.app import commands
from mechsym.app.answers import Answer, Plotted, hinge_answer, moving
from mechsym.app.markup import bars, chart, frame, run_table, table
from mechsym.app.saving import FILES, case_text, file_of
from mechsym.app.sliders import Slider, safe, sliders
from mechsym.errors import BadInput

_PAUSE = 0.04  # a slider rests so long before the page is computed [s]
_REST = 0.4  # and so long before the moving picture is drawn anew [s]


class Page:
    """The state of one browser: moved values, what they were before, what is pinned, what runs."""

    def __init__(self, name: str, query: dict[str, str]) -> None:
        from nicegui import ui

        self.ui, self.own = ui, name
        self.name = query.pop("case", name)
        self.refused = ""
        try:
            self.values = safe(self.name, name, query)
        except BadInput as refused:
            self.name, self.values, self.refused = name, {}, str(refused)
        self.before: list[dict[str, float]] = []
        self.pinned: Answer | None = None
        self.moved = 0
        self.running: asyncio.Task[Any] | None = None
        self.controls: dict[str, Any] = {}

    def build(self) -> None:
        """Lay the page out and fill it."""
        ui, case = self.ui, cases.load(self.name)
        self.tabs = commands.tabs(case)
        self.knobs = {s.key: s for s in sliders(case)}
        with ui.row().classes("w-full items-center no-wrap"):
            ui.label(f"mechsym: {self.name}").classes("text-h5")
            names = sorted({*cases.names(), self.own})
            other = ui.select(names, value=self.name, label="case").classes("w-48")
            other.on_value_change(lambda e: ui.navigate.to("/?" + urlencode({"case": e.value})))
            ui.button("undo", on_click=self.undo).props("flat dense")
            ui.button("pin", on_click=self.pin).props("flat dense").tooltip("keep this design beside the next ones")
            ui.button("reset", on_click=lambda: self.go({})).props("flat dense")
            ui.button("case.toml", on_click=self.save).props("flat dense")
            for kind in FILES if "hinge" in self.tabs else ():
                ui.button(kind, on_click=partial(self.file, kind)).props("flat dense")
        ui.label(case.about).classes("text-grey-8")
        with ui.row().classes("w-full no-wrap items-start"):
            with ui.column().classes("w-96 shrink-0"):
                self._sliders()
            with ui.column().classes("grow min-w-0"):
                self._views()
        self.refresh()

    def _sliders(self) -> None:
        ui = self.ui
        sections: dict[str, list[str]] = {}
        for key in self.knobs:
            sections.setdefault(key.partition(".")[0], []).append(key)
        for section, keys in sections.items():
            with (
                ui.expansion(section, value=section in ("spring", "operation", "guide"))
                .classes("w-full")
                .props("dense")
            ):
                for key in keys:
                    self._slider(self.knobs[key])

    def _slider(self, knob: Slider) -> None:
        ui, value = self.ui, self.values.get(knob.key, knob.value)
        unit = "" if knob.unit == "-" else f" [{knob.unit}]"
        with ui.row().classes("w-full items-center no-wrap gap-2"):
            ui.label(f"{knob.label}{unit}").classes("w-40 text-sm").tooltip(knob.about or knob.key)
            moved = ui.slider(min=min(knob.low, value), max=max(knob.high, value), step=knob.step, value=value)
            moved.classes("grow").props(f'data-key="{knob.key}"')
            shown = ui.label(f"{value:.4g}").classes("w-16 text-right text-sm")
        moved.on_value_change(lambda e: self.move(knob.key, float(e.value)))
        self.controls[knob.key] = (moved, shown)

    def _views(self) -> None:
        ui = self.ui
        with ui.tabs().props("dense align=left") as tabs:
            for name in (*self.tabs, "audit"):
                ui.tab(name)
        self.panels: dict[str, Any] = {}
        with ui.tab_panels(tabs, value=(*self.tabs, "audit")[0]).classes("w-full"):
            for name in (*self.tabs, "audit"):
                with ui.tab_panel(name):
                    self.panels[name] = self._audit() if name == "audit" else self._command(name)

    def _command(self, name: str) -> Any:
        """The tab of a command: what is known at once where there is such a thing, and its run."""
        ui = self.ui
        if name == "hinge":
            self.verdict = ui.label().classes("text-h6").props('data-verdict="1"')
            self.doubts = ui.label().classes("text-orange-9 whitespace-pre-line")
            with ui.row().classes("w-full no-wrap items-start"):
                self.rows, self.bars = ui.html("", sanitize=False), ui.html("", sanitize=False)
            self.charts = ui.row().classes("w-full")
            self.drawn: dict[str, Any] = {}
            self.stage = ui.html("", sanitize=False).classes("w-full")
        with ui.row().classes("items-center"):
            start = ui.button(f"run mechsym {name}", on_click=lambda: self.start(name))
            busy = ui.spinner(size="sm")
        busy.visible = False
        return start, busy, ui.html("", sanitize=False).classes("w-full")

    def _audit(self) -> Any:
        ui = self.ui
        self.formula = ui.input("formula", placeholder="r*(1 - cos(phi)) + r**2*sin(phi)**2/(2*l)").classes("w-full")
        self.against = ui.input("against", value=f"{cases.load(self.name).mechanism}.x").classes("w-96")
        with ui.row().classes("items-center"):
            start = ui.button("run mechsym audit", on_click=lambda: self.start("audit"))
            busy = ui.spinner(size="sm")
        busy.visible = False
        return start, busy, ui.html("", sanitize=False).classes("w-full")

    async def move(self, key: str, value: float) -> None:
        """One slider has moved: the newest place wins."""
        if value == self.values.get(key, self.knobs[key].value):
            return
        self.before.append(dict(self.values))
        self.values = {**self.values, key: value}
        self.controls[key][1].text = f"{value:.4g}"
        self.moved += 1
        mine = self.moved
        await asyncio.sleep(_PAUSE)
        if mine == self.moved:
            await self.update()

    def undo(self) -> None:
        """Back to what was before the last move."""
        if self.before:
            self.go(self.before.pop(), keep=False)

    def go(self, values: dict[str, float], keep: bool = True) -> None:
        """Set all values at once."""
        if keep:
            self.before.append(dict(self.values))
        self.values = dict(values)
        for key, (moved, shown) in self.controls.items():
            value = values.get(key, self.knobs[key].value)
            moved.value, shown.text = value, f"{value:.4g}"
        self.refresh()

    def pin(self) -> None:
        """Keep what is shown beside what comes."""
        self.pinned = hinge_answer(self.name, self.values) if "hinge" in self.tabs else None
        self.refresh()

    def save(self) -> None:
        """The case with the moved values as a file that loads."""
        try:
            text = case_text(self.name, self.values)
        except BadInput as refused:
            self.ui.notify(str(refused), type="negative")
        else:
            self.ui.download(text.encode(), f"{self.name}-changed.toml")

    async def file(self, kind: str) -> None:
        """Make a file with its command and hand it over."""
        self.ui.notify(f"{kind} of {self.name} is being made")
        try:
            name, data = await file_of(kind, self.name, self.values)
        except BadInput as refused:
            self.ui.notify(str(refused), type="negative")
        else:
            self.ui.download(data, name)

    def refresh(self) -> None:
        """Compute what is known at once and show it."""
        self.ui.timer(0.0, self.update, once=True)

    async def update(self) -> None:
        """Show the answer to the values as they stand, unless they have moved on."""
        from nicegui import run

        query = urlencode({"case": self.name, **{k: repr(v) for k, v in self.values.items()}})
        self.ui.run_javascript(f"history.replaceState(null, '', '/?' + {json.dumps(query)})")
        if self.refused:
            self.ui.notify(self.refused, type="negative")
            self.refused = ""
        if "hinge" not in self.tabs:
            return
        asked = self.moved
        answer = await run.io_bound(hinge_answer, self.name, dict(self.values))
        if asked == self.moved and answer is not None:
            self._show(answer)
            await asyncio.sleep(_REST)
            if asked == self.moved:
                picture = await run.io_bound(moving, answer, self.name)
                self.stage.set_content("" if picture is None else frame(picture, self.name))

    def _show(self, answer: Answer) -> None:
        self.verdict.text = ("can be built: " if answer.good else "cannot be built: ") + answer.words
        self.verdict.classes(replace=f"text-h6 text-{'green' if answer.good else 'red'}-9")
        self.doubts.text = "\n".join(f"doubt: {d}" for d in answer.doubts)
        self.rows.set_content(table(answer, self.pinned))
        self.bars.set_content(bars(answer))
        self._draw(answer)

    def _draw(self, answer: Answer) -> None:
        charts: dict[str, list[tuple[Plotted, str]]] = {}
        for curve in answer.curves:
            charts.setdefault(curve.chart, []).append((curve, "solid"))
        for curve in self.pinned.curves if self.pinned else ():
            charts.setdefault(curve.chart, []).append((curve, "dashed"))
        for name, curves in charts.items():
            if name not in self.drawn:
                with self.charts:
                    self.drawn[name] = (
                        self.ui.echart(chart(curves)).classes("h-64").style("width: 31%; min-width: 18rem")
                    )
            else:
                self.drawn[name].options.clear()
                self.drawn[name].options.update(chart(curves))
                self.drawn[name].update()

    async def start(self, name: str) -> None:
        """Run the command of a tab; a run that is still on its way ends."""
        if self.running is not None and not self.running.done():
            self.running.cancel()
        line = commands.words(name, self.name, self.values)
        if name == "audit":
            line = ["audit", "--formula", self.formula.value or "", "--against", self.against.value or ""]
        _, busy, shown = self.panels[name]
        busy.visible = True
        self.running = asyncio.ensure_future(commands.run(line))
        try:
            shown.set_content(run_table(await self.running))
        except asyncio.CancelledError:
            shown.set_content("")
        busy.visible = False
