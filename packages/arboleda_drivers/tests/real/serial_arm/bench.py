"""An arm behind the driver `serial_arm`: its servos are played by hand on a pseudo terminal."""

from __future__ import annotations

import math
import queue
import threading
from collections.abc import Callable
from pathlib import Path

from contract.bench import HALT, LATCH, OTHER, WORK, Bench, Device, Ref
from tests.patience import PATIENCE_S

from arboleda.plant_file.loader import load
from arboleda.runtime.build import App, Options, build
from arboleda_drivers.serial_arm.servos import TICKS
from arboleda_drivers.serial_arm.virtual.faults import FAULTS
from arboleda_drivers.serial_arm.virtual.machine import OVERLOAD, VirtualServos
from arboleda_drivers.virtual.faults import Faults
from arboleda_drivers.virtual.pty_line import PtyLine

HOME = "home"
POSES = {HOME: (0, 0, 0, 0, 0, 0), WORK: (10, 20, -30, 0, 5, 0), OTHER: (5, 0, 0, 0, 0, 0)}
PLANT = """
name: servos
uses: [recipes.py]
cells:
  shop:
    devices:
      arm:
        kind: arm
        model: cr10a
        tolerance: {{deg: [0.3, 0.3, 0.3, 0.3, 0.3, 0.3]}}
        driver:
          serial_arm:
            serial: {line}
            reply_s: 0.2  # servos in a thread of a busy process are slow to answer
            joints: [{{id: 1}}, {{id: 2}}, {{id: 3}}, {{id: 4}}, {{id: 5}}, {{id: 6}}]
    targets:
      home: {{arm: {{deg: [0, 0, 0, 0, 0, 0]}}}}
      a: {{arm: {{deg: [10, 20, -30, 0, 5, 0]}}}}
      b: {{arm: {{deg: [5, 0, 0, 0, 0, 0]}}}}
"""
RECIPES = """
from arboleda.recipes import recipe

@recipe("work")
def work_(cell):
    return cell.device("arm").go("a")

@recipe("other")
def other(cell):
    return cell.device("arm").go("b")
"""
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


class PlayedArm:
    """It answers what it is asked; moves wait for the test, but those home, which it does at once."""

    def __init__(self, line: Path) -> None:
        self._orders: queue.Queue[tuple[str, Ref]] = queue.Queue()
        self._given: list[tuple[Goals, bytes]] = []
        self._homes, self._stop_word = True, HALT  # one packet is both
        self._servos = PlayedServos(self._hear)
        # By name: once it was pulled, its number may be that of another test's line.
        self.line = PtyLine(self._servos, link=str(line))
        self.line.start()

    def told(self) -> tuple[str, Ref]:
        return self._orders.get(timeout=PATIENCE_S)

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

    def rests(self) -> None:
        pass  # where it is told to hold it holds

    def answers(self, ref: Ref, word: str) -> None:
        raise AssertionError("an arm is asked nothing")

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

    def latches(self) -> None:
        pass

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
            self._orders.put((self._stop_word, None))
            self._stop_word = HALT if self._homes else LATCH
            return
        word = next(name for name, pose in POSES.items() if _ticks(pose) == goals)
        self._given.append((goals, data))
        if word == HOME and self._homes:
            self._servos.take(data)
            self._servos.put(goals)
        else:
            self._orders.put((word, len(self._given)))


def _ticks(pose: tuple[int, ...]) -> Goals:
    return tuple(TICKS // 2 + round(math.radians(each) * TICKS / math.tau) for each in pose)


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    folder.mkdir()
    arm = PlayedArm(folder / "line")
    (folder / "plant.yaml").write_text(PLANT.format(line=arm.line.path), "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    app = build(load(folder / "plant.yaml"), ("orchestrator",), Options(state_dir=state))
    return app, lambda app: arm


BENCH = Bench(open=_open)
