"""What somebody tries who should not be in: each is refused with a sentence, and reaches no plant."""

from __future__ import annotations

import asyncio
import secrets
import socket
from collections.abc import Callable, Iterable
from typing import Any
from urllib.parse import unquote

import httpx
import pytest
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from tests.guarded_plant import Web
from tests.in_process import Caller
from tests.web_plant import TOKENS, Plant

from arboleda.model.messages import Verb
from arboleda.web import limits
from arboleda.web.access.auth import Role, allowed
from arboleda.web.access.guard import SerialRequests

HOST = "127.0.0.1:8080"
SELDOM = 1e-9  # per second: what was used up stays used up


def sentence(answer: httpx.Response) -> str:
    return str(answer.json()["sentence"])


def as_sent(app: ASGIApp, target: str) -> ASGIApp:
    """The application as a server hands this target of a request on to it; a client would mend the target."""

    async def handed_on(scope: Scope, receive: Receive, send: Send) -> None:
        await app({**scope, "path": unquote(target), "raw_path": target.encode()}, receive, send)

    return handed_on


# Names: who asks, and from where


@pytest.mark.parametrize(
    "host",
    [
        "evil.example:8080",
        "127.0.0.1.nip.example",
        "localhost.evil.example",
        "",
        "[::2]:8080",
        "127.1",
        "2130706433",
        "[::ffff:127.0.0.1]",
        "127.0.0.1:8080@evil.example",
        "localhost.",
        "169.254.1.1",
        "l\u043ecalhost",
        "\uff11\uff12\uff17.0.0.1",
        "127.0.0.1:\u0661",
    ],
)
def test_no_spelling_of_another_name_is_ours(web: Caller, plant: Plant, host: str) -> None:
    answer = web.post("/api/plant/release", headers={"host": host.encode()})
    assert answer.status_code == 403 and "is not called" in sentence(answer)
    assert plant.acts == []


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", f"https://{HOST}", "http://127.0.0.1:1", "http://127.0.0.1"]
)
def test_a_page_of_another_origin_operates_nothing(web: Caller, plant: Plant, origin: str) -> None:
    assert web.post("/api/plant/release", headers={"origin": origin}).status_code == 403
    assert plant.acts == []


@pytest.mark.parametrize("host", [HOST, "localhost:8080", "LOCALHOST", "[::1]:8080"])
def test_our_own_names_and_origin_are_let_in(web: Caller, host: str) -> None:
    assert web.get("/api/plant", headers={"host": host, "origin": f"http://{host}"}).status_code == 200


def test_on_a_network_addresses_and_the_own_name_are_ours_and_no_other_name(open_to_all: Web) -> None:
    client = open_to_all.client(token=Role.VIEWER)
    ours = ("192.168.1.5:8080", "[fe80::1]", socket.gethostname(), "localhost")
    others = ("evil.example", "192.168.1.5.evil.example", "3232235781", "fe80::1", "", "[1.2.3.4]")
    found = {host: client.get("/api/plant", headers={"host": host}).status_code for host in ours + others}
    assert found == dict.fromkeys(ours, 200) | dict.fromkeys(others, 403)


@pytest.mark.parametrize(
    "twice",
    [
        [("origin", f"http://{HOST}"), ("origin", "http://evil.example")],
        [("host", HOST), ("host", "evil.example")],
        [("content-length", "0"), ("transfer-encoding", "chunked")],
    ],
    ids=["origin", "host", "length"],
)
def test_two_headers_where_one_counts_are_refused(
    web: Caller, plant: Plant, twice: list[tuple[str, str]]
) -> None:
    assert web.post("/api/plant/release", headers=twice).status_code == 400
    assert plant.acts == []


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_what_another_page_embeds_is_refused_and_a_link_is_followed(local: Web, site: str) -> None:
    browser = local.client(**{"sec-fetch-site": site})
    assert browser.get("/api/plant", headers={"sec-fetch-mode": "no-cors"}).status_code == 403
    assert browser.get("/api/plant", headers={"sec-fetch-mode": "navigate"}).status_code == 200


