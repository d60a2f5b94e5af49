"""Former leader: a process that led a plant, and may not know yet that another one does."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from arboleda.departures.leading import Standing, may_leave
from arboleda.departures.leaving import is_too_late
from arboleda.model.commands import Command
from arboleda.model.messages import Heartbeat, Report, Shutdown
from arboleda.wire.hop import FromPlant
from arboleda.wire.transport import Publication

from ..disk import is_kept
from ..plant_process import ENDS_S
from ..world import World
from .change_of_leaders import SupersededProcess, bury
from .database import SharedDisk, StoreRefused, StoreUnreachable
from .process import Process

WAKES_S = 0.02  # how often it does something, at the least, until it is over


@dataclass(frozen=True, kw_only=True)
class LateMessage:
    """A message of a former plant, or a publication of its bridge, that left after another process led."""

    epoch: int
    standing: Standing
    message: Command | Heartbeat | Publication


class FormerLeader:
    """Former leader: goes on as a frozen, cut off or slow process until it finds out and is `over`."""

    def __init__(self, world: World, disk: SharedDisk, process: Process, left: SupersededProcess) -> None:
        self.process = process
        self.over = False
        self._world, self._disk, self._left = world, disk, left
        self._ends_at: float | None = None
        world.at(left.until, self._go_on)

    def end(self) -> None:
        """End it, as if it was killed; may be called twice."""
        if not self.over:
            self.over = True
            bury(self._world, self._left)

    def _go_on(self, _: object) -> None:
        if self.over:
            return
        world, left = self._world, self._left
        self._step_bridge([])
        events, left.inbox = left.inbox, []
        self._let_out(left.plant.step(world.now, events))
        if self._ends_at is not None and world.now >= self._ends_at:
            self.end()
        if not self.over:
            world.at(world.now + WAKES_S, self._go_on)

    def _let_out(self, messages: Iterable[object]) -> None:
        """Let a message out as the plant's loop does: keep it first, and check the lead before it leaves."""
        for message in messages:
            if self.over:
                return
            if is_kept(message) and self._ends_at is None:
                self._keep(message)
            elif isinstance(message, Command | Heartbeat):
                self._say(message)

    def _keep(self, message: object) -> None:
        try:
            self._disk.take(self.process, message, self._world.now)  # type: ignore[arg-type]
        except StoreRefused:
            self.process.standing = Standing.SUPERSEDED
            self.end()
        except StoreUnreachable:
            self.process.standing = Standing.UNSURE
            self._begin_end()

    def _say(self, message: Command | Heartbeat) -> None:
        world = self._world
        standing = self.process.confirm(self._disk.row, world.now)
        if may_leave(message, standing) and not is_too_late(message, self._left.plant, world.now):
            world.moment.former.append(
                LateMessage(epoch=self.process.epoch, standing=self.process.standing, message=message)
            )
            self._step_bridge([FromPlant(at=world.now, message=message)])
        if standing is Standing.SUPERSEDED:
            self.end()
        elif standing is Standing.UNSURE:
            self._begin_end()

    def _begin_end(self) -> None:
        """Begin to end, as it cannot find out whether it leads: its robots are to stand first."""
        if self._ends_at is None:
            self._ends_at = self._world.now + ENDS_S
            self._left.inbox.append(Shutdown(at=self._world.now))

    def _step_bridge(self, events: list[FromPlant]) -> None:
        world, left = self._world, self._left
        inbox, left.client.inbox = left.client.inbox, []
        for message in left.bridge.step(world.now, [*inbox, *events]):
            if isinstance(message, Report):
                left.inbox.append(message)
            elif isinstance(message, Publication):
                late = LateMessage(epoch=self.process.epoch, standing=self.process.standing, message=message)
                world.moment.former.append(late)
                world.publish(message, left.client)
