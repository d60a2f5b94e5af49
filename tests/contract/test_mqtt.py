"""The MQTT client against each kind of broker."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress

import pytest
from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion, MQTTProtocolVersion

from arboleda.adapters import mqtt
from arboleda.adapters.broker_login import Credentials
from arboleda.adapters.clock import seconds
from arboleda.adapters.mqtt import WAITS_S, NotConnected
from arboleda.model.plant_model import MqttVersion
from arboleda.wire.transport import Publication

from ..patience import PATIENCE_S, SOON_S
from .conftest import said

GOALS, STATE, PRESENCE = "ra_1/juntas", "ra_1/sensores", "ra_1/conexion"


def message(payload: bytes, topic: str = GOALS, **options) -> Publication:
    return Publication(topic=topic, payload=payload, **options)


def lines(caplog) -> list[str]:
    return [record.getMessage() for record in caplog.records if record.name == "arboleda.adapters.mqtt"]


def test_a_subscriber_hears_what_is_published_after_it_is_up(broker, peer):
    board = peer("ra_1", broker.address, subscriptions=[GOALS]).up()
    bridge = peer("bridge", broker.address).up()

    began = time.monotonic()
    bridge.client.publish(message(b"goal"))

    heard = board.inbox.wait(lambda inbox: inbox.deliveries)[0]
    assert (heard.topic, heard.payload, heard.retain) == (GOALS, b"goal", False)
    assert began <= heard.at <= time.monotonic()


def test_a_retained_message_is_flagged_for_a_newcomer_only(broker, peer):
    early = peer("early", broker.address, subscriptions=[PRESENCE]).up()
    early.client.publish(message(b"1", PRESENCE, retain=True))
    early.inbox.wait(lambda inbox: inbox.deliveries)

    late = peer("late", broker.address, subscriptions=[PRESENCE])

    assert late.inbox.wait(lambda inbox: inbox.deliveries)[0].retain is True
    assert late.inbox.links == [True]
    assert early.inbox.deliveries[0].retain is False


def test_messages_arrive_in_order_at_every_quality(broker, peer):
    board = peer("ra_1", broker.address, subscriptions=[GOALS]).up()
    bridge = peer("bridge", broker.address).up()
    sent = [b"%d" % n for n in range(90)]

    for payload in sent:
        bridge.client.publish(message(payload))
    board.inbox.wait(lambda inbox: len(inbox.deliveries) == len(sent))
    for payload in sent:
        bridge.client.publish(message(payload, qos=0))
    board.inbox.wait(lambda inbox: len(inbox.deliveries) == 2 * len(sent))

    assert board.inbox.payloads == sent + sent


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


def test_answers_are_not_held_back_by_the_sockets(broker, peer):
    """Without TCP_NODELAY each answer waits 40 ms for an acknowledgment of what was sent before it."""
    for name in ("ra_1", "bridge"):
        peer(name, broker.address, subscriptions=[GOALS]).up()
    options = [
        end.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY) for end in connections(broker.address.port)
    ]
    assert len(options) >= 2, "both clients, and the broker where it is in this process"
    assert all(options)


def test_an_oversized_payload_is_for_the_codec_to_refuse(broker, peer):
    board = peer("ra_1", broker.address, subscriptions=[GOALS]).up()
    board.client.publish(message(b"x" * 4000))
    assert len(board.inbox.wait(lambda inbox: inbox.payloads)[0]) == 4000


def test_over_mqtt_5_a_huge_message_does_not_even_come(mosquitto, peer):
    broker = mosquitto()
    broker.start()
    board = peer("ra_1", broker.address, subscriptions=[GOALS], version=MqttVersion.V5).up()
    other = peer("other", broker.address).up()
    for payload in (b"x" * 100_000, b"small"):
        other.client.publish(message(payload))
    assert board.inbox.wait(lambda inbox: inbox.payloads) == [b"small"]
    assert board.inbox.links == [True]


def test_a_plant_of_many_robots_subscribes_in_packets_that_every_broker_takes(broker, peer):
    robots = [f"{'r' * 60}{n:03}" for n in range(600)]
    bridge = peer("bridge", broker.address, subscriptions=[f"{robot}/sensores" for robot in robots]).up()
    for robot in (robots[0], robots[-1]):
        bridge.client.publish(message(robot.encode(), f"{robot}/sensores"))
    assert bridge.inbox.wait(lambda inbox: len(inbox.payloads) == 2)


def test_what_is_published_without_a_broker_is_refused_and_never_sent(stopped_broker, peer):
    board = peer("ra_1", stopped_broker.address, subscriptions=[GOALS])
    bridge = peer("bridge", stopped_broker.address)
    with pytest.raises(NotConnected, match="is not connected"):
        bridge.client.publish(message(b"old"))

    stopped_broker.start()
    board.up()
    bridge.up().client.publish(message(b"new"))

    assert board.inbox.wait(lambda inbox: inbox.payloads) == [b"new"]


def test_after_a_restart_of_the_broker_it_subscribes_again_and_replays_nothing(broker, peer):
    board = peer("ra_1", broker.address, subscriptions=[GOALS]).up()
    bridge = peer("bridge", broker.address).up()
    bridge.client.publish(message(b"before"))
    board.inbox.wait(lambda inbox: inbox.deliveries)

    broker.stop()
    for one in (board, bridge):
        one.inbox.wait(lambda inbox: inbox.links == [True, False])
    with pytest.raises(NotConnected):
        bridge.client.publish(message(b"between"))
    broker.start()
    for one in (board, bridge):
        one.inbox.wait(lambda inbox: inbox.links == [True, False, True])
    bridge.client.publish(message(b"after"))

    assert board.inbox.wait(lambda inbox: len(inbox.payloads) == 2 and inbox.payloads) == [
        b"before",
        b"after",
    ]


def test_an_outage_is_told_once_and_so_is_its_end(stopped_broker, peer, caplog):
    bridge = peer("bridge", stopped_broker.address)
    quiet = peer("ra_1", stopped_broker.address, announce=False)
    said(caplog, "is not there")
    time.sleep(1.0)  # several attempts more
    stopped_broker.start()
    bridge.up()
    quiet.up()

    where = f"The MQTT broker at {stopped_broker.address} is"
    missing, back = lines(caplog)
    assert missing.startswith(f"{where} not there (")
    assert "refused" in missing
    assert back == f"{where} there."


def test_nothing_is_told_when_all_is_well(broker, peer, caplog):
    bridge = peer("bridge", broker.address).up()
    bridge.client.close()
    assert lines(caplog) == []


def test_closing_leaves_no_last_will_and_loses_nothing(broker, peer):
    will = message(b"lost", PRESENCE, retain=True)
    watcher = peer("watcher", broker.address, subscriptions=[PRESENCE, GOALS]).up()
    board = peer("ra_1", broker.address, will=will).up()

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


def test_a_broken_connection_leaves_the_last_will_retained(broker, peer, raw_peer):
    watcher = peer("watcher", broker.address, subscriptions=[PRESENCE]).up()
    raw_peer(broker.address, "ra_1", will=(PRESENCE, b"0")).close()
    assert watcher.inbox.wait(lambda inbox: inbox.payloads) == [b"0"]

    late = peer("late", broker.address, subscriptions=[PRESENCE])
    assert late.inbox.wait(lambda inbox: inbox.deliveries)[0].retain is True


def test_a_newer_connection_of_the_same_board_has_the_last_word(broker, peer, raw_peer):
    watcher = peer("watcher", broker.address, subscriptions=[PRESENCE]).up()
    older = raw_peer(broker.address, "ra_1", will=(PRESENCE, b"0"))
    older.publish(PRESENCE, b"1", retain=True)
    watcher.inbox.wait(lambda inbox: inbox.payloads == [b"1"])

    newer = raw_peer(broker.address, "ra_1", will=(PRESENCE, b"0"))
    newer.publish(PRESENCE, b"1", retain=True)

    assert older.socket.recv(1) == b""
    watcher.inbox.wait(lambda inbox: inbox.payloads[:3] == [b"1", b"0", b"1"])
    late = peer("late", broker.address, subscriptions=[PRESENCE])
    assert late.inbox.wait(lambda inbox: inbox.payloads) == [b"1"]


def test_it_can_be_closed_while_there_is_no_broker(stopped_broker, peer):
    waiting = peer("bridge", stopped_broker.address)
    began = time.monotonic()
    waiting.client.close()
    assert time.monotonic() - began < SOON_S


def test_a_refused_login_is_one_sentence(mosquitto, peer, caplog):
    strict = mosquitto("allow_anonymous false")
    strict.start()
    peer("bridge", strict.address)
    peer("ra_1", strict.address, credentials=Credentials(user="ra_1", password="wrong"))
    for who in ("a client", "user"):
        said(caplog, f"refused {who}")
    time.sleep(1.0)  # several attempts more

    told = sorted(lines(caplog))
    where = f"The MQTT broker at {strict.address} refused"
    assert told == [
        f"{where} a client without user name over MQTT 3.1.1: Not authorized; trying again.",
        f"{where} user 'ra_1' over MQTT 3.1.1: Not authorized; trying again.",
    ]


def test_mqtt_5_lets_commands_expire_after_a_second(mosquitto, peer):
    broker = mosquitto()
    broker.start()
    expiries = {}

    def note(_client, _userdata, heard):
        expiries[heard.payload] = getattr(heard.properties, "MessageExpiryInterval", None)

    listener = Client(CallbackAPIVersion.VERSION2, protocol=MQTTProtocolVersion.MQTTv5)
    listener.on_message = note
    listener.connect(broker.address.host, broker.address.port)
    listener.subscribe("#", 1)
    listener.loop_start()
    bridge = peer("bridge", broker.address, subscriptions=[GOALS], version=MqttVersion.V5).up()
    try:
        bridge.client.publish(message(b"goal"))
        bridge.client.publish(message(b"1", PRESENCE, retain=True))
        bridge.client.publish(message(b"beat", "ra_1/latido", qos=0))
        deadline = time.monotonic() + PATIENCE_S
        while len(expiries) < 3 and time.monotonic() < deadline:
            time.sleep(0.01)
    finally:
        listener.disconnect()
        listener.loop_stop()

    assert expiries == {b"goal": 1, b"1": None, b"beat": None}


def test_what_was_right_too_long_ago_never_leaves_and_ends_the_connection(broker, peer, caplog):
    board = peer("ra_1", broker.address, subscriptions=[GOALS]).up()
    bridge = peer("bridge", broker.address).up()

    bridge.client.publish(message(b"late"), since=seconds() - mqtt.WAITS_S - 0.1)

    bridge.inbox.wait(lambda inbox: inbox.links == [True, False, True])
    bridge.client.publish(message(b"fresh"), since=seconds() + PATIENCE_S)
    board.inbox.wait(lambda inbox: inbox.deliveries)
    assert board.inbox.payloads == [b"fresh"]
    assert any(f"waited in this process for more than {mqtt.WAITS_S:g} s" in line for line in lines(caplog))


TALKATIVE = """
import sys, time
from arboleda.adapters.broker_login import Address
from arboleda.adapters.clock import seconds
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.wire.transport import Publication


