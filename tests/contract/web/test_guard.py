"""What somebody tries who should not be in: each is refused with a sentence, and reaches no plant."""

from __future__ import annotations

import http.client
import secrets
import socket

import pytest

from arboleda.model.messages import Verb
from arboleda.web import limits
from arboleda.web.access.auth import Role

from ...patience import PATIENCE_S
from .conftest import TOKENS, VIEW


def sentence(answer) -> str:
    return answer.json()["sentence"]


def raw(port: int, request: bytes) -> bytes:
    """What the server says to these bytes, until it closes."""
    with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S) as talk:
        talk.sendall(request)
        said = b""
        while chunk := talk.recv(65536):
            said += chunk
        return said


def head(port: int, target: str, *lines: str) -> bytes:
    """The beginning of a request that is for us."""
    return "\r\n".join([f"{target} HTTP/1.1", f"Host: 127.0.0.1:{port}", *lines, "", ""]).encode()


def posted(port: int, *lines: str, path: str = "/api/plant/release", body: str = "") -> bytes:
    words = [f"POST {path} HTTP/1.1", *(lines or (f"Host: 127.0.0.1:{port}",)), "Connection: close", "", body]
    return raw(port, "\r\n".join(words).encode())


# Names: who asks, and from where


@pytest.mark.parametrize("headers", [{"host": "evil.example"}, {"origin": "http://evil.example"}])
def test_a_page_of_another_site_operates_nothing(web, plant, headers):
    assert web.post("/api/plant/release", headers=headers).status_code == 403
    assert plant.acts == []


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1.evil.example", "", "[::2]:{port}"]
)
def test_a_foreign_host_is_turned_away(web, port, plant, host):
    answer = web.post("/api/tasks", json={"text": "x"}, headers={"host": host.format(port=port)})
    assert answer.status_code == 403
    assert plant.texts == []


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "https://127.0.0.1:{port}", "http://127.0.0.1:1"]
)
def test_a_foreign_origin_is_turned_away(web, port, plant, origin):
    answer = web.post("/api/tasks", json={"text": "x"}, headers={"origin": origin.format(port=port)})
    assert answer.status_code == 403
    assert plant.texts == []


@pytest.mark.parametrize("host", ["127.0.0.1:{port}", "localhost:{port}", "LOCALHOST", "[::1]:{port}"])
def test_our_own_names_and_origin_are_let_in(web, port, host):
    host = host.format(port=port)
    assert web.get("/api/plant", headers={"host": host, "origin": f"http://{host}"}).status_code == 200


def test_a_long_body_is_turned_away_with_and_without_a_length(web, port, plant):
    exact = b'{"text": "' + b"x" * (4096 - 12) + b'"}'
    assert web.post("/api/tasks", content=exact).status_code == 202
    assert web.post("/api/tasks", content=exact + b" ").status_code == 413
    chunked = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
    chunked.request("POST", "/api/tasks", body=iter([b"x" * 3000, b"x" * 3000]), encode_chunked=True)
    assert chunked.getresponse().status == 413
    chunked.close()
    assert len(plant.texts) == 1


@pytest.mark.parametrize(
    "host",
    [
        "evil.example",
        "127.0.0.1.nip.example:{port}",
        "localhost.evil.example",
        "127.1",
        "2130706433",
        "0x7f000001",
        "0177.0.0.1",
        "[::ffff:127.0.0.1]",
        "127.0.0.1:{port}@evil.example",
        "localhost.",
        "169.254.1.1",
        "l\u043ecalhost",
        "127\u30020\u30020\u30021",
        "\uff11\uff12\uff17.0.0.1",
        "127.0.0.1:\u0661",
    ],
)
def test_no_spelling_of_another_name_is_ours(local, plant, host):
    said = posted(local.port, f"Host: {host.format(port=local.port)}")
    assert said.startswith((b"HTTP/1.1 403 ", b"HTTP/1.1 400 "))
    assert plant.acts == []


def test_on_a_network_addresses_and_the_own_name_are_ours_and_no_other_name(open_to_all):
    client = open_to_all.client(token=Role.VIEWER)
    for host in ("192.168.1.5:8080", "[fe80::1]", socket.gethostname(), "localhost"):
        assert client.get("/api/plant", headers={"host": host}).status_code == 200, host
    for host in ("evil.example", "192.168.1.5.evil.example", "3232235781", "fe80::1", "", "[1.2.3.4]"):
        assert client.get("/api/plant", headers={"host": host}).status_code == 403, host


