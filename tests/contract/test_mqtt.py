"""The MQTT client at a mosquitto, and at the plant's own broker where that might do otherwise."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import pytest
from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion, MQTTProtocolVersion

from arboleda.adapters import mqtt
from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import Address, Credentials
from arboleda.adapters.clock import seconds
from arboleda.adapters.mqtt import NotConnected, PromptClient
from arboleda.model.plant_model import MqttVersion
from arboleda.wire.transport import Publication

from ..patience import PATIENCE_S
from .conftest import Inbox, Mosquitto, said

GOALS, STATE, PRESENCE = "ra_1/juntas", "ra_1/sensores", "ra_1/conexion"


def message(payload: bytes, topic: str = GOALS, **options) -> Publication:
    return Publication(topic=topic, payload=payload, **options)


def lines(caplog) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.name == "arboleda.adapters.mqtt"]


@pytest.fixture
def mosquitto_there(mosquitto: Callable[..., Mosquitto]) -> Mosquitto:
    broker = mosquitto()
    broker.start()
    return broker


@pytest.fixture
def own() -> Iterator[Address]:
    """The address of the plant's own broker."""
    broker = EmbeddedBroker(port=0)
    yield broker.start()
    broker.stop()


@pytest.fixture
def tries(monkeypatch: pytest.MonkeyPatch) -> Callable[[int], None]:
    """`tries(5)`: wait until clients have tried so often to connect."""
    made = Inbox()
    connect = PromptClient.connect

    def counted(client: PromptClient, *args: Any, **options: Any) -> Any:
        made.put(args)
        return connect(client, *args, **options)

    monkeypatch.setattr(PromptClient, "connect", counted)
    return lambda count: made.wait(lambda inbox: len(inbox) >= count)


def test_messages_arrive_in_order_at_every_quality(mosquitto_there, peer):
    board = peer("ra_1", mosquitto_there.address, subscriptions=[GOALS]).up()
    bridge = peer("bridge", mosquitto_there.address).up()
    sent = [b"%d" % n for n in range(90)]

    for payload in sent:
        bridge.client.publish(message(payload))
    board.inbox.wait(lambda inbox: len(inbox.deliveries) == len(sent))
    for payload in sent:
        bridge.client.publish(message(payload, qos=0))
    board.inbox.wait(lambda inbox: len(inbox.deliveries) == 2 * len(sent))

    assert board.inbox.payloads == sent + sent
    assert {(each.topic, each.retain) for each in board.inbox.deliveries} == {(GOALS, False)}


def connections(port: int) -> Iterator[socket.socket]:
    """The ends of TCP connections to that port that this process has, as copies."""
    for name in os.listdir("/proc/self/fd"):
        try:
            end = socket.socket(fileno=os.dup(int(name)))
        except OSError:  # no socket, or closed meanwhile
            continue
        with end:
            if end.family != socket.AF_INET or end.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN):
                continue
            with suppress(OSError):  # one that is not connected any more
                if port in (end.getsockname()[1], end.getpeername()[1]):
                    yield end


def test_answers_are_not_held_back_by_the_sockets(own, peer):
    """Without TCP_NODELAY each answer waits 40 ms for an acknowledgment of what was sent before it."""
    for name in ("ra_1", "bridge"):
        peer(name, own, subscriptions=[GOALS]).up()
    options = [end.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY) for end in connections(own.port)]
    assert len(options) >= 4, "both clients, and the broker's ends of them"
    assert all(options)


def test_a_plant_of_many_robots_subscribes_in_packets_that_the_own_broker_takes(own, peer):
    robots = [f"{'r' * 60}{n:03}" for n in range(600)]
    bridge = peer("bridge", own, subscriptions=[f"{robot}/sensores" for robot in robots]).up()
    for robot in (robots[0], robots[-1]):
        bridge.client.publish(message(robot.encode(), f"{robot}/sensores"))
    assert bridge.inbox.wait(lambda inbox: len(inbox.payloads) == 2)


