"""People who teach a cell by hand, at any time, and are lost while they hold a button; never drawn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from arboleda.drivers import Position, Robot
from arboleda.engine import Teaching
from arboleda.engine.inspection import teaching_of
from arboleda.model.messages import Jog, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import World

from ..chance import Dice
from .kind import Fault, kind, words

BEAT_S = 0.05  # how often a page says that a button is held
PRESS_S = (0.1, 2.0)
PAUSE_S = (0.1, 1.0)
MOST_S = 30.0  # of one who teaches
ENDS, LOST, LATE = "ends", "lost", "what was said comes late"
LATE_S = 1.0
ASKS_AGAIN_S = 0.5
MOST_TIMES = 60


@dataclass(kw_only=True)
class Teacher:
    """Teacher of one cell, who presses buttons of its robots until the time is over."""

    world: World
    cell: str
    name: str
    how: str
    seconds: float
    dice: Dice
    until: float = 0.0
    session: int = 0
    number: int = 0
    robot: str = ""
    goal: Position | None = None
    word: str = ""
    held_until: float = 0.0
    _begun: int = -1

    def begin(self) -> None:
        """Have the cell halted and its task cancelled, and begin as soon as the plant allows it."""
        self.world.request_verb(Verb.HOLD, self.cell)
        self.world.at(self.world.now + ASKS_AGAIN_S, self._ask, 1)

    def _ask(self, times: int) -> None:
        if self._teaching is not None:
            self._go_on(None)
        elif times < MOST_TIMES:
            verb, arguments = (Verb.CANCEL, ()) if times == 1 else (Verb.TEACH, (("teacher", self.name),))
            self.world.request_verb(verb, self.cell, arguments=arguments)
            self.world.at(self.world.now + ASKS_AGAIN_S, self._ask, times + 1)

    @property
    def _teaching(self) -> Teaching | None:
        """Its own manual mode; None where that has ended, or was refused."""
        found = teaching_of(self.world.plant.cells[self.cell])
        return found if found is not None and found.teacher == self.name else None

    def _go_on(self, _: object) -> None:
        teaching, now = self._teaching, self.world.now
        if teaching is None:
            return
        self.session = teaching.session
        self.until = self.until if self.session == self._begun else now + self.seconds
        self._begun = self.session
        if now >= self.until:
            self._leave()
            return
        self._press()
        self.world.at(self.held_until + self.dice.between(*PAUSE_S), self._go_on, None)

    def _leave(self) -> None:
        """Say so, twice as with a double click; or be gone: then it ends by itself."""
        for late_s in () if self.how == LOST else (0.0, BEAT_S):
            self.world.at(self.world.now + late_s, self._end, None)

    def _end(self, _: object) -> None:
        self.world.request_verb(Verb.AUTOMATIC, self.cell)

    def _press(self) -> None:
        self.number += 1
        robot = self.dice.pick(
            [each for each in self.world.model.cell(self.cell).reached if not each.is_person]
        )
        self.robot = robot.name
        self.word, self.goal = _what(robot, self.dice)
        self.held_until = self.world.now + self.dice.between(*PRESS_S)
        self._hold(self.number)

    def _hold(self, number: int) -> None:
        if self._teaching is None or number != self.number:
            return
        if self.world.now < self.held_until:
            self._say(held=True)
            self.world.at(self.world.now + BEAT_S, self._hold, number)
        elif self.how == LATE:
            self.world.at(self.world.now + LATE_S, self._say_late, number)
        elif self.how == ENDS:
            self._say(held=False)

    def _say_late(self, number: int) -> None:
        """A message of a press that is over, as a network may bring it."""
        if number == self.number and self._teaching is not None:
            self._say(held=True)

    def _say(self, *, held: bool) -> None:
        jog = Jog(
            at=self.world.now,
            cell=self.cell,
            session=self.session,
            number=self.number,
            robot=self.robot,
            goal=self.goal,
            word=self.word,
            held=held,
        )
        self.world.tell(jog)


def _what(robot: Robot, dice: Dice) -> tuple[str, Position | None]:
    """A goal anywhere, be it beyond a limit; or one of the verbs that every robot knows.

    Nobody grips: what is true of parts is followed by tasks alone.
    """
    if robot.floor_grid is not None:
        return "", dice.below(robot.floor_grid.size + 1)
    verbs = ["home"] if robot.homes else []
    verbs += ["let_go"] if robot.held_fact is not None else []
    if not robot.joints or (verbs and dice.chance(0.2)):
        return dice.pick(verbs or ["home"]), None
    return "", tuple(dice.between(1.05 * each.lower, 1.05 * each.upper) for each in robot.joints)


def _cells(model: PlantModel) -> Sequence[str]:
    return tuple(cell.name for cell in model.cells if any(not each.is_person for each in cell.reached))


@kind(targets=_cells, words=words(ENDS, LOST, LATE), amount=(1.0, MOST_S), weight=0.0)
def teach(world: World, fault: Fault) -> None:
    """Somebody teaches a cell by hand for `amount` s: presses buttons, lets go, is lost, or is heard late."""
    teacher = Teacher(
        world=world,
        cell=fault.target,
        name=f"teacher {fault.seed}",
        how=fault.word,
        seconds=fault.amount,
        dice=Dice(fault.seed, "teach"),
    )
    teacher.begin()


KINDS = (teach,)
