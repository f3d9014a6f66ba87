"""Pictures of the README, from real runs: `make pictures` draws docs/pictures anew.

hinge.svg, fourbar.svg   turn by themselves; report.png, workbench.png are taken in the Chromium of the machine
"""

import os
import re
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

from mechsym import cases, jobs
from mechsym.files import Json
from mechsym.hinge.plots import elastic_hinge
from mechsym.jobs.machine import mechanism_of
from mechsym.mechanisms.drawing import Shapes, declared
from mechsym.mechanisms.record import listing
from mechsym.mechanisms.turning import rules, scene
from mechsym.out.pdf import chromium

FOLDER = Path(__file__).parent / "pictures"
_FRAMES, _SECONDS, _COLOURS = 48, 4, 256
_LEGEND = {
    "track": "track, cut into a disc that stands still",
    "second_track": "that of the second roller, beside it",
    "roller": "rollers, which run in the tracks",
    "spring": "gas spring between two pistons, turned by the crank",
}


def hinge() -> str:
    """The elastic hinge of the marine engine, turning, with what its parts are."""
    design = jobs.hinge(cases.load("zotov-89"))
    return moving(elastic_hinge(design.guide, design.rollers), "An elastic hinge turning", _LEGEND)


def fourbar() -> str:
    """The four-bar linkage of the page on own mechanisms, turning."""
    text = (Path(__file__).parent / "own-mechanism.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        for name, block in re.findall(r"```\w+ file=(fourbar\.\w+)\n(.*?)```", text, re.S):
            (Path(folder) / name).write_text(block, encoding="utf-8")
        case = cases.load(str(Path(folder) / "fourbar.toml"))
        mechanism = mechanism_of(case)
        drawn = declared(mechanism, listing(mechanism.name))
        assert drawn is not None
        return moving(drawn, "A four-bar linkage turning", {})


def book() -> dict[str, str]:
    """Mechanisms of the same page that stand still, as `mechsym derive --draw` draws them."""
    from mechsym.mechanisms.plots import assembled

    text = (Path(__file__).parent / "own-mechanism.md").read_text(encoding="utf-8")
    shown = set(re.findall(r"\(pictures/(\w+)\.svg\)", text)) - {"fourbar"}
    with tempfile.TemporaryDirectory() as folder:
        for name, block in re.findall(r"```python file=(\w+)\.py\n(.*?)```", text, re.S):
            (Path(folder) / f"{name}.py").write_text(block, encoding="utf-8")
        return {f"{name}.svg": assembled(f"{folder}/{name}.py")[1] for name in sorted(shown)}


def moving(drawn: Callable[[float], Shapes], title: str, legend: dict[str, str]) -> str:
    """A drawing over the crank angle as an SVG that moves without scripts, with a line for each role of a legend."""
    shown = scene(drawn, title, 1.0, _FRAMES)
    width, height = shown["size"]
    lines = [f'<g class="{role}"><line x1="20" x2="90" y1="{height + 40 + 48 * k}" y2="{height + 40 + 48 * k}"/></g>'
             f'<text x="110" y="{height + 52 + 48 * k}">{words}</text>'
             for k, (role, words) in enumerate(legend.items())]  # fmt: skip
    high = height + (30 + 48 * len(legend) if legend else 0)
    text = "text{font:34px sans-serif;fill:#5b6675}@media(prefers-color-scheme:dark){text{fill:#a9b3c0}}"
    body = "\n".join([*map(_shape, shown["shapes"]), *lines])
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {high:g}" role="img"><title>{title}</title>\n'
        f"<style>{rules()}{text}</style>\n{body}\n</svg>\n"
    )


def _shape(shape: Json) -> str:
    moves = [*shape["moves"], shape["moves"][0]] if shape["moves"] else []
    tag, names = ("circle", ("cx", "cy")) if shape["r"] else ("polyline", ("points",))

    def value(frame: list[float], name: str) -> str:
        if tag == "circle":
            return f"{frame[name == 'cy']:g}"
        return " ".join(f"{x:.0f},{y:.0f}" for x, y in zip(frame[::2], frame[1::2], strict=True))

    fixed = "".join(f' {name}="{value(shape["at"], name)}"' for name in names)
    moved = "".join(
        f'<animate attributeName="{name}" dur="{_SECONDS}s" repeatCount="indefinite" '
        f'values="{";".join(value(frame, name) for frame in moves)}"/>'
        for name in names
        if moves
    )
    size = f' r="{shape["r"]}"' if shape["r"] else ""
    return f'<{tag} class="{shape["role"]}"{fixed}{size}>{moved}</{tag}>'


def _small(png: bytes) -> bytes:
    """A picture of a page in few colours."""
    from PIL import Image

    made = BytesIO()
    # by coverage: the median would take thin lines, as the second track, for grey
    reduced = Image.open(BytesIO(png)).convert("RGB").quantize(_COLOURS, method=Image.Quantize.MAXCOVERAGE)
    reduced.save(made, "PNG", optimize=True)
    return made.getvalue()


def shots() -> dict[str, bytes]:
    """First screens of the report and the workbench of the marine engine."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as folder, sync_playwright() as running:
        subprocess.run([sys.executable, "-m", "mechsym", "report", "zotov-89", "--out", folder], check=True)
        browser = running.chromium.launch(executable_path=chromium(), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1000, "height": 1150})
        page.goto((Path(folder) / "zotov-89-report.html").as_uri())
        report = page.screenshot()
        page = browser.new_page(viewport={"width": 1400, "height": 900})
        server, address = _workbench(Path(folder))
        try:
            page.goto(address)
            page.wait_for_function("!document.querySelector('[data-verdict]').textContent.startsWith('designing')")
            page.wait_for_timeout(6000)
            bench = page.screenshot()
        finally:
            server.terminate()
            server.wait()
        browser.close()
    return {"report.png": _small(report), "workbench.png": _small(bench)}


def _workbench(folder: Path) -> tuple["subprocess.Popen[bytes]", str]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    said = folder / "said.txt"
    outside = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST")}
    with said.open("w") as to:
        server = subprocess.Popen([sys.executable, "-m", "mechsym", "app", "zotov-89", "--port", str(port)],
                                  stderr=to, env=outside)  # fmt: skip
    for _ in range(600):
        words = said.read_text().split()
        try:
            if words:
                urllib.request.build_opener(urllib.request.HTTPCookieProcessor()).open(words[0], timeout=5).close()
                return server, words[0]
        except OSError:
            pass
        time.sleep(0.2)
    server.terminate()
    raise SystemExit("the workbench does not answer")


def main() -> None:
    """Write all of them."""
    FOLDER.mkdir(exist_ok=True)
    for name, text in (("hinge.svg", hinge()), ("fourbar.svg", fourbar()), *book().items()):
        (FOLDER / name).write_text(text, encoding="utf-8")
    for name, data in shots().items():
        (FOLDER / name).write_bytes(data)


if __name__ == "__main__":
    main()
