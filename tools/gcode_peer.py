"""Frame of the peers of the driver `gcode`: a firmware built for this machine, and the driver at its line."""

from __future__ import annotations

import os
import subprocess
import time
import tty
from collections.abc import Callable, Sequence
from pathlib import Path

from arboleda.kinds.joints import Jointed
from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda.plant_file.loader import load
from arboleda_drivers.gcode.adapter import Gcode
from arboleda_drivers.gcode.settings import MM, Settings

PATIENCE_S = 60.0
GANTRIES = Path(__file__).parents[1] / "examples/gantry"
Place = tuple[float, ...]


def gantry(file: str) -> Jointed:
    """The gantry of a plant file of the example."""
    (robot,) = load(GANTRIES / file).robots.values()
    assert isinstance(robot, Jointed)
    return robot


class Program:
    """Program at the far end of a line, which it has for its input and output.

    It keeps its answers to itself at a pipe, so it has a pseudo terminal of its own.
    """

    def __init__(self, arguments: Sequence[str], folder: str | None = None) -> None:
        self.is_unplugged = False
        self._arguments, self._folder = arguments, folder
        self._now = 0.0
        self._start()

    def _start(self) -> None:
        self._line, far = os.openpty()
        tty.setraw(far)
        os.set_blocking(self._line, False)
        self._process = subprocess.Popen(self._arguments, stdin=far, stdout=far, cwd=self._folder)
        os.close(far)

    def reset(self) -> None:
        """Begin anew, as a board does whose button is pressed; the line stays."""
        self._process.kill()
        self._process.wait()
        line = self._line
        self._start()
        os.close(line)

    @property
    def next_deadline(self) -> float:
        return self._now + 0.005

    def step(self, now: float, data: bytes = b"") -> bytes:
        self._now = now
        if data:
            os.write(self._line, data)
        try:
            return os.read(self._line, 4096)
        except OSError:  # it has nothing to say
            return b""

    def hear(self, data: bytes) -> None:
        """Hear bytes that came another way."""
        os.write(self._line, data)

    def end(self) -> None:
        self._process.kill()
        self._process.wait()
        os.close(self._line)


class Trial:
    """The driver at work, what it reports, and how much of that is not as it should be."""

    def __init__(self, robot: Jointed, settings: Settings) -> None:
        self.reports: list[Report] = []
        self.wrong = 0
        self._robot = robot
        self._number = 0
        self._words = ""
        self._driver = Gcode(settings)
        self._driver.start([robot], self._take, time.monotonic)

    def _take(self, report: Report) -> None:
        self.reports.append(report)

    @property
    def last(self) -> Report:
        return self.reports[-1]

    def give(self, make: Callable[..., Command], **values: object) -> str:
        """Send a command, and return its id."""
        self._number += 1
        id = f"1-{self._number}"
        self._driver.send(make(id=id, robot=self._robot.name, **values))
        return id

    def see(self, what: str, fits: Callable[[Report], bool]) -> Report | None:
        """Wait for a last report that fits, and say what became of it; None if none came."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            if self.reports and fits(last := self.last):
                self.say(what, right=True)
                return last
            time.sleep(0.01)
        self.say(what, right=False)
        return None

    def say(self, what: str, *, right: bool) -> None:
        """Say whether it was seen."""
        self.wrong += not right
        print(f"{'seen    ' if right else 'NOT seen'}  {what}: {self._shown}", flush=True)

    @property
    def _shown(self) -> str:
        if not self.reports:
            return "it has said nothing"
        last = self.last
        assert last.state is not None
        where = "an unknown place" if last.q is None else str([round(each * MM, 2) for each in last.q])
        before, self._words = self._words, str(last.lost or last.failure or last.refusal or "")
        news = f", {self._words}" if self._words != before else ""
        return f"{last.state.name.lower()}, at {where}{news}"

    def stands_at(self, report: Report, *mm: float) -> bool:
        """True where a report tells this place."""
        return report.q is not None and self._robot.motion.stands_at(report.q, tuple(at / MM for at in mm))

    def stop(self) -> None:
        self._driver.stop()
