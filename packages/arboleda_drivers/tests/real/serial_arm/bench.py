"""An arm behind the driver `serial_arm`: its servos are played by hand on a pseudo terminal."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from pathlib import Path

from tests.patience import PATIENCE_S

from arboleda.testing.drivers import Bench
from arboleda.testing.drivers.bench import Ref
from arboleda_drivers.serial_arm.servos import TICKS
from arboleda_drivers.serial_arm.virtual.faults import FAULTS
from arboleda_drivers.serial_arm.virtual.machine import OVERLOAD, VirtualServos
from arboleda_drivers.virtual.faults import Faults
from arboleda_drivers.virtual.pty_line import PtyLine

from ..contract.mover import ARM_DEG, WORDS, Opened, PlayedMover, app_of, arm

KEYS = """tolerance: {deg: [0.3, 0.3, 0.3, 0.3, 0.3, 0.3]}, """
JOINTS = "[{id: 1}, {id: 2}, {id: 3}, {id: 4}, {id: 5}, {id: 6}]"
REPLY_S = 0.2  # servos in a thread of a busy process are slow to answer
ACCELERATION_AT, HOLD_UNITS = 3, 100  # of the first servo; a hold has more, a move less
STRIDE, STRIDES = 5, 100  # ticks of a servo at work for each answer, and how many until it is where it was
Goals = tuple[int, ...]


class PlayedServos(VirtualServos):
    """Servos that go nowhere by themselves, and take no goal but where they stand.

    `restless`: they are at work, and stand elsewhere in each round of questions, however slow that is: two
    rounds that find them at one place, a second apart, are an arm that gets no further.
    """

    def __init__(self, told: Callable[[Goals, bytes], None]) -> None:
        self.switched = Faults(FAULTS)
        super().__init__(self.switched, torque=True)
        for servo in self.servos.values():
            servo.put(servo.layout.acceleration, 50)  # it has been made ready before
        self._told = told
        self.lock = threading.RLock()
        self._asked = threading.Condition(self.lock)
        self._answers = 0
        self.restless = False
        self._strides = 0  # since then, of one round

    def step(self, now: float, data: bytes = b"") -> bytes:
        with self.lock:
            answer = super().step(now, data)
            self._answers += bool(answer)
            if not self.restless:
                self._strides = 0
            elif answer:
                self._strides = (self._strides + 1) % STRIDES
                for servo in self.servos.values():
                    servo.at += STRIDE if self._strides else STRIDE * (1 - STRIDES)
            self._asked.notify_all()
            return answer

    def show(self) -> None:
        """Wait until the driver has asked each servo again, and with the next question taken that in."""
        with self.lock:
            enough = self._answers + 2 * len(self.servos)
            assert self._asked.wait_for(lambda: self._answers >= enough, PATIENCE_S)

    def take(self, data: bytes) -> None:
        """Take the goals that were written."""
        super()._sync_write(data)

    def places(self) -> Goals:
        return tuple(round(servo.at) for servo in self.servos.values())

    def put(self, places: Goals) -> None:
        for servo, at in zip(self.servos.values(), places, strict=True):
            servo.at = float(at)

    def _move(self, id: int, seconds: float) -> None:
        pass

    def _sync_write(self, data: bytes) -> None:
        goals = tuple(int.from_bytes(data[at + 2 : at + 4], "little") for at in range(2, len(data), 8))
        self._told(goals, data)


class PlayedArm(PlayedMover):
    """It answers what it is asked; moves wait for the test, but those home, which it does at once."""

    def __init__(self, line: Path) -> None:
        super().__init__()
        self._given: list[tuple[Goals, bytes]] = []
        self._servos = PlayedServos(self._hear)
        # By name: once it was pulled, its number may be that of another test's line.
        self.line = PtyLine(self._servos, link=str(line))
        self.line.start()

    def accepts(self, ref: Ref) -> None:
        with self._servos.lock:
            self._servos.take(self._of(ref)[1])
            self._servos.restless = True

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        with self._servos.lock:
            self._servos.restless = False
            if there:
                self._servos.put(self._of(ref)[0])

    def rejects(self, ref: Ref) -> str:
        return "(goal_not_taken"

    def gives_up(self, ref: Ref) -> str:
        self._servos.show()  # it was at work before
        with self._servos.lock:
            servo = self._servos.servos[2]
            servo.put(servo.layout.status, OVERLOAD)
        return "gave up (overload of joint2"

    def hush(self) -> None:
        self._servos.switched.switch("mute", on=True)

    def boots(self) -> None:
        with self._servos.lock:
            self._servos.restless = False
            for servo in self._servos.servos.values():
                servo.boot()

    def vanish(self) -> None:
        self._servos.switched.switch("unplugged", on=True)

    def come_back(self) -> None:
        self._homes = False  # whatever it is told to do from now on is an order
        self._servos.switched.switch("unplugged", on=False)

    def close(self) -> None:
        self.line.stop()

    def _of(self, ref: Ref) -> tuple[Goals, bytes]:
        assert isinstance(ref, int)
        return self._given[ref - 1]

    def _hear(self, goals: Goals, data: bytes) -> None:
        """Take what is written to the servos: a hold at once, a move when the test says so."""
        if data[ACCELERATION_AT] > HOLD_UNITS:
            self._servos.restless = False
            self._servos.take(data)
            self._order_stop()
            return
        word = next(name for name, pose in zip(WORDS, ARM_DEG, strict=True) if _ticks(pose) == goals)
        self._given.append((goals, data))
        if self._is_made(word, len(self._given)):
            self._servos.take(data)
            self._servos.put(goals)


def _ticks(pose: tuple[int, ...]) -> Goals:
    return tuple(TICKS // 2 + round(math.radians(each) * TICKS / math.tau) for each in pose)


def _open(folder: Path, state: Path) -> Opened:
    folder.mkdir()
    played = PlayedArm(folder / "line")
    driver = f"{{serial_arm: {{serial: {played.line.path}, reply_s: {REPLY_S}, joints: {JOINTS}}}}}"
    return app_of(folder, state, arm(driver, KEYS), "arm"), lambda app: played


BENCH = Bench(open=_open, takes="arboleda_drivers.serial_arm.servos.Feetech.reading")
