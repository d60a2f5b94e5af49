"""The firmware's board as a program, with what goes wrong."""

from __future__ import annotations

import json
import subprocess
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from arboleda.adapters.broker_login import Address
from arboleda.adapters.mqtt import MqttClient
from arboleda.wire.transport import Connection, Delivery, Publication

from ..patience import PATIENCE_S

pytestmark = pytest.mark.system

EPOCH = 7


class Desk:
    """A board's program with its console at hand, and a client that hears what it says."""

    def __init__(
        self, program: str, port: int, *, name: str = "ra_1", words: tuple[str, ...] = ("--robot", "ra_1")
    ) -> None:
        self.heard: list[Delivery] = []
        self._name = name
        self._seq = 0
        topics = (f"{name}/sensores", f"{name}/conexion")
        address = Address(host="127.0.0.1", port=port)
        self._client = MqttClient("desk", address, subscriptions=topics, on_event=self._hear)
        self._client.start()
        self.program = subprocess.Popen(
            [program, *words, "--broker", f"127.0.0.1:{port}"], stdin=subprocess.PIPE, text=True
        )

    def type(self, line: str) -> None:
        assert self.program.stdin is not None
        print(line, file=self.program.stdin, flush=True)

    def send(self, channel: str, **body: Any) -> None:
        self._seq += 1
        payload = json.dumps({**body, "seq": self._seq, "epoca": EPOCH}).encode()
        self._client.publish(Publication(topic=f"{self._name}/{channel}", payload=payload))

    def wait(self, such: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """The first telemetry from now on that is such."""
        begin, until = len(self.heard), time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            for delivery in self.heard[begin:]:
                if delivery.topic.endswith("sensores") and such(said := json.loads(delivery.payload)):
                    return said
            time.sleep(0.01)
        return pytest.fail(f"never heard; last: {self.heard[-1:]}")

    def presence(self) -> bytes:
        return [each.payload for each in self.heard if each.topic.endswith("conexion")][-1]

    def close(self) -> None:
        self.program.terminate()
        self.program.wait(PATIENCE_S)
        assert self.program.stdin is not None
        self.program.stdin.close()
        self._client.close()

    def _hear(self, event: Delivery | Connection) -> None:
        if isinstance(event, Delivery):
            self.heard.append(event)


@pytest.fixture
def desk(board: str, mosquitto: Callable[[int], Any], free_port: int) -> Iterator[Desk]:
    mosquitto(free_port)
    made = Desk(board, free_port)
    yield made
    made.close()


def test_what_goes_wrong_at_its_console_shows_in_what_it_says(desk: Desk) -> None:
    before = desk.wait(lambda said: True)
    desk.type("reboot")
    after = desk.wait(lambda said: said["arranque"] != before["arranque"])
    assert (after["estado"], after["ref"]) == (3, 0)
    desk.send("referencia", ref=1)
    homed = desk.wait(lambda said: said.get("hecho") == 1)
    assert (homed["estado"], homed["ref"], homed["q1_mov"]) == (0, 1, 0.0)

    desk.type("lose 1 500")  # steps, which show nowhere but on the console
    desk.send("juntas", q1=9, q2=0, q3=0)
    said = desk.wait(lambda said: said.get("hecho") == 2)
    assert said["q1_mov"] == pytest.approx(9, abs=0.01)

    desk.send("juntas", q1=54, q2=0, q3=0)
    desk.wait(lambda said: said["estado"] == 1)
    desk.type("mute 2")  # it says nothing meanwhile, and goes on moving
    assert desk.wait(lambda said: said["estado"] != 1)["hecho"] == 3

    desk.send("juntas", q1=-90, q2=0, q3=0)
    desk.wait(lambda said: said["q1_mov"] < 50)
    desk.type("stall 300")  # a loop that hangs at speed loses steps, and asks for homing
    lost = desk.wait(lambda said: said["estado"] != 1)
    assert (lost["estado"], lost["ref"], lost.get("hecho") == 4) == (3, 0, False)


def test_a_board_that_was_there_before_its_broker_joins_it_and_leaves_it_with_a_word(
    board: str, mosquitto: Callable[[int], Any], free_port: int
) -> None:
    desk = Desk(board, free_port)
    try:
        mosquitto(free_port)
        assert desk.wait(lambda said: True)["estado"] == 0
        assert desk.presence() == b"1"
        desk.type("quit")
        assert desk.program.wait(PATIENCE_S) == 0
        until = time.monotonic() + PATIENCE_S
        while desk.presence() != b"0" and time.monotonic() < until:
            time.sleep(0.01)
        assert desk.presence() == b"0"
    finally:
        desk.close()
