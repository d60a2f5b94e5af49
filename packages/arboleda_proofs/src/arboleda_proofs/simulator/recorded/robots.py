"""Record of what each robot has told the plant and of operators' stops; no belief of the plant is read.

`believed_as_said` finds by it a robot of which it is not believed that it is homed again.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from copy import copy
from enum import Enum

from arboleda.drivers import Evidence, MotionState, Report, Robot, Value
from arboleda.engine import Belief
from arboleda.model.messages import BUILT_IN
from arboleda.model.plant_model import Link

NUMBERS = 512  # telemetry messages, more than a plant that was stalled finds in its inbox
LOOK_S = 0.5  # a report that says the same counts as news this often


class Obstacle(str, Enum):
    """The reason why a robot must not be given a command."""

    OFFLINE = "offline"
    UNANSWERED = "reached by a bridge that does not hear this plant"
    UNHOMED = "unhomed"
    FAULTED = "faulted"
    LATCHED = "latched"
    STOPPED = "of a cell that was stopped and not reset"


class StopProgress(Enum):
    """Progress of an operator's stop: not cleared yet, or cleared and not reset."""

    LATCHED = "latched"
    CLEARED = "cleared"


STOPS = {"on": StopProgress.LATCHED, "cleared": StopProgress.CLEARED}  # by the word that is kept


class KnownRobot:
    """Last word of a robot on everything, None where it never said; `stop` outlives the plant, `words` are
    those of its last report that counted as news.
    """

    def __init__(self, robot: Robot, stale_after_s: float) -> None:
        self.robot = robot
        self.stop: StopProgress | None = None
        self.missed_clear = False  # an operator cleared its stop while it was offline
        self.halts = 0  # halts and stops that the plant sent it
        self._patience_s = stale_after_s if robot.evidence is not Evidence.STATE else math.inf
        self.forget()

    def forget(self) -> None:
        """Forget all, as a plant that starts has heard nothing."""
        self.words: tuple[object, ...] = ()
        self._look_at = 0.0
        self.heard_at: float | None = None
        self.stale_at = math.inf  # when its silence will have lasted too long, s
        self.state: MotionState | None = None
        self.homed: bool | None = None
        self.boot: int | None = None
        self.numbers: deque[int | None] = deque([None], maxlen=NUMBERS)  # of its telemetry; None: none yet
        self.epoch: int | None = None
        self.plant: int | None = None
        self.q: tuple[float, ...] | None = None
        self.node: int | None = None
        self.effector: bool | None = None
        self.piece: bool | None = None
        self.facts: dict[str, Value] = {}
        self.displaced = False  # it cannot report its homing, and has booted
        self.barred = False  # a command was refused because of a stop that it does not tell
        self.unnamed: str | None = None  # the last command that it was sent, until a report names it

    def take_over(self, belief: Belief) -> None:
        """Take over what it said before this record began, as the plant believes it."""
        self.heard_at = belief.heard_at
        self.stale_at = math.inf if belief.heard_at is None else belief.heard_at + self._patience_s
        self.state, self.homed = belief.state, belief.homed
        self.boot, self.epoch, self.plant = belief.boot_id, belief.epoch, belief.plant
        self.q, self.node = belief.q, belief.node
        self.numbers.append(belief.number)
        self.effector, self.piece, self.facts = belief.effector, belief.piece, dict(belief.facts)

    def as_it_is(self) -> KnownRobot:
        """A copy that later reports do not change."""
        known = copy(self)
        known.facts = dict(self.facts)
        return known

    def hear(self, report: Report) -> bool:
        """Take over a report; True if it says something else than the one before, or the same for LOOK_S."""
        anew = report.words != self.words or report.at >= self._look_at
        if anew:
            self.words, self._look_at = report.words, report.at + LOOK_S
            self._take_over(report)
        if report.number is not None:
            self.numbers.append(report.number)
        if report.state is not MotionState.NO_LINK:
            self.heard_at, self.stale_at = report.at, report.at + self._patience_s
        return anew

    def _take_over(self, report: Report) -> None:
        if self.unnamed is not None and self.unnamed in (report.accepted, report.done, report.rejected):
            self.unnamed = None
        if report.boot_id is not None and report.boot_id != self.boot:
            self._hear_boot(report)
        if report.epoch is not None:
            self.barred &= report.epoch == self.epoch
            self.epoch, self.plant = report.epoch, report.plant
        if report.homed is not None:
            self.homed = report.homed
        if report.q is not None:
            self.q = report.q
        if report.node is not None:
            self.node = report.node
        if report.effector is not None:
            self.effector = report.effector
        if report.piece is not None:
            self.piece = report.piece
        if report.facts:
            self.facts.update(report.facts)
        if report.state is not None:
            self.state = report.state

    def fact(self, name: str) -> Value | None:
        """The last word of the robot on a fact, some of which have a field of their own."""
        value: Value | None = getattr(self, name) if name in BUILT_IN else self.facts.get(name)
        return value

    def _hear_boot(self, report: Report) -> None:
        changed = self.boot is not None
        counted_anew = self.robot.evidence is Evidence.JOINTS and self.epoch != report.epoch
        if changed and not self.robot.says_homed and not counted_anew:
            self.displaced = True
        self.boot = report.boot_id

    def offline(self, now: float) -> bool:
        if self.state is MotionState.NO_LINK:
            return True
        return self.stale_at <= now or (self.heard_at is None and self._patience_s < math.inf)

    @property
    def unhomed(self) -> bool:
        """True if the position of the robot means nothing."""
        return self.homed is False or self.displaced or self.state is MotionState.NOT_HOMED

    def is_unfit(self, now: float, plant_epoch: int) -> bool:
        """True if anything speaks against a command to the robot."""
        return any(is_so(self, now, plant_epoch) for is_so in OBSTACLES.values())

    def obstacles(self, now: float, plant_epoch: int) -> frozenset[Obstacle]:
        """Everything that speaks against a command to the robot."""
        return frozenset(word for word, is_so in OBSTACLES.items() if is_so(self, now, plant_epoch))


OBSTACLES: dict[Obstacle, Callable[[KnownRobot, float, int], bool]] = {
    Obstacle.OFFLINE: lambda known, now, epoch: known.offline(now),
    Obstacle.UNANSWERED: lambda known, now, epoch: (
        known.robot.link is Link.MQTT and known.epoch is not None and known.plant != epoch
    ),
    Obstacle.UNHOMED: lambda known, now, epoch: known.unhomed,
    Obstacle.FAULTED: lambda known, now, epoch: known.state is MotionState.FAULT,
    Obstacle.LATCHED: lambda known, now, epoch: (
        known.stop is StopProgress.LATCHED or known.state is MotionState.STOP_LATCHED or known.barred
    ),
}