client = MqttClient("bridge", Address(host=sys.argv[1], port=int(sys.argv[2])), on_event=lambda event: None)
client.start()
while True:
    try:
        now = seconds()
        client.publish(Publication(topic="ra_1/juntas", payload=repr(now).encode()), since=now)
    except NotConnected:  # nor does it take more than some in advance
        time.sleep(0.01)
"""


@pytest.mark.parametrize("stopped_broker", ["embedded", "mosquitto"], indirect=True)
def test_a_process_that_was_frozen_sends_nothing_of_before(broker, peer):
    """What lay in it was right for the leader that it was; another one may lead the robots by now."""
    board = peer("ra_1", broker.address, subscriptions=[GOALS]).up()
    other = peer("ra_2", broker.address).up()
    where = broker.address.host, str(broker.address.port)
    child = subprocess.Popen([sys.executable, "-c", TALKATIVE, *where])
    try:
        board.inbox.wait(lambda inbox: len(inbox.deliveries) > 50)
        child.send_signal(signal.SIGSTOP)
        time.sleep(WAITS_S + 0.5)
        for mark in (b"-1", b"-2", b"-3"):  # the one message that was on its way has arrived by then
            other.client.publish(message(mark))
            board.inbox.wait(lambda inbox, mark=mark: mark in inbox.payloads)
        before, thawed_at = len(board.inbox.deliveries), seconds()
        child.send_signal(signal.SIGCONT)
        board.inbox.wait(lambda inbox: float(inbox.payloads[-1]) > thawed_at)
    finally:
        child.kill()
        child.wait()
    assert [each for each in board.inbox.deliveries[before:] if float(each.payload) < thawed_at] == []
