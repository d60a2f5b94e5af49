"""Routes of a package that sleep or hang delay nothing but the routes of their package."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from tests.added_package import install
from tests.patience import PATIENCE_S
from websockets.sync.client import connect
from websockets.typing import Origin

from arboleda.web import routes, second_loop

CODE = """
import threading

from fastapi import APIRouter, HTTPException, WebSocket

STARTED, GOES_ON = threading.Semaphore(0), threading.Event()


def hang():
    STARTED.release()
    GOES_ON.wait(60)
    return "gone on"


async def sleep():  # it should not, and does
    return hang()


async def refuse():
    raise HTTPException(418, "no tea")


async def where():
    return threading.current_thread().name


async def follow(socket: WebSocket):
    await socket.accept()
    await socket.send_text(await socket.receive_text() + threading.current_thread().name)
    await socket.close()


def routes(side):
    api = APIRouter(prefix="/api/{name}")
    for each in (hang, sleep, refuse, where):
        api.add_api_route("/" + each.__name__, each)
    api.add_api_websocket_route("/follow", follow)
    return api
"""


@pytest.fixture
def web(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, serve: Callable[..., Any]) -> Iterator[Any]:
    """A plant with two packages of somebody else."""
    monkeypatch.syspath_prepend(tmp_path / "site")
    for name in ("acme", "bolt"):
        code = CODE.replace("{name}", name)
        install(tmp_path / "site", name, code, group=routes.GROUP, what="routes")
    yield serve()
    for name in ("acme", "bolt"):
        sys.modules.pop(name, None)


@pytest.fixture
def browsers() -> Iterator[ThreadPoolExecutor]:
    with ThreadPoolExecutor(50) as pool:
        yield pool
        sys.modules["acme"].GOES_ON.set()


@pytest.mark.parametrize(("path", "count"), [("sleep", 1), ("hang", 45)])
def test_everybody_else_is_answered_meanwhile(
    web: Any, browsers: ThreadPoolExecutor, path: str, count: int
) -> None:
    asked = [browsers.submit(web.client().get, f"/api/acme/{path}") for _ in range(count)]
    acme = sys.modules["acme"]
    assert all(acme.STARTED.acquire(timeout=PATIENCE_S) for _ in range(min(count, 40)))
    assert web.client().get("/api/plant").json()["plant"] == "demo"
    assert web.client().get("/api/history").status_code == 200
    assert web.client().get("/api/bolt/where").json() == "routes of bolt"
    assert not any(each.done() for each in asked)
    acme.GOES_ON.set()
    assert {each.result(PATIENCE_S).json() for each in asked} == {"gone on"}


def test_what_a_route_refuses_is_refused_as_everywhere(web: Any) -> None:
    answer = web.client().get("/api/acme/refuse")
    assert (answer.status_code, answer.json()) == (418, {"sentence": "no tea"})


def test_a_websocket_is_served_there_too(web: Any) -> None:
    with connect(f"ws://127.0.0.1:{web.port}/api/acme/follow", origin=Origin(web.origin)) as socket:
        socket.send("in the ")
        assert socket.recv(PATIENCE_S) == "in the routes of acme"


def test_the_server_ends_while_a_route_of_a_package_hangs(
    web: Any, browsers: ThreadPoolExecutor, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(second_loop, "END_S", 0.1)
    browsers.submit(web.client().get, "/api/acme/sleep")
    assert sys.modules["acme"].STARTED.acquire(timeout=PATIENCE_S)
    web.server.stop()
    assert "the web server leaves its routes of acme, which did not end within 0.1 s" in caplog.text