@pytest.mark.parametrize("twice", ["Host: evil.example", "Origin: http://evil.example\r\nOrigin: {origin}"])
def test_two_headers_where_one_counts_are_refused(local, plant, twice):
    said = posted(local.port, f"Host: 127.0.0.1:{local.port}", twice.format(origin=local.origin))
    assert said.startswith(b"HTTP/1.1 400 ")
    assert plant.acts == []


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_what_another_page_embeds_is_refused_and_a_link_is_followed(local, site):
    browser = local.client(**{"sec-fetch-site": site})
    assert browser.get("/api/plant", headers={"sec-fetch-mode": "no-cors"}).status_code == 403
    assert browser.get("/api/docs", headers={"sec-fetch-mode": "navigate"}).status_code == 200


@pytest.mark.parametrize("method", ["GET", "OPTIONS", "POST"])
def test_no_answer_invites_other_origins(web, method):
    names = {name.lower() for name in web.request(method, "/api/plant").headers}
    assert not [name for name in names if name.startswith("access-control-")]


@pytest.mark.parametrize("header", ["x-forwarded-for", "forwarded", "via", "x-real-ip"])
def test_a_proxy_does_not_open_a_plant_that_is_for_its_own_machine(web, plant, header):
    answer = web.post("/api/plant/release", headers={header: "192.168.1.66"})
    assert answer.status_code == 403 and "--public-url" in sentence(answer)
    assert plant.acts == []


def test_behind_a_proxy_its_address_is_the_origin_and_nothing_passes_without_a_token(serve):
    web = serve(dict(TOKENS), public_url="https://plant.example")
    proxied = {"host": "plant.example", "x-forwarded-for": "10.0.0.7", "x-forwarded-prefix": "//evil.example"}
    assert web.client().get("/api/plant", headers=proxied).status_code == 401
    browser = web.client(login=Role.OPERATOR)
    for origin, status in (
        ("https://plant.example", 200),
        ("http://plant.example", 403),
        ("https://plant.example:444", 403),
        ("https://evil.example", 403),
    ):
        answer = browser.post("/api/plant/hold", headers={**proxied, "origin": origin})
        assert answer.status_code == status, origin


def test_behind_a_proxy_guesses_are_counted_for_whom_the_proxy_saw(serve):
    web = serve(dict(TOKENS), public_url="https://plant.example")
    wrong = {"authorization": "Bearer wrong"}
    for number in range(limits.GUESS[1] + 1):  # what the client itself puts there changes nothing
        last = web.client().get(
            "/api/plant", headers={**wrong, "x-forwarded-for": f"10.9.9.{number}, 10.0.0.7"}
        )
    assert last.status_code == 429
    assert web.client().get("/api/plant", headers={**wrong, "x-forwarded-for": "10.0.0.8"}).status_code == 401


# Tokens, sessions, roles


def test_without_a_token_nothing_is_told_and_nothing_done(open_to_all, plant):
    nobody = open_to_all.client(origin=open_to_all.origin)
    for method, path in [
        ("GET", "/api/plant"),
        ("GET", "/api/events"),
        ("GET", "/api/docs"),
        ("GET", "/api/openapi.json"),
        ("POST", "/api/tasks"),
        ("POST", "/api/plant/stop"),
        ("POST", "/api/cells/sis_a/stop"),
        ("POST", "/logout"),
        ("GET", "/login/../api/plant"),
        ("GET", "/_nicegui/anything.js"),
    ]:
        answer = nobody.request(method, path)
        assert answer.status_code == 401, path
        assert "token" in sentence(answer)
    assert (plant.texts, plant.acts) == ([], [])


def test_a_browser_without_a_session_is_led_to_the_login(open_to_all):
    answer = open_to_all.client().get("/", headers={"accept": "text/html,*/*"})
    assert (answer.status_code, answer.headers["location"]) == (303, "/login")


@pytest.mark.parametrize(
    ("role", "verb", "status"),
    [(Role.OPERATOR, verb, 200) for verb in Verb]
    + [(Role.VIEWER, verb, 200 if verb is Verb.STOP else 403) for verb in Verb],
)
@pytest.mark.parametrize("how", ["token", "login"])
def test_a_viewer_stops_and_does_nothing_else(open_to_all_once, plant_once, how, role, verb, status):
    somebody = open_to_all_once.client(**{how: role})
    before = len(plant_once.acts)
    for path in (f"/api/plant/{verb.value}", f"/api/cells/sis_a/{verb.value}"):
        answer = somebody.post(path)
        assert answer.status_code == status
        if status == 403:
            assert sentence(answer) == f"A viewer may look and stop; {verb.value} needs the operator's token."
    assert len(plant_once.acts) - before == (2 if status == 200 else 0)


