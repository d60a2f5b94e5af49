"""Lines and the broker: order, copies, losses, and what a connection takes with it when it ends."""

from __future__ import annotations

import pytest

from arboleda.rig.network import Broker, Client, Hop, Line
from arboleda.wire.transport import Delivery, Publication

TELEMETRY, COMMAND, PRESENCE = "ra_1/sensores", "ra_1/juntas", "ra_1/conexion"


class Net:
    """A broker with a board and a bridge; `pass_time` brings what is under way."""

    def __init__(self) -> None:
        self.now = 0.0
        self.delivered: list[tuple[str, Delivery]] = []
        self._agenda: list[tuple[float, int, object, object]] = []
        self.outdated: list[Delivery] = []
        self.broker = Broker(self, self._at, self.delivered, self.outdated)
        self.board, self.bridge = Client("ra_1", [COMMAND]), Client("bridge", [TELEMETRY, PRESENCE])
        for client in (self.board, self.bridge):
            self.broker.join(client)
            client.connect(True)

    def say(self, payload: bytes, topic: str = TELEMETRY, *, retain: bool = False) -> None:
        self.broker.publish(Publication(topic=topic, payload=payload, retain=retain), self.board)

    def pass_time(self, seconds: float) -> list[bytes]:
        """The payloads that arrive meanwhile."""
        before, end = len(self.heard), self.now + seconds
        while self._agenda and min(self._agenda)[0] <= end:
            due = min(self._agenda)
            self._agenda.remove(due)
            self.now = due[0]
            due[2](due[3])
        self.now = end
        return [payload for _, _, payload, _ in self.heard[before:]]

    @property
    def heard(self) -> list[tuple[float, str, bytes, bool]]:
        return [(each.at, name, each.payload, each.retain) for name, each in self.delivered]

    @property
    def payloads(self) -> list[bytes]:
        return [payload for _, _, payload, _ in self.heard]

    def _at(self, time, call, argument):
        self._agenda.append((time, len(self._agenda) + len(self.heard) * 1000, call, argument))


@pytest.fixture
def net():
    return Net()


def late(seconds):
    return lambda message: (seconds,)


def test_what_is_sent_after_a_day_in_which_nobody_did_anything_stays_behind_what_was_under_way():
    line, hop = Line(), Hop()
    for way in (line, hop):
        way.troubles.append(late(8.0))
    assert line.carry(1.0, "old") == hop.carry_on("ra1/command", 1.0, "old") == [9.0]
    for way in (line, hop):
        way.skip(80_000.0)
        way.troubles.clear()
    assert line.carry(80_002.0, "new") == hop.carry_on("ra1/command", 80_002.0, "new") == [80_009.0]


def test_a_calm_line_brings_everything_at_once():
    line = Line()
    assert [line.carry(now, "x") for now in (1.0, 1.0, 2.5)] == [[1.0], [1.0], [2.5]]


def test_the_delays_of_several_troubles_add_up():
    line = Line()
    line.troubles += [late(0.5), late(0.25)]
    assert line.carry(1.0, "x") == [1.75]


def test_messages_keep_their_order_behind_a_late_one():
    line = Line()
    line.troubles.append(late(2.0))
    line.carry(1.0, "slow")
    line.troubles.clear()
    assert line.carry(1.5, "behind it") == [3.0]
    assert line.carry(4.0, "later") == [4.0]


def test_messages_overtake_each_other_where_the_line_reorders():
    line = Line()
    line.troubles.append(late(2.0))
    line.carry(1.0, "slow")
    line.troubles.clear()
    line.reorders += 1
    assert line.carry(1.5, "quick") == [1.5]
    line.reorders -= 1
    assert line.carry(1.6, "in order again") == [3.0]


def test_presence_keeps_its_place_even_where_the_line_reorders():
    line = Line()
    line.reorders += 1
    line.troubles.append(late(2.0))
    line.carry(1.0, Publication(topic=PRESENCE, payload=b"0", retain=True))
    line.troubles.clear()
    assert line.carry(1.5, Publication(topic=PRESENCE, payload=b"1", retain=True)) == [3.0]


def test_a_message_can_be_lost_or_come_twice():
    line = Line()
    line.troubles.append(lambda message: () if message == "lost" else (0.0, 0.5))
    assert line.carry(1.0, "lost") == []
    assert line.carry(1.0, "twice") == [1.0, 1.5]
    assert line.busy_until == 1.5


def test_troubles_multiply_copies():
    line = Line()
    line.troubles += [lambda message: (0.0, 1.0), lambda message: (0.0, 0.5)]
    assert sorted(line.carry(0.0, "x")) == [0.0, 0.5, 1.0, 1.5]


def test_what_is_not_late_is_there_before_publish_returns(net):
    net.say(b"1")
    assert net.heard == [(0.0, "bridge", b"1", False)]


def test_only_those_who_subscribed_hear_it(net):
    net.broker.publish(Publication(topic=COMMAND, payload=b"go"))
    assert [name for _, name, _, _ in net.heard] == ["ra_1"]


def test_both_directions_make_it_late(net):
    net.board.up.troubles.append(late(1.0))
    net.bridge.down.troubles.append(late(0.5))
    net.say(b"1")
    assert net.pass_time(1.4) == []
    assert net.pass_time(0.2) == [b"1"]


def test_who_is_not_connected_neither_speaks_nor_hears(net):
    net.board.connect(False)
    net.say(b"1")
    net.board.connect(True)
    net.bridge.connect(False)
    net.say(b"2")
    assert net.payloads == []


def test_what_was_under_way_is_lost_with_the_connection(net):
    net.bridge.down.troubles.append(late(1.0))
    net.say(b"1")
    net.bridge.connect(False)
    net.bridge.connect(True)
    assert net.pass_time(5.0) == []


def test_a_lost_queue_takes_what_waits_but_not_presence(net):
    net.bridge.down.troubles.append(late(1.0))
    net.say(b"telemetry")
    net.say(b"1", PRESENCE, retain=True)
    net.bridge.queue += 1
    net.say(b"later")
    assert net.pass_time(5.0) == [b"1", b"later"]


def test_the_last_retained_message_is_told_to_whoever_subscribes(net):
    for payload in (b"0", b"1"):
        net.say(payload, PRESENCE, retain=True)
    net.delivered.clear()
    net.broker.tell_retained(net.bridge)
    net.broker.tell_retained(net.board)
    assert net.heard == [(0.0, "bridge", b"1", True)]


def test_a_broker_that_dies_takes_everything_with_it(net):
    net.say(b"1", PRESENCE, retain=True)
    net.delivered.clear()
    net.board.up.troubles.append(late(1.0))
    net.say(b"under way")
    net.broker.die()
    net.broker.is_up = True
    for client in (net.board, net.bridge):
        client.connect(True)
        net.broker.tell_retained(client)
    assert net.pass_time(5.0) == []
    assert not net.broker.retained


@pytest.mark.parametrize("line", ["up", "down"])
def test_what_comes_of_a_client_that_was_superseded_meanwhile_is_outdated_and_what_it_says_then_is_not(
    net, line
):
    net.say(b"in time")
    {"up": net.board.up, "down": net.bridge.down}[line].troubles.append(late(1.0))
    net.say(b"under way")
    net.board.superseded = True
    net.say(b"later")
    assert net.pass_time(5.0) == [b"under way", b"later"]
    assert [each.payload for each in net.outdated] == [b"under way"]
