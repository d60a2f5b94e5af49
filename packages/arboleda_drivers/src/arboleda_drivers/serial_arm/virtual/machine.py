"""Virtual servos on one bus: registers, motion, and answers to packets. No line, no clock."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from arboleda_drivers.serial_arm.packets import BROADCAST, Instruction, Packet, PacketReader
from arboleda_drivers.serial_arm.servos import MAKERS, TICKS, Dynamixel, Feetech, signed

LATE_S = 0.08
STEP_S = 0.01  # of motion
FASTEST, QUICKEST = 3400.0, 20000.0  # ticks/s, ticks/s2: of a servo without load
PUSH_TICKS = 15 * TICKS // 360
SIZE = 256  # registers
VOLTAGE, OVERHEATING, OVERLOAD = 1, 4, 32  # of both makers


@dataclass(frozen=True, kw_only=True)
class Layout:
    """Registers of a maker's servos, each an address and a length."""

    model: tuple[int, int]
    torque: tuple[int, int]
    acceleration: tuple[int, int]
    speed: tuple[int, int]
    goal: tuple[int, int]
    position: tuple[int, int]
    volts: tuple[int, int]
    celsius: tuple[int, int]
    status: tuple[int, int]
    mode: tuple[int, int]
    held_mode: int
    model_number: int
    units: tuple[float, float]  # of speed, ticks/s, and acceleration, ticks/s2
    read_only_from: int


LAYOUTS = {
    "feetech": Layout(
        model=(3, 2),
        torque=(40, 1),
        acceleration=(41, 1),
        speed=(46, 2),
        goal=(42, 2),
        position=(56, 2),
        volts=(62, 1),
        celsius=(63, 1),
        status=(65, 1),
        mode=(33, 1),
        held_mode=0,
        model_number=777,
        units=(1.0, Feetech.ACCELERATION_UNIT),
        read_only_from=56,
    ),
    "dynamixel": Layout(
        model=(0, 2),
        torque=(64, 1),
        acceleration=(108, 4),
        speed=(112, 4),
        goal=(116, 4),
        position=(132, 4),
        volts=(144, 2),
        celsius=(146, 1),
        status=(70, 1),
        mode=(11, 1),
        held_mode=3,
        model_number=1200,
        units=(Dynamixel.SPEED_UNIT, Dynamixel.ACCELERATION_UNIT),
        read_only_from=122,
    ),
}


@dataclass(kw_only=True)
class Servo:
    """One servo: its registers, where it truly is (ticks), and how fast it goes (ticks/s)."""

    layout: Layout
    at: float
    speed: float = 0.0
    start: float = 0.0  # where it was when it got its goal
    memory: bytearray = field(default_factory=lambda: bytearray(SIZE))

    def __post_init__(self) -> None:
        self.put(self.layout.model, self.layout.model_number)
        self.put(self.layout.mode, self.layout.held_mode)
        self.put(self.layout.celsius, 30)
        self.put(self.layout.volts, 74)
        self.boot()

    def boot(self) -> None:
        """Forget what a servo forgets without power; it stays where it is."""
        for place in (self.layout.torque, self.layout.acceleration, self.layout.speed, self.layout.status):
            self.put(place, 0)
        self.set_goal(round(self.at))

    def get(self, place: tuple[int, int]) -> int:
        address, length = place
        value = int.from_bytes(self.memory[address : address + length], "little", signed=length == 4)
        return signed(value, 15) if length == 2 else value

    def put(self, place: tuple[int, int], value: int) -> None:
        address, length = place
        self.memory[address : address + length] = value.to_bytes(length, "little", signed=length == 4)

    @property
    def torque(self) -> bool:
        return self.get(self.layout.torque) == 1

    @property
    def goal(self) -> int:
        return self.get(self.layout.goal)

    def set_goal(self, goal: int) -> None:
        self.put(self.layout.goal, goal)
        self.start = self.at

    @property
    def is_half_way(self) -> bool:
        """True once it has gone half of the way to its goal, and is on the way."""
        way = abs(self.goal - self.start)
        return way > 20 and abs(self.at - self.start) >= way / 2 and abs(self.goal - self.at) > 10

    def move(self, seconds: float, *, share: float = 1.0) -> None:
        """Go on towards the goal for a while."""
        left = self.goal - self.at
        unit, ramp = self.layout.units
        most = (self.get(self.layout.speed) * unit or FASTEST) * share
        quick = min(self.get(self.layout.acceleration) * ramp or QUICKEST, QUICKEST)
        allowed = min(most, FASTEST, math.sqrt(2 * quick * abs(left)) + 1.0)
        speed = min(abs(self.speed) + quick * seconds, allowed)
        if abs(left) <= speed * seconds:
            self.at, self.speed = float(self.goal), 0.0
        else:
            self.speed = math.copysign(speed, left)
            self.at += self.speed * seconds


