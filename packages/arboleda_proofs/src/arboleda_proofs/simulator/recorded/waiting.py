"""Robots that wait for shared zones, and for how long.

`zone_requests_end` finds by it an arm that waits for its zones twice as long as it may.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

from arboleda.drivers import MoveJoints
from arboleda.engine import Plant
from arboleda.engine.inspection import asking_of
from arboleda.model.cell_states import CellState

from .cells import KnownCell
from .commands import Commands, SentCommand
from .zone_users import ZoneUser


class Waiting:
    """Follows the robots that get into shared zones; `users`: those that wait for some."""

    def __init__(self, cells: Mapping[str, KnownCell]) -> None:
        self.users: list[ZoneUser] = []
        self._cells = cells
        self._requests: tuple[tuple[str, frozenset[str]], ...] = ()

    def look(self, plant: Plant, commands: Commands, seconds: float) -> None:
        """Look at the zones, before the cells are taken over: each still has its previous state. `seconds`
        passed since the step before.
        """
        requests = asking_of(plant)
        if requests != self._requests:
            self._requests, robots = requests, dict(requests)
            users = [user for cell in self._cells.values() for user in cell.zone_users.values()]
            self.users = [user for user in users if user.robot in robots]
        for user in self.users if seconds <= plant.away_after_s else ():
            state, behind_work = self._cells[user.cell].state, self._is_behind_work(user, plant, commands)
            user.wait(seconds, state=state, behind_work=behind_work)
        self._look_at_recoveries(plant, commands.new)

    def _look_at_recoveries(self, plant: Plant, new: Iterable[SentCommand]) -> None:
        moves: dict[str, list[SentCommand]] = {}
        for each in new:
            if each.entry is not None and each.entry.cancelled_at is None:  # not halted at once
                of_cell = moves.setdefault(each.entry.cell, [])
                of_cell += [each] if isinstance(each.command, MoveJoints) else []
        holders = plant.zones.holders.values()
        for cell in self._cells.values():
            for user in cell.zone_users.values():
                if cell.name in moves:
                    user.watch_recovery(moves[cell.name])
                user.holds = user.robot in holders

    def _is_behind_work(self, user: ZoneUser, plant: Plant, commands: Commands) -> bool:
        """True if all that have, or get earlier, the zones that this robot wants are at work."""
        zones, wanted = plant.zones, dict(self._requests)[user.robot]
        holders = [zones.holders[zone] for zone in wanted if zone in zones.holders]
        before = {*holders, *zones.queue.ahead_of(user.robot)}
        told = {sent.robot for sent in commands.open.values()}
        at_work = (self._is_at_work(zones.holder(each) or each, told) for each in before)
        return all(at_work) and not any(map(zones.is_quarantined, wanted))

    def _is_at_work(self, holder: str, told: Collection[str]) -> bool:
        """True where a cell executes, or a cell of a robot does, or that robot is `told` something.

        The plant says so by itself, and may be wrong.
        """
        if holder in self._cells:
            return self._cells[holder].run.state is CellState.EXECUTE
        executing = (each.cell for each in self._cells.values() if each.run.state is CellState.EXECUTE)
        return holder in told or any(each.name == holder for cell in executing for each in cell.robots)
