"""Truth about the tasks of the storage recipes, in whichever cell they run."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from arboleda.core import text
from arboleda.model.commands import Switch
from arboleda.model.messages import Report, TaskChanged, TaskState
from arboleda.model.task import Order
from arboleda.recipes.storage_layout import StorageLayout

from ..truth.robot import RobotTruth
from ..world import World
from .deeds import CellTruth, EndedTask
from .parts import Parts
from .tasks import NAMES, stores


class StorageTruth:
    """Deeds of the cells that offer a storage recipe, by cell, and where their parts are.

    Of this step: `begun`, the cells whose task began, and `ended`, the tasks that did; `stray_grips`, the
    arms that the plant told to grip though no task of their cell ran. While a cell carries out a task of
    another recipe, and until the next one of these, nothing is followed there.
    """

    def __init__(
        self, world: World, robots: dict[str, RobotTruth], unseen: Callable[[RobotTruth], bool]
    ) -> None:
        self.begun: list[CellTruth] = []
        self.ended: list[EndedTask] = []
        self.stray_grips: list[str] = []
        self.parts = Parts()
        self.arms: dict[str, Any] = {}
        self.mobiles: dict[str, Any] = {}
        self.cells: dict[str, CellTruth] = {}
        self._world, self._unseen = world, unseen
        self._of_arm: dict[str, CellTruth] = {}
        self._of_robot: dict[str, CellTruth] = {}
        self._orders: dict[str, Order] = {}
        for layout in map(StorageLayout, filter(stores, world.model.cells)):
            self._add(layout, robots)

    def _add(self, layout: StorageLayout, robots: dict[str, Any]) -> None:
        arm, mobile = robots.get(layout.arm.name), robots.get(layout.mobile.name)
        cell = self.cells[layout.name] = CellTruth(layout, arm, mobile)
        self._of_arm[layout.arm.name] = cell
        self._of_robot |= {layout.arm.name: cell, layout.mobile.name: cell}
        if mobile is not None:
            self.mobiles[layout.mobile.name] = mobile
        if arm is not None:
            self.arms[layout.arm.name] = arm
            self.parts.start(arm)

    @property
    def has_news(self) -> bool:
        """True if a task began or ended in this step, or an arm was told to grip for none."""
        return bool(self.begun or self.ended or self.stray_grips)

    def forget(self) -> None:
        """Forget what happened in the step before."""
        for cell in self.cells.values():
            cell.switch = None
        self.parts.forget()
        self.begun, self.ended, self.stray_grips = [], [], []

    def restart(self) -> None:
        """Begin with a new plant: the old one's tasks are gone, but for those that go on."""
        for name, cell in self.cells.items():
            goes_on = self._world.plant.cells[name].task
            if goes_on is None or goes_on.id != cell.task:
                cell.cut_off()
                self.parts.empty(name)
            if goes_on is not None and goes_on.id != cell.task:  # its start was not reported
                self._begin(cell, goes_on.id, goes_on.order)

    def follow(self, changed: Iterable[RobotTruth]) -> None:
        """Take in what robots did in this step."""
        for cell in dict.fromkeys(
            self._of_robot[name] for each in changed if (name := each.robot.name) in self._of_robot
        ):
            if cell.of_others:
                continue
            cell.look()
            if cell.arm is not None:
                cell.blind = cell.blind or self._unseen(cell.arm)
                self.parts.look(cell, cell.arm)

    def hear(self, reports: Iterable[Report]) -> None:
        """Take in what the plant hears of pieces."""
        for report in reports:
            if report.piece is not None and report.robot in self._of_arm:
                debounce_s = self._world.model.timing.piece_debounce_s
                self._of_arm[report.robot].feel(report.at, is_there=report.piece, debounce_s=debounce_s)

    def command(self, command: Switch) -> None:
        """Take in that the plant tells an effector to grip, or to let go."""
        cell = self._of_arm.get(command.robot)
        if cell is None or command.grips is None or cell.of_others:
            return
        cell.tell(grips=command.grips)
        if command.grips and cell.task is None:
            self.stray_grips.append(command.robot)

    def release(self, robots: Iterable[str]) -> None:
        """Take in that an operator has these robots let go."""
        for name in robots:
            if name in self._of_robot:
                self._of_robot[name].released = True

    def task(self, change: TaskChanged) -> None:
        """Take in the plant's word on a task."""
        cell = self.cells.get(change.cell or "")
        if cell is None or (change.state is TaskState.RUNNING and change.task == cell.task):
            return  # elsewhere, or somebody asked for it again
        if change.state is TaskState.RUNNING:
            self._begin(cell, change.task, self._order(change.text))
            self.begun += [] if cell.of_others else [cell]
        elif change.task == cell.task and change.state is not TaskState.QUEUED:
            is_done = change.state is TaskState.DONE
            self.ended.append(cell.end(change.text, done=is_done, unchecked=change.unchecked))
            self.parts.empty(cell.cell.name)

    def _begin(self, cell: CellTruth, task: str, order: Order) -> None:
        if self._world.versions:  # what ended before, ended with its own
            cell.cell = StorageLayout(self._world.model.cell(cell.cell.name))
        if order.recipe not in NAMES:
            cell.cut_off()
            cell.of_others, cell.switch = True, None
            return
        if cell.of_others and cell.arm is not None:
            self.parts.take_over(cell.arm)
        cell.of_others = False
        cell.begin(task, order, self._world.now)

    def _order(self, words: str) -> Order:
        if words not in self._orders:
            self._orders[words] = text.parse(words, self._world.model)
        return self._orders[words]
