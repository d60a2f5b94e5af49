"""Process of a simulated plant: its inbox, its steps, its commits on a disk, its deaths and its ends."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING, Any

from arboleda.departures.leaving import SENT_TOO_LATE, is_too_late, late_departure, leaves_unkept
from arboleda.engine import Plant
from arboleda.model.commands import Command
from arboleda.model.messages import (
    CellRevised,
    Event,
    Heartbeat,
    OperatorAnswer,
    Report,
    Revision,
    RevisionAnswer,
    RevisionName,
    Shutdown,
    TaskChanged,
    Undelivered,
)
from arboleda.model.plant_model import PlantModel
from arboleda.model.revision import revised
from arboleda.model.sentence import as_sentence
from arboleda.wire.hop import HEARTBEAT, FromPlant, command_topic, loses_its_id, plain_topic, without_id

from .disk import Content, DiskFull, is_kept

if TYPE_CHECKING:
    from .world import World

ENDS_S = 6.0  # how long a plant that ends waits for its robots to stand
Gate = Callable[[Command | Heartbeat], None]


class Side(Enum):
    """The side of a commit, or of a message that leaves: just before it, or just after it."""

    BEFORE = "before"
    AFTER = "after"


@dataclass(slots=True, eq=False)
class Fuse:
    """The plant dies on this `side` of its commit or message number `count` from now, by `die`."""

    count: int
    side: Side
    die: Callable[[], None]

    def burns(self, side: Side) -> bool:
        """True if the plant dies now; called before and after each commit and message that counts."""
        self.count -= side is Side.BEFORE
        return self.count <= 0 and side is self.side


class _PlantDeath(Exception):
    """Raised inside of a step in which the plant dies."""


@dataclass(slots=True, eq=False)
class Ending:
    """A plant that could not keep something: it halts its robots, and is gone once they stand."""

    plant: Plant
    why: DiskFull
    starts_again: bool = False


class PlantProcess:
    """Process of a world's plant: starts on what the disk has kept, and keeps there what must not be lost.

    `found` is what was on the disk at its last start, `starts` counts the starts, `has_stepped` is true once
    it has made a step since. Its `fuses` let it die in the middle of a step. `gate` is called before a
    message leaves for the bridge, and raises DiskFull where that may not leave. `when_gone` is called once
    when a plant that ends is gone. `new_plant` makes the plant of each start.
    """

    def __init__(
        self, world: World, name: str, new_plant: Callable[..., Plant], epochs: Iterator[int]
    ) -> None:
        self._world, self._name, self._new_plant, self._epochs = world, name, new_plant, epochs
        self.inbox: list[Event] = []
        self.starts = 1
        self.found = Content()
        self.has_stepped = False
        self.fuses: list[Fuse] = []
        self.gate: Gate | None = None
        self.when_gone: list[Callable[[], None]] = []
        self._ending: Ending | None = None
        self._writes_until = world.now  # the end of its last commit

    def stop(self) -> None:
        """Kill the process; the next one will have what was kept."""
        world = self._world
        world.last_fault_at = world.now
        if self._is_frozen:  # which cannot even die
            return
        self.fuses.clear()
        if not world.is_on(self._name):
            self.be_gone()
            return
        world.processes.off.add(self._name)
        world.processes.due[self._name] = math.inf
        self._begin_anew()
        world.plant = self.make_plant()

    def start(self) -> None:
        """Start on what is left; the plant has heard nothing of what happened meanwhile.

        Where there is no room on the disk it does not start, and one that ends has to be gone before.
        """
        world, processes = self._world, self._world.processes
        if world.is_on(self._name):
            return
        if self._ending is not None:
            self._ending.starts_again = True
        elif self._is_frozen:  # its machine is
            if not world.disk.full:
                world.at(processes.stalled[self._name], lambda _: self.start())
        elif not world.disk.full:
            processes.off.discard(self._name)
            processes.due[self._name] = world.now
            if world.plant.now != world.now:
                world.plant = self.make_plant()

    def lead(self, epoch: int) -> None:
        """Start at once in place of another process, under this number and on what is kept."""
        world = self._world
        self.fuses.clear()
        self._begin_anew()
        world.last_fault_at = world.now
        world.processes.off.discard(self._name)
        world.plant, world.processes.due[self._name] = self.make_plant(epoch), world.now

    def _begin_anew(self) -> None:
        self._writes_until, self.inbox = self._world.now, []
        self.starts += 1
        self.has_stepped = False

    def make_plant(self, epoch: int | None = None) -> Plant:
        """Make a plant of what the disk has kept; without an epoch it gets the next one."""
        world = self._world
        self.found = world.disk.found()
        world.model = world.offers
        return self._new_plant(
            world.model,
            epoch=next(self._epochs) if epoch is None else epoch,
            now=world.now,
            memory=self.found.facts,
            kept=self.found.tasks.values(),
            recipes=world.recipes,
        )

    @property
    def is_awake(self) -> bool:
        """True if the plant can make a step; one that is ending still makes steps."""
        processes = self._world.processes
        runs = self._name not in processes.off or self._ending is not None
        return runs and self._name not in processes.stalled

    @property
    def is_ending(self) -> bool:
        """True while a plant that can keep nothing more waits for its robots to stand still."""
        return self._ending is not None

    @property
    def is_there(self) -> bool:
        """True while the plant runs or ends, and so takes in what reaches it."""
        return self._name not in self._world.processes.off or self._ending is not None

    @property
    def waits_for_disk(self) -> bool:
        """True while the plant waits for a commit."""
        return self._writes_until > self._world.now

    @property
    def _is_frozen(self) -> bool:
        return self._name in self._world.processes.stalled

    def skip(self, seconds: float) -> None:
        """Have a commit end so much later, as time passes in which nobody does anything."""
        self._writes_until += seconds

    def cut_power(self, reached: int) -> None:
        """Cut the power of the plant's machine: of the unsynced commits only the first `reached` stay."""
        if self.is_there:
            self._world.disk.cut_power(reached, self._world.now)
            self.stop()

    def take_version(self, model: PlantModel) -> None:
        """Have the plant take another version, of which each cell says when it does."""
        world = self._world
        number = len(world.versions) + 1
        version = RevisionName(digest=str(number), number=number)
        world.versions[version.digest] = world.plant.versions[version.digest] = model
        self.post(Revision(at=world.now, version=version))

    def post(self, event: Event) -> None:
        """Put an event into the inbox; it is lost if the plant does not run."""
        if self._name not in self._world.processes.off or self._ending is not None:
            self.inbox.append(event)

    def go_on(self) -> bool:
        """Have the process go on where it stood still; False while it waits for its disk."""
        if self.waits_for_disk:
            self._world.processes.stalled[self._name] = self._writes_until
        return not self.waits_for_disk

    def step(self) -> None:
        """Have the plant take in its inbox, and let out what it says, each message after its commit."""
        if self._ending is not None:
            self._step_ending(self._ending)
            return
        world = self._world
        moment = world.moment
        self.has_stepped = True
        events, self.inbox = self.inbox, []
        for event in events:
            if isinstance(event, Undelivered):
                moment.undelivered.append(event.id)
            elif isinstance(event, Report):
                moment.reports.append(event)
            else:
                moment.requests.append(event)
        if moment.requests:
            for look in world.before_asking:
                look()
        self._writes_until = world.now
        messages = deque(world.plant.step(world.now, events))
        try:
            while messages:
                self._let_out(messages[0])
                messages.popleft()
        except _PlantDeath:
            return
        except DiskFull as full:
            self._end(messages, full)
            return
        world.processes.due[self._name] = world.plant.next_deadline
        if self.waits_for_disk:
            self._wait_for_disk()

    def _wait_for_disk(self) -> None:
        """Have the process do nothing until its last commit has ended."""
        stalled = self._world.processes.stalled
        until = max(self._writes_until, stalled.get(self._name, 0.0))
        stalled[self._name] = until
        self._world.at(until, self._go_on_in_time)

    def _go_on_in_time(self, _: object) -> None:
        if self._world.processes.stalled.get(self._name, math.inf) <= self._world.now:
            self._world.go_on(self._name)

    def _let_out(self, message: Any) -> None:
        """Let a message of the plant out, with what has to be kept on the disk before anybody hears of it."""
        world = self._world
        if is_kept(message):
            self._burn(Side.BEFORE)
            precedes = world.plant.precedes_commands(message)
            self._writes_until += world.disk.commit(message, world.now, precedes_commands=precedes)
            self._burn(Side.AFTER)
        leaves = isinstance(message, Command | TaskChanged | OperatorAnswer)
        if leaves:
            self._burn(Side.BEFORE)
        if isinstance(message, TaskChanged | OperatorAnswer):
            world.disk.sync()  # whoever is told waits for that, and the plant does not
        elif not is_kept(message) and not leaves_unkept(message):
            self._writes_until += world.disk.let_command_leave(world.now)
        if self.gate is not None and isinstance(message, Command | Heartbeat):
            self.gate(message)
        world.moment.sent.append(message)
        if isinstance(message, RevisionAnswer) and message.refusal is None:
            world.offers = world.plant.versions[message.version.digest]
        elif isinstance(message, CellRevised):
            self._follow(message.cell, world.plant.versions[message.version.digest])
        if isinstance(message, Command | Heartbeat) and self.waits_for_disk:
            world.at(self._writes_until, self._say_late, (world.plant, message))
            if late := late_departure(message, world.plant, self._writes_until):
                self.post(late)
        elif isinstance(message, Command | Heartbeat):
            self._say(message)
        if leaves:
            self._burn(Side.AFTER)

    def _follow(self, cell: str, version: PlantModel) -> None:
        """Know of a cell what it works by from now on."""
        world = self._world
        cells = {each.name: each for each in world.model.cells}
        cells[cell] = revised(cells[cell], version.cell(cell))
        world.model = replace(world.model, cells=tuple(cells.values()))

    def _burn(self, side: Side) -> None:
        """Count one commit, or one message that leaves; the plant dies here if its fuse has burnt down."""
        self._burn_fuses(side)
        if self._name in self._world.processes.off:
            self._make_last_words()
            raise _PlantDeath

    def _burn_fuses(self, side: Side) -> None:
        for fuse in [each for each in self.fuses if each.burns(side)]:
            if fuse in self.fuses:
                fuse.die()

    def _say(self, message: Command | Heartbeat) -> None:
        """Send a message of the plant to the bridge, on topics of ROS 2 to which others listen, too."""
        world = self._world
        if isinstance(message, Heartbeat):
            world.send_to_bridge(HEARTBEAT, FromPlant(at=world.now, message=message))
            return
        copied = loses_its_id(message)
        world.send_to_bridge(command_topic(message), FromPlant(at=world.now, message=message, copied=copied))
        if copied:
            world.send_to_bridge(plain_topic(message), FromPlant(at=world.now, message=without_id(message)))

    def _say_late(self, late: tuple[Plant, Command | Heartbeat]) -> None:
        """Send a message that waited for a commit, unless it is too late or its plant has died."""
        world = self._world
        plant, message = late
        if plant is not world.plant or self._name in world.processes.off or not self._leads_still(message):
            return
        if not is_too_late(message, plant, world.now):
            world.moment.late.append((message, world.now - plant.now))
            self._say(message)
        elif isinstance(message, Command):
            why = SENT_TOO_LATE(seconds=world.now - plant.now)
            self.post(Undelivered(at=world.now, id=message.id, robot=message.robot, sentence=why))

    def _leads_still(self, message: Command | Heartbeat) -> bool:
        """True if a message that waited may leave; if not, the plant finds that out with its next one."""
        try:
            if self.gate is not None:
                self.gate(message)
        except DiskFull:
            return False
        return True

    def _make_last_words(self) -> None:
        """Make all that the plant was asked and has sent in this step its last words."""
        moment = self._world.moment
        moment.last_words += [*moment.requests, *moment.sent]
        moment.requests.clear()
        moment.reports.clear()
        moment.sent.clear()

    def _end(self, unkept: Iterable[Any], why: DiskFull) -> None:
        """End a plant that cannot keep something: it counts as dead, but has its robots halted first."""
        world = self._world
        ending, fuses = Ending(world.plant, why), [*self.fuses]
        self.stop()
        self._make_last_words()
        self._ending, world.processes.due[self._name], self.fuses = ending, world.now, fuses
        world.at(world.now + ENDS_S, self.be_gone, ending)
        self._let_out_unkept(unkept, ending)
        if self._ending is ending:
            self.inbox.append(Shutdown(at=world.now))

    def _step_ending(self, ending: Ending) -> None:
        events, self.inbox = self.inbox, []
        messages = ending.plant.step(self._world.now, events)
        self._world.processes.due[self._name] = ending.plant.next_deadline
        self._let_out_unkept(messages, ending)
        if ending.plant.intake.closed and ending.plant.at_rest:
            self.be_gone(ending)

    def _let_out_unkept(self, messages: Iterable[Any], ending: Ending) -> None:
        for message in messages:
            if not leaves_unkept(message):
                if isinstance(message, Command):
                    why = as_sentence(ending.why)
                    undelivered = Undelivered(
                        at=self._world.now, id=message.id, robot=message.robot, sentence=why
                    )
                    self.inbox.append(undelivered)
                continue
            self._burn_fuses(Side.BEFORE)
            if self._ending is not ending:
                return
            self._world.moment.unkept.append(message)
            if isinstance(message, Command | Heartbeat):
                self._say(message)
            self._burn_fuses(Side.AFTER)
            if self._ending is not ending:
                return

    def be_gone(self, ending: Ending | None = None) -> None:
        """Remove a plant that ends; where an ending is given, only if it is this one."""
        if self._ending is None or ending not in (None, self._ending):
            return
        ending = self._ending
        self._ending, self.inbox, self._world.processes.due[self._name] = None, [], math.inf
        self._world.plant = self.make_plant()
        called, self.when_gone = self.when_gone, []
        for call in called:
            call()
        if ending.starts_again:
            self.start()
