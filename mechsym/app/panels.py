"""The tabs of the workbench: the hinge at once, a command as soon as its sliders rest, a formula of one's own."""

import asyncio
import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from mechsym.app import commands
from mechsym.app.answers import Answer, Plotted, hinge_answer, machine, moving, reading
from mechsym.app.commands import Run
from mechsym.app.markup import bars, chart, findings, frame, run_groups, run_head, table

if TYPE_CHECKING:
    from nicegui.element import Element
    from nicegui.elements.echart import EChart

AUDIT = "audit"
_REST = 0.4  # sliders rest so long before what is slow begins [s]
_PICTURE = 1.2  # and so long before the picture is drawn anew: it would keep the next answer waiting [s]


class Panel:
    """One tab: built where it stands, told what values there are."""

    def __init__(self, ui: Any, name: str, path: str, mechanism: str) -> None:
        self.ui, self.name, self.path, self.mechanism = ui, name, path, mechanism
        self.drawn: dict[str, EChart] = {}
        self.charts: Any = None
        self.build()

    def build(self) -> None:
        """Lay out what it holds."""

    async def show(self, values: Mapping[str, float], newest: Callable[[], bool]) -> None:
        """Show what belongs to values [SI unit of their key], as long as they are the newest."""

    def pin(self) -> None:
        """Keep what is shown beside what comes."""

    def draw(self, curves: tuple[Plotted, ...], pinned: tuple[Plotted, ...]) -> None:
        """Curves as charts, those of one chart together, pinned ones dashed."""
        charts: dict[str, list[tuple[Plotted, str]]] = {}
        for curve in curves:
            charts.setdefault(curve.chart, []).append((curve, "solid"))
        for curve in pinned:
            charts.setdefault(curve.chart, []).append((curve, "dashed"))
        for name in [n for n in self.drawn if n not in charts]:
            self.drawn.pop(name).delete()
        for name, options in charts.items():
            if name in self.drawn:
                self.drawn[name].options.clear()
                self.drawn[name].options.update(chart(options))
                self.drawn[name].update()
            else:
                with self.charts:
                    self.drawn[name] = self.ui.echart(chart(options)).classes("h-64 w-full")
                self.linked(self.drawn[name], options[0][0])

    def linked(self, element: "Element", curve: Plotted) -> None:
        """Link the cursor of a new chart with the picture."""


class HingePanel(Panel):
    """Verdict, limits, curves and the turning picture; the cursor of each is that of all."""

    def build(self) -> None:
        """Lay out what it holds."""
        ui = self.ui
        self.one = asyncio.Lock()
        self.answer: Answer | None = None
        self.pinned: Answer | None = None
        with ui.element("div").classes("w-full grid gap-6 grid-cols-1 lg:grid-cols-2 items-start"):
            self.stage = ui.html("", sanitize=False).classes("w-full")
            with ui.column().classes("gap-2"):
                self.verdict = ui.label("designing the hinge ..").classes("text-lg").props('data-verdict="1"')
                self.first = ui.html("", sanitize=False).props('data-findings="1"')
                self.doubts = ui.label().classes("text-orange-9 whitespace-pre-line")
                self.bars = ui.html("", sanitize=False)
        self.charts = ui.element("div").classes("w-full grid gap-2 grid-cols-1 sm:grid-cols-2 xl:grid-cols-3")
        self.rows = ui.html("", sanitize=False)

    async def show(self, values: Mapping[str, float], newest: Callable[[], bool]) -> None:
        """The answer at once, the picture when the sliders rest."""
        from nicegui import run

        async with self.one:  # one answer at a time; what has been overtaken while it waited is left out
            answer = await run.io_bound(hinge_answer, self.path, values) if newest() else None
        if answer is None:
            return
        self._show(answer)
        await asyncio.sleep(_REST)
        if newest():
            # the verdict above has said the first of them
            others = [one for one in await run.io_bound(answer.findings) if one.words not in answer.words]
            self.first.set_content(findings(others))
        await asyncio.sleep(_PICTURE - _REST)
        if newest():
            picture = await run.io_bound(moving, answer, "mechanism and guide, to scale")
            self.stage.set_content("" if picture is None else frame(picture, "mechanism and guide", answer.turns))

    def _show(self, answer: Answer) -> None:
        self.answer = answer
        self.verdict.text = answer.words
        self.verdict.classes(replace=f"text-lg text-{'green' if answer.good else 'red'}-7")
        self.doubts.text = "\n".join(f"doubt: {d}" for d in answer.doubts)
        self.rows.set_content(table(answer.rows, self.pinned.rows if self.pinned else ()))
        self.bars.set_content(bars(answer))
        self.draw(answer.curves, self.pinned.curves if self.pinned else ())

    def pin(self) -> None:
        """Keep what is shown beside what comes."""
        self.pinned = self.answer

    def linked(self, element: "Element", curve: Plotted) -> None:
        """Link the cursor of a new chart with the picture."""
        ratio = self.answer.ratio if self.answer and "guide" in curve.x_name else 1.0
        self.ui.run_javascript(f"mechsymLink({json.dumps(element.id)}, {json.dumps(ratio)})")


