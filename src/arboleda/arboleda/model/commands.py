"""Commands to robots: the bases that the engine goes by, and the commands that every robot knows."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import Enum

from .facts import Facts

GO, GRIP, LET_GO = "go", "grip", "let_go"
"""The names of a robot's own commands in a plant file."""
LABELS = ("id", "heard", "token")  # what a command carries on its way beside what it was made with
FRESH_S = 2.0
"""Time after which a board obeys a command no more, s: since it sent the telemetry that the command names."""
Position = tuple[float, ...] | int
"""Where a robot is, as its kind reports it: the joints of an arm, the node of a mobile robot."""


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
    """Command to a robot; its base says what the engine must know of it, whatever it is in detail."""

    id: str
    robot: str
    heard: int | None = None
    """The number of the last telemetry of the robot's board that the plant had heard when it gave this; None
    where that has none."""
    token: str | None = None
    """What its board is to echo: which step of which task it is; None where it is of none."""

    @property
    def word(self) -> str:
        """The verb by which a plant file speaks of it; empty where it never does."""
        return ""

    @property
    def given(self) -> dict[str, object]:
        """The values that it was made with, by name, as screens show them."""
        return {each.name: getattr(self, each.name) for each in fields(self) if each.name not in LABELS}

    @property
    def sets(self) -> Facts:
        """The facts that it makes true; where the robot reports facts, they prove it."""
        return ()

    @property
    def needs(self) -> Facts:
        """The facts that must be true when it is given."""
        return ()

    @property
    def works_on_part(self) -> bool:
        """True where there has to be a part at its device for it."""
        return False

    @property
    def at_most_s(self) -> float | None:
        """The longest time that it may take, s; None where the robot and its way say that."""
        return None


class Work(Command):
    """Keeps its robot busy: one at a time, refused while the robot is stopped or not homed."""

    @property
    def on_stop(self) -> OnStop:
        """Its end when its step is left, or its cell is held or stopped."""
        return OnStop.HALT


class Motion(Work):
    """Moves the robot: halted when its step is left, ends when the evidence says so."""

    @property
    def word(self) -> str:
        return GO

    @property
    def way(self) -> tuple[Position, ...]:
        """The positions it comes by, of several the first where it begins, the last its goal.

        Empty where it leads to no named position.
        """
        return ()


class Process(Work):
    """Work that a machine does by itself; one that finishes goes on whoever stops waiting for it."""


class Switch(Command):
    """Sets something that stays as it is set: never halted, ends when it is reported, or has settled."""

    @property
    def word(self) -> str:
        if self.grips is None:
            return ""
        return GRIP if self.grips else LET_GO

    @property
    def grips(self) -> bool | None:
        """True: its robot may hold a part from now on; False: it lets go; None: it has to do with no part."""
        return None

    @property
    def takes_s(self) -> float:
        """The time that it takes by what is declared of it, s."""
        return 0.0


class Query(Command):
    """Asks for an answer, one at a time; forgotten when its step is left, even while its robot is stopped."""


class Question(Query):
    """A query that somebody answers who sees it on the plant's own screens."""

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
    """True where a stop latch forbids it: all work, and every switch but one that lets go of a part."""
    return isinstance(command, Work) or (isinstance(command, Switch) and command.grips is not False)
