"""The door of the workbench against a foreign page: rebinding, a socket from another origin, frames, guessed tokens."""

import asyncio

import pytest

from mechsym.app.server import Door

HOSTS = ("127.0.0.1:8080", "localhost:8080")
HERE = {"host": HOSTS[0]}
COOKIE = {"cookie": "mechsym_8080=right"}


async def workbench(scope, receive, send):
    if scope["type"] == "websocket":
        return await send({"type": "websocket.accept"})
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"values of an engine"})


def asked(kind="http", path="/", query="", **headers):
    sent = []

    async def send(message):
        sent.append(message)

    scope = {
        "type": kind,
        "path": path,
        "query_string": query.encode(),
        "headers": [(k.replace("_", "-").encode(), v.encode()) for k, v in headers.items()],
    }
    asyncio.run(Door(workbench, HOSTS, "right")(scope, None, send))
    return sent


def head(sent):
    return {name.decode(): value.decode() for name, value in sent[0]["headers"]}


@pytest.mark.parametrize("host", HOSTS)
def test_the_browser_that_has_the_address_comes_in_and_the_token_leaves_the_address(host):
    first = asked(query="token=right&spring.p0=8e6", host=host)
    assert first[0]["status"] == 303 and head(first)["location"] == "/?spring.p0=8e6"
    cookie = head(first)["set-cookie"]
    assert "HttpOnly" in cookie and "SameSite" in cookie
    then = asked(query="spring.p0=8e6", host=host, cookie=cookie.partition(";")[0])
    assert then[0]["status"] == 200 and then[1]["body"] == b"values of an engine"
    assert asked("websocket", host=host, origin=f"http://{host}", **COOKIE) == [{"type": "websocket.accept"}]


FOREIGN = {
    "rebinding": {"host": "evil.example:8080"},
    "rebinding to another port": {"host": "127.0.0.1:80"},
    "no host": {},
    "two names": {"host": "127.0.0.1:8080, evil.example"},
    "another origin": {**HERE, "origin": "https://evil.example"},
    "a page of another port": {**HERE, "origin": "http://127.0.0.1:9000"},
    "a file or a sandboxed frame": {**HERE, "origin": "null"},
    "a picture asked for by the page of another port": {
        **HERE,
        "sec_fetch_site": "same-site",
        "sec_fetch_mode": "no-cors",
    },
    "a name that begins alike": {**HERE, "origin": "http://127.0.0.1:8080.evil.example"},
}


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize("headers", FOREIGN.values(), ids=FOREIGN)
def test_a_foreign_page_is_refused_even_with_the_token(headers, kind):
    sent = asked(kind, query="token=right", **headers, **COOKIE)
    assert [m["type"] for m in sent] == ["websocket.close"] or (
        sent[0]["status"] == 403 and b"values" not in sent[1]["body"]
    )
    assert "set-cookie" not in (head(sent) if kind == "http" else {})


@pytest.mark.parametrize(
    "other", ['a={"x":1}', "a b=1", "x=\u00e9", "a@b=1", "flag", "a=b c", "", "mechsym_8080=wrong"]
)
def test_cookies_of_other_programs_of_this_machine_keep_nobody_out(other):
    for cookie in (f"{other}; mechsym_8080=right", f"mechsym_8080=right; {other}"):
        assert asked(**HERE, cookie=cookie)[0]["status"] == 200


def test_a_link_from_elsewhere_may_lead_here():
    linked = {"sec_fetch_site": "cross-site", "sec_fetch_mode": "navigate"}
    assert asked(query="token=right", **HERE, **linked)[0]["status"] == 303


@pytest.mark.parametrize("query", ["", "token=", "token=wrong", "token=righ", "token=%72ight%00", "token=\u00e9"])
@pytest.mark.parametrize("cookie", ["", "mechsym_8080=wrong", "mechsym_8081=right", "=;==", "mechsym_8080=ri\u00e9"])
def test_without_the_token_nothing_is_shown(query, cookie):
    page = asked(query=query, **HERE, cookie=cookie)
    assert page[0]["status"] == 403 and b"values" not in page[1]["body"] and b"token" in page[1]["body"]
    assert asked("websocket", query=query, **HERE, cookie=cookie)[0]["type"] == "websocket.close"


@pytest.mark.parametrize("headers", [COOKIE, {}], ids=["shown", "refused"])
def test_no_page_may_frame_it_and_nothing_comes_from_outside(headers):
    answer = head(asked(**HERE, **headers))
    assert answer["x-frame-options"] == "DENY" and "frame-ancestors 'none'" in answer["content-security-policy"]
    assert "default-src 'self'" in answer["content-security-policy"] and answer["referrer-policy"] == "no-referrer"
    assert "http" not in answer["content-security-policy"]


@pytest.mark.parametrize("path", ["//evil.example", "///evil.example/", "/\\evil.example"])
def test_the_way_on_leads_to_this_machine(path):
    where = head(asked(path=path, query="token=right", **HERE))["location"]
    assert not where.startswith(("//", "/\\", "http"))
