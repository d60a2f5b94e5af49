"""From the end of a Dobot's move to the next one, over the driver and the plant, as its controller sees it.

Ours is `arboleda up` with the driver `dobot`; the floor (`floor_dobot.py`) is a bare client of two sockets
that looks at the same three things in each frame and has its next line ready. Each has a virtual controller
of its own in this process, and they have turns. A controller tells of an end with its next frame, every 8 ms:
figures are from that frame, which is what software adds, and from the end itself, which the arm waits.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence

from arboleda_drivers.dobot.frames import Mode
from arboleda_drivers.dobot.virtual.command import Server
from arboleda_drivers.dobot.virtual.machine import ClientText, Frame, Message, VirtualDobot

from .floor_dobot import ANGLES_DEG
from .processes import Process
from .result import Aim, Figure, Result, percentile
from .scene import Scene

PATIENCE_S = 60.0  # of one turn
LONGEST_S = 0.5  # what is longer lies between two turns
MOVES = 20  # in each task
RUN = "from arboleda.cli.main import main; main()"
PLANT = """
name: bench_dobot
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
{targets}
"""
TARGET = "      at_{number}: {{arm: {{deg: [{angle}, 0, 0, 0, 0, 0]}}}}"
RECIPES = f"""
from arboleda.recipes import recipe, work

@recipe("to_and_fro")
def to_and_fro(cell):
    arm = cell.device("arm")
    return work([arm.go(f"at_{{number % {len(ANGLES_DEG)}}}") for number in range({MOVES})])
"""


class Watched(VirtualDobot):
    """A virtual controller that notes each wait for the next move: from an end, and from its frame."""

    def __init__(self, *args: object, **named: object) -> None:
        super().__init__(*args, **named)  # type: ignore[arg-type]
        self.waits: list[tuple[float, float]] = []  # s
        self._was, self._ended_at, self._frame_at = Mode.IDLE, 0.0, 0.0

    def step(self, now: float, events: Sequence[ClientText]) -> list[Message]:
        moves = any("MovJ" in event.text for event in events)
        if moves and self._ended_at and self._frame_at and now - self._ended_at < LONGEST_S:
            self.waits.append((now - self._ended_at, now - self._frame_at))
        out = super().step(now, events)
        if self._was is Mode.RUNNING and self.arm.mode is Mode.IDLE:
            self._ended_at, self._frame_at = now, 0.0
        if self.arm.mode is not Mode.IDLE:
            self._ended_at = 0.0
        elif self._ended_at and not self._frame_at and any(isinstance(each, Frame) for each in out):
            self._frame_at = now
        self._was = self.arm.mode
        return out


def run(scene: Scene) -> Result:
    """Some hundred moves of each side, or as many as a short look allows."""
    turns = 2 if scene.quick else 10
    servers = [Server(enabled=True, make=Watched) for _ in range(2)]
    for server in servers:
        server.start()
    try:
        for turn in range(turns):
            scene.say(f"turn {turn + 1} of {turns}")
            _floor(scene, servers[1]).wait(PATIENCE_S)
            _ours(scene, servers[0]).wait(PATIENCE_S)
    finally:
        for server in servers:
            server.stop()
    ours, floor = ([*server.machine.waits] for server in servers)  # type: ignore[attr-defined]
    return _result(ours, floor)


def _ours(scene: Scene, server: Server) -> Process:
    folder = scene.folder
    rows = (TARGET.format(number=number, angle=angle) for number, angle in enumerate(ANGLES_DEG))
    text = PLANT.format(port=server.port, feedback=server.feedback_port, targets="\n".join(rows))
    (folder / "plant.yaml").write_text(text, "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    options = ["--plant", str(folder / "plant.yaml"), "--state", str(folder / "state"), "--boards", "real"]
    return Process(
        [sys.executable, "-c", RUN, "up", "--once", "shop", "--no-ros", *options], folder / "ours.log"
    )


def _floor(scene: Scene, server: Server) -> Process:
    ports = (str(server.port), str(server.feedback_port))
    return scene.python("arboleda_bench.floor_dobot", *ports, str(MOVES))


def _result(ours: Sequence[tuple[float, float]], floor: Sequence[tuple[float, float]]) -> Result:
    since: dict[str, Callable[[tuple[float, float]], float]] = {"its end": lambda each: each[0]}
    since["the frame"] = lambda each: each[1]
    figures = []
    for name, pick in since.items():
        for percent in (50, 99):
            mine, theirs = (
                percentile([pick(each) * 1000 for each in side], percent) for side in (ours, floor)
            )
            aim = Aim(most=3, of_ratio=False) if name == "its end" and percent == 50 else None
            figures.append(
                Figure(name=f"p{percent}, from {name}", unit="ms", ours=mine, floor=theirs, aim=aim)
            )
    counted = (
        f"{len(ours)} moves of ours that followed another, {len(floor)} of the floor, in turns of {MOVES}."
    )
    ways = "Moves of 0.1 to 3 degrees, of many lengths, so that ends fall anywhere between two frames."
    return Result(figures=figures, notes=(counted, ways))
