"""The packets of MQTT 3.1.1, as bytes and as values. Chapters are those of the OASIS standard."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum

from .limits import PACKET_BYTES, TOPIC_BYTES

LEVEL = 4  # of the protocol, as CONNECT names it (3.1.2.2)
FAILED = 0x80  # in SUBACK: no subscription (3.9.3)
LENGTH_BYTES = 4  # at most, of the field that says how long a packet is (2.2.3)


class Kind(IntEnum):
    """The type of a packet (2.2.1)."""

    CONNECT = 1
    CONNACK = 2
    PUBLISH = 3
    PUBACK = 4
    PUBREC = 5
    PUBREL = 6
    PUBCOMP = 7
    SUBSCRIBE = 8
    SUBACK = 9
    UNSUBSCRIBE = 10
    UNSUBACK = 11
    PINGREQ = 12
    PINGRESP = 13
    DISCONNECT = 14


FLAGS = {Kind.PUBREL: 2, Kind.SUBSCRIBE: 2, Kind.UNSUBSCRIBE: 2}  # used by PUBLISH only, else 0


class Answer(IntEnum):
    """The return code of CONNACK (3.2.2.3)."""

    ACCEPTED = 0
    PROTOCOL = 1
    CLIENT_ID = 2
    BUSY = 3
    NOT_AUTHORIZED = 5


class ProtocolError(Exception):
    """Error: a client sent something that MQTT or the limits do not allow; it is cut off."""


class ConnectRefused(Exception):
    """Error: a CONNECT is refused with `answer`."""

    def __init__(self, answer: Answer) -> None:
        super().__init__(answer.name)
        self.answer = answer


@dataclass(frozen=True, kw_only=True)
class Packet:
    """Packet as it came: its type, its flags, and the body."""

    kind: Kind
    flags: int
    body: bytes


@dataclass(frozen=True, kw_only=True)
class Message:
    """Published message; `qos` is 0 to 2."""

    topic: str
    payload: bytes
    qos: int
    retain: bool


@dataclass(frozen=True, kw_only=True)
class Connect:
    """Fields of a CONNECT packet; with `keep_alive_s` 0 the client may be silent for as long as it likes."""

    client_id: str
    clean: bool
    keep_alive_s: int
    will: Message | None
    user: str | None
    password: bytes | None


class Stream:
    """Cuts the bytes of a client into packets; keeps no more than was fed since the last whole one."""

    def __init__(self) -> None:
        self._bytes = bytearray()

    def feed(self, data: bytes | memoryview) -> None:
        self._bytes += data

    def next(self) -> Packet | None:
        """The next whole packet; None until it is there. Raises ProtocolError if it is too long."""
        head = self._head()
        if head is None:
            return None
        begin, end = head
        if len(self._bytes) < end:
            return None
        kind, flags, body = self._bytes[0] >> 4, self._bytes[0] & 15, bytes(self._bytes[begin:end])
        del self._bytes[:end]
        return _packet(kind, flags, body)

    def _head(self) -> tuple[int, int] | None:
        """Begin and end of the next packet's body in the buffer; None until its length has arrived."""
        length = 0
        for place in range(LENGTH_BYTES):
            if len(self._bytes) < place + 2:
                return None
            byte = self._bytes[place + 1]
            length |= (byte & 127) << (7 * place)
            begin = place + 2
            if length + begin > PACKET_BYTES:
                break
            if byte < 128:
                return begin, begin + length
        raise ProtocolError(f"a packet of more than {PACKET_BYTES} bytes")


def _packet(kind: int, flags: int, body: bytes) -> Packet:
    if not Kind.CONNECT <= kind <= Kind.DISCONNECT:
        raise ProtocolError(f"no packet has the type {kind}")
    known = Kind(kind)
    if known is not Kind.PUBLISH and flags != FLAGS.get(known, 0):
        raise ProtocolError(f"{known.name} with the flags {flags}")
    return Packet(kind=known, flags=flags, body=body)


class Fields:
    """Reader of the fields of a body, one by one; raises ProtocolError if the body ends too early."""

    def __init__(self, body: bytes) -> None:
        self._body = body
        self._at = 0

    def rest(self) -> bytes:
        return self._take(len(self._body) - self._at)

    def byte(self) -> int:
        return self._take(1)[0]

    def number(self) -> int:
        return int.from_bytes(self._take(2), "big")

    def data(self) -> bytes:
        return self._take(self.number())

    def text(self) -> str:
        try:
            text = self.data().decode()
        except UnicodeDecodeError:
            raise ProtocolError("a text that is not UTF-8") from None
        if "\0" in text:
            raise ProtocolError("a text with U+0000")
        return text

    @property
    def left(self) -> bool:
        return self._at < len(self._body)

    def end(self) -> None:
        if self.left:
            raise ProtocolError("more bytes than the packet has fields")

    def _take(self, count: int) -> bytes:
        if self._at + count > len(self._body):
            raise ProtocolError("a packet that ends within a field")
        self._at += count
        return self._body[self._at - count : self._at]


