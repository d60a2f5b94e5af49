"""Faults by hand over HTTP: who may, and what is said of a wrong request."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import httpx
import pytest
from tests.guarded_plant import PRESENT, shared_app

from arboleda.web.access.auth import Role
from arboleda_proofs.routes import faults
from arboleda_proofs.running.api import BegunFault, FaultRefused, FaultsApi

BEGUN = BegunFault(number=1, robot="ra1", kind="no_grip", about="Grip beside the part", left_s=600.0)
NO_GRIP = {"kind": "no_grip", "robot": "ra1", "seconds": 600}
Ask = Callable[..., httpx.Response]


class Desk:
    """Desk that begins one kind of fault at ra1, and nothing else."""

    def __init__(self) -> None:
        self.going_on: list[BegunFault] = []

    def offers(self) -> list[Any]:
        return []

    def begun(self) -> list[BegunFault]:
        return self.going_on

    def begin(self, kind: str, robot: str, seconds: float | None) -> BegunFault:
        if robot != "ra1":
            raise FaultRefused(f"there is no device {robot}")
        self.going_on.append(BEGUN)
        return BEGUN

    def end(self, robot: str = "", number: int | None = None) -> list[BegunFault]:
        if number is not None:
            raise FaultRefused(f"no fault {number} goes on now")
        ended, self.going_on = self.going_on, []
        return ended


@pytest.fixture
def desk() -> Desk:
    return Desk()


@pytest.fixture
def ask(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> Ask:
    """`ask(path, body)`: what a plant with that desk answers to a post of somebody."""

    async def here(call: Callable[[], Any]) -> Any:
        return call()

    monkeypatch.setattr(faults, "run_in_threadpool", here)

    def go(
        path: str, body: dict[str, Any], *, role: Role = Role.OPERATOR, at: Desk | None = desk
    ) -> httpx.Response:
        monkeypatch.setattr(PRESENT, "plant", SimpleNamespace(ask={FaultsApi: at}.get))

        async def as_role(scope: Any, receive: Any, send: Any) -> None:
            await shared_app()({**scope, "arboleda.role": role}, receive, send)

        async def post() -> httpx.Response:
            transport = httpx.ASGITransport(app=as_role)
            async with httpx.AsyncClient(transport=transport, base_url="http://plant") as client:
                return await client.post(f"/api/faults{path}", json=body)

        return asyncio.run(post())

    return go


def test_a_fault_begins_and_ends(ask: Ask, desk: Desk) -> None:
    assert ask("", NO_GRIP).json()["left_s"] == 600.0
    assert desk.going_on == [BEGUN]
    assert [each["kind"] for each in ask("/end", {"robot": "ra1"}).json()] == ["no_grip"]
    assert desk.going_on == []


@pytest.mark.parametrize(
    ("path", "body", "status", "said"),
    [
        ("", {"kind": "no_grip", "robot": "ra9"}, 409, "there is no device ra9"),
        ("", {"kind": "no_grip", "robot": "ra1", "seconds": "5"}, 422, "seconds"),
        ("", {"kind": "no_grip"}, 422, "robot"),
        ("/end", {"number": 77}, 409, "no fault 77 goes on now"),
    ],
)
def test_a_wrong_request_changes_nothing_and_says_why(
    ask: Ask, desk: Desk, path: str, body: dict[str, Any], status: int, said: str
) -> None:
    answer = ask(path, body)
    assert (answer.status_code, desk.going_on) == (status, [])
    assert said in answer.json()["sentence"]


@pytest.mark.parametrize(("path", "body"), [("", NO_GRIP), ("/end", {})])
def test_a_viewer_may_provoke_nothing(ask: Ask, desk: Desk, path: str, body: dict[str, Any]) -> None:
    answer = ask(path, body, role=Role.VIEWER)
    assert (answer.status_code, desk.going_on) == (403, [])
    assert "provoking a fault needs the operator's token" in answer.json()["sentence"]


def test_a_process_without_devices_refuses_all(ask: Ask) -> None:
    answer = ask("", NO_GRIP, at=None)
    assert (answer.status_code, answer.json()["sentence"]) == (409, faults.NOT_HERE)
