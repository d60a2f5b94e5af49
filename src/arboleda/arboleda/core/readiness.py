"""Readiness of a cell: why none of its tasks can start, by what its robots still do, hold or lack."""

from __future__ import annotations

from arboleda.model.commands import Question
from arboleda.model.grips import Grip
from arboleda.model.messages import Failure, Reason
from arboleda.model.plant_model import Cell
from arboleda.model.sentence import Phrase, Sentence
from arboleda.trees.context import Context
from arboleda.trees.part_places import ASKED

STILL_ASKED = Phrase("robot.still_asked", "{person} has a question to answer first")
STILL_DOING = Phrase("robot.still_doing", "{robot} is still {doing}")
MAY_HOLD = Phrase("part.may_hold", "{arm} may hold a part, its effector is {grip}")
MAY_HOLD_BY_FACT = Phrase("part.may_hold_by_fact", "{device} may hold a part: {fact} is {grip}")
HELD_AS = {
    Grip.OFF: Phrase("held_as.off", "false"),
    Grip.ON: Phrase("held_as.on", "true"),
    Grip.SWITCHING: Phrase("held_as.switching", "not known yet"),
}
GRIPS = {grip: Phrase(f"grip.{grip.value}", grip.value) for grip in Grip}


class Readiness:
    """Inspector of one cell's robots, before a task starts."""

    def __init__(self, cell: Cell, context: Context) -> None:
        self._cell = cell
        self._context = context

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on."""
        self._cell = cell

    def objection(self) -> Sentence | None:
        """The first thing that keeps an idle cell from starting a task; None where it is ready."""
        if busy := self.busy():
            return busy
        failures = [self._context.robots.obstacle(robot.name) for robot in self._cell.reached]
        astray = self._context.zones.astray()
        failures += [astray[1] if astray else None, self.part_in_hand()]
        asked = (ASKED(place=place) for place in self._context.places.asked.targets)
        return next((failure.sentence for failure in failures if failure), None) or next(asked, None)

    def busy(self) -> Sentence | None:
        """The command that a robot of the cell still carries out, or the question that a person has open."""
        first = next(iter(self._context.commands.open()), None)
        if first is None:
            return None
        if isinstance(first.command, Question):
            return STILL_ASKED(person=first.command.robot)
        return STILL_DOING(robot=first.command.robot, doing=first.doing)

    def part_in_hand(self) -> Failure | None:
        """The first robot that may hold a part."""
        robot = next(iter(self._context.parts.holding), None)
        if robot is None:
            return None
        return Failure(reason=Reason.INTERRUPTED, sentence=self._may_hold(robot))

    def obstacle_at_work(self) -> Sentence | None:
        """The first obstacle to a command of a cell at work: that a robot moves is none."""
        robots = self._context.robots
        for each in self._cell.reached:
            if not robots.belief(each.name).moves and (obstacle := robots.obstacle(each.name)) is not None:
                return obstacle.sentence
        return None

    def _may_hold(self, robot: str) -> Sentence:
        device = next(each for each in self._cell.robots if each.name == robot)
        grip, fact = self._context.parts.grip(robot), device.held_fact
        if device.has_effector or fact is None:
            return MAY_HOLD(arm=robot, grip=GRIPS[grip]())
        return MAY_HOLD_BY_FACT(device=robot, fact=fact, grip=HELD_AS[grip]())
