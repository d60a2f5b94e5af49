"""Commands to robots: the base classes by which the engine treats them, and the commands of every robot."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import Enum

from .facts import Facts

GO, GRIP, LET_GO = "go", "grip", "let_go"
"""The names of a robot's own commands in a plant file."""
LABELS = ("id", "heard", "token")  # fields for its way, which are no values of the command
FRESH_S = 2.0
"""A board refuses a command (s) after it sent the telemetry that the command names."""
Position = tuple[float, ...] | int
"""Position of a robot, as its kind reports it: the joints of an arm, the node of a mobile robot."""


class StopMode(int, Enum):
    """The `stop_cmd` / `paro` values."""

    CLEAR = 0
    LATCH = 1
    HALT = 2


class OnStop(str, Enum):
    """Behaviour of a machine at work when it is stopped, or when nobody waits for the work any more."""

    HALT = "halt"
    FINISH = "finish"


@dataclass(frozen=True, kw_only=True)
class Command:
    """Command to a robot; the engine knows it by its base class and the properties here alone."""

    id: str
    robot: str
    heard: int | None = None
    """The number of the board's last telemetry that the plant had heard; None for a board without numbers."""
    token: str | None = None
    """The token of its step and task, which its board echoes; None where no task gives it."""

    @property
    def word(self) -> str:
        """The verb by which a plant file names it; empty where none does."""
        return ""

    @property
    def given(self) -> dict[str, object]:
        """Its values by name, as screens show them."""
        return {each.name: getattr(self, each.name) for each in fields(self) if each.name not in LABELS}

    @property
    def sets(self) -> Facts:
        """The facts that it sets; where the robot reports them, they prove it."""
        return ()

    @property
    def needs(self) -> Facts:
        """The facts that must be true when it is given."""
        return ()

    @property
    def works_on_part(self) -> bool:
        """True where it needs a part at its device."""
        return False

    @property
    def makes_part(self) -> bool:
        """True where it makes a part, which lies at its device then."""
        return False

    @property
    def at_most_s(self) -> float | None:
        """The longest time that it may take, s; None where that follows from the robot and its way."""
        return None


class Work(Command):
    """Work of a robot: one at a time, refused while the robot is stopped or not homed."""

    @property
    def on_stop(self) -> OnStop:
        """The end of its work where its step is left, or its cell is held or stopped."""
        return OnStop.HALT


class Motion(Work):
    """Motion of a robot: halted when its step is left, done when the evidence proves it."""

    @property
    def word(self) -> str:
        return GO

    @property
    def way(self) -> tuple[Position, ...]:
        """Its positions: the last is the goal, the first of several where it begins. Empty without a goal."""
        return ()


class Process(Work):
    """Work that a machine does by itself; with `OnStop.FINISH` it goes on when nobody waits for it."""


class Switch(Command):
    """Switching of a fact, which stays as it was set: never halted, done when reported or settled."""

    @property
    def word(self) -> str:
        if self.grips is None:
            return ""
        return GRIP if self.grips else LET_GO

    @property
    def grips(self) -> bool | None:
        """True where it grips, False where it lets go, None where it concerns no part."""
        return None

    @property
    def takes_s(self) -> float:
        """The time that it takes by its declaration, s."""
        return 0.0


class Query(Command):
    """Query for an answer: one at a time, also of a stopped robot; dropped when its step is left."""


class Question(Query):
    """Query that a person answers on the plant's own screens."""

    @property
    def text(self) -> str:
        """The question in words."""
        raise NotImplementedError

    @property
    def answers(self) -> tuple[str, ...]:
        """All that can be answered."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class Stop(Command):
    """Halt the running move, stop and latch, or clear the latch."""

    mode: StopMode


@dataclass(frozen=True, kw_only=True)
class Home(Motion):
    """Run the homing routine."""


def needs_clear(command: Command) -> bool:
    """True for a command that a latched stop forbids: work, and every switch but one that lets go."""
    return isinstance(command, Work) or (isinstance(command, Switch) and command.grips is not False)