def test_a_viewer_gives_no_task(open_to_all, plant):
    assert open_to_all.client(token=Role.VIEWER).post("/api/tasks", json={"text": "x"}).status_code == 403
    assert plant.texts == []
    assert open_to_all.client(token=Role.OPERATOR).post("/api/tasks", json={"text": "x"}).status_code == 202


@pytest.mark.parametrize(
    "value",
    [
        "Bearer",
        "Bearer ",
        "Bearer " + "o" * 31,
        "Bearer " + "o" * 33,
        "Bearer " + "O" * 32,
        "Bearer \u00e9\u00e9",
        "Bearer " + "\uff4f" * 32,
        "Basic " + "o" * 32,
        "o" * 32,
        "Bearer " + "o" * 32 + " x",
    ],
)
def test_what_is_not_the_token_is_none(open_to_all, plant, value):
    said = posted(open_to_all.port, f"Host: 127.0.0.1:{open_to_all.port}", f"Authorization: {value}")
    assert said.startswith((b"HTTP/1.1 401 ", b"HTTP/1.1 403 "))
    assert plant.acts == []


def test_every_known_token_is_compared_in_constant_time(open_to_all, monkeypatch):
    compared, compare = [], secrets.compare_digest
    monkeypatch.setattr(secrets, "compare_digest", lambda a, b: compared.append((a, b)) or compare(a, b))
    open_to_all.client(authorization="Bearer guess").get("/api/plant")
    assert compared == [(b"guess", token.encode()) for token in TOKENS.values()]


@pytest.mark.parametrize("query", ["token=x", "a=1&Access_Token=x", "token", "%74oken=x"])
@pytest.mark.parametrize("path", ["/api/plant", "/login", "/"])
def test_a_token_in_an_address_is_refused_even_a_right_one(open_to_all, path, query):
    query = query.replace("=x", f"={TOKENS[Role.OPERATOR]}")
    answer = open_to_all.client(token=Role.OPERATOR).get(f"{path}?{query}")
    assert answer.status_code == 400 and "does not belong into an address" in sentence(answer)


def test_an_absent_origin_passes_with_a_token_only(open_to_all, plant):
    browser = open_to_all.client(login=Role.OPERATOR)
    del browser.headers["origin"]
    assert browser.get("/api/plant").status_code == 200
    answer = browser.post("/api/plant/stop")
    assert answer.status_code == 403 and "Origin" in sentence(answer)
    assert plant.acts == []
    assert open_to_all.client(token=Role.OPERATOR).post("/api/plant/stop").status_code == 200


def test_an_absent_origin_passes_for_the_api_on_ones_own_machine_only(web, plant):
    assert web.post("/_nicegui_ws/socket.io/").status_code == 403
    assert web.post("/api/plant/stop").status_code == 200
    assert len(plant.acts) == 1


def test_the_wrong_tokens_of_one_address_are_few_and_lock_no_right_one_out(open_to_all, plant):
    guesser = open_to_all.client(authorization="Bearer x")
    answers = [guesser.get("/api/plant") for _ in range(limits.GUESS[1] + 1)]
    assert [answer.status_code for answer in answers] == [401] * limits.GUESS[1] + [429]
    assert answers[-1].headers["retry-after"] == "60"
    assert open_to_all.client(token=Role.VIEWER).post("/api/plant/stop").status_code == 200
    assert len(plant.acts) == 1


# Sizes, shapes, rates


@pytest.mark.parametrize("count", [1, 300])
def test_a_bomb_of_headers_is_refused(local, count):
    bomb = [f"X-{number}: {'a' * (limits.HEADER_BYTES // count)}" for number in range(count)]
    said = posted(local.port, f"Host: 127.0.0.1:{local.port}", *bomb, path="/api/plant/stop")
    assert said.startswith(b"HTTP/1.1 431 ") and b"sentence" in said


def test_headers_without_end_are_cut_off(local):
    with socket.create_connection(("127.0.0.1", local.port), timeout=PATIENCE_S) as talk:
        talk.sendall(b"GET / HTTP/1.1\r\nX-A: " + b"a" * 40_000)
        assert talk.recv(100).startswith(b"HTTP/1.1 400 ")


def test_a_body_without_end_is_refused_while_it_comes(local, plant):
    with socket.create_connection(("127.0.0.1", local.port), timeout=PATIENCE_S) as talk:
        chunks = (b"400\r\n" + b"a" * 1024 + b"\r\n") * 5
        talk.sendall(head(local.port, "POST /api/tasks", "Transfer-Encoding: chunked") + chunks)
        assert talk.recv(100).startswith(b"HTTP/1.1 413 ")
    assert plant.texts == []