@pytest.mark.parametrize("method", ["GET", "OPTIONS"])
def test_no_answer_invites_other_origins(web: Caller, method: str) -> None:
    names = {name.lower() for name in web.request(method, "/api/plant").headers}
    assert not [name for name in names if name.startswith("access-control-")]


@pytest.mark.parametrize("header", ["x-forwarded-for", "forwarded", "via", "x-real-ip"])
def test_a_proxy_does_not_open_a_plant_that_is_for_its_own_machine(
    web: Caller, plant: Plant, header: str
) -> None:
    answer = web.post("/api/plant/release", headers={header: "192.168.1.66"})
    assert answer.status_code == 403 and "--public-url" in sentence(answer)
    assert plant.acts == []


PROXIED = {"host": "plant.example", "x-forwarded-for": "10.0.0.7", "x-forwarded-prefix": "//evil.example"}


@pytest.fixture
def proxied(serve: Callable[..., Web]) -> Web:
    return serve(dict(TOKENS), public_url="https://plant.example")


def test_behind_a_proxy_nothing_passes_without_a_token(proxied: Web) -> None:
    assert proxied.client().get("/api/plant", headers=PROXIED).status_code == 401


@pytest.mark.parametrize(
    ("origin", "status"),
    [
        ("https://plant.example", 200),
        ("http://plant.example", 403),
        ("https://plant.example:444", 403),
        ("https://evil.example", 403),
    ],
)
def test_behind_a_proxy_its_address_is_the_origin(proxied: Web, origin: str, status: int) -> None:
    browser = proxied.client(login=Role.OPERATOR)
    assert browser.post("/api/plant/hold", headers={**PROXIED, "origin": origin}).status_code == status


def test_behind_a_proxy_guesses_are_counted_for_whom_the_proxy_saw(proxied: Web) -> None:
    def guess(seen: str) -> int:
        headers = {"authorization": "Bearer wrong", "x-forwarded-for": seen}
        return proxied.client().get("/api/plant", headers=headers).status_code

    # What the client itself puts before that changes nothing.
    answers = [guess(f"10.9.9.{number}, 10.0.0.7") for number in range(limits.GUESS[1])]
    assert answers == [401] * limits.GUESS[1]
    assert (guess("10.0.0.7"), guess("10.0.0.8")) == (429, 401)


def test_a_request_for_another_plant_does_nothing(serve: Callable[..., Web], plant: Plant) -> None:
    answer = serve(name="painting").client().post("/api/plant/stop", headers={"arboleda-plant": "demo"})
    assert answer.status_code == 421
    assert sentence(answer) == "This is the plant painting, and 'demo' is meant."
    assert plant.acts == []


# Tokens, sessions, roles


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/api/plant"),
        ("GET", "/api/events"),
        ("GET", "/api/docs"),
        ("POST", "/api/tasks"),
        ("POST", "/api/plant/stop"),
        ("POST", "/api/cells/sis_a/stop"),
        ("POST", "/logout"),
        ("GET", "/_nicegui/anything.js"),
    ],
)
def test_without_a_token_nothing_is_told_and_nothing_done(
    open_to_all: Web, plant: Plant, method: str, path: str
) -> None:
    answer = open_to_all.client(origin=open_to_all.origin).request(method, path)
    assert answer.status_code == 401 and "token" in sentence(answer)
    assert (plant.texts, plant.acts) == ([], [])


def test_no_way_round_leads_from_the_login_into_the_api(open_to_all: Web) -> None:
    app = as_sent(open_to_all.app, "/login/../api/plant")
    assert Caller(app).get("/login").status_code == 401


def test_a_browser_without_a_session_is_led_to_the_login(open_to_all: Web) -> None:
    answer = open_to_all.client().get("/", headers={"accept": "text/html,*/*"})
    assert (answer.status_code, answer.headers["location"]) == (303, "/login")


