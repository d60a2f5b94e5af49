"""The address at which a page has what was found said in its language."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import httpx
import pytest
from fastapi import FastAPI
from starlette.types import Receive, Scope, Send

from arboleda.dashboard import findings_route
from arboleda.dashboard.findings import findings
from arboleda.web.access.auth import Forbidden, Role

Post = Callable[..., httpx.Response]
MISSING = {"lines": ['the key "a" is missing', "cells.b: there is nothing to undo"]}


class Make:
    def translate(self, language: str, lines: list[str]) -> list[str]:
        return [findings(language)(line) for line in lines]


def post(role: Role | None, body: Any, *, make: Make | None, language: str = "es") -> httpx.Response:
    app = FastAPI()
    side: Any = SimpleNamespace(make=make)
    findings_route.serve(app, side)

    async def as_role(scope: Scope, receive: Receive, send: Send) -> None:
        await app({**scope, "arboleda.role": role}, receive, send)

    async def asked() -> httpx.Response:
        transport = httpx.ASGITransport(app=as_role)
        async with httpx.AsyncClient(transport=transport, base_url="http://plant") as client:
            return await client.post(f"/findings.json?lang={language}", json=body)

    return asyncio.run(asked())


def test_lines_come_back_in_the_language_of_the_page() -> None:
    answer = post(Role.OPERATOR, MISSING, make=Make())
    assert answer.json() == {"lines": ['falta la clave "a"', "cells.b: no hay nada que deshacer"]}
    assert post(Role.OPERATOR, MISSING, make=Make(), language="en").json() == MISSING


def test_a_plant_without_a_draft_has_none() -> None:
    assert post(Role.OPERATOR, MISSING, make=None).status_code == 404


def test_a_viewer_has_no_lines_said() -> None:
    with pytest.raises(Forbidden):
        post(Role.VIEWER, MISSING, make=Make())
