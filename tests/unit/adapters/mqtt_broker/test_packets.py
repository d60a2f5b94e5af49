"""The packets of MQTT 3.1.1: what is read, what is refused, and that nothing else can happen."""

from __future__ import annotations

import struct
from contextlib import suppress
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.adapters.mqtt_broker import packets
from arboleda.adapters.mqtt_broker.limits import PACKET_BYTES, TOPIC_BYTES
from arboleda.adapters.mqtt_broker.packets import Answer, ConnectRefused, Kind, Message, ProtocolError, Stream

READERS = {
    Kind.CONNECT: lambda packet: packets.read_connect(packet.body),
    Kind.PUBLISH: packets.read_publish,
    Kind.SUBSCRIBE: lambda packet: packets.read_subscribe(packet.body),
    Kind.UNSUBSCRIBE: lambda packet: packets.read_unsubscribe(packet.body),
    Kind.PUBACK: lambda packet: packets.read_id(packet.body),
}


def text(value: str | bytes) -> bytes:
    raw = value.encode() if isinstance(value, str) else value
    return struct.pack("!H", len(raw)) + raw


def read(data: bytes) -> list[packets.Packet]:
    stream = Stream()
    stream.feed(data)
    return list(iter(stream.next, None))


def connect(*fields: bytes, flags: int = 2, name: str = "MQTT", level: int = 4) -> bytes:
    return text(name) + bytes((level, flags)) + struct.pack("!H", 5) + b"".join(fields)


@given(
    topic=st.text("abc/é", min_size=1, max_size=40),
    payload=st.binary(max_size=300),
    qos=st.integers(0, 2),
    retain=st.booleans(),
    number=st.integers(1, 65535),
)
def test_a_message_is_read_as_it_was_written(
    topic: str, payload: bytes, qos: int, retain: bool, number: int
) -> None:
    message = Message(topic=topic, payload=payload, qos=qos, retain=retain)
    [packet] = read(packets.publish(message, number))
    assert packets.read_publish(packet) == (message, number if qos else 0)


@given(data=st.binary(max_size=200), cuts=st.lists(st.integers(0, 200)))
def test_it_does_not_matter_in_which_pieces_bytes_come(data: bytes, cuts: list[int]) -> None:
    def outcome(pieces: list[bytes]) -> tuple[list[packets.Packet], bool]:
        stream, found = Stream(), []
        try:
            for piece in pieces:
                stream.feed(piece)
                found += iter(stream.next, None)
        except ProtocolError:
            return found, True
        return found, False

    places = [0, *sorted(min(cut, len(data)) for cut in cuts), len(data)]
    pieces = [data[begin:end] for begin, end in pairwise(places)]
    assert outcome(pieces)[1] == outcome([data])[1]
    if not outcome([data])[1]:
        assert outcome(pieces) == outcome([data])


@given(kind=st.sampled_from(sorted(READERS)), flags=st.integers(0, 15), body=st.binary(max_size=80))
def test_nonsense_is_a_protocol_error_and_nothing_worse(kind: Kind, flags: int, body: bytes) -> None:
    packet = packets.Packet(kind=kind, flags=flags, body=body)
    with suppress(ProtocolError, ConnectRefused):
        READERS[kind](packet)


@pytest.mark.parametrize("length", [b"\xff\xff\xff\x7f", b"\xff\xff\xff\xff", b"\x80\x20"])
def test_a_packet_that_is_too_long_is_refused_before_it_comes(length: bytes) -> None:
    with pytest.raises(ProtocolError, match=f"more than {PACKET_BYTES} bytes"):
        read(b"\x30" + length)


def test_the_longest_packet_is_read() -> None:
    message = Message(topic="t", payload=b"x" * (PACKET_BYTES - 6), qos=0, retain=False)
    written = packets.publish(message, 0)
    assert len(written) == PACKET_BYTES
    assert len(read(written)) == 1


@pytest.mark.parametrize("first", [0x00, 0xF0, 0x11, 0x80, 0x60, 0xC1])
def test_types_and_flags_that_mqtt_has_not_are_refused(first: int) -> None:
    with pytest.raises(ProtocolError):
        read(bytes((first, 0)))


def test_connect_says_who_it_is_and_what_it_leaves() -> None:
    will = text("ra_1/conexion") + text("0")
    said = packets.read_connect(connect(text("id"), will, text("ra_1"), text(b"\xff"), flags=0xEE))
    assert (said.client_id, said.clean, said.keep_alive_s) == ("id", True, 5)
    assert said.will == Message(topic="ra_1/conexion", payload=b"0", qos=1, retain=True)
    assert (said.user, said.password) == ("ra_1", b"\xff")


@pytest.mark.parametrize("body", [connect(text("x"), level=5), connect(text("x"), name="MQIsdp", level=3)])
def test_another_version_of_mqtt_is_told_so(body: bytes) -> None:
    with pytest.raises(ConnectRefused) as refused:
        packets.read_connect(body)
    assert refused.value.answer is Answer.PROTOCOL


@pytest.mark.parametrize(
    "body",
    [
        connect(text("x"), flags=0x03),
        connect(text("x"), flags=0x42),
        connect(text("x"), flags=0x22),
        connect(text("x"), text("a/#"), text("0"), flags=0x06),
        connect(text("x"), text("a"), text("0"), flags=0x1E),
        connect(text("x"), b"more"),
        connect(text(b"\xff")),
        connect(text("a\0b")),
        connect(b"\x00\x05abc"),
    ],
)
def test_a_connect_that_contradicts_itself_is_refused(body: bytes) -> None:
    with pytest.raises(ProtocolError):
        packets.read_connect(body)


@pytest.mark.parametrize("topic", ["", "a/+", "#", "x" * (TOPIC_BYTES + 1), "é" * 129])
def test_a_topic_with_wildcards_or_too_long_is_refused(topic: str) -> None:
    with pytest.raises(ProtocolError, match="a topic"):
        packets.read_publish(packets.Packet(kind=Kind.PUBLISH, flags=0, body=text(topic)))


def test_subscribe_needs_a_filter_and_a_packet_id() -> None:
    assert packets.read_subscribe(b"\0\x07" + text("a/#") + b"\x02" + text("b") + b"\0") == (
        7,
        [("a/#", 2), ("b", 0)],
    )
    for body in (b"\0\x07", b"\0\0" + text("a") + b"\0", b"\0\x07" + text("a") + b"\x03"):
        with pytest.raises(ProtocolError):
            packets.read_subscribe(body)