def test_after_a_restart_of_the_broker_it_subscribes_again_and_replays_nothing(mosquitto_there, peer):
    board = peer("ra_1", mosquitto_there.address, subscriptions=[GOALS]).up()
    bridge = peer("bridge", mosquitto_there.address).up()
    bridge.client.publish(message(b"before"))
    board.inbox.wait(lambda inbox: inbox.deliveries)

    mosquitto_there.stop()
    for one in (board, bridge):
        one.inbox.wait(lambda inbox: inbox.links == [True, False])
    with pytest.raises(NotConnected):
        bridge.client.publish(message(b"between"))
    mosquitto_there.start()
    for one in (board, bridge):
        one.inbox.wait(lambda inbox: inbox.links == [True, False, True])
    bridge.client.publish(message(b"after"))

    assert board.inbox.wait(lambda inbox: len(inbox.payloads) == 2 and inbox.payloads) == [
        b"before",
        b"after",
    ]


def test_an_outage_is_told_once_and_so_is_its_end(mosquitto, peer, tries, caplog):
    broker = mosquitto()
    peer("gone", broker.address, announce=False).client.close()
    bridge = peer("bridge", broker.address)
    quiet = peer("ra_1", broker.address, announce=False)
    tries(8)
    broker.start()
    bridge.up()
    quiet.up()

    where = f"The MQTT broker at {broker.address} is"
    missing, back = lines(caplog)
    assert missing.startswith(f"{where} not there (")
    assert "refused" in missing
    assert back == f"{where} there."


def test_closing_leaves_no_last_will_and_loses_nothing(mosquitto_there, peer, caplog):
    will = message(b"lost", PRESENCE, retain=True)
    watcher = peer("watcher", mosquitto_there.address, subscriptions=[PRESENCE, GOALS]).up()
    board = peer("ra_1", mosquitto_there.address, will=will).up()

    for n in range(20):
        board.client.publish(message(b"%d" % n))
    board.client.publish(message(b"left", PRESENCE, retain=True))
    board.client.close()
    watcher.client.publish(message(b"end"))

    heard = watcher.inbox.wait(lambda inbox: b"end" in inbox.payloads and inbox.payloads)
    assert heard == [*(b"%d" % n for n in range(20)), b"left", b"end"]
    assert board.inbox.links == [True, False]
    with pytest.raises(NotConnected):
        board.client.publish(message(b"late"))
    board.client.close()
    assert lines(caplog) == []


def test_who_is_gone_leaves_its_last_will_and_a_newer_connection_has_the_last_word(own, peer, raw_peer):
    watcher = peer("watcher", own, subscriptions=[PRESENCE]).up()
    older = raw_peer(own, "ra_1", will=(PRESENCE, b"0"))
    older.publish(PRESENCE, b"1", retain=True)
    watcher.inbox.wait(lambda inbox: inbox.payloads == [b"1"])

    newer = raw_peer(own, "ra_1", will=(PRESENCE, b"0"))
    newer.publish(PRESENCE, b"1", retain=True)
    assert older.socket.recv(1) == b""
    watcher.inbox.wait(lambda inbox: inbox.payloads == [b"1", b"0", b"1"])
    newer.close()
    watcher.inbox.wait(lambda inbox: inbox.payloads == [b"1", b"0", b"1", b"0"])

    late = peer("late", own, subscriptions=[PRESENCE])
    late.inbox.wait(lambda inbox: inbox.payloads == [b"0"])
    assert late.inbox.deliveries[0].retain and not any(each.retain for each in watcher.inbox.deliveries)


def test_a_refused_login_is_one_sentence(mosquitto, peer, tries, caplog):
    strict = mosquitto("allow_anonymous false")
    strict.start()
    peer("bridge", strict.address)
    peer("ra_1", strict.address, credentials=Credentials(user="ra_1", password="wrong"))
    for who in ("a client", "user"):
        said(caplog, f"refused {who}")
    tries(8)

    told = sorted(lines(caplog))
    where = f"The MQTT broker at {strict.address} refused"
    assert told == [
        f"{where} a client without user name over MQTT 3.1.1: Not authorized; trying again.",
        f"{where} user 'ra_1' over MQTT 3.1.1: Not authorized; trying again.",
    ]


