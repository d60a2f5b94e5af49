"""The truth about a plant of storage cells, step by step."""

from __future__ import annotations

from typing import Any

from arboleda.core import text
from arboleda.model.commands import Command, Switch
from arboleda.model.messages import OperatorAnswer, TaskChanged, TaskState, Verb
from arboleda.model.task import Order
from arboleda.recipes.storage_layout import StorageLayout

from ..storage.deeds import CellTruth, EndedTask
from ..storage.parts import Parts
from ..world import World
from .robots import RobotsTruth
from .stops import robots_of


class Truth(RobotsTruth):
    """Cells by name, beside the robots.

    Of this step: `begun`, the cells whose task began, and `ended`, the tasks that did; `stray_grips`, the
    arms that the plant told to grip though no task of their cell ran.
    """

    def __init__(self, world: World) -> None:
        self.begun: list[CellTruth] = []
        self.ended: list[EndedTask] = []
        self.stray_grips: list[str] = []
        super().__init__(world)
        self.arms: dict[str, Any] = {name: each for name, each in self.robots.items() if each.robot.joints}
        self.mobiles: dict[str, Any] = {
            name: each for name, each in self.robots.items() if each.robot.floor_grid
        }
        self.parts = Parts()
        roles = [
            (cell, self.arms.get(cell.arm.name), self.mobiles.get(cell.mobile.name))
            for cell in map(StorageLayout, world.model.cells)
        ]
        self.cells = {cell.name: CellTruth(cell, arm, mobile) for cell, arm, mobile in roles}
        for arm in self.arms.values():
            self.parts.start(arm)
        self._orders: dict[str, Order] = {}

    def _did_anything(self) -> bool:
        return bool(self.changed or self.begun or self.ended or self.stray_grips)

    def _forget(self) -> None:
        super()._forget()
        for cell in self.cells.values():
            cell.switch = None
        self.parts.forget()
        self.begun, self.ended, self.stray_grips = [], [], []

    def _new_plant(self) -> None:
        """Begin with a new plant: the old one's tasks are gone, but for those that go on."""
        super()._new_plant()
        for name, cell in self.cells.items():
            goes_on = self.world.plant.cells[name].task
            if goes_on is None or goes_on.id != cell.task:
                cell.cut_off()
                self.parts.empty(name)
            if goes_on is not None and goes_on.id != cell.task:  # its start was not reported
                cell.begin(goes_on.id, goes_on.order, self.world.now)

    def _follow_changes(self) -> None:
        super()._follow_changes()
        for name in dict.fromkeys(robot.cell.name for robot in self.changed):
            cell = self.cells[name]
            cell.look()
            if cell.arm is not None:
                cell.blind = cell.blind or self.unseen(cell.arm)
                self.parts.look(cell, cell.arm)

    def _look_at_plant(self) -> None:
        for report in self.world.moment.heard:
            if report.piece is False and report.robot in self.arms:
                self.cells[self.world.model.cell_of[report.robot].name].feel()
        super()._look_at_plant()

    def _take_in(self, message: object) -> None:
        if isinstance(message, TaskChanged):
            self._task(message)
        else:
            super()._take_in(message)

    def _command(self, command: Command) -> None:
        super()._command(command)
        if not isinstance(command, Switch) or command.grips is None:
            return
        cell = self.cells[self.world.model.cell_of[command.robot].name]
        cell.tell(grips=command.grips)
        if command.grips and cell.task is None:
            self.stray_grips.append(command.robot)

    def _answered(self, answer: OperatorAnswer) -> None:
        super()._answered(answer)
        if answer.verb is Verb.RELEASE:
            for name in robots_of(self.world.model, answer.scope):
                self.cells[self.world.model.cell_of[name].name].released = True

    def _task(self, change: TaskChanged) -> None:
        cell = self.cells.get(change.cell or "")
        if cell is None:
            return
        if change.state is TaskState.RUNNING and change.task == cell.task:
            return  # somebody asked for it again
        if change.state is TaskState.RUNNING:
            cell.begin(change.task, self._order(change.text), self.world.now)
            self.begun.append(cell)
        elif change.task == cell.task and change.state is not TaskState.QUEUED:
            is_done = change.state is TaskState.DONE
            self.ended.append(cell.end(change.text, done=is_done, unchecked=change.unchecked))
            self.parts.empty(cell.cell.name)

    def _order(self, words: str) -> Order:
        if words not in self._orders:
            self._orders[words] = text.parse(words, self.world.model)
        return self._orders[words]
