"""Packets on the bus of servos: Dynamixel's protocol 1.0, which Feetech's servos speak too, and 2.0.

Sources: ROBOTIS e-Manual, "DYNAMIXEL Protocol 1.0" and "2.0"; Feetech's "Communication Protocol User Manual".
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Protocol

BROADCAST = 0xFE
HIGHEST_ID = 0xFC
LONGEST = 512  # bytes of a packet; servos send far fewer


class Instruction(IntEnum):
    """Instruction of a packet to a servo."""

    PING = 1
    READ = 2
    WRITE = 3
    REBOOT = 8  # protocol 2.0 only
    SYNC_READ = 0x82
    SYNC_WRITE = 0x83


@dataclass(frozen=True, kw_only=True)
class Packet:
    """Packet to a servo, whose `code` is its instruction, or from one, whose `code` is its error."""

    id: int
    code: int
    data: bytes = b""


class BadPacket(ValueError):
    """Bytes that begin as a packet does and cannot be one."""


class Framing(Protocol):
    """Form of packets on the wire, in both directions."""

    header: bytes
    word: int  # bytes of an address, and of a length, in instructions

    def packed(self, packet: Packet, *, reply: bool = False) -> bytes:
        """The bytes of a packet; `reply`: from a servo."""

    def length(self, data: bytes) -> int | None:
        """The length of the packet that begins here; None until it is known. Raises BadPacket."""

    def unpacked(self, data: bytes, *, reply: bool) -> Packet:
        """The packet of exactly these bytes. Raises BadPacket."""


class Protocol1:
    """Frames FF FF, id, length, instruction or error, parameters, inverted sum."""

    header = b"\xff\xff"
    word = 1

    def packed(self, packet: Packet, *, reply: bool = False) -> bytes:
        body = bytes([packet.id, len(packet.data) + 2, packet.code]) + packet.data
        return self.header + body + bytes([~sum(body) & 0xFF])

    def length(self, data: bytes) -> int | None:
        if len(data) < 4:
            return None
        if data[2] > BROADCAST or data[3] < 2:
            raise BadPacket("no id or no length of a packet")
        return data[3] + 4

    def unpacked(self, data: bytes, *, reply: bool) -> Packet:
        if ~sum(data[2:-1]) & 0xFF != data[-1]:
            raise BadPacket("its sum is wrong")
        return Packet(id=data[2], code=data[4], data=data[5:-1])


class Protocol2:
    """Frames FF FF FD 00, id, length, instruction, for replies the error, parameters, CRC-16.

    Within instruction and parameters FF FF FD is followed by another FD, so that it begins no packet.
    """

    header = b"\xff\xff\xfd\x00"
    word = 2
    status = 0x55

    def packed(self, packet: Packet, *, reply: bool = False) -> bytes:
        codes = bytes([self.status, packet.code]) if reply else bytes([packet.code])
        body = (codes + packet.data).replace(b"\xff\xff\xfd", b"\xff\xff\xfd\xfd")
        head = self.header + bytes([packet.id]) + (len(body) + 2).to_bytes(2, "little") + body
        return head + crc16(head).to_bytes(2, "little")

    def length(self, data: bytes) -> int | None:
        if len(data) < 7:
            return None
        length = int.from_bytes(data[5:7], "little")
        if data[4] > BROADCAST or not 3 <= length <= LONGEST:
            raise BadPacket("no id or no length of a packet")
        return length + 7

    def unpacked(self, data: bytes, *, reply: bool) -> Packet:
        if crc16(data[:-2]) != int.from_bytes(data[-2:], "little"):
            raise BadPacket("its CRC is wrong")
        body = data[7:-2].replace(b"\xff\xff\xfd\xfd", b"\xff\xff\xfd")
        if not reply:
            return Packet(id=data[4], code=body[0], data=body[1:])
        if body[0] != self.status or len(body) < 2:
            raise BadPacket("it is no reply")
        return Packet(id=data[4], code=body[1], data=body[2:])


class PacketReader:
    """Splitter of a stream into packets; bytes that form none are skipped up to the next header."""

    def __init__(self, framing: Framing, *, replies: bool) -> None:
        self._framing, self._replies = framing, replies
        self._rest = b""
        self.refused = 0  # skipped bytes

    def clear(self) -> None:
        """Forget an incomplete packet: what comes now answers another question."""
        self.refused += len(self._rest)
        self._rest = b""

    def feed(self, data: bytes) -> list[Packet]:
        """The packets that are complete now, in order."""
        rest, found = self._rest + data, []
        while rest := self._from_header(rest):
            try:
                length = self._framing.length(rest)
                if length is None or len(rest) < length:
                    break
                found.append(self._framing.unpacked(rest[:length], reply=self._replies))
                rest = rest[length:]
            except BadPacket:
                rest = rest[1:]
                self.refused += 1
        self._rest = rest
        return found

    def _from_header(self, rest: bytes) -> bytes:
        """The bytes from the first header on, or from what may become one."""
        header = self._framing.header
        at = rest.find(header)
        if at < 0:
            begun = (size for size in range(len(header) - 1, 0, -1) if rest.endswith(header[:size]))
            at = len(rest) - next(begun, 0)
        self.refused += at
        return rest[at:]


def crc16(data: bytes) -> int:
    """The CRC-16 of protocol 2.0: polynomial 0x8005, from 0, highest bit first."""
    crc = 0
    for byte in data:
        crc = (crc << 8 & 0xFFFF) ^ CRC_TABLE[crc >> 8 ^ byte]
    return crc


def _crc_of(byte: int) -> int:
    crc = byte << 8
    for _ in range(8):
        crc = crc << 1 ^ 0x8005 if crc & 0x8000 else crc << 1
    return crc & 0xFFFF


CRC_TABLE = tuple(map(_crc_of, range(256)))
