"""A login over a real connection, and the end of its session."""

from __future__ import annotations

from tests.web_plant import TOKENS

from arboleda.web.access.auth import Role

from .conftest import Web


def test_a_session_does_what_its_role_may_until_logout(open_to_all: Web) -> None:
    viewer, operator = (open_to_all.client(origin=open_to_all.origin) for _ in range(2))
    assert viewer.post("/login", data={"token": TOKENS[Role.VIEWER]}).status_code == 303
    assert operator.post("/login", data={"token": TOKENS[Role.OPERATOR]}).status_code == 303
    assert [each.post("/api/plant/reset").status_code for each in (viewer, operator)] == [403, 200]
    stolen = operator.cookies[open_to_all.cookie]
    assert operator.post("/logout").headers["location"] == "/login"
    assert open_to_all.cookie not in operator.cookies
    thief = open_to_all.client(origin=open_to_all.origin, cookie=f"{open_to_all.cookie}={stolen}")
    assert thief.post("/api/plant/stop").status_code == 401
