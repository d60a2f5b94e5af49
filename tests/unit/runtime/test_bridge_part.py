"""What the bridge sends is as old as the step that it came of, however long its thread stood still since."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.adapters import clock
from arboleda.adapters.broker_login import Address
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import MotionState
from arboleda.plant_file import loader
from arboleda.runtime.parts import bridge
from arboleda.runtime.parts.broker import OtherBroker
from arboleda.wire.payloads import Presence, Telemetry, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Connection, Delivery, Publication


class Client:
    """In the place of the MQTT client: since when what it is given waits."""

    def __init__(self) -> None:
        self.since: list[float | None] = []

    def start(self) -> None: ...

    def publish(self, _: Publication, since: float | None = None) -> None:
        self.since.append(since)


def test_what_it_sends_counts_from_the_step_that_it_came_of(monkeypatch: pytest.MonkeyPatch) -> None:
    client = Client()
    reported_at: list[float] = []
    monkeypatch.setattr(bridge, "MqttClient", lambda *_, **__: client)
    model, now = loader.load(None), clock.seconds()
    part = bridge.BridgePart(model, 7, OtherBroker(Address(host="127.0.0.1", port=1), None), _crash)
    part.connect(lambda _report: reported_at.append(clock.seconds()))
    part.join()
    part.send(Stop(id="7-1", robot="ra1", mode=StopMode.LATCH))
    part.loop.post(Connection(at=now, client="", up=True))
    still = Telemetry(state=MotionState.STOPPED, q=(0.0,) * 3, node=None)
    for channel, said in ((Channel.PRESENCE, Presence(online=True)), (Channel.TELEMETRY, still)):
        where = topic(model.robots["ra1"].mqtt, channel)
        part.loop.post(Delivery(at=now, topic=where, payload=encode(said), retain=False))
    part.loop.turn()  # its reports leave before the stop that the board, back again, may have forgotten
    (since,) = client.since
    assert since is not None and now <= since < reported_at[0]


def _crash(_: str, error: BaseException) -> Any:
    raise error
