"""The real server before a plant that answers what a test prepared."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import httpx
import pytest
from fastapi import FastAPI, WebSocket, WebSocketDisconnect
from tests.patience import PATIENCE_S
from tests.web_plant import TOKENS, Plant
from tests.web_plant import local as local
from tests.web_plant import open_to_all as open_to_all
from tests.web_plant import plant as plant
from tests.web_plant import web as web

from arboleda.adapters.server_tls import ServerTls, pinned
from arboleda.web import limits
from arboleda.web.access.auth import Door, Role
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.api import make_app
from arboleda.web.package_routes import taking
from arboleda.web.second_loop import SecondLoop
from arboleda.web.server import Server


class Web:
    """A running server: where, and clients of it."""

    def __init__(self, server: Server, door: Door, tls: ServerTls | None = None) -> None:
        self.port = port = server.start()
        self.server = server
        self.door = door
        self.origin = f"{'https' if tls else 'http'}://127.0.0.1:{port}"
        self.believing = pinned(tls.pem) if tls else True
        self.cookie = f"arboleda_{port}"
        self._clients: list[httpx.Client] = []

    def client(self, *, token: Role | None = None, login: Role | None = None, **headers: str) -> httpx.Client:
        """Somebody with a token, a tool; or with a session, a browser; or with neither."""
        if token is not None:
            headers["authorization"] = f"Bearer {TOKENS[token]}"
        made = httpx.Client(
            base_url=self.origin, trust_env=False, headers=headers, timeout=PATIENCE_S, verify=self.believing
        )
        if login is not None:
            made.headers["origin"] = self.origin
            made.cookies.set(self.cookie, self.session(login))
        self._clients.append(made)
        return made

    def session(self, role: Role) -> str:
        session = self.door.log_in(TOKENS[role].encode())
        assert session
        return session

    def close(self) -> None:
        for client in self._clients:
            client.close()


def echo(app: FastAPI) -> None:
    """A websocket that says who is there and repeats what it hears, as a page's socket would."""

    @app.websocket("/_page/socket")
    async def socket(socket: WebSocket) -> None:
        await socket.accept()
        await socket.send_text(socket.scope["arboleda.role"].value)
        try:
            while True:
                await socket.send_text(await socket.receive_text())
        except WebSocketDisconnect:
            pass


@contextmanager
def running(
    plant: Plant,
    tokens: dict[Role, str] | None = None,
    public_url: str | None = None,
    mount: Callable[[FastAPI], None] = echo,
    sockets: int = limits.SOCKETS,
    streams: int = limits.STREAMS,
    tls: ServerTls | None = None,
    name: str = "",
    **options: Any,
) -> Iterator[Web]:
    """As on one's own machine; with tokens as on a network. Both listen to 127.0.0.1. `mount` adds pages,
    `name` is the plant's."""
    door = Door((lambda: tokens) if tokens else None)
    app = make_app(plant, streams=streams)
    mount(app)
    bound = "0.0.0.0" if tokens and not public_url else "127.0.0.1"
    names = names_for(bound, public_url, scheme="https" if tls else "http")
    guarded = Guard(SecondLoop(app), names, door, sockets=sockets, plant=name, takes=taking(app))
    server = Server(guarded, **{"port": 0, **options}, tls=tls)
    web = Web(server, door, tls)
    try:
        yield web
    finally:
        web.close()
        server.stop()


@pytest.fixture
def serve(plant: Plant) -> Iterator[Callable[..., Web]]:
    """`serve()`, `serve(tokens)`: see `running`."""
    with ExitStack() as stack:
        yield lambda *args, **options: stack.enter_context(running(plant, *args, **options))
