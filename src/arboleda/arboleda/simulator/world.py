"""World: a whole plant in one process, with bridge, boards and broker, under time that is handed to them."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from enum import Enum
from heapq import heappop, heappush
from itertools import count
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from arboleda.core.leaving import SENT_TOO_LATE, is_too_late, late_departure, leaves_unkept
from arboleda.core.plant import Plant
from arboleda.model.commands import Command
from arboleda.model.facts import Facts
from arboleda.model.messages import (
    CellRevised,
    Event,
    Fact,
    Heartbeat,
    OperatorAnswer,
    OperatorRequest,
    Report,
    Revision,
    RevisionAnswer,
    Shutdown,
    TaskChanged,
    TaskRequest,
    Undelivered,
    Verb,
)
from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Builders
from arboleda.model.revision import RevisionName, revised
from arboleda.model.sentence import as_sentence
from arboleda.model.verbs import Arguments
from arboleda.sim.arm import ArmBody
from arboleda.sim.board import Board
from arboleda.sim.devices import Devices
from arboleda.wire.bridge import Bridge
from arboleda.wire.hop import HEARTBEAT, FromPlant, command_topic, loses_its_id, plain_topic, without_id
from arboleda.wire.payloads import Goal
from arboleda.wire.transport import Connection, Delivery, Publication

if TYPE_CHECKING:
    from .hosts.hosts import Hosts
from .disk import Content, Disk, DiskFull, is_kept
from .network import Broker, Client, Hop, Line

START_S = 100.0  # what its clock says where a world begins
FIRST_EPOCH = 1000  # of its plant; its bridge has the next one
PLANT, BRIDGE = "plant", "bridge"
ENDS_S = 6.0  # how long a plant that ends waits for its robots to stand
BY_HAND_S = 1.0  # from putting a robot right by hand to declaring it
AT_ONE_INSTANT = 1000  # passes; more means two machines that never stop talking
Carry = Callable[[Publication], Iterable[Publication]]
Mix = Callable[[Publication], Publication]
Part = Callable[[Report], Iterable[Report]]
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
    """A plant that could not keep something: it halts its robots, and is `gone` once they stand."""

    plant: Plant
    why: DiskFull
    starts_again: bool = False


@dataclass(slots=True, eq=False)
class SupersededProcess:
    """A process that another one has superseded: its plant with what it was told, its bridge with its client,
    and until when it is frozen.
    """

    plant: Plant
    bridge: Bridge
    client: Client
    inbox: list[Event]
    until: float


@dataclass(slots=True)
class BridgeStep:
    """One step of the bridge: what it took in, in order, and what it gave out."""

    bridge: Bridge
    now: float
    events: list[Any]
    out: list[Any]


@dataclass(slots=True)
class Moment:
    """All that happened in one pass over the machines, in order; emptied before the next one.

    `last_words` are what a plant that died in the middle of its step was asked and had sent by then: the
    rest of that step is nobody's. `unkept` is what leaves a plant that ends as it can keep nothing more.
    `late` is what left only when a commit had taken its time, and how many s after its step; `undelivered`
    are the commands of which the plant heard in this step that they did not leave.
    """

    asked: list[Event] = field(default_factory=list)  # tasks and operators' requests that reached the plant
    heard: list[Report] = field(default_factory=list)  # reports that reached the plant
    sent: list[Any] = field(default_factory=list)  # commands and notices of the plant
    taken: list[FromPlant] = field(default_factory=list)  # what the bridge took in from the plant and others
    published: list[tuple[str, Publication]] = field(default_factory=list)  # (client, what it published)
    ordered: list[Publication] = field(default_factory=list)  # what the bridge published of that
    delivered: list[tuple[str, Delivery]] = field(default_factory=list)  # (client, what reached it)
    former: list[Any] = field(default_factory=list)  # what left a process that another one had superseded
    writes: list[Any] = field(default_factory=list)  # what a store took that two hosts reach
    executed: list[tuple[str, Goal]] = field(default_factory=list)  # (board, command it carries out)
    opened: list[str] = field(default_factory=list)  # boards whose effectors somebody else opened
    bridged: list[BridgeStep] = field(default_factory=list)  # what the bridge took in, and gave out
    put_right: list[str] = field(default_factory=list)  # boards whose robots somebody moved by hand
    last_words: list[Any] = field(default_factory=list)
    unkept: list[Any] = field(default_factory=list)
    undelivered: list[str] = field(default_factory=list)
    late: list[tuple[Any, float]] = field(default_factory=list)

    def clear(self) -> None:
        self.asked.clear()
        self.heard.clear()
        self.sent.clear()
        self.taken.clear()
        self.published.clear()
        self.ordered.clear()
        self.delivered.clear()
        self.former.clear()
        self.writes.clear()
        self.executed.clear()
        self.opened.clear()
        self.bridged.clear()
        self.put_right.clear()
        self.last_words.clear()
        self.unkept.clear()
        self.undelivered.clear()
        self.late.clear()


class World:
    """A plant at `now` seconds; `advance` moves it from deadline to deadline, `watchers` are called after
    every pass with what happened in `moment`.

    `mixers` turn what a board itself publishes into what it says instead, `carriers` what anybody publishes
    into what the network gets, `partings` a robot's report into several, stamped with when they come;
    `make_plant` makes the plant of each start. `disk` is what the plant kept, `found` what of it was there
    when it started last; `starts` counts that.
    Processes and their lines are named by `PLANT`, `BRIDGE` and the boards' MQTT names.
    """

    def __init__(
        self,
        model: PlantModel,
        *,
        now: float = START_S,
        epoch: int = FIRST_EPOCH,
        watchers: Iterable[Callable[[], None]] = (),
        carriers: Iterable[Carry] = (),
        recipes: Builders | None = None,
        make_plant: Callable[..., Plant] | None = None,
        disk: Disk | None = None,
    ) -> None:
        self._make_plant = make_plant
        self.hosts: Hosts | None = None  # where a second host waits
        self.gate: Gate | None = None  # asked before a message leaves for the bridge; raises DiskFull
        self.model = model
        self.versions: dict[str, PlantModel] = {}  # that were put to work, by their digests
        self.offers = model  # what a new task is one of
        self.now = now
        self.moment = Moment()
        self.watchers = list(watchers)
        self.carriers = list(carriers)
        self.mixers: dict[str, Mix] = {}
        self.partings: dict[str, Part] = {}
        self.before_asking: list[Callable[[], None]] = []  # called before a step in which somebody asks
        self.disk = disk or Disk()
        self.starts = 1
        self.found = Content()
        self.has_stepped = False  # since it started
        self.fuses: list[Fuse] = []
        self.when_gone: list[Callable[[], None]] = []  # called once when a plant that ends is gone
        self._ending: Ending | None = None
        self._writes_until = now  # the end of the plant's last commit
        self.faults_active = 0  # lasting faults that have begun and not ended
        self.last_fault_at = -math.inf  # when anything last broke, or was mended again
        self.deceptions: Counter[tuple[str, str]] = Counter()  # (board, what it now may lie about)
        self.holds: Counter[tuple[str, str]] = Counter()  # (what faults keep up, whom): by how many of them
        self.obeyed: dict[str, Goal] = {}  # the last command that each board carried out since it booted
        self._epochs = count(epoch)
        self._boot_ids = count(1)
        self._agenda: list[tuple[float, int, Callable[[Any], None], Any]] = []
        self._agenda_no = count()
        self._stalled: dict[str, float] = {}
        self.skipped_s = 0.0  # of `now`, in which nobody did anything
        self._off: set[str] = set()
        self.broker = Broker(self, self.at, self.moment.delivered)
        self.to_bridge, self.to_plant = Hop(), Hop()  # the hop between plant and bridge
        self.beat_reached_bridge_at = -math.inf  # the last heartbeat, since the bridge started
        self.recipes = recipes
        self.plant = self._new_plant()
        self.devices = Devices(model, now=now, boot_ids=lambda: next(self._boot_ids))
        self.boards: dict[str, Board] = self.devices.boards
        self.bridge: Bridge | None = None
        self._plant_inbox: list[Event] = []
        self._due: dict[str, float] = dict.fromkeys((PLANT, *self.boards), now)
        for name, board in self.boards.items():
            self._add_board(name, board)
        self._stations = [(name, board, self.broker.clients[name]) for name, board in self.boards.items()]
        self.start_bridge()
        self.settle()

    def request_task(self, text: str, token: str | None = None) -> None:
        """Ask for a task in somebody's name; the plant's next step takes it in, and answers by the token."""
        kept = self.disk.ended(text.rpartition("#")[2]) if "#" in text else None
        self.tell(TaskRequest(at=self.now, text=text, request=text if token is None else token, kept=kept))

    def request_verb(
        self, verb: Verb, scope: str = "", *, by_hand: bool = False, arguments: Arguments = ()
    ) -> None:
        """Act as an operator; what a verb only declares as done by hand must have been done before."""
        self.tell(OperatorRequest(at=self.now, verb=verb, scope=scope, by_hand=by_hand, arguments=arguments))

    def home_by_hand(self, scope: str) -> None:
        """Put the robots of a scope that stand still at their reference by hand, and declare that."""
        self.put_at_reference(scope)
        self.at(self.now + BY_HAND_S, self._declare_homed, scope)

    def put_at_reference(self, scope: str) -> None:
        """Move the robots of a scope that stand still by hand to where their counters begin."""
        for name in self._boards_of(scope):
            if not self.boards[name].body.moving:
                self.boards[name].put_at_reference()
                self.moment.put_right.append(name)

    def release_by_hand(self, scope: str) -> None:
        """Take out by hand what the robots of a scope that stand still hold, and declare that."""
        self.take_out(scope)
        self.at(self.now + BY_HAND_S, self._declare_empty, scope)

    def take_out(self, scope: str) -> None:
        """Take out by hand what the robots of a scope that stand still hold."""
        for name in self._boards_of(scope):
            body = self.boards[name].body
            if not body.moving:
                opens = isinstance(body, ArmBody) and body.effector
                body.take_out()
                self.moment.put_right.append(name)
                self.moment.opened += [name] if opens else []

    def open_effector(self, board: str) -> None:
        """Open an effector as if by somebody else than this plant; its board says that it is off."""
        body = self.boards[board].body
        if isinstance(body, ArmBody) and self.is_on(board) and not body.stuck:
            body.switch_effector(False)
            self.moment.opened.append(board)

    def set_by_hand(self, board: str, facts: Facts) -> None:
        """Make facts so at a device by hand."""
        self.boards[board].body.set_by_hand(facts)
        self.moment.put_right.append(board)

    def tell(self, event: Event) -> None:
        """Put an event into the plant's inbox; it is lost if the plant does not run."""
        self._post(event)

    @property
    def memory(self) -> dict[Fact, dict[str, str]]:
        """The facts that the plant had to keep."""
        return self.disk.facts

    def crash(self, process: str = PLANT) -> None:
        """Kill a process and start it at once, the plant with what it kept, a board as it boots."""
        self.last_fault_at = self.now
        if process == PLANT:
            if self.is_on(PLANT):
                self.stop_plant()
                self.start_plant()
        elif process == BRIDGE:
            self.stop_bridge()
            self.start_bridge()
        else:
            self.power_off(process)
            self.power_on(process)

    def stop_plant(self) -> None:
        """Kill the plant's process; the next one will have what was kept."""
        self.last_fault_at = self.now
        if PLANT in self._stalled:  # a frozen process cannot even die
            return
        self.fuses.clear()
        if PLANT in self._off:
            self._be_gone(self._ending)
            return
        self._writes_until = self.now
        self._plant_inbox = []
        self._off.add(PLANT)
        self._due[PLANT] = math.inf
        self.starts += 1
        self.has_stepped = False
        self.plant = self._new_plant()

    def start_plant(self) -> None:
        """The plant starts on what is left; it has heard nothing of what was said meanwhile.

        Where there is no room on the disk it does not start, and one that ends has to be gone before.
        """
        if PLANT in self._off and self._ending is not None:
            self._ending.starts_again = True
        elif PLANT in self._off and not self.disk.full:
            if PLANT in self._stalled:  # its machine is frozen
                self.at(self._stalled[PLANT], lambda _: self.start_plant())
                return
            self._off.discard(PLANT)
            self._due[PLANT] = self.now
            if self.plant.now != self.now:
                self.plant = self._new_plant()

    def change_leaders(self, epoch: int) -> SupersededProcess | None:
        """Have another process lead, plant and bridge, under this number and on what is kept; return what is
        left of the one before, if that runs.
        """
        self._be_gone(self._ending)
        client, bridge, left = self.broker.clients[BRIDGE], self.bridge, None
        until = max(self._stalled.pop(PLANT, self.now), self._stalled.pop(BRIDGE, self.now))
        if PLANT in self._off or bridge is None:
            self.broker.leave(client)
        else:
            left = SupersededProcess(self.plant, bridge, client, self._plant_inbox, until)
            self.broker.rename(client, f"{BRIDGE} before {epoch}")
            self._stalled[client.name] = math.inf  # only the holder of `left` steps it
        self.fuses.clear()
        self._writes_until, self._plant_inbox, self.last_fault_at = self.now, [], self.now
        self._off.discard(PLANT)
        self.starts += 1
        self.has_stepped = False
        self.plant, self._due[PLANT] = self._new_plant(epoch), self.now
        self.beat_reached_bridge_at = -math.inf
        self.start_bridge(epoch)
        return left

    def bury(self, left: SupersededProcess) -> None:
        """Remove the rest of a process that led."""
        self.broker.leave(left.client)
        del self._stalled[left.client.name]

    @property
    def is_ending(self) -> bool:
        """True while a plant that can keep nothing more waits for its robots to stand still."""
        return self._ending is not None

    def cut_power(self, reached: int) -> None:
        """Cut the power of the plant's machine: of the unsynced commits only the first `reached` stay."""
        if PLANT not in self._off or self._ending is not None:
            self.disk.cut_power(reached, self.now)
            self.stop_plant()

    def stall(self, process: str, seconds: float) -> None:
        """Have a process do nothing for a while; what reaches it waits."""
        self.last_fault_at = self.now
        self._stall(process, self.now + seconds)

    def _stall(self, process: str, until: float) -> None:
        until = max(until, self._stalled.get(process, 0.0))
        self._stalled[process] = until
        self.at(until, self._go_on, process)

    def skip(self, seconds: float) -> None:
        """Let time pass in which nobody does anything: whatever was to come happens so much later."""
        self.now += seconds
        self.skipped_s += seconds
        self._writes_until += seconds
        self._agenda = [(at + seconds, *rest) for at, *rest in self._agenda]  # in the same order
        self._stalled = {process: until + seconds for process, until in self._stalled.items()}
        for line in self._lines():
            line.skip(seconds)

    @property
    def to_come(self) -> list[tuple[float, Callable[[Any], None], Any]]:
        """The calls that are to be made, in order, each with its time and its argument."""
        return [(at, *call) for at, _, *call in sorted(self._agenda, key=itemgetter(0, 1))]

    @property
    def is_quiet(self) -> bool:
        """True if every process runs, and no message is under way."""
        running = not self._off and not self._stalled
        return running and all(line.is_clear(self.now) for line in self._lines())

    @property
    def awake_s(self) -> float:
        """`now`, less the time in which nobody did anything."""
        return self.now - self.skipped_s

    def _lines(self) -> Iterable[Line]:
        yield from (self.to_bridge, self.to_plant)
        for client in self.broker.clients.values():
            yield from (client.up, client.down)

    def go_on(self, process: str) -> None:
        """Have a stalled process go on; a plant that waits for its disk goes on waiting."""
        if process == PLANT and self.writes:
            self._stalled[PLANT] = self._writes_until
        elif self._stalled.pop(process, None) is not None:
            self.wake(process)

    def is_stalled(self, process: str) -> bool:
        """True while a process does nothing for a while."""
        return process in self._stalled

    @property
    def writes(self) -> bool:
        """True while the plant waits for a commit."""
        return self._writes_until > self.now

    def wake(self, process: str) -> None:
        """Have a process that is there step in this pass, as something was done to it."""
        if process in self._due and self._awake(process):
            self._due[process] = self.now

    def power_off(self, board: str, *, will_after_s: float = 0.0) -> None:
        """Cut a board's power; the broker tells its last will when it notices."""
        self.last_fault_at = self.now
        if board in self._off:
            return
        client = self.broker.clients[board]
        self._off.add(board)
        self.obeyed.pop(board, None)
        client.inbox.clear()
        now_us = _us(self.now)
        self.boards[board].connect(now_us, False)
        self.boards[board].reboot(now_us, next(self._boot_ids))
        self.boards[board].take()
        self._due[board] = math.inf
        client.connect(False)
        will = (client, client.connection)
        if will_after_s:
            self.at(self.now + will_after_s, self._tell_will, will)
        else:
            self._tell_will(will)

    def power_on(self, board: str) -> None:
        """Power a board: it boots and reaches the broker."""
        if board not in self._off:
            return
        self._off.discard(board)
        self._due[board] = self.now
        self._reconnect(self.broker.clients[board])

    def is_on(self, process: str) -> bool:
        """True if a board has power, or if the bridge or the plant runs."""
        return process not in self._off

    def stop_broker(self) -> None:
        """Stop the broker: every connection breaks, and what it retained is gone."""
        self.last_fault_at = self.now
        self.broker.die()
        for client in self.broker.clients.values():
            self._tell_connection(client)

    def start_broker(self) -> None:
        """Start a new broker, to which everybody connects again."""
        self.broker.is_up = True
        for client in self.broker.clients.values():
            self._reconnect(client)

    def stop_bridge(self) -> None:
        """Kill the bridge's process."""
        self.last_fault_at = self.now
        self.bridge = None
        self._off.add(BRIDGE)
        self.beat_reached_bridge_at = -math.inf
        client = self.broker.clients[BRIDGE]
        client.inbox.clear()
        client.connect(False)
        self._due.pop(BRIDGE, None)

    def start_bridge(self, epoch: int | None = None) -> None:
        """Start a new bridge; it connects, and the broker delivers what it retained."""
        self.bridge = Bridge(self.model, epoch=next(self._epochs) if epoch is None else epoch, now=self.now)
        self._off.discard(BRIDGE)
        if BRIDGE not in self.broker.clients:
            self.broker.join(Client(BRIDGE, self.bridge.subscriptions))
        self._due[BRIDGE] = self.now
        self._reconnect(self.broker.clients[BRIDGE])

    def publish(self, publication: Publication, sender: Client | None = None) -> None:
        """Publish for a sender; None: a foreign client, over a line without faults."""
        name = sender.name if sender else ""
        self.moment.published.append((name, publication))
        if name == BRIDGE:
            self.moment.ordered.append(publication)
        if name in self.mixers:
            publication = self.mixers[name](publication)
        if not self.carriers:
            self.broker.publish(publication, sender)
            return
        carried = [publication]
        for carrier in self.carriers:
            carried = [each for one in carried for each in carrier(one)]
        for each in carried:
            self.broker.publish(each, sender)

    def at(self, time: float, call: Callable[[Any], None], argument: Any = None) -> None:
        """Have `call(argument)` made at `time`, or now where that has passed."""
        heappush(self._agenda, (time, next(self._agenda_no), call, argument))

    def advance(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let at most `seconds` pass; return True as soon as `until` comes true."""
        end = self.awake_s + seconds
        if self._has_work():
            self.settle()
        while not until():
            due = self.next_deadline
            if due - self.skipped_s > end:
                self.now = end + self.skipped_s
                return until()
            self.now = max(self.now, due)
            self.settle()
        return True

    @property
    def next_deadline(self) -> float:
        """The time at which something happens next if nobody interferes."""
        due = self._agenda[0][0] if self._agenda else math.inf
        if not self._stalled:
            return min(due, *self._due.values())
        return min((due, *(at for name, at in self._due.items() if name not in self._stalled)))

    def settle(self) -> None:
        """Step whoever has something to do now, until nobody has."""
        for _ in range(AT_ONE_INSTANT):
            self._pass()
            for watch in self.watchers:
                watch()
            self.moment.clear()
            if not self._has_work() and self.next_deadline > self.now:
                return
        raise AssertionError(f"the machines do not come to rest at {self.now}")

    def _has_work(self) -> bool:
        if self._plant_inbox and self._plant_awake:
            return True
        for client in self.broker.clients.values():  # noqa: SIM110 - no generator: it is asked in every pass
            if client.inbox and self._awake(client.name):
                return True
        return False

    def _awake(self, process: str) -> bool:
        return process not in self._off and process not in self._stalled

    @property
    def _plant_awake(self) -> bool:
        """True if the plant can make a step; one that is ending still makes steps."""
        return (PLANT not in self._off or self._ending is not None) and PLANT not in self._stalled

    def _go_on(self, process: str) -> None:
        if self._stalled.get(process, math.inf) <= self.now:
            self.go_on(process)

    def _pass(self) -> None:
        while self._agenda and self._agenda[0][0] <= self.now:
            _, _, call, argument = heappop(self._agenda)
            call(argument)
        now, due, bridge = self.now, self._due, self.broker.clients[BRIDGE]
        now_us = _us(now)
        if bridge.inbox:  # what the plant said
            self._step_bridge(bridge)
        off, stalled = self._off, self._stalled
        for name, board, client in self._stations:
            if (client.inbox or due[name] <= now) and name not in off and name not in stalled:
                self._step_board(now_us, name, board, client)
        if bridge.inbox or due.get(BRIDGE, math.inf) <= now:  # what the boards said
            self._step_bridge(bridge)
        if (self._plant_inbox or due[PLANT] <= now) and self._plant_awake:
            self._step_plant() if self._ending is None else self._step_ending(self._ending)

    def _step_board(self, now_us: int, name: str, board: Board, client: Client) -> None:
        if client.inbox:
            inbox, client.inbox = client.inbox, []
            for event in inbox:
                if isinstance(event, Delivery):
                    board.receive(now_us, event)
                else:
                    board.connect(now_us, event.up)
        board.advance(now_us)
        due_us = board.next_deadline_us
        self._due[name] = math.inf if due_us is None else due_us / 1e6
        for publication in board.take():
            self.publish(publication, client)

    def _step_bridge(self, client: Client) -> None:
        bridge = self.bridge
        if bridge is None or not self._awake(BRIDGE):
            return
        inbox, client.inbox = client.inbox, []
        self.moment.taken += [event for event in inbox if isinstance(event, FromPlant)]
        now = self.now
        clear = self.to_plant.is_clear(now) and (PLANT not in self._off or self._ending is not None)
        out = bridge.step(now, inbox)
        self.moment.bridged.append(BridgeStep(bridge, now, inbox, out))
        for message in out:
            if isinstance(message, Report):
                if message.robot in self.partings:
                    for part in self.partings[message.robot](message):
                        self.at(part.at, self._report, part)
                elif clear and message.at == now:
                    self._plant_inbox.append(message)
                else:
                    self._carry(self.to_plant.carry_on(message.robot, now, message), self._to_plant, message)
            elif isinstance(message, Publication):
                self.publish(message, client)
        due = bridge.next_deadline
        self._due[BRIDGE] = math.inf if due is None else due

    def _report(self, report: Report) -> None:
        self._carry(self.to_plant.carry_on(report.robot, self.now, report), self._to_plant, report)

    def _step_plant(self) -> None:
        self.has_stepped = True
        events, self._plant_inbox = self._plant_inbox, []
        for event in events:
            if isinstance(event, Undelivered):
                self.moment.undelivered.append(event.id)
            else:
                (self.moment.heard if isinstance(event, Report) else self.moment.asked).append(event)  # type: ignore[arg-type]
        if self.moment.asked:
            for look in self.before_asking:
                look()
        self._writes_until = self.now
        said = deque(self.plant.step(self.now, events))
        try:
            while said:
                self._let_out(said[0])
                said.popleft()
        except _PlantDeath:
            return
        except DiskFull as full:
            self._end(said, full)
            return
        self._due[PLANT] = self.plant.next_deadline
        if self.writes:
            self._stall(PLANT, self._writes_until)

    def _let_out(self, message: Any) -> None:
        """Let a message of the plant out, with what has to be kept on the disk before anybody hears of it."""
        if is_kept(message):
            self._burn(Side.BEFORE)
            precedes = self.plant.precedes_commands(message)
            self._writes_until += self.disk.commit(message, self.now, precedes_commands=precedes)
            self._burn(Side.AFTER)
        leaves = isinstance(message, Command | TaskChanged | OperatorAnswer)
        if leaves:
            self._burn(Side.BEFORE)
        if isinstance(message, TaskChanged | OperatorAnswer):
            self.disk.sync()  # whoever is told waits for that, and the plant does not
        elif not is_kept(message) and not leaves_unkept(message):
            self._writes_until += self.disk.let_command_leave(self.now)
        if self.gate is not None and isinstance(message, Command | Heartbeat):
            self.gate(message)
        self.moment.sent.append(message)
        if isinstance(message, RevisionAnswer) and message.refusal is None:
            self.offers = self.plant.versions[message.version.digest]
        elif isinstance(message, CellRevised):
            self._follow(message.cell, self.plant.versions[message.version.digest])
        if isinstance(message, Command | Heartbeat) and self.writes:
            self.at(self._writes_until, self._say_late, (self.plant, message))
            if late := late_departure(message, self.plant, self._writes_until):
                self._post(late)
        elif isinstance(message, Command | Heartbeat):
            self._say(message)
        if leaves:
            self._burn(Side.AFTER)

    def put_to_work(self, model: PlantModel) -> None:
        """Have the plant take another version, of which each cell says when it does."""
        number = len(self.versions) + 1
        version = RevisionName(digest=str(number), number=number)
        self.versions[version.digest] = self.plant.versions[version.digest] = model
        self.tell(Revision(at=self.now, version=version))

    def _follow(self, cell: str, version: PlantModel) -> None:
        """Know of a cell what it works by from now on."""
        cells = {each.name: each for each in self.model.cells}
        cells[cell] = revised(cells[cell], version.cell(cell))
        self.model = replace(self.model, cells=tuple(cells.values()))

    def _burn(self, side: Side) -> None:
        """Count one commit, or one message that leaves; the plant dies here if its fuse has burnt down."""
        self._burn_fuses(side)
        if PLANT in self._off:
            self._make_last_words()
            raise _PlantDeath

    def _burn_fuses(self, side: Side) -> None:
        for fuse in [each for each in self.fuses if each.burns(side)]:
            if fuse in self.fuses:
                fuse.die()

    def _say_late(self, late: tuple[Plant, Command | Heartbeat]) -> None:
        """Send a message that waited for a commit, unless it is too late or its plant has died."""
        plant, message = late
        if plant is not self.plant or PLANT in self._off or not self._leads_still(message):
            return
        if not is_too_late(message, plant, self.now):
            self.moment.late.append((message, self.now - plant.now))
            self._say(message)
        elif isinstance(message, Command):
            why = SENT_TOO_LATE(seconds=self.now - plant.now)
            self._post(Undelivered(at=self.now, id=message.id, robot=message.robot, sentence=why))

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
        moment = self.moment
        moment.last_words += [*moment.asked, *moment.sent]
        moment.asked.clear()
        moment.heard.clear()
        moment.sent.clear()

    def _end(self, unkept: Iterable[Any], why: DiskFull) -> None:
        """End a plant that cannot keep something: it counts as dead, but has its robots halted first."""
        ending, fuses = Ending(self.plant, why), [*self.fuses]
        self.stop_plant()
        self._make_last_words()
        self._ending, self._due[PLANT], self.fuses = ending, self.now, fuses
        self.at(self.now + ENDS_S, self._be_gone, ending)
        self._let_out_unkept(unkept, ending)
        if self._ending is ending:
            self._plant_inbox.append(Shutdown(at=self.now))

    def _step_ending(self, ending: Ending) -> None:
        events, self._plant_inbox = self._plant_inbox, []
        said = ending.plant.step(self.now, events)
        self._due[PLANT] = ending.plant.next_deadline
        self._let_out_unkept(said, ending)
        if ending.plant.intake.closed and ending.plant.at_rest:
            self._be_gone(ending)

    def _let_out_unkept(self, said: Iterable[Any], ending: Ending) -> None:
        for message in said:
            if not leaves_unkept(message):
                if isinstance(message, Command):
                    why = as_sentence(ending.why)
                    undelivered = Undelivered(at=self.now, id=message.id, robot=message.robot, sentence=why)
                    self._plant_inbox.append(undelivered)
                continue
            self._burn_fuses(Side.BEFORE)
            if self._ending is not ending:
                return
            self.moment.unkept.append(message)
            if isinstance(message, Command | Heartbeat):
                self._say(message)
            self._burn_fuses(Side.AFTER)
            if self._ending is not ending:
                return

    def _be_gone(self, ending: Ending | None) -> None:
        """Remove a plant that has ended, if it is this one."""
        if ending is None or ending is not self._ending:
            return
        self._ending, self._plant_inbox, self._due[PLANT] = None, [], math.inf
        self.plant = self._new_plant()
        called, self.when_gone = self.when_gone, []
        for call in called:
            call()
        if ending.starts_again:
            self.start_plant()

    def _post(self, event: Event) -> None:
        if PLANT not in self._off or self._ending is not None:
            self._plant_inbox.append(event)

    def _new_plant(self, epoch: int | None = None) -> Plant:
        self.found = self.disk.found()
        self.model = self.offers
        make = self._make_plant or Plant
        return make(
            self.model,
            epoch=next(self._epochs) if epoch is None else epoch,
            now=self.now,
            memory=self.found.facts,
            kept=self.found.tasks.values(),
            recipes=self.recipes,
        )

    def _say(self, message: Command | Heartbeat) -> None:
        """Send a message of the plant to the bridge, on topics of ROS 2 to which others listen, too."""
        if isinstance(message, Heartbeat):
            self._to_hop(HEARTBEAT, FromPlant(at=self.now, message=message))
            return
        copied = loses_its_id(message)
        self._to_hop(command_topic(message), FromPlant(at=self.now, message=message, copied=copied))
        if copied:
            self._to_hop(plain_topic(message), FromPlant(at=self.now, message=without_id(message)))

    def _to_hop(self, topic: str, said: FromPlant) -> None:
        self._carry(self.to_bridge.carry_on(topic, self.now, said.message), self._to_bridge, said)

    def _carry(self, arrivals: Iterable[float], call: Callable[[Any], None], message: Any) -> None:
        for at in arrivals:
            if at <= self.now:
                call(message)
            else:
                self.at(at, call, message)

    def _to_bridge(self, said: FromPlant) -> None:
        if self.bridge is None:
            return
        if isinstance(said.message, Heartbeat) and said.message.epoch == self.plant.epoch:
            self.beat_reached_bridge_at = self.now
        heard = said if said.at == self.now else replace(said, at=self.now)
        self.broker.clients[BRIDGE].inbox.append(heard)

    def _to_plant(self, report: Report) -> None:
        self._post(report if report.at == self.now else report.again(self.now))

    def _declare_homed(self, scope: str) -> None:
        """Declare robots homed by hand, unless one moves; one that has booted since is put right again."""
        if not any(self.boards[name].body.moving for name in self._boards_of(scope)):
            self.put_at_reference(scope)
            self.request_verb(Verb.HOME, scope, by_hand=True)

    def _declare_empty(self, scope: str) -> None:
        self.request_verb(Verb.RELEASE, scope, by_hand=True)

    def _boards_of(self, scope: str) -> list[str]:
        """The boards of a robot, a cell or the plant."""
        scope = scope.strip().lower()
        cells = {cell.name: [robot.name for robot in cell.robots] for cell in self.model.cells}
        robots = cells.get(scope, [scope] if scope in self.model.robots else list(self.model.robots))
        return [self.model.robots[name].mqtt for name in robots]

    def _add_board(self, name: str, board: Board) -> None:
        client = Client(name, board.subscriptions)
        self.broker.join(client)
        board.watch = lambda goal: self._obey(name, goal)
        self._reconnect(client)

    def _obey(self, board: str, goal: Goal) -> None:
        self.obeyed[board] = goal
        self.moment.executed.append((board, goal))

    def _reconnect(self, client: Client) -> None:
        if not self.broker.is_up or client.name in self._off or (client.name == BRIDGE and not self.bridge):
            return
        client.connect(True)
        self._tell_connection(client)
        self.broker.tell_retained(client)

    def _tell_connection(self, client: Client) -> None:
        if client.name not in self._off:
            client.inbox.append(Connection(at=self.now, client=client.name, up=client.connected))

    def _tell_will(self, will: tuple[Client, int]) -> None:
        client, connection = will
        if client.connection == connection:
            self.publish(Publication(topic=f"{client.name}/conexion", payload=b"0", retain=True))


def _us(seconds: float) -> int:
    return round(seconds * 1e6)