class VirtualServos:
    """Virtual arm on a bus; the last id is its gripper. Times in s of any clock, positions in ticks."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        maker: str = "feetech",
        ids: Sequence[int] = (1, 2, 3, 4, 5, 6),
        positions: Sequence[int] | None = None,
        torque: bool = False,
        part_at: int = 2300,
    ) -> None:
        self.faults = faults
        self._framing = MAKERS[maker].framing
        self._reader = PacketReader(self._framing, replies=False)
        layout = LAYOUTS[maker]
        places = positions or (TICKS // 2,) * len(ids)
        self.servos = {id: Servo(layout=layout, at=float(at)) for id, at in zip(ids, places, strict=True)}
        for servo in self.servos.values():
            servo.put(layout.torque, int(torque))
        self._layout, self._ids = layout, list(ids)
        self._part_at = part_at
        self._now: float | None = None
        self._answers = 0
        self._late: deque[tuple[float, bytes]] = deque()
        self._was_off = False
        self._disturbed: set[int] = set()  # the goals that another program has already replaced

    @property
    def next_deadline(self) -> float:
        return self._late[0][0] if self._late else math.inf

    @property
    def is_unplugged(self) -> bool:
        """True while there is no line."""
        return "unplugged" in self.faults

    def step(self, now: float, data: bytes = b"") -> bytes:
        """Let time pass, take bytes from the line, and return the bytes that come back."""
        self._pass_time(now)
        out = data if "echo" in self.faults else b""
        if self.is_unplugged:
            self._late.clear()
            return b""
        for packet in self._reader.feed(data):
            for id in self._addressed(packet):
                out += self._sent(now, id, self._answer(id, packet))
        while self._late and self._late[0][0] <= now:
            out += self._late.popleft()[1]
        return out

    # How time passes.

    def _pass_time(self, now: float) -> None:
        last = now if self._now is None else self._now
        self._now = now
        self._befall()
        if "power_cycle" in self.faults:
            return
        while last < now:
            seconds = min(STEP_S, now - last)
            last += seconds
            for id in self._ids:
                self._move(id, seconds)
        for number, id in enumerate(self._ids):
            servo = self.servos[id]
            pushed = PUSH_TICKS if number == 0 and "pushed" in self.faults else 0
            if number != 2 or "old_position" not in self.faults:
                servo.put(self._layout.position, round(servo.at) + pushed)
            servo.put(self._layout.volts, 45 if "low_voltage" in self.faults else 74)

    def _move(self, id: int, seconds: float) -> None:
        servo, is_gripper = self.servos[id], id == self._ids[-1]
        stalls = "stall" in self.faults and not is_gripper and servo.is_half_way
        stuck = is_gripper and "gripper_stuck" in self.faults
        alarmed = servo.get(self._layout.status) & (OVERLOAD | OVERHEATING)
        if not servo.torque or alarmed or stalls or stuck:
            servo.speed = 0.0
            return
        before = servo.at
        servo.move(seconds, share=0.1 if "slow" in self.faults else 1.0)
        if is_gripper and "part" in self.faults and servo.goal < self._part_at <= before:
            servo.at = max(servo.at, float(self._part_at))
        if self._ids[1] == id and "overload" in self.faults and servo.is_half_way:
            self._alarm(id, OVERLOAD)
        others = self._ids[0] == id and "another_master" in self.faults and servo.is_half_way
        if others and servo.goal not in self._disturbed:
            servo.set_goal(round(servo.at) + 30)
            self._disturbed = {servo.goal}

    def _befall(self) -> None:
        """Let the faults strike that befall an arm by themselves."""
        for id in self._ids:
            servo = self.servos[id]
            if "torque_off" in self.faults:
                servo.put(self._layout.torque, 0)
            status = servo.get(self._layout.status) & ~VOLTAGE
            servo.put(self._layout.status, status | VOLTAGE * ("low_voltage" in self.faults))
        if "overheating" in self.faults:
            self._alarm(self._ids[2], OVERHEATING)
        self.servos[self._ids[2]].put(self._layout.celsius, 80 if "overheating" in self.faults else 30)
        mode = 1 if "wrong_mode" in self.faults else self._layout.held_mode
        self.servos[self._ids[1]].put(self._layout.mode, mode)
        off = "power_cycle" in self.faults
        if self._was_off and not off:
            for servo in self.servos.values():
                servo.boot()
        self._was_off = off

    def _alarm(self, id: int, bit: int) -> None:
        servo = self.servos[id]
        servo.put(self._layout.status, servo.get(self._layout.status) | bit)
        if self._layout is LAYOUTS["dynamixel"]:
            servo.put(self._layout.torque, 0)

    # Packets.

    def _addressed(self, packet: Packet) -> list[int]:
        if packet.code == Instruction.SYNC_READ:
            ids = packet.data[2 * self._framing.word :]
            return [id for id in ids if id in self.servos]
        if packet.id == BROADCAST:
            if packet.code == Instruction.SYNC_WRITE:
                self._sync_write(packet.data)
            return self._ids if packet.code == Instruction.PING else []
        return [packet.id] if packet.id in self.servos else []

    def _answer(self, id: int, packet: Packet) -> Packet | None:
        """The answer of one servo; None if it is silent."""
        if {"mute", "power_cycle"} & set(self.faults):
            return None
        if "mute_servo" in self.faults and id == self._ids[2]:
            return None
        servo, code, data = self.servos[id], packet.code, packet.data
        result, error = b"", 0
        word = self._framing.word
        if code in (Instruction.READ, Instruction.SYNC_READ) and len(data) >= 2 * word:
            address, length = (int.from_bytes(data[at : at + word], "little") for at in (0, word))
            result = bytes(servo.memory[address : address + length])
        elif code == Instruction.WRITE and len(data) > word:
            self._write(servo, int.from_bytes(data[:word], "little"), data[word:])
        elif code == Instruction.REBOOT:
            servo.boot()
        elif code == Instruction.PING:
            result = bytes([*servo.memory[0:2], 50]) if self._layout is LAYOUTS["dynamixel"] else b""
        else:
            error = 2  # it does not know the instruction: of protocol 2.0
        if self._layout is LAYOUTS["feetech"]:
            error = servo.get(self._layout.status)
        elif servo.get(self._layout.status):
            error |= 0x80
        return Packet(id=id, code=error, data=result)

    def _sync_write(self, data: bytes) -> None:
        word = self._framing.word
        address, length = (int.from_bytes(data[at : at + word], "little") for at in (0, word))
        rows = data[2 * word :]
        for at in range(0, len(rows) - length, length + 1):
            if rows[at] in self.servos and "power_cycle" not in self.faults:
                self._write(self.servos[rows[at]], address, rows[at + 1 : at + 1 + length])

    def _write(self, servo: Servo, address: int, values: bytes) -> None:
        goal_at = self._layout.goal[0]
        writes_goal = address <= goal_at < address + len(values)
        if writes_goal and self._refuses_goal(servo):
            return
        if address + len(values) > self._layout.read_only_from:
            return
        before = servo.goal
        servo.memory[address : address + len(values)] = values
        if writes_goal and servo.goal != before:
            servo.start = servo.at
        if address == self._layout.torque[0] and values[0] == 1 and self._layout is LAYOUTS["feetech"]:
            servo.put(self._layout.status, 0)
            self._befall()

    def _refuses_goal(self, servo: Servo) -> bool:
        if "no_goal" in self.faults and servo is self.servos[self._ids[1]]:
            return True
        return "deaf" in self.faults and servo.speed != 0

    def _sent(self, now: float, id: int, answer: Packet | None) -> bytes:
        """The bytes of an answer as they arrive."""
        if answer is None:
            return b""
        self._answers += 1
        third = self._answers % 3 == 0
        if "wrong_id" in self.faults and third:
            answer = Packet(id=self._ids[self._ids.index(id) - 1], code=answer.code, data=answer.data)
        data = self._framing.packed(answer, reply=True)
        if "broken_frames" in self.faults and third:
            data = data[:-1] + bytes([data[-1] ^ 0x55])
        if "torn" in self.faults and third:
            data = data[:-2]
        if "noise" in self.faults:
            data = b"\x00\xff\x31\xff" + data
        if "late" in self.faults:
            self._late.append((now + LATE_S, data))
            return b""
        return data

    def positions(self) -> Mapping[int, int]:
        """The true position of each servo (ticks)."""
        return {id: round(servo.at) for id, servo in self.servos.items()}
