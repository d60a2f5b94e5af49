"""The virtual boards in a process of their own: it outlives the plant, and tells what its arms truly did.

`python -m arboleda_kills.boards RATE`. It reads a line of JSON for each thing that somebody does,
`{"broker": [HOST, PORT]}` or null, `{"reference": ROBOT}`, `{"empty": ROBOT}`, `{"repair": ROBOT}`, and ends
with its input. It prints a line for each deed.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from itertools import count
from typing import Any

from arboleda.adapters import clock
from arboleda.adapters.broker_login import Address
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.runtime.loop import Loop
from arboleda.runtime.rate import at_rate
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.sim.devices import Devices, FromBoard
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.payloads import Goal, StopGoal

from .board_clients import BoardClients, forget_unsent
from .deeds import ALONE, PICK_UP, Deed, Did
from .steady import unix_s

NOWHERE = "no pose"


class WatchedDevices:
    """The boards, and what each arm took up, let go, or was told to do in a step."""

    def __init__(self, model: PlantModel) -> None:
        self.devices = Devices(model, now=clock.seconds(), boot_ids=count(int(time.time())).__next__)
        self.deeds: list[Deed] = []
        self._model = model
        self._arms: dict[str, ArmBody] = {}
        self._holding: set[str] = set()
        for robot in model.robots.values():
            board = self.devices.boards[robot.mqtt]
            board.watch = lambda goal, name=robot.name: self._note_goal(name, goal)
            if isinstance(board.body, ArmBody):
                self._arms[robot.name] = board.body

    @property
    def next_deadline(self) -> float | None:
        return self.devices.next_deadline

    def step(self, now: float, events: Sequence[Any]) -> list[FromBoard]:
        out = self.devices.step(now, events)
        for robot, body in self._arms.items():
            if body.holding != (robot in self._holding):
                self._holding ^= {robot}
                self._add(robot, Did.PICKED if body.holding else Did.LET_GO, self._place(robot, body))
        return out

    def take(self) -> list[Deed]:
        """The deeds since the last call."""
        deeds, self.deeds = self.deeds, []
        return deeds

    def _note_goal(self, robot: str, goal: Goal) -> None:
        if not isinstance(goal, StopGoal):
            self._add(robot, Did.WAS_TOLD, type(goal).__name__)

    def _add(self, robot: str, did: Did, what: str) -> None:
        cell = self._model.cell_of[robot].name
        self.deeds.append(Deed(at=unix_s(), cell=cell, robot=robot, did=did, what=what))

    def _place(self, robot: str, body: ArmBody) -> str:
        """The pose at which the arm truly stands, to the step of its motors."""
        cell = StorageLayout(self._model.cell_of[robot])
        for pose in cell.space.poses:
            assert isinstance(pose.q, tuple)
            rows = zip(cell.arm.joints, body.true_place, pose.q, strict=True)
            if all(abs(here - there) <= joint.step for joint, here, there in rows):
                alone = pose.name.startswith(PICK_UP) and pose.name != self._offered(cell)
                return f"{pose.name}{ALONE}" if alone else pose.name
        return NOWHERE

    def _offered(self, cell: StorageLayout) -> str | None:
        """The pick-up of the exit at which the mobile robot stands."""
        node = self.devices.boards[cell.mobile.mqtt].body.true_place
        exits = {path.nodes[-1] for path in cell.paths}
        return cell.pickup_over(node).name if node in exits else None


class Boards:
    """The boards on whichever broker the plant has now."""

    def __init__(self, model: PlantModel) -> None:
        self._watched = WatchedDevices(model)
        self._model = model
        self._clients = BoardClients(self._watched.devices, lambda event: self.loop.post(event))
        self.loop: Loop[Any, Any] = Loop(
            "boards",
            self._watched,
            self._clients.send,
            on_send_error=forget_unsent,
            on_step=lambda *_: self._tell(),
        )

    def act(self, line: dict[str, Any]) -> None:
        """Carry out one line of the input."""
        if "broker" in line:
            self._clients.leave()
            if broker := line["broker"]:
                self._clients.join(Address(host=broker[0], port=broker[1]))
        if robot := line.get("reference"):
            self._at_board(robot, Board.put_at_reference)
        if robot := line.get("empty"):
            self._at_board(robot, lambda board: board.body.take_out())
        if robot := line.get("repair"):
            self._at_board(robot, lambda board: board.repair(round(clock.seconds() * 1e6)))

    def _at_board(self, robot: str, act: Callable[[Board], None]) -> None:
        board = self._watched.devices.boards[self._model.robots[robot].mqtt]
        self.loop.read(lambda _: act(board))

    def _tell(self) -> None:
        tell(self._watched.take())


def tell(deeds: Iterable[Deed]) -> None:
    """A line for each."""
    for deed in deeds:
        print(json.dumps(deed.data()), flush=True)


def main() -> None:
    boards = Boards(at_rate(loader.load(None), float(sys.argv[1])))
    boards.loop.start()
    with suppress(KeyboardInterrupt):
        for line in sys.stdin:
            boards.act(json.loads(line))
    boards.loop.stop()


if __name__ == "__main__":
    main()