def test_over_mqtt_5_commands_expire_after_a_second(mosquitto_there, peer):
    heard = Inbox()

    def note(_client, _userdata, one):
        heard.put((one.payload, getattr(one.properties, "MessageExpiryInterval", None)))

    listener = Client(CallbackAPIVersion.VERSION2, protocol=MQTTProtocolVersion.MQTTv5)
    listener.on_message = note
    listener.connect(mosquitto_there.address.host, mosquitto_there.address.port)
    listener.subscribe("#", 1)
    listener.loop_start()
    bridge = peer("bridge", mosquitto_there.address, subscriptions=[GOALS], version=MqttVersion.V5).up()
    try:
        bridge.client.publish(message(b"goal"))
        bridge.client.publish(message(b"1", PRESENCE, retain=True))
        bridge.client.publish(message(b"beat", "ra_1/latido", qos=0))
        heard.wait(lambda inbox: len(inbox) == 3)
    finally:
        listener.disconnect()
        listener.loop_stop()

    assert dict(heard) == {b"goal": 1, b"1": None, b"beat": None}


def test_over_mqtt_5_huge_messages_do_not_come(mosquitto_there, peer):
    bridge = peer("bridge", mosquitto_there.address, subscriptions=[GOALS], version=MqttVersion.V5).up()
    other = peer("other", mosquitto_there.address).up()
    for payload in (b"x" * 100_000, b"small"):
        other.client.publish(message(payload))
    bridge.inbox.wait(lambda inbox: b"small" in inbox.payloads)
    assert (bridge.inbox.payloads, bridge.inbox.links) == ([b"small"], [True])


def test_what_was_right_too_long_ago_never_leaves_and_ends_the_connection(mosquitto_there, peer, caplog):
    board = peer("ra_1", mosquitto_there.address, subscriptions=[GOALS]).up()
    bridge = peer("bridge", mosquitto_there.address).up()

    bridge.client.publish(message(b"late"), since=seconds() - mqtt.WAITS_S - 0.1)

    bridge.inbox.wait(lambda inbox: inbox.links == [True, False, True])
    bridge.client.publish(message(b"fresh"), since=seconds() + PATIENCE_S)
    board.inbox.wait(lambda inbox: inbox.deliveries)
    assert board.inbox.payloads == [b"fresh"]
    assert any(f"waited in this process for more than {mqtt.WAITS_S:g} s" in line for line in lines(caplog))


FROZEN_S = 0.5  # what lay so long in that process is out of date
TALKATIVE = """
import sys, time
from arboleda.adapters.broker_login import Address
from arboleda.adapters.clock import seconds
from arboleda.adapters import mqtt
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.wire.transport import Publication

mqtt.WAITS_S = float(sys.argv[3])
client = MqttClient("bridge", Address(host=sys.argv[1], port=int(sys.argv[2])), on_event=lambda event: None)
client.start()
while True:
    try:
        now = seconds()
        client.publish(Publication(topic="ra_1/juntas", payload=repr(now).encode()), since=now)
    except NotConnected:  # nor does it take more than some in advance
        time.sleep(0.01)
"""


def test_a_process_that_was_frozen_sends_nothing_of_before(mosquitto_there, peer):
    """What lay in it was right for the leader that it was; another one may lead the robots by now."""
    board = peer("ra_1", mosquitto_there.address, subscriptions=[GOALS]).up()
    other = peer("ra_2", mosquitto_there.address).up()
    where = mosquitto_there.address.host, str(mosquitto_there.address.port), str(FROZEN_S)
    child = subprocess.Popen([sys.executable, "-c", TALKATIVE, *where])
    try:
        board.inbox.wait(lambda inbox: len(inbox.deliveries) > 50)
        child.send_signal(signal.SIGSTOP)
        until, marks = seconds() + 2 * FROZEN_S, 0
        while marks < 3 or seconds() < until:  # the one message that was on its way has arrived by then
            marks += 1
            other.client.publish(message(b"-%d" % marks))
            board.inbox.wait(lambda inbox, marks=marks: b"-%d" % marks in inbox.payloads)
        before, thawed_at = len(board.inbox.deliveries), seconds()
        child.send_signal(signal.SIGCONT)
        board.inbox.wait(lambda inbox: float(inbox.payloads[-1]) > thawed_at)
    finally:
        child.kill()
        child.wait()
    assert [each for each in board.inbox.deliveries[before:] if float(each.payload) < thawed_at] == []
