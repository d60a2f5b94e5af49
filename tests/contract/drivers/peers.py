"""A press behind each driver, which a test plays by hand: what it is told, and whatever it is to say."""

from __future__ import annotations

import importlib.util
import json
import queue
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol

from arboleda.adapters.broker_login import address
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.model.plant_model import MotionState
from arboleda.wire.transport import Connection, Delivery, Publication

PATIENCE_S = 20.0
BEAT_S = 0.1
NAME = "press"
EXAMPLE = Path(__file__).parents[3] / "examples/own_driver"
CODES = {"stopped": MotionState.STOPPED, "moving": MotionState.MOVING, "latched": MotionState.STOP_LATCHED}
HALT, LATCH, CLEAR = "halt", "latch", "clear"
STOPS = {2: HALT, 1: LATCH, 0: CLEAR}


@dataclass(frozen=True, kw_only=True)
class Order:
    """What the press was told: a verb, or a stop; `ref` is how its protocol names the command."""

    ref: Any
    word: str


@dataclass(frozen=True, kw_only=True)
class Words:
    """What the press says; ids are the refs of orders."""

    state: str = "stopped"
    guard: str = "open"
    boot: int = 1
    accepted: Any = None
    done: Any = None
    rejected: tuple[Any, str] | None = None
    failed: tuple[Any, str] | None = None
    answered: tuple[Any, str] | None = None


class Wire(Protocol):
    """One protocol: `told` gets each order, in any thread."""

    def say(self, words: Words) -> None: ...
    def vanish(self) -> None:
        """The connection ends, as where a cable is pulled."""

    def come_back(self) -> None: ...
    def close(self) -> None: ...


@dataclass
class Press:
    """It says its words again and again, until it is hushed."""

    connect: Callable[[Callable[[Order], None]], Wire]
    words: Words = field(default_factory=Words)
    orders: queue.Queue[Order] = field(default_factory=queue.Queue)
    taken: list[Order] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._quiet, self._ending = threading.Event(), threading.Event()
        self._wire = self.connect(self.orders.put)
        self._thread = threading.Thread(target=self._speak, name="press", daemon=True)
        self._thread.start()

    def told(self, word: str) -> Any:
        """The ref of the next order, which is this one."""
        order = self.orders.get(timeout=PATIENCE_S)
        self.taken.append(order)
        assert order.word == word
        return order.ref

    def says(self, **words: Any) -> None:
        """Changes what it says, and says it."""
        self.words = replace(self.words, **words)
        self._wire.say(self.words)

    def hush(self) -> None:
        self._quiet.set()

    def vanish(self) -> None:
        self._quiet.set()
        self._wire.vanish()

    def come_back(self) -> None:
        self._wire.come_back()
        self._quiet.clear()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self._wire.close()

    def _speak(self) -> None:
        while not self._ending.wait(BEAT_S):
            if not self._quiet.is_set():
                self._wire.say(self.words)


class MqttWire:
    """A board on a broker, as topics.md describes it."""

    def __init__(self, broker: str, told: Callable[[Order], None]) -> None:
        self._broker, self._told, self._number = broker, told, 0
        self._client = self._connected()

    def say(self, words: Words) -> None:
        self._number += 1
        said: dict[str, Any] = {
            "estado": CODES[words.state].value,
            "seq": self._number,
            "arranque": words.boot,
        }
        said |= {"datos": {"guard": words.guard}}
        refs = [ref for ref in (words.accepted, words.done) if ref is not None]
        refs += [pair[0] for pair in (words.rejected, words.failed, words.answered) if pair is not None]
        if refs:
            said |= {"epoca_ack": refs[0][0], "ack": words.accepted[1] if words.accepted else 0}
        if words.done is not None:
            said |= {"hecho": words.done[1]}
        if words.rejected is not None:
            said |= {"rechazo_seq": words.rejected[0][1], "rechazo": words.rejected[1]}
        if words.failed is not None:
            said |= {"fallos": [[words.failed[0][1], words.failed[1]]]}
        if words.answered is not None:
            said |= {"respuesta_seq": words.answered[0][1], "respuesta": words.answered[1]}
        self._publish("sensores", json.dumps(said).encode())

    def vanish(self) -> None:
        self._publish("conexion", b"0", retain=True)  # what the broker says in its place
        self._client.close()

    def come_back(self) -> None:
        self._client = self._connected()

    def close(self) -> None:
        self._client.close()

    def _connected(self) -> MqttClient:
        up = threading.Event()

        def heard(event: Delivery | Connection) -> None:
            if isinstance(event, Delivery):
                self._read(event.topic, json.loads(event.payload))
            elif event.up:
                up.set()

        topics = [f"{NAME}/{channel}" for channel in ("orden", "paro")]
        client = MqttClient(NAME, address(self._broker), on_event=heard, subscriptions=topics)
        client.start()
        assert up.wait(PATIENCE_S)
        client.publish(Publication(topic=f"{NAME}/conexion", payload=b"1", retain=True))
        return client

    def _read(self, topic: str, said: dict[str, Any]) -> None:
        word = said["verbo"] if topic.endswith("orden") else STOPS[said["paro"]]
        self._told(Order(ref=(said["epoca"], said["seq"]), word=word))

    def _publish(self, channel: str, payload: bytes, *, retain: bool = False) -> None:
        message = Publication(topic=f"{NAME}/{channel}", payload=payload, qos=0, retain=retain)
        with suppress(NotConnected):  # nobody hears it, as on any wire that is cut
            self._client.publish(message)


