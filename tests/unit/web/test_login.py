"""The login form, its cookie, and the ends of a session."""

from __future__ import annotations

import pytest
from tests.web_plant import TOKENS

from arboleda.model.errors import StartError
from arboleda.web import limits
from arboleda.web.access import auth
from arboleda.web.access.auth import Door, Role


def log_in(web, token: str, **headers: str):
    return web.client(origin=web.origin, **headers).post("/login", data={"token": token})


def test_the_token_opens_a_session_under_a_cookie_that_scripts_and_other_sites_do_not_get(open_to_all):
    answer = log_in(open_to_all, TOKENS[Role.OPERATOR])
    assert (answer.status_code, answer.headers["location"]) == (303, "/")
    words = {word.strip().lower() for word in answer.headers["set-cookie"].split(";")}
    assert {"httponly", "samesite=strict", "path=/"} <= words
    assert not [word for word in words if word.startswith(("domain", "secure"))]
    assert TOKENS[Role.OPERATOR] not in answer.headers["set-cookie"]


def test_the_cookie_of_an_encrypted_page_stays_encrypted(serve):
    web = serve(dict(TOKENS), public_url="https://plant.example")
    answer = web.client(origin="https://plant.example").post("/login", data={"token": TOKENS[Role.VIEWER]})
    assert "; secure" in answer.headers["set-cookie"].lower()


@pytest.mark.parametrize("token", ["", "x", "\u00f6" * 32, "o" * 32 + "\x00", "\ud800"])
def test_a_wrong_token_gets_the_form_again(open_to_all, token):
    body = token.encode(errors="surrogatepass")
    browser = open_to_all.client(origin=open_to_all.origin)
    answer = browser.post("/login", data={"token": body})
    assert answer.status_code == 401 and "not valid" in answer.text
    assert "set-cookie" not in answer.headers


@pytest.mark.parametrize(
    "body", [b"", b"\xff\xfe", b"token", b"a=1&b=2&c=3&d=4&e=5", b'{"token": "oooo"}', b"token=%ff"]
)
def test_a_body_that_is_no_form_logs_nobody_in(open_to_all, body):
    assert open_to_all.client(origin=open_to_all.origin).post("/login", content=body).status_code == 401


def test_guessing_at_the_form_ends_soon(open_to_all):
    answers = [log_in(open_to_all, f"guess {number}").status_code for number in range(limits.GUESS[1])]
    assert set(answers) == {401}
    assert log_in(open_to_all, TOKENS[Role.OPERATOR]).status_code == 429


@pytest.mark.parametrize("origin", ["http://evil.example", "null", None])
def test_nobody_is_logged_in_from_another_page(open_to_all, origin):
    headers = {"origin": origin} if origin else {}
    answer = open_to_all.client(**headers).post("/login", data={"token": TOKENS[Role.OPERATOR]})
    assert answer.status_code == 403


def test_a_foreign_cookie_is_nobody(open_to_all):
    stranger = open_to_all.client()
    for value in ("", "x" * 43, '"', "a=b", "\u00e9", TOKENS[Role.OPERATOR]):
        cookie = f"{open_to_all.cookie}={value}".encode()
        assert stranger.get("/api/plant", headers={"cookie": cookie}).status_code == 401, value


def test_the_form_speaks_spanish_where_the_browser_does_and_runs_no_script(open_to_all):
    form = open_to_all.client().get("/login", headers={"accept-language": "es-MX,en"})
    assert "Entrar en la planta" in form.text and 'lang="es"' in form.text
    assert "script" not in form.text
    assert "script-src" not in form.headers["content-security-policy"]
    assert form.headers["content-security-policy"].startswith("default-src 'none'; style-src 'sha256-")


def test_on_ones_own_machine_there_is_nothing_to_log_in_to(local):
    assert local.client().get("/login").headers["location"] == "/"


def test_a_new_token_ends_the_sessions_of_the_old_one():
    tokens = dict(TOKENS)
    door = Door(lambda: tokens)
    viewer, operator = (door.log_in(tokens[role].encode()) for role in (Role.VIEWER, Role.OPERATOR))
    known = door.by_cookie(operator)
    tokens[Role.OPERATOR] = "n" * 32
    assert door.by_cookie(operator) is None and not known.alive()
    assert door.by_cookie(viewer).role is Role.VIEWER
    assert door.log_in(b"o" * 32) is None


def test_a_session_ends_after_a_week():
    now = [0.0]
    door = Door(lambda: TOKENS, lambda: now[0])
    session = door.log_in(b"v" * 32)
    now[0] = auth.SESSION_S - 1
    assert door.by_cookie(session) is not None
    now[0] = auth.SESSION_S
    assert door.by_cookie(session) is None


def test_sessions_are_limited_in_number():
    door = Door(lambda: TOKENS)
    sessions = [door.log_in(b"v" * 32) for _ in range(auth.SESSIONS + 1)]
    assert door.by_cookie(sessions[0]) is None
    assert door.by_cookie(sessions[1]) is not None and door.by_cookie(sessions[-1]) is not None


def test_tokens_that_cannot_be_read_let_nobody_in_and_are_said_once(caplog):
    def broken():
        raise StartError("The tokens cannot be read.")

    door = Door(broken)
    assert door.by_token(b"v" * 32) is None and door.log_in(b"v" * 32) is None
    assert [record.getMessage() for record in caplog.records] == [
        "nobody can log in: The tokens cannot be read."
    ]


def test_where_somebody_wanted_to_go_survives_the_login(open_to_all):
    browser = open_to_all.client(origin=open_to_all.origin, accept="text/html")
    turned = browser.get("/?tab=tasks&cell=sis_b")
    assert (turned.status_code, turned.headers["location"]) == (303, "/login?tab=tasks&cell=sis_b")
    form = browser.get(turned.headers["location"])
    assert 'action="/login?tab=tasks&amp;cell=sis_b"' in form.text
    answer = browser.post("/login?tab=tasks&cell=sis_b", data={"token": TOKENS[Role.VIEWER]})
    assert answer.headers["location"] == "/?tab=tasks&cell=sis_b"
    assert browser.get("/login?tab=links").headers["location"] == "/?tab=links"


@pytest.mark.parametrize(
    "query", ["//evil.example", "next=https://evil.example", "%0d%0aset-cookie:a=b", '"><b>']
)
def test_no_address_leads_a_login_elsewhere(open_to_all, query):
    browser = open_to_all.client(origin=open_to_all.origin)
    form = browser.get(f"/login?{query}").text
    assert '"><b>' not in form
    answer = browser.post(f"/login?{query}", data={"token": TOKENS[Role.VIEWER]})
    assert answer.headers["location"].startswith("/?") and "a" not in browser.cookies


def test_the_form_speaks_the_language_of_the_address(open_to_all):
    assert "Clave" in open_to_all.client(**{"accept-language": "en"}).get("/login?lang=es").text
