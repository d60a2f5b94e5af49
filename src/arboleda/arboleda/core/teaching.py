"""Teaching of one cell: the button that a teacher holds becomes short moves, which end with it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from arboleda.dispatch.ledger import Entry
from arboleda.model.commands import GRIP, LET_GO, Command, Home, Motion, OnStop, Position, Work
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Jog
from arboleda.model.outside import plain, quoted
from arboleda.model.plant_model import Robot
from arboleda.model.sentence import OWN, Phrase, Sentence, as_sentence
from arboleda.trees.context import Context

HOLD_S = 0.2
"""A button counts as held for so long after the plant was last told so."""
FRESH_S = 0.12
"""Short goals follow each other for so long after the plant was last told; then it waits to be told again."""
HOME = "home"
DOING = Phrase("doing.teach", "being taught by {teacher}")
TAUGHT = Phrase("cell.taught", "{cell} is being taught by {teacher}; automatic {cell} ends that")
NOT_TAUGHT = Phrase("refusal.not_taught", "nobody teaches {cell}; teach {cell} begins that")
OTHER_TEACHES = Phrase("refusal.other_teaches", "{cell} is being taught by {teacher}, and only by one person")
NOT_OF_CELL = Phrase("refusal.not_of_cell", "{robot} is no device of {cell}; there are {known}")
NO_PLACE_KNOWN = Phrase(
    "refusal.no_place_known", "{robot} reports no position that can be believed, so it is not moved by hand"
)
BEYOND = Phrase("refusal.beyond", "{robot} cannot go there: {limits}")
ZONE_OF_OTHER = Phrase("refusal.zone_of_other", "{robot} may get into zone {zone}, which {holder} holds")
NO_ROUTINE = Phrase("refusal.no_routine", "{robot} runs no homing routine on the word of the plant")
LET_GO_OF = Phrase("teach.let_go_of", "{robot} was halted: the button is not held any more")


@dataclass(kw_only=True)
class Press:
    """Button that is held, until `until` s of the plant's time; `entry` is its last command."""

    jog: Jog
    until: float
    entry: Entry | None = None

    def hold(self, jog: Jog) -> None:
        """Hold it on. The goal of a button may change, and nothing else."""
        if (jog.robot, jog.word, jog.values) == (self.jog.robot, self.jog.word, self.jog.values):
            self.jog, self.until = jog, max(self.until, jog.at + HOLD_S)


