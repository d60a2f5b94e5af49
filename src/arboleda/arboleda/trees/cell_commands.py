"""Commands of one cell: sent where nothing objects, halted, and looked up while they are open."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.ledger import Entry
from arboleda.dispatch.obstacles import Barrier, Make
from arboleda.model.commands import Command, Query
from arboleda.model.messages import Failure
from arboleda.model.sentence import Sentence
from arboleda.model.step_token import ATTEMPTS, MOST_STEPS

from .cell_time import CellTime


class CellCommands:
    """Sender of one cell's commands. `sent` counts them; `used` are the robots that the task has commanded.

    `task` is the hash of the task's id, by which boards echo its steps; None while no task runs. The first of
    the `guards` that objects keeps a command from leaving.
    """

    def __init__(
        self,
        cell: str,
        dispatcher: Dispatcher,
        time: CellTime,
        guards: Sequence[Barrier],
    ) -> None:
        self.sent = 0
        self.used: set[str] = set()
        self.task: str | None = None
        self._cell = cell
        self._dispatcher = dispatcher
        self._time = time
        self._guards = guards

    def send(self, make: Make, doing: Sentence, *, step: int | None = None, attempt: int = 0) -> Entry:
        """Send the command that `make(id=...)` returns; its entry has failed where it may not leave.

        `step` is the number of its node in the tree, `attempt` how often the node has given it.
        """
        self.sent += 1
        now, token = self._time.plant_now, None
        if self.task is not None and step is not None and step < MOST_STEPS:
            token = f"{self.task}{step:04x}{attempt % ATTEMPTS:02x}"
        entry = self._dispatcher.send(make, self._cell, doing, now, barrier=self._objection, token=token)
        if not isinstance(entry.command, Query):
            self.used.add(entry.command.robot)
        return entry

    def objection(self, make: Make) -> Failure | None:
        """The reason why a command would not leave now."""
        return self._dispatcher.obstacles.objection(make, barrier=self._objection)

    def cancel(self, entry: Entry) -> None:
        """Halt an open command."""
        self._dispatcher.cancel(entry, self._time.plant_now)

    def cancel_all(self) -> None:
        """Ask every command of the cell to end, and halt what moves."""
        self._dispatcher.cancel_all(self._cell, self._time.plant_now)

    def cancel_motions(self) -> None:
        """Halt the commands that can be halted; an effector finishes switching, and a machine its work."""
        for entry in self.open():
            if entry.halts and entry.cancelled_at is None:
                self.cancel(entry)

    def open(self) -> list[Entry]:
        """The cell's commands that have not ended."""
        return self._dispatcher.ledger.of_cell(self._cell)

    def first_of(self, robot: str) -> Entry | None:
        """The first open command of a robot, of any cell."""
        return next(iter(self._dispatcher.ledger.of_robot(robot)), None)

    def may_come_to_rest(self, robot: str) -> bool:
        """True where a robot may take a command soon: its last move may be over, or was cancelled."""
        return self._dispatcher.obstacles.may_come_to_rest(robot)

    def finishes(self, robot: str) -> bool:
        """True while a robot does work that goes on to its end."""
        return self._dispatcher.ledger.finishes(robot)

    def _objection(self, command: Command) -> Failure | None:
        for guard in self._guards:
            if (failure := guard(command)) is not None:
                return failure
        return None
