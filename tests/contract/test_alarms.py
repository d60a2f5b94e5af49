"""Alarms as they arrive: over HTTP at a real server, over MQTT at a real broker, from a plant that runs."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.webhook import Hook, NotDelivered, Webhook
from arboleda.model.messages import Verb
from arboleda.runtime.alarm_options import AlarmOptions
from arboleda.runtime.build import App, Options, build
from arboleda.runtime.parts.alarms import OnTopic
from arboleda.runtime.parts.broker import OtherBroker
from arboleda.runtime.parts.part import Broker
from arboleda.testing import shipped

from ..patience import PATIENCE_S
from .conftest import Inbox, Mosquitto

ALARM = {"id": "lab-1-1", "sentence": "sis_a is held", "dropped": 0}


class Hooked:
    """An HTTP server that keeps what is posted, and answers once its gate is open."""

    def __init__(self) -> None:
        self.posts: Inbox = Inbox()
        self.gate = threading.Event()
        self.gate.set()
        hooked = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                posted = self.rfile.read(int(self.headers["Content-Length"]))
                hooked.gate.wait(PATIENCE_S)
                hooked.posts.put(json.loads(posted))  # whoever has the answer may look at once
                self.send_response(204)
                self.end_headers()

            def log_message(self, *_: object) -> None: ...

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def hook(self) -> Hook:
        return Hook(url=f"http://127.0.0.1:{self.server.server_port}/hooks/SECRET")

    def close(self) -> None:
        self.gate.set()
        self.server.shutdown()
        self.server.server_close()


@pytest.fixture
def hooked() -> Iterator[Hooked]:
    made = Hooked()
    yield made
    made.close()


def test_over_mqtt_an_alarm_waits_for_the_broker_and_is_taken_once_it_has_it(
    mosquitto: Callable[..., Mosquitto], peer: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    broker = mosquitto()
    monkeypatch.setattr("arboleda.runtime.parts.alarms.TAKES_S", 0.3)
    topic = OnTopic(shipped(), OtherBroker(broker.address, None), "arboleda/alarms")
    with pytest.raises(NotDelivered, match="is not connected"):
        topic.post(ALARM)
    monkeypatch.setattr("arboleda.runtime.parts.alarms.TAKES_S", PATIENCE_S)
    broker.start()
    reader = peer("reader", broker.address, subscriptions=["arboleda/alarms"]).up()
    topic.post(ALARM)
    reader.inbox.wait(lambda inbox: inbox.payloads)
    assert [json.loads(each) for each in reader.inbox.payloads] == [ALARM]
    broker.stop()
    monkeypatch.setattr("arboleda.runtime.parts.alarms.TAKES_S", 0.3)
    with pytest.raises(NotDelivered):
        topic.post(ALARM)
    topic.close()


@pytest.fixture
def running(hooked: Hooked, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[App]:
    """The shipped plant on virtual boards, with its API, whose alarms go to both, however long that takes."""
    patient = partial(Webhook, timeout_s=2 * PATIENCE_S)
    monkeypatch.setattr("arboleda.runtime.parts.alarms.Webhook", patient)
    alarms = AlarmOptions(hook=hooked.hook(), topic="arboleda/alarms")
    options = Options(state_dir=tmp_path / "state", page=False, rate=10.0, of_parts=(alarms,))
    app = build(shipped("sis_a"), {"broker", "devices", "bridge", "orchestrator", "web"}, options)
    app.start()
    yield app
    hooked.gate.set()
    app.stop()


def at(app: App, state: str) -> None:
    """Wait until its cell is in this state."""
    end = time.monotonic() + PATIENCE_S
    while (cell := app.plant.screens.snapshot()["cells"][0])["state"] != state or cell["not_ready"]:
        assert time.monotonic() < end, (cell["state"], cell["not_ready"])
        time.sleep(0.05)


def test_a_stop_of_a_plant_that_runs_arrives_by_both_ways(
    running: App, hooked: Hooked, peer: Callable[..., Any]
) -> None:
    address = running.offers.need(Broker).address
    reader = peer("reader", address, subscriptions=["arboleda/alarms"]).up()
    at(running, "idle")
    running.plant.submit("sis_a 0B 7 #t1").result(PATIENCE_S)
    at(running, "execute")
    running.plant.operate(Verb.STOP).result(PATIENCE_S)
    hooked.posts.wait(lambda posts: len(posts) == 2)
    by_kind = {post["kind"]: post for post in hooked.posts}
    assert by_kind.keys() == {"task_failed", "cell_held"}
    failed, held = by_kind["task_failed"], by_kind["cell_held"]
    assert failed["task"] == {"id": "t1", "text": "sis_a 0B 7"} and failed["reason"] == "stopped"
    assert held["state"] == "aborted" and held["plant"] == running.model.name and held["advice"]
    reader.inbox.wait(lambda inbox: len(inbox.payloads) == 2)
    told = [json.loads(each) for each in reader.inbox.payloads]
    assert {each["id"] for each in told} == {failed["id"], held["id"]}


def test_a_receiver_that_hangs_costs_the_plant_nothing(running: App, hooked: Hooked) -> None:
    hooked.gate.clear()
    at(running, "idle")
    running.plant.operate(Verb.STOP).result(PATIENCE_S)
    running.plant.operate(Verb.CLEAR).result(PATIENCE_S)
    running.plant.operate(Verb.STOP).result(PATIENCE_S)
    assert not hooked.posts, "both were answered while it hung"