@pytest.mark.parametrize("verb", Verb)
def test_an_operator_may_do_all_and_a_viewer_stop(verb: Verb) -> None:
    may = {role: allowed(role, verb.value) for role in (Role.OPERATOR, Role.VIEWER, None)}
    assert may == {Role.OPERATOR: True, Role.VIEWER: verb is Verb.STOP, None: False}


@pytest.mark.parametrize("how", ["token", "login"])
@pytest.mark.parametrize("path", ["plant", "cells/sis_a"])
def test_a_viewer_stops_and_does_nothing_else(open_to_all: Web, plant: Plant, how: str, path: str) -> None:
    viewer = open_to_all.client(**{how: Role.VIEWER})
    assert viewer.post(f"/api/{path}/stop").status_code == 200
    refused = viewer.post(f"/api/{path}/reset")
    assert refused.status_code == 403
    assert sentence(refused) == "A viewer may look and stop; reset needs the operator's token."
    assert open_to_all.client(**{how: Role.OPERATOR}).post(f"/api/{path}/reset").status_code == 200
    assert [verb for verb, *_ in plant.acts] == [Verb.STOP, Verb.RESET]


def test_a_viewer_gives_no_task(open_to_all: Web, plant: Plant) -> None:
    assert open_to_all.client(token=Role.VIEWER).post("/api/tasks", json={"text": "x"}).status_code == 403
    assert plant.texts == []
    assert open_to_all.client(token=Role.OPERATOR).post("/api/tasks", json={"text": "x"}).status_code == 202


@pytest.mark.parametrize(
    "value",
    [
        "Bearer",
        "Bearer " + "o" * 31,
        "Bearer " + "o" * 33,
        "Bearer " + "O" * 32,
        "Bearer \u00e9\u00e9",
        "Bearer " + "o" * 32 + " x",
        "Basic " + "o" * 32,
        "o" * 32,
    ],
)
def test_what_is_not_the_token_is_none(open_to_all: Web, plant: Plant, value: str) -> None:
    answer = open_to_all.client().post("/api/plant/release", headers={"authorization": value.encode()})
    assert answer.status_code == 401
    assert plant.acts == []


def test_every_known_token_is_compared_in_constant_time(
    open_to_all: Web, monkeypatch: pytest.MonkeyPatch
) -> None:
    compared, compare = [], secrets.compare_digest
    monkeypatch.setattr(secrets, "compare_digest", lambda a, b: compared.append((a, b)) or compare(a, b))
    open_to_all.client(authorization="Bearer guess").get("/api/plant")
    assert compared == [(b"guess", token.encode()) for token in TOKENS.values()]


@pytest.mark.parametrize("name", ["token", "Access_Token", "bearer", "%74oken"])
def test_a_token_in_an_address_is_refused_even_a_right_one(open_to_all: Web, name: str) -> None:
    operator = open_to_all.client(token=Role.OPERATOR)
    for path in ("/api/plant", "/login", "/"):
        answer = operator.get(f"{path}?a=1&{name}={TOKENS[Role.OPERATOR]}")
        assert answer.status_code == 400 and "does not belong into an address" in sentence(answer), path


def test_an_absent_origin_passes_with_a_token_only(open_to_all: Web, plant: Plant) -> None:
    browser = open_to_all.client(login=Role.OPERATOR)
    del browser.headers["origin"]
    assert browser.get("/api/plant").status_code == 200
    answer = browser.post("/api/plant/stop")
    assert answer.status_code == 403 and "Origin" in sentence(answer)
    assert plant.acts == []
    assert open_to_all.client(token=Role.OPERATOR).post("/api/plant/stop").status_code == 200


def test_an_absent_origin_passes_for_the_api_on_ones_own_machine_only(web: Caller, plant: Plant) -> None:
    assert web.post("/_nicegui_ws/socket.io/").status_code == 403
    assert web.post("/api/plant/stop").status_code == 200
    assert len(plant.acts) == 1