class Teaching:
    """Manual mode of one cell: no task runs, and nothing moves but by the button that is held.

    `session` is its number. `trouble` is why the last press moved nothing, or ended too early.
    """

    def __init__(self, context: Context, *, session: int, teacher: str) -> None:
        self.session = session
        self.teacher = teacher
        self.trouble: Sentence | None = None
        self.since = self._touched_at = context.time.plant_now
        self._context = context
        self._press: Press | None = None
        self._halting: Entry | None = None  # the last command of the press before
        self._over = 0  # presses up to this number are over, even if a late message says more of them

    @property
    def due(self) -> float:
        """The time at which `look` is due without an event, s of the plant's time."""
        ends_at = self._touched_at + self._context.cell.teach.ends_after_s
        return ends_at if self._press is None else min(ends_at, self._press.until)

    @property
    def sentence(self) -> Sentence:
        """The person who teaches the cell, and how that ends."""
        return TAUGHT(cell=self._context.cell.name, teacher=self.teacher)

    @property
    def is_forgotten(self) -> bool:
        """True once nobody has touched a button for so long that the teaching ends."""
        return self._context.time.plant_now >= self._touched_at + self._context.cell.teach.ends_after_s

    @property
    def held(self) -> Jog | None:
        """The button that is held now."""
        return None if self._press is None else self._press.jog

    def refusal(self, jog: Jog) -> Sentence | None:
        """The reason why a new press would move nothing; None where it can begin, or was taken before."""
        is_new = jog.number > self._over and (self._press is None or jog.number != self._press.jog.number)
        why = self.objection(jog) if is_new else None
        return None if why is None or self._context.commands.may_come_to_rest(jog.robot) else why

    def objection(self, jog: Jog) -> Sentence | None:
        """The reason why a press would move nothing now; None where it can begin."""
        cell = self._context.cell
        robot = next((each for each in cell.reached if each.name == jog.robot and not each.is_person), None)
        if robot is None:
            names = tuple(each.name for each in cell.reached if not each.is_person)
            return NOT_OF_CELL(robot=quoted(jog.robot), cell=cell.name, known=names)
        try:
            return self._objection(robot, jog)
        except ArboledaError as error:
            return as_sentence(error)

    def take(self, jog: Jog) -> bool:
        """Take a message about a button; True where it changes anything."""
        self._touched_at = jog.at
        held = self._press
        if held is not None and jog.at > held.until:
            self._end_press(LET_GO_OF(robot=held.jog.robot))
            held = None
        if jog.number <= self._over:
            return False
        if held is not None and jog.number == held.jog.number and jog.held:
            held.hold(jog)
            return False
        if held is not None:
            self._end_press(None)
        if jog.held and jog.number > self._over:
            self._press, self.trouble = Press(jog=jog, until=jog.at + HOLD_S), None
        self._over = max(self._over, jog.number - 1 if jog.held else jog.number)
        return True

    def look(self) -> bool:
        """Go on with the button that is held, or halt after one that is not; True where anything was done."""
        press = self._press
        if press is None:
            return False
        if self._context.time.plant_now >= press.until:
            self._end_press(LET_GO_OF(robot=press.jog.robot))
            return True
        if self._is_under_way or self._context.time.plant_now > press.jog.at + FRESH_S:
            return False
        return self._go_on(press)

    def end(self) -> None:
        """Halt what moves, and take no press any more."""
        if self._press is not None:
            self._end_press(None)
        self._over = 2**63

    @property
    def _is_under_way(self) -> bool:
        """True while a command of this press, or of the press before, has not ended."""
        entries = (self._halting, None if self._press is None else self._press.entry)
        return any(each is not None and each.open for each in entries)

    def _objection(self, robot: Robot, jog: Jog) -> Sentence | None:
        if (limits := self._out_of_reach(robot, jog)) is not None:
            return limits
        make = self._make(robot, jog)
        taken = None if jog.goal is None and jog.word != HOME else self._zone_of_other(robot.name)
        if taken is not None:
            return taken
        if self._is_under_way:  # it is halted first, and then looked at again
            return None
        if robot.name in self._context.cell.shared and self._context.devices.holder(robot.name) is None:
            obstacle = self._context.robots.obstacle(robot.name)
        else:
            obstacle = self._context.commands.objection(make)
        return None if obstacle is None else obstacle.sentence

    def _out_of_reach(self, robot: Robot, jog: Jog) -> Sentence | None:
        if jog.word == HOME and not self._context.robots.homes_by_routine(robot.name):
            return NO_ROUTINE(robot=robot.name)
        if jog.word:
            return None
        if jog.goal is None or not robot.goes or self._context.robots.position(robot.name) is None:
            obstacle = self._context.robots.obstacle(robot.name)
            return NO_PLACE_KNOWN(robot=robot.name) if obstacle is None else obstacle.sentence
        limits = robot.motion.beyond(jog.goal)
        return None if limits is None else BEYOND(robot=robot.name, limits=OWN(text=plain(limits)))

    def _zone_of_other(self, robot: str) -> Sentence | None:
        taken = self._context.zones.taken_by_others(robot).items()
        return next((ZONE_OF_OTHER(robot=robot, zone=zone, holder=holder) for zone, holder in taken), None)

    def _make(self, robot: Robot, jog: Jog) -> Callable[..., Command]:
        if jog.word == HOME:
            return partial(Home, robot=robot.name)
        if jog.word in (GRIP, LET_GO):
            return robot.grip if jog.word == GRIP else robot.let_go
        if jog.word:
            return partial(robot.verb_command, jog.word, jog.values)
        here, teach = self._context.robots.position(robot.name), self._context.cell.teach
        assert here is not None and jog.goal is not None
        stride = robot.motion.stride(here, jog.goal, turn=teach.turn, slide=teach.slide)
        return partial(robot.go, way=stride)

    def _go_on(self, press: Press) -> bool:
        """Give the next command of a press, or end the press."""
        ended, press.entry, self._halting = press.entry, None, None
        jog = press.jog
        if ended is not None and ended.failure is not None and not ended.too_early:
            return self._end_press(ended.failure.sentence)
        if (ended is not None and jog.word and ended.failure is None) or self._has_arrived(jog):
            return self._end_press(None)
        if (why := self.objection(jog)) is not None:
            if self._context.commands.may_come_to_rest(jog.robot):
                return False  # its next report tells
            return self._end_press(why)
        robot = next(each for each in self._context.cell.reached if each.name == jog.robot)
        self._take_hold_of(robot)
        press.entry = self._context.commands.send(self._make(robot, jog), DOING(teacher=self.teacher))
        if not _is_halted(press.entry.command):
            press.until = math.inf  # the command ends by itself, whether the button is held or not
        return True

    def _take_hold_of(self, robot: Robot) -> None:
        """Have the cell hold a shared device, and a robot all zones that it may get into."""
        if robot.name in self._context.cell.shared and not self._context.devices.holds(robot.name):
            self._context.devices.claim(robot.name)
        self._context.zones.make_room(robot.name)

    def _has_arrived(self, jog: Jog) -> bool:
        here = self._context.robots.position(jog.robot)
        robot = self._context.robots.belief(jog.robot).robot
        return jog.goal is not None and here is not None and _is_there(robot, here, jog.goal)

    def _end_press(self, trouble: Sentence | None) -> bool:
        press = self._press
        assert press is not None
        self._press, self.trouble = None, trouble
        self._over = max(self._over, press.jog.number)
        if press.entry is not None and press.entry.open:
            self._halting = press.entry
            self._context.commands.cancel(press.entry)
        return True


def _is_there(robot: Robot, here: Position, goal: Position) -> bool:
    return robot.motion.beyond(goal) is None and robot.motion.stands_at(here, goal)


def _is_halted(command: Command) -> bool:
    """True where a command is halted once nobody holds its button."""
    return isinstance(command, Motion) or (isinstance(command, Work) and command.on_stop is OnStop.HALT)