class RunPanel(Panel):
    """A command of mechsym: run again when the sliders rest, or by its button where it takes long."""

    def build(self) -> None:
        """Lay out what it holds."""
        ui = self.ui
        self.values: dict[str, float] = {}
        self.last: Run | None = None
        self.last_of: dict[str, float] | None = None
        self.pinned: Run | None = None
        self.running: asyncio.Task[Run] | None = None
        self.drawn_for: dict[str, float] | None = None
        self.above()
        with ui.element("div").classes("w-full").props(f'data-run="{self.name}"'):
            with ui.element("div").classes("w-full grid gap-6 grid-cols-1 lg:grid-cols-2 items-start"):
                self.stage = ui.html("", sanitize=False).classes("w-full")
                with ui.column().classes("gap-2"):
                    with ui.row().classes("items-center"):
                        ui.button(f"run mechsym {self.name}", on_click=self.start)
                        self.busy = ui.spinner(size="sm")
                        self.note = ui.label().classes("mechsym-note")
                    self.first = ui.html("", sanitize=False)
            self.charts = ui.element("div").classes("w-full grid gap-2 grid-cols-1 sm:grid-cols-2 xl:grid-cols-3 mt-4")
            self.shown = ui.html("", sanitize=False).classes("w-full")
        self.busy.visible = False
        ui.timer(1.0, self._tick)
        self.seconds = 0

    def above(self) -> None:
        """What stands above the button."""

    def line(self) -> list[str]:
        """The command as typed."""
        return commands.words(self.name, self.path, self.values)

    async def show(self, values: Mapping[str, float], newest: Callable[[], bool]) -> None:
        """Run the command anew where it is fast; else say that what is shown has other values."""
        self.values = dict(values)
        if self.drawn_for is None:  # the machine first
            await self._turn(dict(values))
        if self.last_of == self.values:
            self.note.text = ""
        elif self.name not in commands.LIVE:
            self.note.text = "of other values: run it again" if self.last else ""
        else:
            await asyncio.sleep(_REST)
            if newest():
                await self.start()
        if newest():
            await self._turn(dict(values))

    async def _turn(self, values: dict[str, float]) -> None:
        """Draw the machine of these values, turning."""
        from nicegui import run

        if self.drawn_for != values:
            self.drawn_for = values
            picture = await run.io_bound(machine, self.path, values)
            self.stage.set_content("" if picture is None else frame(picture, "the machine"))
            self.stage.visible = picture is not None

    async def start(self) -> None:
        """Run the command, and show its part of the report beneath; a run that is still on its way ends."""
        from nicegui import run

        if self.running is not None and not self.running.done():
            self.running.cancel()
        asked, self.seconds, self.busy.visible = dict(self.values), 0, True
        self.running = mine = asyncio.ensure_future(commands.run(self.line()))
        try:
            self.last, self.last_of = await mine, asked
        except asyncio.CancelledError:
            return
        self.busy.visible, self.note.text = False, ""
        self._show(self.last)
        page = await run.io_bound(reading, self.path, asked, self.name)
        if page and self.last_of == asked:
            self.last = replace(self.last, page=page)
            self._show(self.last)

    def _tick(self) -> None:
        if self.busy.visible:
            self.seconds += 1
            self.note.text = f"running for {self.seconds} s"

    def _show(self, run: Run) -> None:
        pinned = self.pinned
        self.first.set_content(run_head(run, pinned))
        self.shown.set_content(run_groups(run, pinned))
        self.draw(run.curves, pinned.curves if pinned else ())

    def pin(self) -> None:
        """Keep what is shown beside what comes."""
        self.pinned = self.last
        if self.last:
            self._show(self.last)


class AuditPanel(RunPanel):
    """A formula of one's own against a derivation: verdict and repair."""

    def above(self) -> None:
        """What stands above the button."""
        ui = self.ui
        self.formula = ui.input("formula", placeholder="r*(1 - cos(phi)) + r**2*sin(phi)**2/(2*l)").classes("w-full")
        self.against = ui.input("against", value=commands.against(self.mechanism)).classes("w-full max-w-96")
        self.letters = ui.input("letters, as r=r1+r2,l=l1+l2").classes("w-full max-w-96")

    def line(self) -> list[str]:
        """The command as typed."""
        words = ["audit", "--formula", self.formula.value or "", "--against", self.against.value or ""]
        return [*words, "--letters", self.letters.value] if self.letters.value else words

    async def show(self, values: Mapping[str, float], newest: Callable[[], bool]) -> None:
        """No slider moves a proof."""