def test_the_wrong_tokens_of_one_address_are_few_and_lock_no_right_one_out(
    open_to_all: Web, plant: Plant
) -> None:
    guesser = open_to_all.client(authorization="Bearer x")
    answers = [guesser.get("/api/plant") for _ in range(limits.GUESS[1] + 1)]
    assert [answer.status_code for answer in answers] == [401] * limits.GUESS[1] + [429]
    assert answers[-1].headers["retry-after"] == "60"
    assert open_to_all.client(token=Role.VIEWER).post("/api/plant/stop").status_code == 200
    assert len(plant.acts) == 1


# Sizes, shapes, rates


@pytest.mark.parametrize("count", [1, 300])
def test_a_bomb_of_headers_is_refused(web: Caller, plant: Plant, count: int) -> None:
    bomb = {f"x-{number}": "a" * (limits.HEADER_BYTES // count) for number in range(count)}
    answer = web.post("/api/plant/stop", headers=bomb)
    assert answer.status_code == 431 and sentence(answer)
    assert plant.acts == []


def test_a_body_is_taken_up_to_its_limit_and_refused_beyond_it(web: Caller, plant: Plant) -> None:
    exact = b'{"text": "' + b"x" * (limits.API_BODY_BYTES - 12) + b'"}'
    assert web.post("/api/tasks", content=exact).status_code == 202
    assert web.post("/api/tasks", content=exact + b" ").status_code == 413
    assert len(plant.texts) == 1


def heard(web: Web, messages: Iterable[Message]) -> tuple[list[int], int]:
    """The statuses that a request of these messages is answered with, and how many of them were taken; more
    than these never come."""
    coming, taken, statuses = iter(messages), 0, []

    async def receive() -> Message:
        nonlocal taken
        for message in coming:
            taken += 1
            return message
        return await asyncio.Future()

    async def send(message: Message) -> None:
        statuses.extend([message["status"]] if "status" in message else [])

    head: Any = {"type": "http", "method": "POST", "path": "/api/plant/release", "query_string": b""}
    head |= {"raw_path": b"/api/plant/release", "headers": [(b"host", HOST.encode())]}
    asyncio.run(web.app({**head, "client": ("127.0.0.1", 50000)}, receive, send))
    return statuses, taken


def test_a_body_without_end_is_refused_while_it_comes(local: Web, plant: Plant) -> None:
    chunk = {"type": "http.request", "body": b"a" * 1024, "more_body": True}
    assert heard(local, [chunk] * 100) == ([413], limits.API_BODY_BYTES // 1024 + 1)
    assert plant.acts == []


def test_a_body_that_never_comes_is_not_waited_for_longer_than_the_limit(
    local: Web, plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "BODY_S", 0)
    assert heard(local, [])[0] == [408]
    assert plant.acts == []


def test_a_body_that_breaks_off_is_answered_nothing_and_does_nothing(local: Web, plant: Plant) -> None:
    begun = {"type": "http.request", "body": b"{", "more_body": True}
    assert heard(local, [begun, {"type": "http.disconnect"}]) == ([], 2)
    assert plant.acts == []


@pytest.mark.parametrize(("open_", "close"), [("[", "]"), ('{"a":', "}")], ids=["lists", "objects"])
def test_deep_json_is_refused_with_a_sentence(web: Caller, plant: Plant, open_: str, close: str) -> None:
    deep = 600
    body = '{"text": ' + open_ * deep + "1" + close * deep + "}"
    answer = web.post("/api/tasks", content=body)
    assert answer.status_code == 422 and sentence(answer).startswith("The body must be JSON")
    assert plant.texts == []


@pytest.mark.parametrize(
    "path",
    [
        "//api/plant/release",
        "/api//plant/release",
        "/api/plant/release/",
        "/API/plant/release",
        "/api/./plant/release",
        "/api/x/../plant/release",
        "/api/plant/release%00",
        "/api/plant;x/release",
        "/api/cells//release",
        "/api/cells/a/b/release",
        "/api/cells/a%2fb/release",
    ],
)
def test_no_other_way_to_write_a_path_reaches_the_plant(local: Web, plant: Plant, path: str) -> None:
    answer = Caller(as_sent(local.app, path)).post("/")
    assert answer.status_code in (403, 404, 422)
    assert plant.acts == []


def test_too_many_changes_are_told_so_and_a_stop_never_is(
    serve: Callable[..., Web], plant: Plant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "CHANGE", (SELDOM, 2))
    web = serve().client()
    answers = [web.post("/api/plant/hold") for _ in range(3)]
    assert [answer.status_code for answer in answers] == [200, 200, 429]
    assert answers[-1].headers["retry-after"] == "1"
    stops = [web.post(f"/api/{where}/stop").status_code for where in ("plant", "cells/sis_a") * 3]
    assert stops == [200] * 6


def test_pages_have_a_rate_of_their_own_that_leaves_the_api_alone(
    serve: Callable[..., Web], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "OPEN", (SELDOM, 2))
    web = serve().client()
    assert [web.get("/").status_code for _ in range(3)] == [404, 404, 429]  # there is no page here
    assert (web.get("/api/plant").status_code, web.get("/some/file").status_code) == (200, 404)


def test_one_client_does_not_use_up_the_requests_of_another(
    serve: Callable[..., Web], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(limits, "CHANGE", (SELDOM, 1))
    web = serve(dict(TOKENS))
    greedy, other = web.client(login=Role.OPERATOR), web.client(login=Role.OPERATOR)
    assert [greedy.post("/api/plant/hold").status_code for _ in range(2)] == [200, 429]
    assert other.post("/api/plant/hold").status_code == 200


def test_one_page_is_made_at_a_time_and_none_for_whoever_has_gone() -> None:
    began: list[str] = []
    sent: list[Message] = []

    async def look() -> list[str]:
        made = asyncio.Event()

        async def page(scope: Scope, receive: Receive, send: Send) -> None:
            began.append(scope["path"])
            await made.wait()
            await send({"type": "http.response.start", "status": 200, "headers": []})

        async def keep(message: Message) -> None:
            sent.append(message)

        async def stays() -> Message:
            return await asyncio.Future()

        async def goes() -> Message:
            return {"type": "http.disconnect"}

        pages = SerialRequests(page)
        asked = [("/first", stays), ("/gone", goes), ("/last", stays)]
        tasks = [asyncio.create_task(pages.run({"path": path}, hears, keep, hears)) for path, hears in asked]
        for _ in range(5):
            await asyncio.sleep(0)
        before = list(began)
        made.set()
        await asyncio.gather(*tasks)
        return before

    assert asyncio.run(look()) == ["/first"]
    assert began == ["/first", "/last"] and len(sent) == 2


# What browsers are told


@pytest.mark.parametrize("path", ["/api/plant", "/nothing", "/login"])
def test_every_answer_forbids_framing_and_guessing(open_to_all: Web, path: str) -> None:
    for client in (open_to_all.client(), open_to_all.client(token=Role.VIEWER)):
        headers = client.get(path).headers
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert (headers["x-frame-options"], headers["x-content-type-options"]) == ("DENY", "nosniff")


def test_the_api_may_load_nothing_and_is_not_kept(web: Caller) -> None:
    headers = web.get("/api/plant").headers
    assert headers["content-security-policy"].startswith("default-src 'none'")
    assert headers["cache-control"] == "no-store"


def test_a_log_line_is_one_line_whatever_the_address(
    web: Caller, plant: Plant, caplog: pytest.LogCaptureFixture
) -> None:
    plant.find = lambda task: 1 / 0
    assert web.get("/api/tasks/a%0aERROR%20forged").status_code == 500
    lines = [record.getMessage() for record in caplog.records if record.name.startswith("arboleda")]
    assert len(lines) == 1 and "\n" not in lines[0]
