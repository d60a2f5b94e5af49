"""The end of a plant: robots first, and no web server that hangs holds it up."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.runtime.build import PARTS, Options, build
from arboleda.runtime.parts.web import WebPart
from arboleda.testing import shipped
from arboleda.web import server
from arboleda.web.server import Server

from ..patience import PATIENCE_S


def test_robots_are_halted_before_the_page_has_ended(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    app = build(shipped(), PARTS, Options(state_dir=tmp_path / "state", page=False))
    halted = threading.Event()
    plant = app.orchestrator
    assert plant is not None
    plant.observers.append(lambda stepped: halted.set() if stepped.intake.closed else None)
    stop, found = WebPart.stop, list[bool]()

    def late(part: WebPart) -> None:
        found.append(halted.wait(PATIENCE_S))
        stop(part)

    monkeypatch.setattr(WebPart, "stop", late)
    app.start()
    app.stop()
    assert found == [True]


@pytest.fixture
def hanging() -> Iterator[Any]:
    """An application that does not end before the test has."""
    over, ended = threading.Event(), threading.Event()

    async def app(scope: Any, receive: Any, send: Any) -> None:
        assert scope["type"] == "lifespan"
        await receive()
        await send({"type": "lifespan.startup.complete"})
        await receive()
        await asyncio.to_thread(over.wait)
        await send({"type": "lifespan.shutdown.complete"})
        ended.set()

    yield app
    over.set()
    assert ended.wait(PATIENCE_S)


def test_a_server_that_hangs_is_left_to_itself(
    hanging: Any, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, free_port: int
) -> None:
    monkeypatch.setattr(server, "STOP_S", 0.5)
    serving = Server(hanging, port=free_port)
    serving.start()
    with caplog.at_level(logging.WARNING):
        serving.stop()
    assert "the HTTP server does not end" in caplog.text
    serving.stop()
