"""The page of the workbench: sliders to the left, what they do to the right. Each browser has a state of its own."""

import json
import time
from collections.abc import Mapping
from functools import partial
from importlib import resources
from typing import TYPE_CHECKING
from urllib.parse import urlencode

from mechsym import cases
from mechsym.app import commands, uploads
from mechsym.app.idle import idle
from mechsym.app.panels import AUDIT, AuditPanel, HingePanel, Panel, RunPanel
from mechsym.app.saving import FILES, case_text, file_of
from mechsym.app.sliders import Slider, safe, sliders
from mechsym.app.told import pretty
from mechsym.errors import BadInput
from mechsym.quantities.display import quantity_text

if TYPE_CHECKING:
    from nicegui.element import Element
    from nicegui.events import UploadEventArguments

_ONE_MOVE = 1.0  # moves of one slider that follow each other so fast are one step of undo [s]


class Page:
    """The state of one browser: moved values, what they were before, which tab is open, what is pinned."""

    def __init__(self, name: str, query: dict[str, str]) -> None:
        from nicegui import ui

        self.ui, self.own = ui, name
        self.name, self.tab = query.pop("case", name), query.pop("tab", "")
        self.refused = ""
        try:
            self.values = safe(self.name, name, query)
        except BadInput as refused:
            self.name, self.values, self.refused = name, {}, str(refused)
        self.path = uploads.kept(self.name) or self.name
        self.before: list[dict[str, float]] = []
        self.moved = 0
        self.last = ("", 0.0)
        self.controls: dict[str, Element] = {}
        self.sections: dict[str, Element] = {}
        self.rows: dict[str, Element] = {}
        self.panels: dict[str, Panel] = {}

    def build(self) -> None:
        """Lay the page out and fill it."""
        ui, case = self.ui, cases.load(self.path)
        ui.dark_mode(None)
        style, script = ((resources.files("mechsym.app") / f).read_text("utf-8") for f in ("view.css", "linked.js"))
        ui.add_head_html(f"<style>\n{style}</style>")
        ui.add_body_html(f"<script>{script}</script>")
        self.tabs = (*commands.tabs(case), AUDIT)
        self.tab = self.tab if self.tab in self.tabs else self.tabs[0]
        self.knobs = {s.key: s for s in sliders(case)}
        self.idle: dict[str, Mapping[str, str]] = {}
        self.read: dict[str, set[str]] = {}
        self._head()
        ui.label(case.about).classes("opacity-70")
        with ui.element("div").classes("w-full flex flex-col md:flex-row gap-4 items-start").style("flex-wrap: nowrap"):
            self.left = ui.column().classes("w-full md:w-80 shrink-0 order-2 md:order-1 gap-0 mechsym-sliders")
            with self.left:
                fold = ui.button("values").props("flat dense no-caps").classes("w-full mechsym-fold")
                fold.on("click", js_handler="e => e.currentTarget.parentElement.classList.toggle('open')")
                self._sliders()
            with ui.column().classes("w-full grow min-w-0 order-1 md:order-2"):
                self._views(case.mechanism)
        ui.timer(0.0, self.opened, once=True)

    def _head(self) -> None:
        ui = self.ui
        with ui.row().classes("w-full items-center gap-1"):
            ui.label("mechsym").classes("text-h5 mr-2")
            names = sorted({*cases.names(), self.own, self.name})
            other = ui.select(names, value=self.name, label="case").classes("w-48 mr-2")
            other.on_value_change(lambda e: ui.navigate.to("/?" + urlencode({"case": e.value})))
            ui.button("undo", on_click=self.undo).props("flat dense")
            ui.button("pin", on_click=self.pin).props("flat dense").tooltip("keep this design beside the next ones")
            ui.button("reset", on_click=lambda: self.go({})).props("flat dense")
            ui.button("case.toml", on_click=self.save).props("flat dense")
            for kind in FILES if "hinge" in self.tabs else ():
                ui.button(kind, on_click=partial(self.file, kind)).props("flat dense")
            with ui.dialog() as box, ui.card():
                ui.label("Case file (TOML): numbers, choices and built-in names only")
                ui.upload(on_upload=self.upload, max_file_size=uploads.LARGEST, auto_upload=True).props("accept=.toml")
            ui.button("upload", on_click=box.open).props("flat dense")

    def _sliders(self) -> None:
        ui = self.ui
        keys: dict[str, list[str]] = {}
        for key in self.knobs:
            keys.setdefault(key.partition(".")[0], []).append(key)
        for section, own in keys.items():
            opened = section in ("spring", "operation", "guide", "drive")
            box = ui.expansion(section, value=opened).classes("w-full").props("dense")
            self.sections[section] = box
            # what is closed is built when it is opened: every element costs time whenever anything changes
            if opened:
                self._fill(section, own)
            else:
                box.on_value_change(partial(self._unfold, section, own))
        self.still = ui.label().classes("text-xs mechsym-note")

    def _fill(self, section: str, own: list[str]) -> None:
        with self.sections[section]:
            for key in own:
                self._slider(self.knobs[key])

    def _unfold(self, section: str, own: list[str], _: object) -> None:
        if own[0] not in self.controls:
            self._fill(section, own)
            self._offer()

    def _slider(self, knob: Slider) -> None:
        ui, value = self.ui, self.values.get(knob.key, knob.value)
        self.rows[knob.key] = ui.row().classes("w-full items-center gap-x-2 gap-y-0")
        with self.rows[knob.key]:
            with ui.row().classes("w-full justify-between gap-2 flex-nowrap"):
                ui.label(knob.label).classes("text-xs break-words").props["title"] = knob.key
                shown = ui.label(told_value(knob, value)).classes("shrink-0 text-sm whitespace-nowrap mechsym-value")
            moved = ui.slider(min=min(knob.low, value), max=max(knob.high, value), step=knob.step, value=value)
            moved.classes("grow").props(f'data-key="{knob.key}" aria-label="{knob.label}"')
        moved.on_value_change(lambda e: self.move(knob.key, float(e.value)))
        self.controls[knob.key] = (moved, shown)

    def _views(self, mechanism: str) -> None:
        ui = self.ui
        with ui.tabs(value=self.tab).props("dense align=left outside-arrows mobile-arrows").classes("w-full") as tabs:
            for name in self.tabs:
                ui.tab(name)
        tabs.on_value_change(lambda e: self.turn_to(str(e.value)))
        with ui.tab_panels(tabs, value=self.tab, animated=False, keep_alive=True).classes("w-full"):
            for name in self.tabs:
                with ui.tab_panel(name).classes("px-0"):
                    kind = {"hinge": HingePanel, AUDIT: AuditPanel}.get(name, RunPanel)
                    self.panels[name] = kind(ui, name, self.path, mechanism)

    async def turn_to(self, tab: str) -> None:
        """Another tab has been opened."""
        self.tab = tab
        await self.opened()

    async def opened(self) -> None:
        """Show the sliders that can move what the open tab says, and what it says."""
        from nicegui import run

        tab = self.tab
        if tab not in self.idle:
            self.idle[tab], self.read[tab] = await run.io_bound(self._said, tab) or ({}, set())
        self._offer()
        await self.update()

    def _said(self, tab: str) -> tuple[Mapping[str, str], set[str]]:
        """Keys that move nothing in a tab, and the sections that it reads."""
        case = cases.load(self.path)
        return idle(case, tab), commands.reads(tab, case)

    def _offer(self) -> None:
        """Show a slider only where it moves something; say of the others why it does not."""
        still, read = self.idle.get(self.tab, {}), self.read.get(self.tab, set())
        here = [key for key in self.knobs if key.partition(".")[0] in read]
        for section, box in self.sections.items():
            box.visible = any(key.startswith(f"{section}.") and key not in still for key in here)
        self.left.visible = bool(here)
        for key, row in self.rows.items():
            row.visible = key not in still
        offered: dict[str, list[str]] = {}
        for key in here:
            if key in still:
                offered.setdefault(still[key], []).append(self.knobs[key].label)
        left_out = "; ".join(f"{', '.join(keys)} ({why})" for why, keys in offered.items())
        self.still.text = f"not here: {left_out}" if left_out else ""

    async def move(self, key: str, value: float) -> None:
        """One slider has moved: the newest place wins."""
        if value == self.values.get(key, self.knobs[key].value):
            return
        if key != self.last[0] or time.monotonic() - self.last[1] > _ONE_MOVE:
            self.before.append(dict(self.values))
        self.last = (key, time.monotonic())
        self.values = {**self.values, key: value}
        self.controls[key][1].text = told_value(self.knobs[key], value)
        self.moved += 1
        await self.update()

    def undo(self) -> None:
        """Back to what was before the last move."""
        self.last = ("", 0.0)
        if self.before:
            self.go(self.before.pop(), keep=False)

    def go(self, values: dict[str, float], keep: bool = True) -> None:
        """Set all values at once."""
        if keep:
            self.before.append(dict(self.values))
        self.values = dict(values)
        self.moved += 1
        for key, (moved, shown) in self.controls.items():
            value = values.get(key, self.knobs[key].value)
            moved.value, shown.text = value, told_value(self.knobs[key], value)
        self.refresh()

    def pin(self) -> None:
        """Keep what is shown beside what comes."""
        for panel in self.panels.values():
            panel.pin()
        self.refresh()

    def save(self) -> None:
        """The case with the moved values as a file that loads."""
        try:
            text = case_text(self.path, self.values)
        except BadInput as refused:
            self.ui.notify(str(refused), type="negative")
        else:
            self.ui.download(text.encode(), f"{self.name}-changed.toml")

    async def upload(self, event: "UploadEventArguments") -> None:
        """Take a case in, as from a stranger."""
        try:
            name = uploads.keep(await event.file.read())
        except BadInput as refused:
            self.ui.notify(str(refused), type="negative", multi_line=True)
        else:
            self.ui.navigate.to("/?" + urlencode({"case": name}))

    async def file(self, kind: str) -> None:
        """Make a file with its command and hand it over."""
        self.ui.notify(f"{kind} of {self.name} is being made")
        try:
            name, data = await file_of(kind, self.path, self.values)
        except BadInput as refused:
            self.ui.notify(str(refused), type="negative")
        else:
            self.ui.download(data, f"{self.name}-{name}")

    def refresh(self) -> None:
        """Compute what is known at once and show it."""
        self.ui.timer(0.0, self.update, once=True)

    async def update(self) -> None:
        """Show in the open tab what belongs to the values as they stand; the address keeps both."""
        state = {"case": self.name, "tab": self.tab, **{k: repr(v) for k, v in self.values.items()}}
        self.ui.run_javascript(f"mechsymAddress('/?' + {json.dumps(urlencode(state))})")
        if self.refused:
            self.ui.notify(self.refused, type="negative")
            self.refused = ""
        asked = self.moved
        await self.panels[self.tab].show(dict(self.values), lambda: asked == self.moved)


def told_value(knob: Slider, value: float) -> str:
    """A value of a slider in the unit of people [unit of the slider]."""
    return pretty(quantity_text(value, knob.unit, 4))
