"""Lesson 9: what a board hears and says: a virtual ESP32 on an MQTT broker, and a client that talks to it."""

from __future__ import annotations

import json
import time
from argparse import ArgumentParser
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Event
from typing import Any

from paho.mqtt.client import Client, MQTTMessage
from paho.mqtt.enums import CallbackAPIVersion

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import address as broker_address
from arboleda.extension import StartError, load
from arboleda.runtime.build import Options, build
from arboleda_class.lessons import spoken

PLANT = Path(__file__).parent / "plants" / "lessons.yaml"
BOARD = "ra_1"
EPOCH = 1  # which run of a sender a number belongs to; a restarted sender takes a higher one
PATIENCE_S = 15.0
TOLD = ("estado", "q1_mov", "ack", "hecho", "rechazo", "rechazo_seq")
STILL, MOVING = 0, 1

Said = dict[str, Any]


class Talk:
    """An MQTT client that publishes commands to one board and waits for what it says."""

    def __init__(self, host: str, port: int) -> None:
        self._heard: SimpleQueue[Said] = SimpleQueue()
        self._client = Client(CallbackAPIVersion.VERSION2)
        self._client.on_connect = lambda client, *_: client.subscribe(f"{BOARD}/sensores")
        self._client.on_message = self._hear
        self._client.connect(host, port)
        self._client.loop_start()

    def say(self, channel: str, **payload: float) -> None:
        """Publish on a topic of the board."""
        text = json.dumps(payload)
        print(f"  -> {BOARD}/{channel} {text}", flush=True)
        self._client.publish(f"{BOARD}/{channel}", text, qos=1)

    def wait(self, arrived: Callable[[Said], bool]) -> None:
        """Until the board says so; what it said then is printed."""
        until = time.monotonic() + PATIENCE_S
        try:
            said = self._heard.get(timeout=PATIENCE_S)
            while not arrived(said):
                said = self._heard.get(timeout=max(0.0, until - time.monotonic()))
        except Empty:
            raise SystemExit(f"{BOARD} did not say that within {PATIENCE_S:g} s") from None
        print(
            f"  <- {BOARD}/sensores {json.dumps({key: said[key] for key in TOLD if key in said})}", flush=True
        )

    def close(self) -> None:
        self._client.disconnect()
        self._client.loop_stop()

    def _hear(self, _client: Client, _data: object, message: MQTTMessage) -> None:
        self._heard.put(json.loads(message.payload))


def lesson(talk: Talk) -> None:
    print("The board reports ten times a second, asked or not.")
    talk.wait(lambda said: said["estado"] == STILL)

    print("A move: accepted, under way, done.")
    talk.say("juntas", q1=45, q2=10, q3=0, seq=1, epoca=EPOCH)
    talk.wait(lambda said: said.get("ack") == 1 and said["estado"] == MOVING)
    talk.wait(lambda said: said.get("hecho") == 1 and said["estado"] == STILL)

    print("An older number: a message that was held up on the way must not move anything.")
    talk.say("juntas", q1=0, q2=0, q3=0, seq=0, epoca=EPOCH)
    talk.wait(lambda said: said.get("rechazo") == "viejo")

    print("Beyond the limit of the joint: refused as a whole.")
    talk.say("juntas", q1=999, q2=0, q3=0, seq=2, epoca=EPOCH)
    talk.wait(lambda said: said.get("rechazo") == "limite")

    print("Halted on the way: still again, but the command is never done.")
    talk.say("juntas", q1=-90, q2=0, q3=0, seq=3, epoca=EPOCH)
    talk.wait(lambda said: said.get("ack") == 3 and said["estado"] == MOVING)
    talk.say("paro", paro=2, seq=4, epoca=EPOCH)
    talk.wait(lambda said: said.get("ack") == 4 and said["estado"] == STILL)

    print("One beat, then silence: the board stops by itself after a second.")
    talk.say("latido", epoca=EPOCH)
    talk.say("juntas", q1=-90, q2=0, q3=0, seq=5, epoca=EPOCH)
    talk.wait(lambda said: said.get("ack") == 5 and said["estado"] == MOVING)
    talk.wait(lambda said: said["estado"] == STILL)


def main() -> None:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("--broker", metavar="HOST:PORT", help="a broker of yours [default: one of its own]")
    parser.add_argument("--port", type=int, default=1883, help="of its own broker; 0 is any free one")
    parser.add_argument("--stay", action="store_true", help="only start the board, to talk to it by hand")
    words = parser.parse_args()
    own = None if words.broker else EmbeddedBroker(port=words.port)
    try:
        address = own.start() if own else broker_address(words.broker)
        talk = Talk(address.host, address.port)
    except StartError as error:
        raise SystemExit(f"{error}\nChoose another one: --port N, or --broker HOST:PORT.") from None
    except OSError as error:
        raise SystemExit(f"{address} does not answer: {error.strerror or error}") from None
    plant = load(PLANT)
    board = build(replace(plant, cells=plant.cells[:1]), {"devices"}, Options(broker=str(address)))
    board.start()
    try:
        print(f"{BOARD} is on the broker {address}.", flush=True)
        Event().wait() if words.stay else lesson(talk)
    except KeyboardInterrupt:
        pass
    finally:
        talk.close()
        board.stop()
        if own is not None:
            own.stop()


if __name__ == "__main__":
    spoken(main)
