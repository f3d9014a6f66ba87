"""The server of the workbench, for this machine alone, and its check without a browser."""

import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable

from mechsym import cases
from mechsym.app.answers import hinge_answer
from mechsym.app.commands import tabs
from mechsym.app.door import TOKEN, Door, token
from mechsym.app.sliders import sliders
from mechsym.app.view import Page
from mechsym.errors import BadInput
from mechsym.files import Json

_HOST = "127.0.0.1"
_WAIT = 60.0  # for the server in `check` [s]
_LOADED = 60.0  # a page that a busy machine keeps waiting so long is still the same page, with its sliders [s]


def serve(name: str, port: int, tell: Callable[[str], None] = lambda address: None) -> None:
    """Serve the workbench of a case on this machine alone, until it is stopped; `tell` takes its address before."""
    try:
        from fastapi import Request
        from nicegui import app, ui
    except ImportError:
        raise BadInput("the workbench needs the extra app: pip install 'mechsym[app]'") from None
    cases.load(name)  # a bad case is refused before the server starts

    def page(request: Request) -> None:
        Page(name, dict(request.query_params)).build()

    ui.page("/")(page)
    secret = token()
    app.add_middleware(Door, hosts=(f"{_HOST}:{port}", f"localhost:{port}"), token=secret)
    tell(f"http://{_HOST}:{port}/?{TOKEN}={secret}")
    ui.run(
        host=_HOST, port=port, title="mechsym", reload=False, show=False, show_welcome_message=False,
        reconnect_timeout=_LOADED,
    )  # fmt: skip


def check(name: str, port: int) -> Json:
    """Start the workbench and read its page without a browser: its case, sliders, tabs and the verdict of the hinge."""
    port = port or _free()
    case = cases.load(name)
    server = subprocess.Popen(
        [sys.executable, "-m", "mechsym", "app", name, "--port", str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        text = _page_of(server)
    finally:
        server.kill()  # it has nothing to lose, and would take its time
        server.wait()
    if case.name not in text:
        raise BadInput(f"the page of the workbench does not show the case {name}")
    words = hinge_answer(name, {}).words if "hinge" in tabs(case) else None
    return {"case": case.name, "sliders": len(sliders(case)), "tabs": list(tabs(case)), "hinge": words}


def _free() -> int:
    with socket.socket() as free:
        free.bind((_HOST, 0))
        return int(free.getsockname()[1])


def _page_of(server: "subprocess.Popen[str]") -> str:
    """The page at the address that the server says first; what it says without one is why it ended."""
    first = server.stderr.readline().strip() if server.stderr else ""
    if not first.startswith("http"):
        rest = server.stderr.read().strip() if server.stderr else ""
        said = rest.splitlines()[-1] if rest else first
        raise BadInput(said.removeprefix("mechsym: ") or "the workbench ended at once")
    browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
    until = time.monotonic() + _WAIT
    while time.monotonic() < until and server.poll() is None:
        try:
            with browser.open(first.split()[0], timeout=5) as answer:
                return str(answer.read().decode())
        except OSError:
            time.sleep(0.2)
    raise BadInput(f"the workbench did not answer within {_WAIT:g} s")
