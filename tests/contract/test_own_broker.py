"""Where the plant's own broker listens."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest

from arboleda.model.errors import StartError
from arboleda.runtime.parts import broker
from arboleda.runtime.parts.broker import OwnBroker


@pytest.fixture
def usual_port(monkeypatch: pytest.MonkeyPatch, free_port: int) -> int:
    """A port of this test's own that stands for 1883."""
    monkeypatch.setattr(broker, "MQTT_PORT", free_port)
    return free_port


@pytest.fixture
def taken(usual_port: int) -> Iterator[int]:
    with socket.create_server(("127.0.0.1", usual_port)):
        yield usual_port


@pytest.mark.parametrize("found_by_port", [True, False])
def test_it_listens_on_the_usual_port(usual_port: int, found_by_port: bool) -> None:
    own = OwnBroker("127.0.0.1", None, frozenset(), found_by_port=found_by_port)
    own.start()
    try:
        assert own.address.port == usual_port
    finally:
        own.stop()


def test_it_takes_another_port_where_nobody_else_must_find_it(taken: int) -> None:
    own = OwnBroker("127.0.0.1", None, frozenset(), found_by_port=False)
    own.start()
    try:
        assert own.address.port not in (0, taken)
    finally:
        own.stop()


def test_it_does_not_hide_from_clients_that_look_for_it(taken: int) -> None:
    with pytest.raises(StartError, match=f"127.0.0.1:{taken}: the port is taken"):
        OwnBroker("127.0.0.1", None, frozenset(), found_by_port=True).start()
