"""Six servos on a bus, in a process of its own; nothing of Arboleda in it.

    servos.py dynamixel|feetech LINE

Packets are made, and checked, by the makers' own SDKs, and registers are where these say. It prints
what press.py prints: a goal elsewhere begins an order, one where it stands drops it, and it ends where all
stand at their goals.
"""

from __future__ import annotations

import select
import sys
import time
from collections.abc import Iterator
from typing import Any, ClassVar

IDS = range(1, 7)
BROADCAST = 0xFE
READ, WRITE, REBOOT, SYNC_WRITE, STATUS = 2, 3, 8, 0x83, 0x55
STEP_S = 0.005
NEAR = 200  # ticks: a goal so near is where it stood a moment before
LEAST = 1  # of the speeds that a servo may be given
FASTEST = 3000.0  # ticks/s


class Dynamixel:
    """Protocol 2.0, and the control table of the X series."""

    header, head = b"\xff\xff\xfd\x00", 7
    word = 2
    torque, goal, speed, place = (64, 1), (116, 4), (112, 4), (132, 4)
    speed_unit = 0.229 / 60 * 4096
    first: ClassVar = {(11, 1): 3, (144, 2): 120, (146, 1): 30}  # its mode, and what it measures

    def __init__(self, line: str) -> None:
        import dynamixel_sdk

        self.port = dynamixel_sdk.PortHandler(line)
        self._handler: Any = dynamixel_sdk.PacketHandler(2.0)

    def length(self, data: bytes) -> int:
        return 7 + int.from_bytes(data[5:7], "little")

    def opened(self, packet: bytes) -> tuple[int, int, bytes] | None:
        """Id, instruction and parameters; None where its sum is wrong."""
        if self._handler.updateCRC(0, [*packet], len(packet) - 2) != int.from_bytes(packet[-2:], "little"):
            return None
        plain = self._handler.removeStuffing([*packet])
        length = plain[5] | plain[6] << 8
        return plain[4], plain[7], bytes(plain[8 : 5 + length])

    def answer(self, id: int, data: bytes) -> None:
        packet = [0, 0, 0, 0, id, len(data) + 4, 0, STATUS, 0, *data, 0, 0]
        self._handler.txPacket(self.port, packet)


class Feetech:
    """Protocol 1.0, and the table of the STS series."""

    header, head = b"\xff\xff", 4
    word = 1
    torque, goal, speed, place = (40, 1), (42, 2), (46, 2), (56, 2)
    speed_unit = 1.0
    first: ClassVar = {(33, 1): 0, (62, 1): 74, (63, 1): 30}

    def __init__(self, line: str) -> None:
        import scservo_sdk

        self.port = scservo_sdk.PortHandler(line)
        self._handler: Any = scservo_sdk.sms_sts(self.port)

    def length(self, data: bytes) -> int:
        return 4 + data[3]

    def opened(self, packet: bytes) -> tuple[int, int, bytes] | None:
        if ~sum(packet[2:-1]) & 0xFF != packet[-1]:
            return None
        return packet[2], packet[4], packet[5:-1]

    def answer(self, id: int, data: bytes) -> None:
        self._handler.txPacket([0, 0, id, len(data) + 2, 0, *data, 0])


class Servos:
    """They go to their goals at the speed that each was given, while their torque is on."""

    def __init__(self, maker: Dynamixel | Feetech) -> None:
        self._maker = maker
        self._tables = {id: bytearray(256) for id in IDS}
        self._at = dict.fromkeys(IDS, 2048.0)
        self._orders = 0
        self._is_at_work = False
        for id in IDS:
            for place, value in maker.first.items():
                self._put(id, place, value)
            self._put(id, maker.goal, 2048)

    def take(self, id: int, instruction: int, data: bytes) -> None:
        word = self._maker.word
        if instruction == SYNC_WRITE:
            at, length = (int.from_bytes(data[each : each + word], "little") for each in (0, word))
            for row in range(2 * word, len(data), 1 + length):
                self._write(data[row], at, data[row + 1 : row + 1 + length])
            self._look()
        elif id in IDS:
            at = int.from_bytes(data[:word], "little")
            if instruction == READ:
                length = int.from_bytes(data[word : 2 * word], "little")
                self._maker.answer(id, bytes(self._tables[id][at : at + length]))
                return
            if instruction == WRITE:
                self._write(id, at, data[word:])
                self._look()
            self._maker.answer(id, b"")

    def move(self, seconds: float) -> None:
        for id in IDS:
            if self._get(id, self._maker.torque):
                way = self._get(id, self._maker.goal) - self._at[id]
                speed = self._get(id, self._maker.speed) * self._maker.speed_unit or FASTEST
                self._at[id] += max(-speed * seconds, min(speed * seconds, way))
            self._put(id, self._maker.place, round(self._at[id]))
        if self._is_at_work and self._farthest() == 0:
            self._is_at_work = False
            say("end", self._orders)

    def _write(self, id: int, at: int, data: bytes) -> None:
        if id in IDS:
            self._tables[id][at : at + len(data)] = data

    def _look(self) -> None:
        """See whether what was written begins an order, or drops one."""
        goals = tuple(self._get(id, self._maker.goal) for id in IDS)
        if goals == self._goals and self._is_at_work:
            return
        self._goals = goals
        if self._farthest() > NEAR:
            self._orders += 1
            self._is_at_work = True
            say("begin", self._orders)
        elif self._is_at_work:
            self._is_at_work = False
            say("drop", self._orders)

    _goals: tuple[int, ...] = ()

    def _farthest(self) -> float:
        """The longest way of a servo; one that is held at the least speed, as it was not heard, has none."""
        goal, goes = self._maker.goal, [id for id in IDS if self._goes(id)]
        return max((abs(self._get(id, goal) - self._at[id]) for id in goes), default=0.0)

    def _goes(self, id: int) -> bool:
        return bool(self._get(id, self._maker.torque)) and self._get(id, self._maker.speed) != LEAST

    def _get(self, id: int, place: tuple[int, int]) -> int:
        at, length = place
        return int.from_bytes(self._tables[id][at : at + length], "little")

    def _put(self, id: int, place: tuple[int, int], value: int) -> None:
        at, length = place
        self._tables[id][at : at + length] = value.to_bytes(length, "little")


def packets(maker: Dynamixel | Feetech, left: bytearray) -> Iterator[bytes]:
    """The whole packets among the bytes that have come, which are taken out."""
    while (at := left.find(maker.header)) >= 0:
        del left[:at]
        if len(left) < maker.head or len(left) < maker.length(left):
            return
        packet = bytes(left[: maker.length(left)])
        del left[: len(packet)]
        yield packet


def say(word: str, number: int) -> None:
    print(word, number, time.monotonic(), flush=True)


def main(name: str, line: str) -> None:
    maker = {"dynamixel": Dynamixel, "feetech": Feetech}[name](line)
    maker.port.openPort()
    servos, left = Servos(maker), bytearray()
    print("ready", 0, flush=True)
    before = time.monotonic()
    while True:
        ready, _, _ = select.select([sys.stdin, maker.port.ser], [], [], STEP_S)
        if sys.stdin in ready and not sys.stdin.readline():
            return
        now = time.monotonic()
        servos.move(now - before)
        before = now
        if maker.port.ser in ready:
            left += maker.port.readPort(4096)
        for packet in packets(maker, left):
            if (found := maker.opened(packet)) is not None:
                servos.take(*found)
                maker.port.is_using = False


main(*sys.argv[1:])