class LineWire:
    """The controller of the example, played by hand."""

    def __init__(self, server: Any) -> None:
        self._server = server

    def say(self, words: Words) -> None:
        said = {"state": words.state, "boot": words.boot, "facts": {"guard": words.guard}}
        ids = {name: getattr(words, name) for name in ("accepted", "done", "rejected", "failed", "answered")}
        self._server.say(said | {name: id for name, id in ids.items() if id is not None})

    def vanish(self) -> None:
        self._server.hang_up()

    def come_back(self) -> None:
        """It is always welcome."""

    def close(self) -> None:
        self._server.close()


def line_of(order: dict[str, Any]) -> Order:
    """An order as a line has it."""
    return Order(ref=order["id"], word=order.get("do") or order["stop"])


def controller() -> ModuleType:
    """The virtual controller of the example."""
    spec = importlib.util.spec_from_file_location("own_controller", EXAMPLE / "controller.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class RosWire:
    """A robot on ROS 2: verbs on one topic, stops on another, all that it says in `status`."""

    def __init__(self, told: Callable[[Order], None]) -> None:
        from arboleda_ros.link import connect

        self._told, self._connect = told, connect
        self.come_back()

    def say(self, words: Words) -> None:
        from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

        facts = json.dumps({"guard": words.guard})
        said = {"state": str(CODES[words.state].value), "boot_id": str(words.boot), "facts": facts}
        said |= {name: id for name in ("accepted", "done") if (id := getattr(words, name)) is not None}
        if words.rejected is not None:
            said |= {"rejected": words.rejected[0], "reason": words.rejected[1]}
        if words.failed is not None:
            said |= {"failed": words.failed[0], "failure": words.failed[1]}
        if words.answered is not None:
            said |= {"answered": words.answered[0], "answer": json.dumps(words.answered[1])}
        values = [KeyValue(key=key, value=value) for key, value in said.items()]
        message = DiagnosticStatus(name=f"arboleda: {NAME}", hardware_id=NAME, values=values)
        if self._link is not None:
            self._status.publish(message)

    def vanish(self) -> None:
        self._link = self._link.close()

    def come_back(self) -> None:
        from diagnostic_msgs.msg import DiagnosticStatus
        from std_msgs.msg import String, UInt8

        self._link = self._connect()
        node = self._link.node("press_controller")
        self._status = node.create_publisher(DiagnosticStatus, f"{NAME}/status", 10)
        node.create_subscription(String, f"{NAME}/order", self._read, 10)
        node.create_subscription(UInt8, f"{NAME}/stop_cmd", self._read_stop, 10)
        self._link.start()

    def close(self) -> None:
        if self._link is not None:
            self.vanish()

    def _read(self, message: Any) -> None:
        said = json.loads(message.data)
        self._told(Order(ref=said["id"], word=said["verb"]))

    def _read_stop(self, message: Any) -> None:
        self._told(Order(ref=None, word=STOPS[message.data]))
