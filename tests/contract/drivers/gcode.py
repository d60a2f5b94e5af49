"""A gantry behind the driver `gcode`: its controller is played by hand on a pseudo terminal."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from pathlib import Path

from arboleda.plant_file.loader import load
from arboleda.runtime.build import App, Options, build
from arboleda.virtual.faults import Faults
from arboleda.virtual.gcode.faults import FAULTS
from arboleda.virtual.gcode.machine import BANNER, BEYOND, HARD_LIMIT, HOLD_BYTE, WORD, Place, VirtualGrbl
from arboleda.virtual.pty_line import PtyLine

from ...patience import PATIENCE_S
from .bench import HALT, LATCH, OTHER, WORK, Bench, Device, Ref

HOME = "home"
POSES: dict[Place, str] = {(0.0, 0.0, 0.0): HOME, (-30.0, -20.0, -5.0): WORK, (-5.0, 0.0, 0.0): OTHER}
PLANT = """
name: grbl
uses: [recipes.py]
cells:
  shop:
    devices:
      gantry: {{kind: gantry, driver: {{gcode: {{serial: {line}}}}}}}
    targets:
      home: {{gantry: {{mm: [0, 0, 0]}}}}
      a: {{gantry: {{mm: [-30, -20, -5]}}}}
      b: {{gantry: {{mm: [-5, 0, 0]}}}}
"""
RECIPES = """
from arboleda.kinds import Axes, Axis, moving_kind
from arboleda.recipes import recipe

@moving_kind("gantry")
def gantry():
    return Axes(*(Axis(name, unit="mm", lower=-300, upper=5, speed=60, step=0.02) for name in "xyz"))

@recipe("work")
def work_(cell):
    return cell.device("gantry").go("a")

@recipe("other")
def other(cell):
    return cell.device("gantry").go("b")
"""


class PlayedGrbl(VirtualGrbl):
    """Controller that answers no move by itself, and goes nowhere; a feed hold has it stand at once."""

    def __init__(self, told: Callable[[Place | None], bool]) -> None:
        self.switched = Faults(FAULTS)
        super().__init__(self.switched, homed=True)
        self._told = told
        self._due = b""
        self.runs = False
        self.lock = threading.RLock()

    def step(self, now: float, data: bytes = b"") -> bytes:
        with self.lock:
            due, self._due = self._due, b""
            return due + super().step(now, data)

    def says(self, line: str) -> None:
        """Say a line at the next opportunity."""
        self._due += line.encode("ascii") + b"\r\n"

    def lock_up(self) -> None:
        """Be in alarm, as after a boot."""
        self.runs = False
        self._stop_all()
        self._locked = True

    @property
    def state(self) -> str:
        return "Run" if self.runs and not self._held else super().state

    def _take(self, now: float, byte: bytes) -> list[str]:
        if byte == HOLD_BYTE:
            self.runs = False
            self._told(None)
        return super()._take(now, byte)

    def _line(self, now: float, line: str) -> list[str]:
        words = {letter: float(value) for letter, value in WORD.findall(line)}
        if "X" not in words or self._locked:
            return super()._line(now, line)
        goal = (words["X"], words["Y"], words["Z"])
        if not self._told(goal):
            return []
        self.place = goal
        return ["ok"]


class PlayedGantry:
    """It answers what it is asked; moves wait for the test, but those home, which it does at once."""

    def __init__(self, line: Path) -> None:
        self._orders: queue.Queue[tuple[str, Ref]] = queue.Queue()
        self._goals: list[Place] = []
        self._homes, self._stop_word = True, HALT  # one byte is both
        self._grbl = PlayedGrbl(self._hear)
        # By name: once it was pulled, its number may be that of another test's line.
        self.line = PtyLine(self._grbl, link=str(line))
        self.line.start()

    def told(self) -> tuple[str, Ref]:
        return self._orders.get(timeout=PATIENCE_S)

    def accepts(self, ref: Ref) -> None:
        with self._grbl.lock:
            self._grbl.runs = True
            self._grbl.says("ok")

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        assert isinstance(ref, int)
        with self._grbl.lock:
            self._grbl.runs = False
            self._grbl.place = self._goals[ref - 1] if there else self._grbl.place

    def rejects(self, ref: Ref) -> str:
        self._grbl.says(f"error:{BEYOND}")
        return "(beyond_travel"

    def gives_up(self, ref: Ref) -> str:
        with self._grbl.lock:
            self._grbl.says(f"ALARM:{HARD_LIMIT}")
            self._grbl.lock_up()
        return "gave up (hard_limit"

    def rests(self) -> None:
        pass  # after a feed hold it stands

    def answers(self, ref: Ref, word: str) -> None:
        raise AssertionError("a gantry is asked nothing")

    def hush(self) -> None:
        self._grbl.switched.switch("mute", on=True)

    def boots(self) -> None:
        with self._grbl.lock:
            self._grbl.says(BANNER)
            self._grbl.lock_up()

    def vanish(self) -> None:
        self._grbl.switched.switch("unplugged", on=True)

    def come_back(self) -> None:
        self._homes = False  # whatever it is told to do from now on is an order
        self._grbl.switched.switch("unplugged", on=False)

    def latches(self) -> None:
        pass

    def close(self) -> None:
        self.line.stop()

    def _hear(self, goal: Place | None) -> bool:
        """Note an order: a feed hold, or a move; True for a move that is made at once."""
        if goal is None:
            self._orders.put((self._stop_word, None))
            self._stop_word = HALT if self._homes else LATCH
            return False
        if POSES[goal] == HOME and self._homes:
            return True
        self._goals.append(goal)
        self._orders.put((POSES[goal], len(self._goals)))
        return False


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    folder.mkdir()
    gantry = PlayedGantry(folder / "line")
    (folder / "plant.yaml").write_text(PLANT.format(line=gantry.line.path), "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    app = build(load(folder / "plant.yaml"), ("orchestrator",), Options(state_dir=state))
    return app, lambda app: gantry


BENCH = Bench(open=_open)
