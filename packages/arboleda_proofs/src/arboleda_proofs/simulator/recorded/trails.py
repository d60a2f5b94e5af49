"""Record of what was kept of tasks at work, and of what the plant that found it makes of that.

`tasks_go_on_from_what_was_kept` finds by it a device that has booted since, at which nobody looks.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from arboleda.drivers import Evidence
from arboleda.engine import Act, State
from arboleda.engine.inspection import MORE, Trail
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Fact, Remember
from arboleda.recipes import Sentence

from .cells import KnownCell
from .commands import Commands
from .robots import KnownRobot

Kept = Mapping[Fact, Mapping[str, str]]
Transitions = Iterable[tuple[KnownCell, CellState, CellState]]


class Trails:
    """Trails that a plant `found` when it started, by cell, until their tasks go on or end.

    `wrong` are sentences of this step on boots that were not looked at, and on trails that do not say what
    became of a command.
    """

    def __init__(self, robots: Mapping[str, KnownRobot]) -> None:
        self.wrong: list[str] = []
        self._robots = robots
        self.found: dict[str, Trail] = {}
        self._holders: Mapping[str, str] = {}  # of zones and shared devices, when it started
        self._sentences: dict[str, Sentence | None] = {}  # by cell, why its task does not go on

    def restart(self, kept: Kept, running: Mapping[str, str]) -> None:
        """Begin another start of the plant, with what it found of the tasks that were at work, by cell."""
        self._sentences.clear()
        steps, self._holders = kept.get(Fact.STEP, {}), kept.get(Fact.QUARANTINE, {})
        self.found = {cell: Trail.read(steps[task]) for cell, task in running.items() if task in steps}

    def look(self, cells: Mapping[str, KnownCell], transitions: Transitions, *, retried: bool) -> None:
        """Take in what became of the tasks that were found; `retried`: somebody had steps given anew."""
        self.wrong = []
        for name in self.found:
            self.wrong += self._more_commands(cells[name])
        for cell, _, after in transitions:
            trail = self.found.pop(cell.name, None)
            if trail is None or after is not CellState.EXECUTE or retried or cell.run.run.recovering:
                continue
            booted = [robot for robot in self._devices(cell) if self._has_booted(trail, robot)]
            self.wrong += (f"{cell.name} goes on with its task, and {robot} has booted" for robot in booted)

    def keep(self, messages: Iterable[object], cells: Mapping[str, KnownCell], commands: Commands) -> None:
        """Take in what is kept of tasks in this step, in which somebody holds a cell or gets one going: the
        commands of steps that wait for that may be done.
        """
        kept = [each for each in messages if isinstance(each, Remember) and each.fact is Fact.STEP]
        last = {each.name: each for each in kept}
        at_work = {cell.run.task.id: cell for cell in cells.values() if cell.run.task is not None}
        for each in kept:
            if each.value is not None and each.name in at_work:
                cell, trail, is_last = at_work[each.name], Trail.read(each.value), each is last[each.name]
                self.wrong += _contradictions(cell, trail, commands, is_last=is_last)

    def _devices(self, cell: KnownCell) -> list[str]:
        """The devices of a cell, of shared ones those that it held when the plant started."""
        shared = [name for name in cell.cell.shared if self._holders.get(name) == cell.name]
        return [*cell.cell.own, *shared]

    def _more_commands(self, cell: KnownCell) -> Iterator[str]:
        """Sentences on a device that has booted, of which it is said now that it was told more."""
        trouble = cell.run.trouble
        sentence, before = trouble.sentence if trouble else None, self._sentences.get(cell.name)
        self._sentences[cell.name] = sentence
        if sentence is None or before is not None or sentence.phrase is not MORE:
            return
        robot = str(sentence.values["robot"])
        if self._has_booted(self.found[cell.name], robot):
            yield f"{cell.name} is held as {sentence}, and {robot} has booted"

    def _has_booted(self, trail: Trail, robot: str) -> bool:
        """True for a device that numbers its commands, and has told of another boot than it had then."""
        known, now = trail.knowledge.get(robot), self._robots[robot]
        numbers = now.robot.evidence is Evidence.IDS and now.heard_at is not None
        return numbers and known is not None and None not in (known.boot, now.boot) and known.boot != now.boot


def _contradictions(cell: KnownCell, trail: Trail, commands: Commands, *, is_last: bool) -> Iterator[str]:
    """Sentences on steps under way of which a trail does not say whether their last command is done.

    One that was cancelled, or that a hold lets end, and then ended in this very step may be kept as not
    done: whoever holds the cell was heard before the report that proves it. A trail that is kept once more
    in the same step says nothing of what was given or has ended in it, and may be of a tree that has ended
    since.
    """
    moved = [sent for sent, _ in commands.moved]
    nodes = cell.run.run.nodes
    for number, kept in trail.nodes.items():
        step, last = nodes[number] if number < len(nodes) else None, kept.get("last")
        if last is None or not isinstance(step, Act) or step.entry is None:
            continue
        sent = commands.last.get(last["robot"])
        if sent is None or sent.command.id != step.entry.command.id:
            continue  # it gave another one since
        awaited = step.entry.cancelled_at is not None or not step.entry.halts
        if sent in moved and awaited and not last["done"]:
            continue
        if not is_last and (sent in moved or sent in commands.new):
            continue
        if last["done"] is not (sent.state is State.DONE):
            yield f"of {sent} it is kept that it is {'' if last['done'] else 'not '}done"
