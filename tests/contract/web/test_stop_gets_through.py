"""Whatever else is open: everybody who may stop the plant can, each of twenty times."""

from __future__ import annotations

import asyncio
import http.client
import json
import socket
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, closing, suppress
from threading import Event, Semaphore

import pytest
from fastapi import FastAPI
from starlette.types import Receive, Scope, Send
from tests.patience import PATIENCE_S
from tests.web_plant import TOKENS, VIEW, Plant

from arboleda.model.messages import Verb
from arboleda.web import second_loop, server
from arboleda.web.access.auth import Role
from arboleda.web.server import Server

from .conftest import Web

STOPS = 20
MOST = 64  # connections that the server takes
ADDRESSES = [f"127.0.0.{number}" for number in range(2, 22)]
# With Expect the server says when it waits for the body, of which no more comes.
SLOW = (
    "POST {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n{login}Content-Length: 40\r\n"
    "Expect: 100-continue\r\n\r\n"
)
STREAM = "GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n{login}\r\n"
VIEWER = {"Authorization": f"Bearer {TOKENS[Role.VIEWER]}"}
LOGIN = f"Authorization: {VIEWER['Authorization']}\r\n"


class Attack:
    """Twenty addresses open connections, say this and nothing after it, and open more for those cut off."""

    def __init__(self, web: Web, said: str, path: str = "", login: str = "", *, count: int = 100) -> None:
        self._port = web.port
        self._said = said.format(path=path, port=web.port, login=login).encode()
        self._answered = said in (SLOW, STREAM)
        self._count = count
        self._open = ExitStack()

    def __enter__(self) -> Attack:
        self.goes_on(self._count)
        return self

    def __exit__(self, *_: object) -> None:
        self._open.close()

    def goes_on(self, count: int = 4) -> None:
        for number in range(count):
            self._one(ADDRESSES[number % len(ADDRESSES)])

    def _one(self, address: str) -> None:
        talk = socket.create_connection(
            ("127.0.0.1", self._port), timeout=PATIENCE_S, source_address=(address, 0)
        )
        self._open.enter_context(talk)
        with suppress(ConnectionError):  # cut off at once
            talk.sendall(self._said)
            if self._answered:
                talk.recv(1)


def stops(web: Web, attack: Attack, login: dict[str, str]) -> list[int]:
    """The answers to that many stops, each over a connection of its own while the attack goes on."""
    answers = []
    for _ in range(STOPS):
        attack.goes_on()
        answers.append(stop(web, login))
    return answers


def stop(web: Web, login: dict[str, str]) -> int:
    """The status of the answer."""
    with closing(http.client.HTTPConnection("127.0.0.1", web.port, timeout=PATIENCE_S)) as client:
        client.request("POST", "/api/plant/stop", headers=login)
        return client.getresponse().status


def test_on_its_own_machine(serve, plant: Plant) -> None:
    web = serve(connections=MOST, streams=16)
    with Attack(web, SLOW, "/api/plant/stop") as attack:
        assert stops(web, attack, {}) == [200] * STOPS
    assert plant.acts == [(Verb.STOP, "", False)] * STOPS


@pytest.mark.parametrize(
    ("said", "path", "login"),
    [("", "", ""), (SLOW, "/api/plant/stop", LOGIN), (STREAM, "", LOGIN)],
    ids=["silent", "half a stop", "stream"],
)
def test_on_a_network(serve, plant: Plant, said: str, path: str, login: str) -> None:
    web = serve(dict(TOKENS), connections=MOST, streams=16)
    with Attack(web, said, path, login) as attack:
        assert stops(web, attack, VIEWER) == [200] * STOPS
    assert plant.acts == [(Verb.STOP, "", False)] * STOPS


def test_a_browser_that_is_logged_in_keeps_its_connection_while_strangers_crowd(serve) -> None:
    web = serve(dict(TOKENS), connections=MOST)
    browser = http.client.HTTPConnection("127.0.0.1", web.port, timeout=PATIENCE_S)
    with closing(browser):
        assert looks(browser)
        with Attack(web, SLOW, "/login"):
            assert looks(browser)


def looks(browser: http.client.HTTPConnection) -> bool:
    """Whether it gets the plant over the connection that it has."""
    browser.request("GET", "/api/plant", headers=VIEWER)
    answer = browser.getresponse()
    return json.load(answer) == VIEW and browser.sock is not None


def test_while_more_is_asked_than_the_server_can_answer(serve, plant: Plant) -> None:
    asked = Semaphore(0)
    web = serve(mount=lambda app: page_that_is_never_made(app, asked), connections=MOST)
    never = "GET /never HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n"
    with Attack(web, never, count=MOST - 1) as attack:
        for _ in range(MOST - 1):
            assert asked.acquire(timeout=PATIENCE_S)
        for _ in range(STOPS):
            attack.goes_on(1)
            assert asked.acquire(timeout=PATIENCE_S)  # the server is full again, and waits for nobody
            assert stop(web, {}) == 200


def page_that_is_never_made(app: FastAPI, asked: Semaphore) -> None:
    @app.get("/never")
    async def page() -> None:
        asked.release()
        await asyncio.Event().wait()


def test_while_something_else_is_made_that_takes_long(serve, plant: Plant) -> None:
    making, stopped = Event(), Event()

    def slow(app: FastAPI) -> None:
        @app.get("/slow")
        async def make() -> bool:  # in the loop, as a page or a snapshot is made
            making.set()
            return stopped.wait(PATIENCE_S)

    web = serve(mount=slow)
    with ThreadPoolExecutor() as browser:
        page = browser.submit(web.client().get, "/slow")
        assert making.wait(PATIENCE_S)
        assert stop(web, {}) == 200
        stopped.set()
        assert page.result().json() is True
    assert plant.acts == [(Verb.STOP, "", False)]


@pytest.fixture
def hanging(serve, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Web, Event]]:
    """A server whose page is never made, and the event that lets its thread go."""
    monkeypatch.setattr(second_loop, "END_S", 0.1)
    making, going_on = Event(), Event()

    def slow(app: FastAPI) -> None:
        @app.get("/slow")
        async def make() -> bool:
            making.set()
            return going_on.wait(PATIENCE_S)

    web = serve(mount=slow)
    with ThreadPoolExecutor() as browser:
        browser.submit(web.client().get, "/slow")
        assert making.wait(PATIENCE_S)
        yield web, going_on
        going_on.set()


def test_the_server_ends_while_a_page_is_made_for_ever(hanging: tuple[Web, Event]) -> None:
    web, going_on = hanging
    web.server.stop()
    assert not going_on.is_set()
    left = [thread for thread in threading.enumerate() if thread.name == "http pages"]
    going_on.set()
    for thread in left:
        thread.join(PATIENCE_S)


def test_the_server_ends_with_an_application_that_does_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(second_loop, "END_S", 0.1)
    monkeypatch.setattr(server, "STOP_S", PATIENCE_S)

    async def endless(scope: Scope, receive: Receive, send: Send) -> None:
        await receive()
        await send({"type": "lifespan.startup.complete"})
        await receive()
        await asyncio.Event().wait()

    served = Server(second_loop.SecondLoop(endless), port=0)
    served.start()
    served.stop()
    assert not {"http", "http pages"} & {thread.name for thread in threading.enumerate()}
