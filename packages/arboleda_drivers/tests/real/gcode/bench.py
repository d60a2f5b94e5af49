"""Gantries behind the driver `gcode`: a controller is played by hand on a pseudo terminal."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path

from arboleda.testing.drivers import Bench
from arboleda.testing.drivers.bench import Ref
from arboleda_drivers.gcode.virtual.faults import GRBL_FAULTS, MARLIN_FAULTS, MOONRAKER_FAULTS
from arboleda_drivers.gcode.virtual.grbl import BANNER, BEYOND, HARD_LIMIT, HOLD_BYTE, VirtualGrbl
from arboleda_drivers.gcode.virtual.machine import Place, words_of
from arboleda_drivers.gcode.virtual.marlin import VirtualMarlin
from arboleda_drivers.gcode.virtual.moonraker import ERROR, VirtualMoonraker, answered, refused
from arboleda_drivers.virtual.faults import Faults
from arboleda_drivers.virtual.pty_line import PtyLine
from arboleda_drivers.virtual.web_socket_line import WebSocketLine

from ..contract.mover import WORDS, Opened, PlayedMover, app_of, plant

PLACES: tuple[Place, ...] = ((0.0, 0.0, 0.0), (30.0, 20.0, 5.0), (5.0, 0.0, 0.0))
KINDS = """
from arboleda.kinds import Axes, Axis, moving_kind

@moving_kind("gantry")
def gantry():
    return Axes(*(Axis(name, unit="mm", lower=-5, upper=300, speed={speed}, step=0.02) for name in "xyz"))
