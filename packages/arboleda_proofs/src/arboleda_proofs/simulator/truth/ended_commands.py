"""Changes in the plant's books of its commands: which ended in this step, and how; answers to queries."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.drivers import Command, Value
from arboleda.engine import Entry, State
from arboleda.engine.inspection import ledger_of
from arboleda.model.plant_model import APART_S
from arboleda.rig.world import BRIDGE, World

CALM_S = 20.0  # after the last fault, whatever it left under way has arrived or is given up


@dataclass(frozen=True, kw_only=True)
class EndedCommand:
    """A command that the plant takes for ended; `sent_at`: when it left.

    `late`: the command, or a report that its robot sent before it came, was under way for some time.
    """

    entry: Entry
    sent_at: float
    late: bool

    @property
    def command(self) -> Command:
        return self.entry.command

    @property
    def done(self) -> bool:
        return self.entry.state is State.DONE


class Books:
    """Follows the open commands of the running plant; `ended` are those of this step."""

    def __init__(self, world: World) -> None:
        self.ended: list[EndedCommand] = []
        self.late: set[str] = set()  # robots whose last command, before this step, was late
        self._in_time: set[str] = set()  # robots that got one in this step that was not
        self._world = world
        self._open: dict[str, EndedCommand] = {}

    def drop(self) -> None:
        """Forget all, as the plant died, and its books with it."""
        self._open = {}

    def look(self) -> None:
        """Note which of the open commands are no longer open since the last step."""
        if self.ended:
            self.ended = []
        if self._in_time:
            self.late, self._in_time = self.late - self._in_time, set()
        entries = ledger_of(self._world.plant).entries
        if not self._open.keys() <= entries.keys():
            self.ended = [self._open.pop(id) for id in [*self._open] if id not in entries]

    def sent(self, command: Command) -> None:
        """Take in a command that the plant has sent; one that has no entry in its ledger is passed over."""
        entry = ledger_of(self._world.plant).entries.get(command.id)
        if entry is not None:
            late = self.is_late(command.robot)
            if late:
                self.late.add(command.robot)
            else:
                self._in_time.add(command.robot)
            self._open[command.id] = EndedCommand(entry=entry, sent_at=self._world.now, late=late)

    def is_late(self, robot: str) -> bool:
        """True if messages between the plant and this robot's board, either way, are slow now."""
        world, name = self._world, self._world.model.robots[robot].mqtt
        clients = [world.broker.clients[each] for each in (BRIDGE, name) if each in world.broker.clients]
        lines = [
            world.to_bridge,
            world.to_plant,
            *(line for each in clients for line in (each.up, each.down)),
        ]
        # what came out of order a moment ago may still be on its way where state and position come apart
        since = world.now - (APART_S if robot in world.partings else 0.0)
        late = any(line.busy_until > since or line.troubles for line in lines)
        late = late or world.plant_process.waits_for_disk
        return late or world.is_stalled(BRIDGE) or world.is_stalled(name)

    def calm_since(self, at: float) -> bool:
        """True if nothing that a fault did can have touched what happened since then."""
        return not self._world.faults_active and self._world.last_fault_at < at - CALM_S


class LastAnswers:
    """The last answer of each device to each query of each cell.

    It is the answer that counted: `an_answer_is_to_its_question` judges that the device gave it.
    """

    def __init__(self) -> None:
        self._last: dict[tuple[str, str], tuple[float, Value]] = {}  # when it was asked, s, and the answer

    def take(self, booked: EndedCommand) -> None:
        """Take in a query that has ended."""
        entry, command = booked.entry, booked.command
        if booked.done and entry.answer is not None:
            self._last[entry.cell, f"{command.robot}.{command.word}"] = booked.sent_at, entry.answer

    def since(self, began: float, cell: str) -> dict[str, Value]:
        """The last answers, as of `camera.look`, to what a cell asked since `began`, in s."""
        return {
            what: answer
            for (asker, what), (asked_at, answer) in self._last.items()
            if asker == cell and asked_at >= began
        }
