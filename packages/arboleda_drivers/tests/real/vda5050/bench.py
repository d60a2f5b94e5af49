"""A cart behind the driver `vda5050`: its vehicle is played by hand at a broker."""

from __future__ import annotations

import threading
from contextlib import suppress
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import address
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.testing.drivers import Bench
from arboleda.testing.drivers.bench import HALT, LATCH, Ref
from arboleda.wire.transport import Connection, Delivery, Publication
from arboleda_drivers.vda5050.messages import Headers, from_bytes, to_bytes

from ..contract.mover import WORDS, Opened, PlayedMover, app_of, plant

BEAT_S = 0.1
VERSION, TOPICS = "2.1", "uagv/v2/played/agv1"
NODES = (0, 7, 5)
STOPS = {"startPause": LATCH, "cancelOrder": HALT}


class PlayedVehicle(PlayedMover):
    """Orders wait for the test, but those home, which it does at once; instant actions are over at once."""

    def __init__(self) -> None:
        self._broker = EmbeddedBroker("127.0.0.1", 0)
        self.address = str(self._broker.start())
        super().__init__()
        self._last: dict[str, dict[str, Any]] = {}  # the last node of each order, by its id
        self._lock = threading.RLock()
        self._headers = Headers(VERSION, "played", "agv1")
        self._state = dict(STANDING)
        self._quiet, self._ending = threading.Event(), threading.Event()
        self._client = self._connected()
        self._thread = threading.Thread(target=self._speak, name="played vehicle", daemon=True)
        self._thread.start()

    def accepts(self, ref: Ref) -> None:
        self._say(orderId=ref, nodeStates=[STEP], driving=True)

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        goal = self._last[ref]
        at = {"lastNodeId": goal["nodeId"], "lastNodeSequenceId": goal["sequenceId"]} if there else {}
        self._say(orderId=ref, nodeStates=[], driving=False, **at)

    def rejects(self, ref: Ref) -> str:
        about = [{"referenceKey": "orderId", "referenceValue": ref}]
        self._say(errors=[{"errorType": "noRouteError", "errorLevel": "WARNING", "errorReferences": about}])
        return "(noRouteError)"

    def gives_up(self, ref: Ref) -> str:
        error = {"errorType": "driveError", "errorLevel": "FATAL"}
        self._say(orderId=ref, nodeStates=[], driving=False, errors=[error])
        return "gave up (driveError)"

    def rests(self) -> None:
        self._say(nodeStates=[], driving=False)

    def hush(self) -> None:
        self._quiet.set()

    def boots(self) -> None:
        with self._lock:
            self._headers = Headers(VERSION, "played", "agv1")
            self._state = dict(STANDING)
        self._say()

    def vanish(self) -> None:
        self._quiet.set()
        self._publish("connection", {"connectionState": "CONNECTIONBROKEN"}, retain=True)
        self._client.close()

    def come_back(self) -> None:
        self._state = dict(STANDING)
        self._client = self._connected()
        self._quiet.clear()

    def latches(self) -> None:
        self._say(paused=True)

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self._client.close()
        self._broker.stop()

    def _connected(self) -> MqttClient:
        up = threading.Event()

        def heard(event: Delivery | Connection) -> None:
            if isinstance(event, Delivery):
                self._hear(event.topic.rpartition("/")[2], event.payload)
            elif event.up:
                up.set()

        topics = [f"{TOPICS}/order", f"{TOPICS}/instantActions"]
        client = MqttClient("played", address(self.address), on_event=heard, subscriptions=topics)
        self._client = client
        client.start()
        assert up.wait(PATIENCE_S)
        self._publish("connection", {"connectionState": "ONLINE"}, retain=True)
        return client

    def _hear(self, topic: str, payload: bytes) -> None:
        said = from_bytes(VERSION, topic, payload)
        if topic == "instantActions":
            self._do(said["actions"])
            return
        ref, goal = said["orderId"], said["nodes"][-1]
        self._last[ref] = goal
        if self._is_made(WORDS[NODES.index(int(goal["nodeId"]))], ref):
            self.finishes(ref)

    def _do(self, actions: list[dict[str, Any]]) -> None:
        over = [{"actionId": each["actionId"], "actionStatus": "FINISHED"} for each in actions]
        self._say(actionStates=[*self._state["actionStates"], *over][-20:])
        found = [STOPS[each["actionType"]] for each in actions if each["actionType"] in STOPS]
        if found:
            self.orders.put((found[0], None))

    def _say(self, **news: Any) -> None:
        with self._lock:
            self._state |= news
            self._publish("state", self._state)

    def _publish(self, topic: str, body: dict[str, Any], *, retain: bool = False) -> None:
        with self._lock, suppress(NotConnected):  # nobody hears it, as on any wire that is cut
            payload = to_bytes(VERSION, topic, {**self._headers(topic), **body})
            self._client.publish(
                Publication(topic=f"{TOPICS}/{topic}", payload=payload, qos=0, retain=retain)
            )

    def _speak(self) -> None:
        while not self._ending.wait(BEAT_S):
            if not self._quiet.is_set():
                self._say()


STEP = {"nodeId": "x", "sequenceId": 2, "released": True}
STANDING: dict[str, Any] = {
    "orderId": "",
    "orderUpdateId": 0,
    "lastNodeId": str(NODES[0]),
    "lastNodeSequenceId": 0,
    "nodeStates": [],
    "edgeStates": [],
    "driving": False,
    "paused": False,
    "actionStates": [],
    "batteryState": {"batteryCharge": 80.0, "charging": False},
    "operatingMode": "AUTOMATIC",
    "errors": [],
    "safetyState": {"eStop": "NONE", "fieldViolation": False},
}


def _open(folder: Path, state: Path) -> Opened:
    vehicle = PlayedVehicle()
    keys = f'broker: "{vehicle.address}", manufacturer: played, serial: agv1, base: 0, silent_after_s: 1.5'
    text = plant("cart", f"kind: mobile, driver: {{vda5050: {{{keys}}}}}", "node", NODES)
    return app_of(folder, state, text, "cart"), lambda app: vehicle


BENCH = Bench(open=_open, takes="arboleda_drivers.vda5050.machine.read")