def test_a_body_that_never_comes_is_waited_for_only_so_long(local, plant, monkeypatch):
    monkeypatch.setattr(limits, "BODY_S", 0.1)
    said = posted(local.port, f"Host: 127.0.0.1:{local.port}", "Content-Length: 5", path="/api/plant/stop")
    assert said.startswith(b"HTTP/1.1 408 ")
    assert plant.acts == []


def test_a_body_that_breaks_off_does_nothing(local, plant, web):
    with socket.create_connection(("127.0.0.1", local.port), timeout=PATIENCE_S) as talk:
        talk.sendall(head(local.port, "POST /api/plant/release", "Content-Length: 9"))
    assert web.get("/api/plant").json() == VIEW
    assert plant.acts == []


def test_a_body_of_two_lengths_is_refused(local, plant):
    said = posted(
        local.port,
        f"Host: 127.0.0.1:{local.port}",
        "Content-Length: 4",
        "Transfer-Encoding: chunked",
        body="0\r\n\r\n",
    )
    assert said.startswith(b"HTTP/1.1 400 ")
    assert plant.acts == []


@pytest.mark.parametrize(("open_", "close"), [("[", "]"), ('{"a":', "}")], ids=["lists", "objects"])
def test_deep_json_is_refused_with_a_sentence(web, plant, open_, close):
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
        "/api/%2e%2e/api/plant/release",
        "/api/plant/release%00",
        "/api/plant;x/release",
        "/api/plant/release%2f",
        "http://evil.example/api/plant/release",
        "/api/cells//release",
        "/api/cells/a/b/release",
        "/api/cells/%2e%2e/plant/release",
    ],
)
def test_no_other_way_to_write_a_path_reaches_the_plant(local, plant, path):
    said = posted(local.port, path=path)
    assert int(said.split()[1]) in (400, 403, 404, 405, 422)
    assert plant.acts == []


def test_garbage_is_answered_and_closed(local, web):
    assert raw(local.port, b"\x16\x03\x01\x02\x00" + b"\x00" * 600 + b"\r\n\r\n").startswith(b"HTTP/1.1 400 ")
    assert web.get("/api/plant").status_code == 200


def test_too_many_requests_are_told_so_and_a_stop_never_is(web):
    answer = web.post("/api/plant/hold")
    while answer.status_code == 200:
        answer = web.post("/api/plant/hold")
    assert (answer.status_code, answer.headers["retry-after"]) == (429, "1")
    stops = [web.post(f"/api/{where}/stop") for where in ("plant", "cells/sis_a") for _ in range(100)]
    assert {stop.status_code for stop in stops} == {200}


def test_pages_have_a_rate_of_their_own_that_leaves_the_api_alone(web):
    answers = [web.get("/").status_code for _ in range(limits.OPEN[1] + 20)]
    assert answers[: limits.OPEN[1]] == [404] * limits.OPEN[1]  # there is no page here
    assert 429 in answers
    assert (web.get("/api/plant").status_code, web.get("/some/file").status_code) == (200, 404)


def test_one_client_does_not_use_up_the_requests_of_another(open_to_all):
    greedy, other = open_to_all.client(login=Role.OPERATOR), open_to_all.client(login=Role.OPERATOR)
    while greedy.post("/api/plant/hold").status_code != 429:
        pass
    assert other.post("/api/plant/hold").status_code == 200


# What browsers are told


@pytest.mark.parametrize("path", ["/api/plant", "/api/docs", "/nothing", "/login"])
def test_every_answer_forbids_framing_and_guessing(open_to_all, path):
    for client in (open_to_all.client(), open_to_all.client(token=Role.VIEWER)):
        headers = client.get(path).headers
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert (headers["x-frame-options"], headers["x-content-type-options"]) == ("DENY", "nosniff")
        assert "server" not in headers


def test_the_api_may_load_nothing_and_is_not_kept(web):
    headers = web.get("/api/plant").headers
    assert headers["content-security-policy"].startswith("default-src 'none'")
    assert headers["cache-control"] == "no-store"


def test_a_log_line_is_one_line_whatever_the_address(web, plant, caplog):
    plant.find = lambda task: 1 / 0
    assert web.get("/api/tasks/a%0aERROR%20forged").status_code == 500
    lines = [record.getMessage() for record in caplog.records if record.name.startswith("arboleda")]
    assert len(lines) == 1 and "\n" not in lines[0]
