"""Probes: counts the branches that a run went through, by name; a campaign checks that all of them fire."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import RECOVERY, Act
from arboleda.model.commands import Stop, StopMode
from arboleda.model.messages import Heartbeat, OperatorAnswer, Report, TaskChanged, TaskState, Verb
from arboleda.rig.world import BRIDGE, World
from arboleda.sim.board import SILENCE_US, Board

WORD = re.compile(rb'"rechazo":"(\w+)"')
LATCH = b'{"paro":1'
ENDS = (TaskState.FAILED, TaskState.CANCELLED)


class Probes:
    """Counts what it sees in a world after each step; `fired` is read when the run is over."""

    def __init__(self, world: World) -> None:
        self.fired: Counter[str] = Counter()
        self._world = world
        self._quarantined: frozenset[str] = frozenset()
        self._bridge, self._epochs = world.bridge, dict[str, int]()
        world.watchers.append(self._look)

    def _look(self) -> None:
        for looks in LOOKS:
            self.fired.update(looks(self))

    def _tasks(self) -> Iterator[str]:
        for said in self._world.moment.sent:
            if isinstance(said, TaskChanged) and said.state in ENDS and said.reason:
                yield f"task: {said.reason.value}"
            elif isinstance(said, OperatorAnswer):
                yield f"verb: {said.verb.value} {'refused' if said.refusal else 'done'}"

    def _trees(self) -> Iterator[str]:
        if all(isinstance(each, Heartbeat) for each in self._world.moment.sent):
            return
        for cell in self._world.plant.cells.values():
            for node in cell.tree.iterate() if cell.tree else ():
                if node.status is not Status.INVALID:
                    yield from _step(node)

    def _zones(self) -> Iterator[str]:
        zones = self._world.plant.zones
        now = frozenset(zone for zone in self._world.model.zones if zones.is_quarantined(zone))
        if now != self._quarantined:
            yield from ["zone: quarantined"] * len(now - self._quarantined)
            answers = [each for each in self._world.moment.sent if isinstance(each, OperatorAnswer)]
            by_hand = {each.scope for each in answers if each.verb is Verb.OVERRIDE and not each.refusal}
            for zone in sorted(self._quarantined - now):
                yield "zone: overridden" if zone in by_hand else "zone: restored"
            self._quarantined = now

    def _refusals(self) -> Iterator[str]:
        for _, publication in self._world.moment.published:
            if found := WORD.search(publication.payload):
                yield f"board: {found[1].decode()}"
        for report in self._world.moment.reports:
            if report.refusal is not None:
                yield f"bridge: {report.refusal}"

    def _latches(self) -> Iterator[str]:
        """Count latches that the plant sends again, in steps in which nobody stops anything."""
        moment = self._world.moment
        stops = any(isinstance(each, OperatorAnswer) and each.verb is Verb.STOP for each in moment.sent)
        for each in moment.sent if not stops else ():
            if isinstance(each, Stop) and each.mode is StopMode.LATCH:
                yield "latch: told again by the plant"
        if not any(isinstance(each, Stop) for each in moment.sent):
            for client, publication in moment.published:
                if client == BRIDGE and publication.payload.startswith(LATCH):
                    yield "latch: told again by the bridge"

    def _bridges(self) -> Iterator[str]:
        if self._bridge is not self._world.bridge:
            self._bridge, self._epochs = self._world.bridge, {}
        for report in self._world.moment.reports:
            yield from self._raised(report)

    def _raised(self, report: Report) -> Iterator[str]:
        if report.epoch is not None:
            before = self._epochs.setdefault(report.robot, report.epoch)
            if report.epoch > before:
                yield "bridge: raised its epoch"

    def _boards(self) -> Iterator[str]:
        return ("board: halts in silence" for board in self._world.boards.values() if _gave_up(board))


LOOKS: tuple[Callable[[Probes], Iterable[str]], ...] = (
    Probes._tasks,
    Probes._trees,
    Probes._zones,
    Probes._refusals,
    Probes._latches,
    Probes._bridges,
    Probes._boards,
)


def _step(node: Behaviour) -> Iterator[str]:
    """A step that has begun: `recovering` if it is part of a recovery, `again` if it is tried again."""
    if isinstance(node, Act) and node.tries:
        yield "step: tried again"
    if node.name.startswith("try ") and node.name != "try 1":
        yield "step: gripped again"
    if node.parent is not None and node.parent.name in (RECOVERY, "carry back", "part back"):
        yield f"recovery: {node.name}"


def _gave_up(board: Board) -> bool:
    """True if a board stops as it has heard nobody; read from its private state, for want of an interface."""
    return board.body.moving and board._job is None and board._alive_us + SILENCE_US <= board._now_us


class Rows(dict[tuple[str, str], str]):
    """A state table that counts the rows that are looked up in it."""

    def __init__(self, table: dict[tuple[str, str], str]) -> None:
        super().__init__(table)
        self.fired: Counter[tuple[str, str]] = Counter()

    def get(self, row: tuple[str, str], default: Any = None, /) -> Any:
        self.fired[row] += 1
        return super().get(row, default)
