"""An arm behind the driver `dobot`: the controller is played by hand on two sockets."""

from __future__ import annotations

import re
import time
from pathlib import Path
from typing import Any

from arboleda.testing.drivers import Bench
from arboleda.testing.drivers.bench import Ref
from arboleda_drivers.dobot.frames import Feedback, Mode

from ..contract.mover import ARM_DEG, WORDS, Opened, PlayedTcpArm, app_of, arm

GOALS = {tuple(map(float, deg)): word for deg, word in zip(ARM_DEG, WORDS, strict=True)}
ANSWERS = {"GetToolDO": "0", "GetErrorID": "[[17],[],[],[],[],[],[]]"}


class PlayedDobot(PlayedTcpArm):
    """It answers what it is asked; moves wait for the test, but those home, which it does at once."""

    def __init__(self) -> None:
        self._unanswered: list[tuple[int | None, str]] = []  # in order, the number of a move among them
        self._goals: dict[int, tuple[float, ...]] = {}
        # It has run for an hour, so that no boot within the test begins in the same second as this one.
        self._began_s, self._numbers = time.monotonic() - 3600, 0
        self._said = Feedback(mode=Mode.IDLE, command=0, joints_deg=(0.0,) * 6, time_ms=0, run_ms=0)
        super().__init__(2)

    def accepts(self, ref: Ref) -> None:
        self._answer(ref, f"0,{{{ref}}}")
        self._say(mode=Mode.RUNNING, command=ref)

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        self._say(mode=Mode.IDLE, command=ref, **({"joints_deg": self._goals[ref]} if there else {}))

    def rejects(self, ref: Ref) -> str:
        self._answer(ref, "-1,{}")
        return "(not_executed)"

    def gives_up(self, ref: Ref) -> str:
        self._say(mode=Mode.ERROR, command=ref)
        return "gave up (alarm 17"

    def rests(self) -> None:
        self._say(mode=Mode.IDLE)

    def boots(self) -> None:
        with self._lock:  # no frame in between shows the new boot at work
            self._began_s, self._numbers = time.monotonic(), 0
            self._say(mode=Mode.DISABLED, command=0)

    def _forget(self) -> None:
        self._unanswered.clear()

    def _told(self, port: int, data: bytes) -> None:
        for line in re.findall(r"\w+\([^()]*\)", str(data, "ascii")):
            self._hear(line)

    def _hear(self, line: str) -> None:
        name, values = line[:-1].split("(")
        with self._lock:
            if name == "MovJ":
                self._hear_move(line, values)
                return
            if name == "Stop":
                self._order_stop()
            self._unanswered.append((None, f"0,{{{ANSWERS.get(name, '')}}},{line};"))
            self._flush()

    def _hear_move(self, line: str, values: str) -> None:
        self._numbers += 1
        number, goal = self._numbers, tuple(float(each) for each in values[7:-1].split(","))
        self._goals[number] = goal
        self._unanswered.append((number, line))
        if self._is_made(GOALS[goal], number):
            self._answer(number, f"0,{{{number}}}")
            self.finishes(number)

    def _answer(self, number: Ref, how: str) -> None:
        with self._lock:
            moves = ((each, f"{how},{line};" if each == number else line) for each, line in self._unanswered)
            self._unanswered = [(None if each == number else each, line) for each, line in moves]
            self._flush()

    def _flush(self) -> None:
        """Answers leave in the order of the questions."""
        while self._unanswered and self._unanswered[0][0] is None:
            self.ports.send(0, self._unanswered.pop(0)[1].encode())

    def _say(self, **news: Any) -> None:
        with self._lock:
            self._said = Feedback(**{**vars(self._said), **news})
        self._frame()

    def _frame(self) -> None:
        with self._lock:
            run_ms = int((time.monotonic() - self._began_s) * 1000)
            started_ms = int(self._began_s * 1000)
            said = Feedback(**{**vars(self._said), "run_ms": run_ms, "time_ms": started_ms + run_ms})
            self.ports.send(1, said.packed())


def _open(folder: Path, state: Path) -> Opened:
    dobot = PlayedDobot()
    port, feedback = dobot.ports.numbers
    driver = f"{{dobot: {{host: 127.0.0.1, port: {port}, feedback_port: {feedback}}}}}"
    return app_of(folder, state, arm(driver), "arm"), lambda app: dobot


BENCH = Bench(open=_open, takes="arboleda_drivers.dobot.machine.FrameReader.feed")
