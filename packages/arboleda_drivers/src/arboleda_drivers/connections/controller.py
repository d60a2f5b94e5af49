"""Controller of a robot of joints: what a maker's driver has to do so that its machine can move the robot."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, Protocol

from arboleda.drivers import Home, Jointed, MoveJoints, Report, SetEffector

from .receipts import Receipts


class Effector(Protocol):
    """Output, or gripper, that is the effector of an arm."""

    def switch(self, now: float, command: SetEffector) -> None:
        """Begin to switch; raises NotSent where there is nothing to switch."""


class Controller(ABC):
    """Controller of one robot over one link after the other; `kind` names it in sentences.

    Methods put messages into `out`, ends of commands into `receipts`, and raise LinkBroken where the link is
    of no use any more. A new link begins with `forget`.
    """

    effector: Effector | None = None

    def __init__(self, robot: Jointed, *, peer: str, kind: str) -> None:
        self.robot, self.peer, self.kind = robot, peer, kind
        self.out: list[Any] = []
        self.receipts = Receipts()
        self.is_latched = False  # a latching stop holds
        self.has_leftover = False  # work of an earlier link, for which nobody waits any more, may go on

    @property
    @abstractmethod
    def next_deadline(self) -> float:
        """The time (s) at which `pass_time` is due even without events."""

    @property
    @abstractmethod
    def is_known(self) -> bool:
        """True once it has shown the robot, so that there is something to report."""

    @property
    def takes_commands(self) -> bool:
        return True

    @property
    @abstractmethod
    def is_busy(self) -> bool:
        """True while it takes no further work."""

    @property
    def may_move_on(self) -> bool:
        """True where the robot may go on moving if the link breaks now."""
        return self.is_busy

    @abstractmethod
    def forget(self, now: float) -> None:
        """Forget all that was heard and said over a link."""

    def greet(self, now: float) -> None:  # noqa: B027 - a controller that answers questions needs none
        """Say what is said first over a new link."""

    @abstractmethod
    def hear(self, now: float, event: Any) -> None:
        """Take bytes of the controller."""

    @abstractmethod
    def pass_time(self, now: float) -> None:
        """Say what is due while the link is open."""

    @abstractmethod
    def move(self, now: float, command: MoveJoints) -> None:
        """Begin a move, or reject it."""

    @abstractmethod
    def home(self, now: float, command: Home) -> None:
        """Begin to make the robot ready, or reject it."""

    @abstractmethod
    def stop(self, now: float, id: str) -> None:
        """Give the work up and stop the robot; `id` is the command's that asked for it, "" for none."""

    def clear(self, now: float, id: str) -> None:
        """Clear a latched stop."""
        self.receipts.tell(accepted=id)

    @abstractmethod
    def report(self, now: float) -> Report:
        """The robot as it was shown last, without the ends of commands."""
