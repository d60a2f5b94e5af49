"""An arm behind the driver `dobot`: the controller is played by hand on two sockets."""

from __future__ import annotations

import queue
import re
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from contract.bench import HALT, LATCH, OTHER, WORK, Bench, Device, Ref
from contract.tcp_ports import Ports
from tests.patience import PATIENCE_S

from arboleda.plant_file.loader import load
from arboleda.runtime.build import App, Options, build
from arboleda_drivers.dobot.frames import Feedback, Mode

FRAME_S = 0.02
HOME = "home"
GOALS = {(0.0,) * 6: HOME, (10.0, 20.0, -30.0, 0.0, 5.0, 0.0): WORK, (5.0, 0.0, 0.0, 0.0, 0.0, 0.0): OTHER}
ANSWERS = {"GetToolDO": "0", "GetErrorID": "[[17],[],[],[],[],[],[]]"}
PLANT = """
name: dobot
uses: [recipes.py]
cells:
  shop:
    devices:
      arm:
        kind: arm
        model: cr10a
        driver: {{dobot: {{host: 127.0.0.1, port: {port}, feedback_port: {feedback}}}}}
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


class PlayedDobot:
    """It answers what it is asked; moves wait for the test, but those home, which it does at once."""

    def __init__(self) -> None:
        self._orders: queue.Queue[tuple[str, Ref]] = queue.Queue()
        self._unanswered: list[tuple[int | None, str]] = []  # in order, the number of a move among them
        self._goals: dict[int, tuple[float, ...]] = {}
        self._lock = threading.RLock()
        # It has run for an hour, so that no boot within the test begins in the same second as this one.
        self._began_s, self._numbers, self._homes = time.monotonic() - 3600, 0, True
        self._stop_word = HALT  # there is one line for both
        self._said = Feedback(mode=Mode.IDLE, command=0, joints_deg=(0.0,) * 6, time_ms=0, run_ms=0)
        self._quiet, self._ending = threading.Event(), threading.Event()
        self.ports = Ports(2, self._told)
        self._thread = threading.Thread(target=self._speak, name="dobot frames", daemon=True)
        self._thread.start()

    def told(self) -> tuple[str, Ref]:
        return self._orders.get(timeout=PATIENCE_S)

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

    def answers(self, ref: Ref, word: str) -> None:
        raise AssertionError("an arm is asked nothing")

    def hush(self) -> None:
        self._quiet.set()

    def boots(self) -> None:
        with self._lock:  # no frame in between shows the new boot at work
            self._began_s, self._numbers = time.monotonic(), 0
            self._say(mode=Mode.DISABLED, command=0)

    def vanish(self) -> None:
        self._quiet.set()
        self.ports.close()
        self._unanswered.clear()

    def come_back(self) -> None:
        self._homes = False  # whatever it is told to do from now on is an order
        self._stop_word = HALT  # of what was left at work; a second one is the plant's latch
        self._say(mode=Mode.IDLE)
        self.ports.open()
        self._quiet.clear()

    def latches(self) -> None:
        self.rests()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self.ports.close()

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
                self._orders.put((self._stop_word, None))
                self._stop_word = HALT if self._homes else LATCH
            self._unanswered.append((None, f"0,{{{ANSWERS.get(name, '')}}},{line};"))
            self._flush()

    def _hear_move(self, line: str, values: str) -> None:
        self._numbers += 1
        number, goal = self._numbers, tuple(float(each) for each in values[7:-1].split(","))
        self._goals[number] = goal
        self._unanswered.append((number, line))
        if GOALS[goal] == HOME and self._homes:
            self._answer(number, f"0,{{{number}}}")
            self.finishes(number)
        else:
            self._orders.put((GOALS[goal], number))

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

    def _speak(self) -> None:
        while not self._ending.wait(FRAME_S):
            if not self._quiet.is_set():
                self._frame()


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    dobot = PlayedDobot()
    folder.mkdir()
    port, feedback = dobot.ports.numbers
    (folder / "plant.yaml").write_text(PLANT.format(port=port, feedback=feedback), "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    app = build(load(folder / "plant.yaml"), ("orchestrator",), Options(state_dir=state))
    return app, lambda app: dobot


BENCH = Bench(open=_open)
