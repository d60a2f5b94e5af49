"""The port of the plant's own broker: the usual one, or another where nobody has to find it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.adapters.broker_login import MQTT_PORT, TLS_PORT, Address
from arboleda.model.errors import StartError
from arboleda.runtime.parts import broker
from arboleda.runtime.parts.broker import OwnBroker

OTHER = 50_000  # the port that a system gives to who asks for any


@pytest.fixture
def taken(monkeypatch: pytest.MonkeyPatch) -> set[int]:
    """Ports that somebody else has, for a broker that only pretends to listen."""
    ports: set[int] = set()

    def embedded(host: str, port: int, **_: Any) -> SimpleNamespace:
        def start() -> Address:
            if port in ports:
                raise StartError("the port is taken")
            return Address(host=host, port=port or OTHER)

        return SimpleNamespace(start=start, credentials=None)

    monkeypatch.setattr(broker, "EmbeddedBroker", embedded)
    return ports


def own(*, found_by_port: bool, tls: Any = None) -> OwnBroker:
    return OwnBroker("127.0.0.1", None, frozenset(), found_by_port=found_by_port, tls=tls)


@pytest.mark.parametrize("found_by_port", [True, False])
@pytest.mark.parametrize(("tls", "port"), [(None, MQTT_PORT), (object(), TLS_PORT)], ids=["plain", "TLS"])
def test_it_listens_on_the_usual_port(taken: set[int], found_by_port: bool, tls: Any, port: int) -> None:
    listening = own(found_by_port=found_by_port, tls=tls)
    listening.start()
    assert listening.address.port == port


def test_it_takes_another_port_where_nobody_else_must_find_it(taken: set[int]) -> None:
    taken.add(MQTT_PORT)
    listening = own(found_by_port=False)
    listening.start()
    assert listening.address.port == OTHER


def test_it_does_not_hide_from_clients_that_look_for_it(taken: set[int]) -> None:
    taken.add(MQTT_PORT)
    with pytest.raises(StartError, match="the port is taken"):
        own(found_by_port=True).start()
