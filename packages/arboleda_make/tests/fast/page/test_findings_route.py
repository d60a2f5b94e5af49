"""The address at which a page has what was found said in its language."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from fastapi import FastAPI
from starlette.types import Receive, Scope, Send
from tests.in_process import Caller, without_threads

from arboleda.dashboard.page_part import GROUP
from arboleda.host.packages import registered
from arboleda.host.pieces import Pieces, piece_of
from arboleda.web.access.auth import Role
from arboleda.web.api import answer_in_sentences
from arboleda.web.package_routes import guarded
from arboleda_make.page import findings_route

FOUND = {"lines": ['the key "a" is missing', "cells.b: there is nothing to undo"]}
SAID = {"lines": ['es: the key "a" is missing', "es: cells.b: there is nothing to undo"]}


@pytest.fixture(autouse=True)
def no_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    without_threads(monkeypatch)


class Make:
    def translate(self, language: str, lines: list[str]) -> list[str]:
        return [f"{language}: {line}" for line in lines]


def page(role: Role, make: Make | None) -> Caller:
    app, beside = FastAPI(), FastAPI()
    answer_in_sentences(app)
    side: Any = SimpleNamespace(ask=lambda _kind: make)
    findings_route.serve(beside, side)
    (point,) = (each for each in registered(GROUP) if each.name == "make")
    app.router.routes += guarded(beside.router.routes, point, {}, Pieces(), piece_of(point, "its page"))

    async def as_role(scope: Scope, receive: Receive, send: Send) -> None:
        await app({**scope, "arboleda.role": role}, receive, send)

    return Caller(as_role)


def test_lines_come_back_in_the_language_of_the_page() -> None:
    assert page(Role.OPERATOR, Make()).post("/findings.json?lang=es", json=FOUND).json() == SAID


def test_a_plant_without_a_draft_has_none() -> None:
    assert page(Role.OPERATOR, None).post("/findings.json?lang=es", json=FOUND).status_code == 404


def test_a_viewer_has_no_lines_said() -> None:
    assert page(Role.VIEWER, Make()).post("/findings.json?lang=es", json=FOUND).status_code == 403