"""


class PlayedGrbl(VirtualGrbl):
    """Controller that answers no move by itself, and goes nowhere; a feed hold has it stand at once."""

    def __init__(self, told: Callable[[Place | None], bool]) -> None:
        self.switched = Faults(GRBL_FAULTS)
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
        words = words_of(line)
        if "X" not in words or self._locked:
            return super()._line(now, line)
        goal = (words["X"], words["Y"], words["Z"])
        if not self._told(goal):
            return []
        self.place = goal
        return ["ok"]


class PlayedMarlin(VirtualMarlin):
    """Controller that answers no move by itself, and goes nowhere; it stands at once where it is stopped."""

    def __init__(self, told: Callable[[Place | None], bool]) -> None:
        self.switched = Faults(MARLIN_FAULTS)
        super().__init__(self.switched)
        self._told = told
        self._due: list[str] = []
        self.runs = self.holds = self._stands = False
        self.lock = threading.RLock()

    def step(self, now: float, data: bytes = b"") -> bytes:
        with self.lock:
            due, self._due = self._due, []
            return self._sent(due) + super().step(now, data)

    def says(self, *lines: str) -> None:
        """Say lines at the next opportunity, and go on with those that wait."""
        self._due += lines
        self.holds = False

    def rest(self, place: Place | None) -> None:
        """Stand, at this place if there is one."""
        self.runs = self.holds = False
        self._goal = place or self._goal

    @property
    def _is_busy(self) -> bool:
        return self.holds or (self._waits and self.runs) or super()._is_busy

    def _quick_stop(self, now: float) -> None:
        self.runs = False
        if not self._stands:  # or it is the same order, said again after the ok of its move
            self._told(None)
        self._stands = True

    def _position_line(self) -> str:
        self._stands = False
        return super()._position_line()

    def _move(self, now: float, line: str) -> list[str]:
        words = words_of(line)
        goal = (words["X"], words["Y"], words["Z"])
        if self._told(goal):
            self._goal = goal
            return ["ok"]
        self.holds = True
        return []


class PlayedMoonraker(VirtualMoonraker):
    """Klipper that answers no move by itself, and goes nowhere; it stands at once where it is stopped."""

    def __init__(self, told: Callable[[Place | None], bool]) -> None:
        self.switched = Faults(MOONRAKER_FAULTS)
        super().__init__(self.switched)
        self._told = told
        self._waits: list[int] = []  # moves without an answer, by the numbers of their requests
        self._due: list[str] = []
        self._holds = self._was_stopped = False
        self.lock = threading.RLock()

    def step(self, now: float, data: bytes = b"") -> bytes:
        with self.lock:
            if b"M400" in data:
                self.rest(None)
                self._was_stopped = True
                self._told(None)
            due, self._due = self._due, []
            return self._sent(due) + super().step(now, data)

    def says(self, refusal: str | None) -> None:
        """Answer the moves that wait: they run, and lead nowhere, or they are refused."""
        self._klipper.stalls = refusal is None and not self._was_stopped
        answers = [
            answered(each, "ok") if refusal is None else refused(each, 400, refusal) for each in self._waits
        ]
        self._due, self._waits = [*self._due, *answers], []

    def rest(self, place: Place | None) -> None:
        """Stand, at this place if there is one."""
        self._klipper.stalls = False
        if place is not None:
            self._stand(place)
        self._klipper.planned = self._klipper.place

    def dies(self) -> None:
        """Be in error, until its firmware is restarted."""
        self.rest(None)
        self._klipper.state = ERROR

    def _run(self, now: float) -> list[str]:
        before = [each.number for each in self._klipper.scripts]
        out, holds = super()._run(now), self._holds
        self._holds = False
        if holds:
            self._waits.append(before[0])
        return out[1:] if holds else out

    def _do(self, now: float, line: str) -> str | None:
        if not line.startswith("G1"):
            return super()._do(now, line)
        words = words_of(line)
        self._klipper.ordered = goal = (words["X"], words["Y"], words["Z"])
        if self._told(goal):
            self.rest(goal)
        else:
            self._holds, self._was_stopped = True, False
        return None


class PlayedGantry(PlayedMover):
    """It answers what it is asked; moves wait for the test, but those home, which it does at once."""

    def __init__(self) -> None:
        super().__init__()
        self._goals: list[Place] = []
        self._controller: PlayedGrbl | PlayedMarlin | PlayedMoonraker

    def begin(self, line: Path) -> str:
        """Be at a line; returns the keys of its address."""
        # By name: once it was pulled, its number may be that of another test's line.
        self._line: PtyLine | WebSocketLine = PtyLine(self._controller, link=str(line))
        self._line.start()
        return f"serial: {line}"

    def accepts(self, ref: Ref) -> None:
        assert not isinstance(self._controller, PlayedMoonraker)
        with self._controller.lock:
            self._controller.runs = True
            self._controller.says("ok")

    def hush(self) -> None:
        self._controller.switched.switch("mute", on=True)

    def vanish(self) -> None:
        self._controller.switched.switch("unplugged", on=True)

    def come_back(self) -> None:
        self._homes = False  # whatever it is told to do from now on is an order
        self._controller.switched.switch("unplugged", on=False)

    def close(self) -> None:
        self._line.stop()

    def _hear(self, goal: Place | None) -> bool:
        """Note an order: a stop, or a move; True for a move that is made at once."""
        if goal is None:
            self._order_stop()
            return False
        self._goals.append(goal)
        return self._is_made(WORDS[PLACES.index(goal)], len(self._goals))


class GrblGantry(PlayedGantry):
    """Gantry whose controller runs GRBL."""

    def __init__(self) -> None:
        super().__init__()
        self._controller = self._grbl = PlayedGrbl(self._hear)

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

    def boots(self) -> None:
        with self._grbl.lock:
            self._grbl.says(BANNER)
            self._grbl.lock_up()


class MarlinGantry(PlayedGantry):
    """Gantry whose controller runs Marlin."""

    def __init__(self) -> None:
        super().__init__()
        self._controller = self._marlin = PlayedMarlin(self._hear)

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        assert isinstance(ref, int)
        with self._marlin.lock:
            self._marlin.rest(self._goals[ref - 1] if there else None)

    def rejects(self, ref: Ref) -> str:
        with self._marlin.lock:
            self._marlin.says('echo:Unknown command: "G1"', "ok")
        return "(unknown_command"

    def gives_up(self, ref: Ref) -> str:
        with self._marlin.lock:
            self._marlin.says("echo:endstops hit:  X:1.00")
        return "gave up (endstop_hit"

    def boots(self) -> None:
        with self._marlin.lock:
            self._marlin.rest(None)
            self._marlin.press_reset()


class MoonrakerGantry(PlayedGantry):
    """Gantry with Klipper behind Moonraker."""

    def __init__(self) -> None:
        super().__init__()
        self._controller = self._moonraker = PlayedMoonraker(self._hear)

    def begin(self, line: Path) -> str:
        self._line = WebSocketLine(self._moonraker)
        self._line.start()
        return f"host: 127.0.0.1, port: {self._line.port}"

    def accepts(self, ref: Ref) -> None:
        with self._moonraker.lock:
            self._moonraker.says(None)

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        assert isinstance(ref, int)
        with self._moonraker.lock:
            self._moonraker.rest(self._goals[ref - 1] if there else None)

    def rejects(self, ref: Ref) -> str:
        with self._moonraker.lock:
            self._moonraker.says("Move out of range: 30.000 20.000 5.000 [0.000]")
        return "(beyond_travel"

    def gives_up(self, ref: Ref) -> str:
        with self._moonraker.lock:
            self._moonraker.dies()
        return "gave up (error"

    def boots(self) -> None:
        with self._moonraker.lock:
            self._moonraker.press_reset()


Gantry = type[GrblGantry | MarlinGantry | MoonrakerGantry]


def _open(folder: Path, state: Path, *, gantry: Gantry, keys: str, speed: int = 60) -> Opened:
    folder.mkdir()
    played = gantry()
    driver = f"{{gcode: {{{played.begin(folder / 'line')}, {keys}}}}}"
    text = plant("gantry", f"kind: gantry, home_at_start: true, driver: {driver}", "mm", PLACES)
    app = app_of(folder, state, text, "gantry", kinds=KINDS.format(speed=speed))
    return app, lambda app: played


TAKES = "arboleda_drivers.gcode.lines.LineReader.feed"
BENCH = Bench(open=partial(_open, gantry=GrblGantry, keys="dialect: grbl"), takes=TAKES)
MARLIN_BENCH = Bench(
    open=partial(_open, gantry=MarlinGantry, keys="dialect: marlin, stop_keeps_place: true"), takes=TAKES
)
MOONRAKER_BENCH = Bench(
    # So fast that a move is one piece.
    open=partial(_open, gantry=MoonrakerGantry, keys="dialect: moonraker", speed=600),
    takes=TAKES,
)