def read_connect(body: bytes) -> Connect:
    """Parses the body of CONNECT (3.1); raises ConnectRefused for another version of MQTT."""
    fields = Fields(body)
    name, level = fields.text(), fields.byte()
    if (name, level) != ("MQTT", LEVEL):
        raise ConnectRefused(Answer.PROTOCOL)
    flags, keep_alive_s = fields.byte(), fields.number()
    if flags & 1:
        raise ProtocolError("a reserved flag of CONNECT is set")
    client_id = fields.text()
    will = _will(fields, flags)
    user = fields.text() if flags & 0x80 else None
    password = fields.data() if flags & 0x40 else None
    if password is not None and user is None:
        raise ProtocolError("a password without a user")
    fields.end()
    return Connect(
        client_id=client_id,
        clean=bool(flags & 2),
        keep_alive_s=keep_alive_s,
        will=will,
        user=user,
        password=password,
    )


def _will(fields: Fields, flags: int) -> Message | None:
    qos, retain = flags >> 3 & 3, bool(flags & 0x20)
    if not flags & 4:
        if qos or retain:
            raise ProtocolError("flags of a last will without one")
        return None
    topic = _topic(fields)
    return Message(topic=topic, payload=fields.data(), qos=_checked_qos(qos), retain=retain)


def read_publish(packet: Packet) -> tuple[Message, int]:
    """Parses PUBLISH (3.3): the message and its packet id, 0 at QoS 0."""
    fields, qos = Fields(packet.body), _checked_qos(packet.flags >> 1 & 3)
    topic = _topic(fields)
    number = _id(fields) if qos else 0
    return Message(topic=topic, payload=fields.rest(), qos=qos, retain=bool(packet.flags & 1)), number


def read_subscribe(body: bytes) -> tuple[int, list[tuple[str, int]]]:
    """Parses SUBSCRIBE (3.8): the packet id, and filters with the QoS requested."""
    fields = Fields(body)
    number = _id(fields)
    wanted: list[tuple[str, int]] = []
    while fields.left or not wanted:
        wanted.append((fields.text(), _checked_qos(fields.byte())))
    return number, wanted


def read_unsubscribe(body: bytes) -> tuple[int, list[str]]:
    """Parses UNSUBSCRIBE (3.10): the packet id and the filters."""
    fields = Fields(body)
    number = _id(fields)
    filters: list[str] = []
    while fields.left or not filters:
        filters.append(fields.text())
    return number, filters


def read_id(body: bytes) -> int:
    """The packet id, which is the whole body of PUBACK, PUBREC, PUBREL and PUBCOMP."""
    fields = Fields(body)
    number = _id(fields)
    fields.end()
    return number


def _id(fields: Fields) -> int:
    number = fields.number()
    if number == 0:
        raise ProtocolError("the packet id 0")
    return number


def _topic(fields: Fields) -> str:
    name = fields.text()
    if not name or "+" in name or "#" in name:
        raise ProtocolError("a topic that is empty or has a wildcard")
    if len(name.encode()) > TOPIC_BYTES:
        raise ProtocolError(f"a topic of more than {TOPIC_BYTES} bytes")
    return name


def _checked_qos(qos: int) -> int:
    if qos > 2:
        raise ProtocolError(f"the QoS {qos}")
    return qos


def connack(answer: Answer) -> bytes:
    """The bytes of CONNACK, without a session from before."""
    return bytes((Kind.CONNACK << 4, 2, 0, answer))


def acknowledge(kind: Kind, number: int) -> bytes:
    """The bytes of PUBACK, PUBREC, PUBREL, PUBCOMP or UNSUBACK of a packet id."""
    return struct.pack("!BBH", kind << 4 | FLAGS.get(kind, 0), 2, number)


def suback(number: int, granted: list[int]) -> bytes:
    """The bytes of SUBACK; each of `granted` is a QoS or FAILED."""
    return _with_length(Kind.SUBACK << 4, struct.pack("!H", number) + bytes(granted))


def publish(message: Message, number: int) -> bytes:
    """The bytes of PUBLISH, with a packet id if its QoS is not 0."""
    topic = message.topic.encode()
    head = struct.pack("!H", len(topic)) + topic
    if message.qos:
        head += struct.pack("!H", number)
    return _with_length(Kind.PUBLISH << 4 | message.qos << 1 | message.retain, head + message.payload)


def pingresp() -> bytes:
    """The bytes of PINGRESP."""
    return bytes((Kind.PINGRESP << 4, 0))


def _with_length(first: int, body: bytes) -> bytes:
    head, length = bytearray((first,)), len(body)
    while length > 127:
        head.append(length & 127 | 128)
        length >>= 7
    head.append(length)
    return bytes(head) + body
