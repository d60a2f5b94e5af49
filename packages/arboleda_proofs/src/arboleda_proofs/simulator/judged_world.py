"""World under watch: its faults, truth, record, trace and invariants go along with every step."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable

from arboleda.engine import Plant
from arboleda.engine.inspection import asking_of
from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Builders
from arboleda.rig.hosts.database import LeaderRow, SharedDisk
from arboleda.rig.hosts.hosts import Hosts
from arboleda.rig.network import Line
from arboleda.rig.world import FIRST_EPOCH, START_S, World

from .faults import KINDS, Fault
from .findings import Findings
from .invariants import Invariant
from .invariants.invariant import Judges, Look
from .judged import judged_by
from .record import Record
from .recorded.leaders import Leaders
from .trace import Trace
from .truth.truth import Truth

REST_S = 600.0  # after the last fault, or end of a task or of a wait for a zone since, all must be at rest
WAITS = 10  # that one task may have one after another, each as long as the plant file allows for a zone
STAYS_S = 10.0  # and stay there


class BrokenInvariant(Exception):
    """An invariant does not hold."""

    def __init__(self, invariant: str, sentence: str) -> None:
        super().__init__(f"{invariant}: {sentence}")
        self.invariant = invariant
        self.sentence = sentence


class JudgedWorld:
    """A world in which every step is judged: raises BrokenInvariant in the step that breaks an invariant.

    `faults` are those that have begun; their times are in s since `start`. `standby`: a second host waits to
    lead.
    """

    def __init__(
        self,
        model: PlantModel,
        *,
        invariants: Iterable[Invariant] | None = None,
        keep: bool = False,
        tell: Callable[[str], None] | None = None,
        recipes: Builders | None = None,
        make_plant: Callable[..., Plant] | None = None,
        standby: bool = False,
    ) -> None:
        disk = SharedDisk(LeaderRow(epoch=FIRST_EPOCH + 1, renewed_at=START_S)) if standby else None
        self.world = World(model, recipes=recipes, make_plant=make_plant, disk=disk)
        hosts = None if disk is None else Hosts(self.world, disk)
        self._start = self.world.now
        self.faults: list[Fault] = []
        self.invariants = tuple(judged_by(standby=standby) if invariants is None else invariants)
        self.trace = Trace(self.world, keep=keep, tell=tell)
        self._ends: dict[int, Callable[[], None]] = {}
        self._rests = 0  # a fault that is expected since before a rest never begins
        truth, record = Truth(self.world), Record(self.world)
        leaders = None if hosts is None else Leaders(self.world, hosts, record.boards)
        self._look = Look(world=self.world, truth=truth, record=record, leaders=leaders)
        self.findings = Findings(self.world, record)
        self._judges = Judges(self.invariants)
        self.world.watchers.append(self._check)

    @property
    def start(self) -> float:
        """The time at which the run began, moved on by the time in which nobody did anything."""
        return self._start + self.world.skipped_s

    @property
    def seconds(self) -> float:
        """The duration of the run so far, s."""
        return self.world.now - self.start

    @property
    def truth(self) -> Truth:
        """The truth about the plant after the last step."""
        return self._look.truth

    @property
    def checks(self) -> Counter[str]:
        """The number of looks at each invariant, by its name."""
        return self._judges.looks

    def expect(self, fault: Fault) -> None:
        """Have a fault begin when its time has come, if that is before the next rest."""
        self.world.at(self.start + fault.at, self._begin_expected, (self._rests, fault))

    def begin(self, fault: Fault) -> None:
        """Bring a fault about now, and have it end when its seconds have passed."""
        world, number = self.world, len(self.faults)
        self.faults.append(fault)
        self.trace.note(f"FAULT      {_line(fault)}")
        end = KINDS[fault.kind].begin(world, fault)
        world.last_fault_at = world.now
        if end is not None:
            world.faults_active += 1
            self._ends[number] = end
            world.at(world.now + fault.seconds, self._end, number)

    def end_faults(self) -> None:
        """End all faults now."""
        for number in list(self._ends):
            self._end(number)

    def come_to_rest(self, until: Callable[[], bool] = lambda: False) -> None:
        """End all faults, let everything come to rest, and judge that it does so and stays at rest, for some
        time or `until` it is known to.
        """
        self._rests += 1
        self.end_faults()
        tasks = self._look.record.tasks
        longest_s = WAITS * max((cell.zone_wait_s for cell in self.world.model.cells), default=0.0)
        open_tasks, since, end = len(tasks.open), self.seconds, self.seconds + REST_S
        while self.seconds < end and not (self._is_quiet() and self._judges.is_at_rest(self._look)):
            self.world.advance(1.0)
            before, open_tasks = open_tasks, len(tasks.open)
            if open_tasks < before:
                since = self.seconds
            waits = bool(asking_of(self.world.plant))
            if open_tasks < before or (waits and self.seconds < since + longest_s):
                end = self.seconds + REST_S
        self._raise(self._judges.at_the_end(self._look))
        self.world.advance(STAYS_S, until)
        self._raise(self._judges.at_the_end(self._look))

    def look_around(self) -> None:
        """Judge the whole now by the invariants that look at it every so often."""
        self._raise(self._judges.look_around(self._look))

    def _is_quiet(self) -> bool:
        """True if no message is under way, of which one that a fault held may be a stranger's stop, and no
        board carries anything out, as it may with a switch that the plant has given up.
        """
        world = self.world
        lines: list[Line] = [world.to_bridge, world.to_plant]
        lines += [line for client in world.broker.clients.values() for line in (client.up, client.down)]
        is_delivered = all(line.busy_until <= world.now for line in lines)
        return is_delivered and all(board.body.next_change_us is None for board in world.boards.values())

    def _begin_expected(self, expected: tuple[int, Fault]) -> None:
        rests, fault = expected
        if rests == self._rests:
            self.begin(fault)

    def _end(self, number: int) -> None:
        end = self._ends.pop(number, None)
        if end is not None:
            end()
            self.world.faults_active -= 1
            self.world.last_fault_at = self.world.now
            self.trace.note(f"fault over {_line(self.faults[number])}")

    def _check(self) -> None:
        look = self._look
        look.truth.look()
        look.record.look()
        if look.leaders is not None:
            look.leaders.look()
        self.trace.look()
        if self.world.last_fault_at == -math.inf:
            self.findings.look()
        self._raise(self._judges.after_a_step(look))

    def _raise(self, breaches: Iterable[tuple[str, str]]) -> None:
        for name, sentence in breaches:
            raise BrokenInvariant(name, sentence)


def _line(fault: Fault) -> str:
    parts = [fault.kind, fault.target, fault.word, f"{fault.amount:g}" if fault.amount else ""]
    lasting = f"for {fault.seconds:.3f} s" if 0 < fault.seconds < math.inf else ""
    return " ".join(part for part in (*parts, lasting) if part)
