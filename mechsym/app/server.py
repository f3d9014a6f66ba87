"""The server of the workbench, for this machine alone, and its check without a browser.

Who may speak to it: the browser that was given its address, and no page from elsewhere. A server on this machine can
be reached by every page that the browser shows: by a name that is made to point here (rebinding), or by a socket, which
no same-origin rule keeps back. So the host that is asked for must be this machine, the page that asks must be the
workbench's own, and both must know the token of the address.
"""

import hmac
import secrets
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Awaitable, Callable, Mapping
from urllib.parse import parse_qsl, urlencode

from mechsym import cases
from mechsym.app.answers import hinge_answer
from mechsym.app.commands import tabs
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


Scope = Json
Message = Json
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

TOKEN = "token"  # of the address

# the page's framework compiles its templates in the browser
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; worker-src 'self' blob:; object-src 'none'; "
    "base-uri 'self'; form-action 'self'; frame-ancestors 'none'"
)
_HEADERS = (
    (b"content-security-policy", _POLICY.encode()),
    (b"x-frame-options", b"DENY"),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
)
_ASK = """<!doctype html><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>mechsym</title><body style="font: 16px/1.5 system-ui, sans-serif; max-width: 34em; margin: 3em auto">
<h1>Which workbench?</h1><p>This address has no token, or one of another run. Open the address that
<code>mechsym app</code> printed in its terminal, or paste its token here.</p>
<form><input name="token" autocomplete="off" autofocus> <button>Open</button></form>"""


class Door:
    """An ASGI application that lets through to another one what comes from its own page.

    app: the application behind. hosts: names with port under which this machine may be asked for. token: what the
    address must hold once; a cookie holds it from then on.
    """

    def __init__(self, app: App, hosts: tuple[str, ...], token: str) -> None:
        self.app, self.hosts, self.token = app, hosts, token
        self.cookie = f"mechsym_{hosts[0].rpartition(':')[2]}"  # cookies do not tell ports apart

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            return await self.app(scope, receive, send)
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        query = dict(parse_qsl(scope.get("query_string", b"").decode("latin-1"), keep_blank_values=True))
        if reason := self._foreign(headers):
            return await _refuse(scope, send, reason)
        if self._knows(query.get(TOKEN, "")) and scope["type"] == "http":
            return await self._welcome(query, send)
        if not self._kept(headers):
            return await _refuse(scope, send, _ASK)
        return await self.app(scope, receive, _guarded(send))

    def _foreign(self, headers: Mapping[str, str]) -> str:
        if headers.get("host", "") not in self.hosts:
            return "this server answers for this machine alone"
        origin = headers.get("origin")
        if origin is not None and origin not in {f"http://{host}" for host in self.hosts}:
            return "a page from elsewhere may not ask"
        # a picture or script asked for by the page of another port comes without an origin and with the cookie
        if headers.get("sec-fetch-site") in ("same-site", "cross-site") and headers.get("sec-fetch-mode") != "navigate":
            return "a page from elsewhere may not ask"
        return ""

    def _knows(self, token: str) -> bool:
        return hmac.compare_digest(token.encode(), self.token.encode())

    def _kept(self, headers: Mapping[str, str]) -> bool:
        """Whether a cookie holds the token; other programs of this machine leave cookies of any form beside it."""
        pairs = (part.strip().partition("=") for part in headers.get("cookie", "").split(";"))
        return any(name == self.cookie and self._knows(value) for name, _, value in pairs)

    async def _welcome(self, query: Mapping[str, str], send: Send) -> None:
        """Keep the token in a cookie and lead on to the address without it, which may be kept or passed on."""
        rest = urlencode({name: value for name, value in query.items() if name != TOKEN})
        cookie = f"{self.cookie}={self.token}; HttpOnly; SameSite=Lax; Path=/"
        where = f"/?{rest}" if rest else "/"  # the only page; a path of the asker's could name another machine
        await _answer(send, 303, "", ((b"location", where.encode()), (b"set-cookie", cookie.encode())))


def token() -> str:
    """A token of a server, new each time."""
    return secrets.token_urlsafe(24)


def _guarded(send: Send) -> Send:
    async def sent(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", ()), *_HEADERS]}
        await send(message)

    return sent


async def _refuse(scope: Scope, send: Send, reason: str) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
    else:
        await _answer(send, 403, reason)


async def _answer(send: Send, status: int, text: str, headers: tuple[tuple[bytes, bytes], ...] = ()) -> None:
    kind = ((b"content-type", b"text/html; charset=utf-8"), (b"cache-control", b"no-store"))
    await send({"type": "http.response.start", "status": status, "headers": [*kind, *_HEADERS, *headers]})
    await send({"type": "http.response.body", "body": text.encode()})
