"""World: a whole plant in one process, with bridge, boards and broker, under time that is handed to them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import replace
from heapq import heappop, heappush
from itertools import count
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from arboleda.engine import Plant
from arboleda.model.messages import Event, Heartbeat, OperatorRequest, Report, TaskRequest, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.recipe import Builders
from arboleda.model.verbs import Arguments
from arboleda.sim.board import Board
from arboleda.sim.devices import Devices
from arboleda.wire.bridge import Bridge
from arboleda.wire.hop import FromPlant
from arboleda.wire.payloads import Goal
from arboleda.wire.transport import Connection, Delivery, Publication

from .disk import Disk
from .manual_work import ManualWork
from .moment import BridgeStep, Moment
from .network import Broker, Client, Hop, Line
from .plant_process import PlantProcess
from .processes import Processes

if TYPE_CHECKING:
    from .hosts.hosts import Hosts

START_S = 100.0  # what its clock says where a world begins
FIRST_EPOCH = 1000  # of its plant; its bridge has the next one
PLANT, BRIDGE = "plant", "bridge"
AT_ONE_INSTANT = 1000  # passes; more means two machines that never stop talking
Carry = Callable[[Publication], Iterable[Publication]]
Mix = Callable[[Publication], Publication]
Part = Callable[[Report], Iterable[Report]]


class World:
    """A plant at `now` seconds; `advance` moves it from deadline to deadline, `watchers` are called after
    every pass with what happened in `moment`.

    `mixers` turn what a board itself publishes into what it says instead, `carriers` what anybody publishes
    into what the network gets, `partings` a robot's report into several, stamped with when they come;
    `make_plant` makes the plant of each start, `disk` is where it keeps what must not be lost;
    `plant_process` stops and starts it. `manual` is what a person does at the machines.
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
        self.hosts: Hosts | None = None  # where a second host waits
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
        self.faults_active = 0  # lasting faults that have begun and not ended
        self.last_fault_at = -math.inf  # when anything last broke, or was mended again
        self.deceptions: Counter[tuple[str, str]] = Counter()  # (board, what it now may lie about)
        self.holds: Counter[tuple[str, str]] = Counter()  # (what faults keep up, whom): by how many of them
        self.obeyed: dict[str, Goal] = {}  # the last command that each board carried out since it booted
        self._epochs = count(epoch)
        self._boot_ids = count(1)
        self._agenda: list[tuple[float, int, Callable[[Any], None], Any]] = []
        self.turns = count()  # of calls that are to come at one time
        self.skipped_s = 0.0  # of `now`, in which nobody did anything
        self.broker = Broker(self, self.at, self.moment.delivered, self.moment.outdated)
        self.to_bridge, self.to_plant = Hop(), Hop()  # the hop between plant and bridge
        self.beat_reached_bridge_at = -math.inf  # the last heartbeat, since the bridge started
        self.epoch_at_bridge = 0  # of the newest heartbeat that reached the bridge, since it started
        self.recipes = recipes
        self.manual = ManualWork(self)
        self.plant_process = PlantProcess(self, PLANT, make_plant or Plant, self._epochs)
        self.plant = self.plant_process.make_plant()
        self.devices = Devices(model, now=now, boot_ids=lambda: next(self._boot_ids))
        self.boards: dict[str, Board] = self.devices.boards
        self.bridge: Bridge | None = None
        self.processes = Processes((PLANT, *self.boards), now)
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

    def tell(self, event: Event) -> None:
        """Put an event into the plant's inbox; it is lost if the plant does not run."""
        self.plant_process.post(event)

    def crash(self, process: str = PLANT) -> None:
        """Kill a process and start it at once, the plant with what it kept, a board as it boots."""
        self.last_fault_at = self.now
        if process == PLANT:
            if self.is_on(PLANT):
                self.plant_process.stop()
                self.plant_process.start()
        elif process == BRIDGE:
            self.stop_bridge()
            self.start_bridge()
        else:
            self.power_off(process)
            self.power_on(process)

    def stall(self, process: str, seconds: float) -> None:
        """Have a process do nothing for a while; what reaches it waits."""
        self.last_fault_at = self.now
        until = max(self.now + seconds, self.processes.stalled.get(process, 0.0))
        self.processes.stalled[process] = until
        self.at(until, self._go_on, process)

    def skip(self, seconds: float) -> None:
        """Let time pass in which nobody does anything: whatever was to come happens so much later."""
        self.now += seconds
        self.skipped_s += seconds
        self.plant_process.skip(seconds)
        self._agenda = [(at + seconds, *rest) for at, *rest in self._agenda]  # in the same order
        self.processes.stalled = {
            process: until + seconds for process, until in self.processes.stalled.items()
        }
        for line in self._lines():
            line.skip(seconds)

    @property
    def to_come(self) -> list[tuple[float, Callable[[Any], None], Any]]:
        """The calls that are to be made, in order, each with its time and its argument."""
        return [(at, *call) for at, _, *call in sorted(self._agenda, key=itemgetter(0, 1))]

    @property
    def is_quiet(self) -> bool:
        """True if every process runs, and no message is under way."""
        running = not self.processes.off and not self.processes.stalled
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
        if process == PLANT and not self.plant_process.go_on():
            return
        if self.processes.stalled.pop(process, None) is not None:
            self.wake(process)

    def is_stalled(self, process: str) -> bool:
        """True while a process does nothing for a while."""
        return process in self.processes.stalled

    def wake(self, process: str) -> None:
        """Have a process that is there step in this pass, as something was done to it."""
        if process in self.processes.due and self.processes.is_awake(process):
            self.processes.due[process] = self.now

    def power_off(self, board: str, *, will_after_s: float = 0.0) -> None:
        """Cut a board's power; the broker tells its last will when it notices."""
        self.last_fault_at = self.now
        if board in self.processes.off:
            return
        client = self.broker.clients[board]
        self.processes.off.add(board)
        self.obeyed.pop(board, None)
        client.inbox.clear()
        now_us = _us(self.now)
        self.boards[board].connect(now_us, False)
        self.boards[board].reboot(now_us, next(self._boot_ids))
        self.boards[board].take()
        self.processes.due[board] = math.inf
        client.connect(False)
        will = (client, client.connection)
        if will_after_s:
            self.at(self.now + will_after_s, self._tell_will, will)
        else:
            self._tell_will(will)

    def power_on(self, board: str) -> None:
        """Power a board: it boots and reaches the broker."""
        if board not in self.processes.off:
            return
        self.processes.off.discard(board)
        self.processes.due[board] = self.now
        self._reconnect(self.broker.clients[board])

    def is_on(self, process: str) -> bool:
        """True if a board has power, or if the bridge or the plant runs."""
        return process not in self.processes.off

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
        self.processes.off.add(BRIDGE)
        self.beat_reached_bridge_at = -math.inf
        client = self.broker.clients[BRIDGE]
        client.inbox.clear()
        client.connect(False)
        self.processes.due.pop(BRIDGE, None)

    def start_bridge(self, epoch: int | None = None) -> None:
        """Start a new bridge; it connects, and the broker delivers what it retained."""
        self.bridge = Bridge(
            self.model,
            epoch=next(self._epochs) if epoch is None else epoch,
            now=self.now,
            has_lease=self.hosts is not None,
        )
        self.epoch_at_bridge = 0
        self.processes.off.discard(BRIDGE)
        if BRIDGE not in self.broker.clients:
            self.broker.join(Client(BRIDGE, self.bridge.subscriptions))
        self.processes.due[BRIDGE] = self.now
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

    def at(
        self, time: float, call: Callable[[Any], None], argument: Any = None, *, turn: int | None = None
    ) -> None:
        """Have `call(argument)` made at `time`, or now where that has passed.

        Calls of one time are made in their turns, by default in the order in which they were asked for.
        """
        heappush(self._agenda, (time, next(self.turns) if turn is None else turn, call, argument))

    def advance(
        self, seconds: float, until: Callable[[], bool] = lambda: False, *, since: float | None = None
    ) -> bool:
        """Let at most `seconds` pass, from now or `since` a time awake; return True once `until` is true."""
        end = (self.awake_s if since is None else since) + seconds
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
        if not self.processes.stalled:
            return min(due, *self.processes.due.values())
        return min(
            (due, *(at for name, at in self.processes.due.items() if name not in self.processes.stalled))
        )

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
        if self.plant_process.inbox and self.plant_process.is_awake:
            return True
        for client in self.broker.clients.values():
            if client.inbox and self.processes.is_awake(client.name):
                return True
        return False

    def _go_on(self, process: str) -> None:
        if self.processes.stalled.get(process, math.inf) <= self.now:
            self.go_on(process)

    def _pass(self) -> None:
        while self._agenda and self._agenda[0][0] <= self.now:
            _, _, call, argument = heappop(self._agenda)
            call(argument)
        now, due, bridge = self.now, self.processes.due, self.broker.clients[BRIDGE]
        now_us = _us(now)
        if bridge.inbox:  # what the plant said
            self._step_bridge(bridge)
        off, stalled = self.processes.off, self.processes.stalled
        for name, board, client in self._stations:
            if (client.inbox or due[name] <= now) and name not in off and name not in stalled:
                self._step_board(now_us, name, board, client)
        if bridge.inbox or due.get(BRIDGE, math.inf) <= now:  # what the boards said
            self._step_bridge(bridge)
        if (self.plant_process.inbox or due[PLANT] <= now) and self.plant_process.is_awake:
            self.plant_process.step()

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
        self.processes.due[name] = math.inf if due_us is None else due_us / 1e6
        for publication in board.take():
            self.publish(publication, client)

    def _step_bridge(self, client: Client) -> None:
        bridge = self.bridge
        if bridge is None or not self.processes.is_awake(BRIDGE):
            return
        inbox, client.inbox = client.inbox, []
        self.moment.taken += [event for event in inbox if isinstance(event, FromPlant)]
        now = self.now
        clear = self.to_plant.is_clear(now) and self.plant_process.is_there
        out = bridge.step(now, inbox)
        self.moment.bridged.append(BridgeStep(bridge, now, inbox, out))
        for message in out:
            if isinstance(message, Report):
                if message.robot in self.partings:
                    for part in self.partings[message.robot](message):
                        self.at(part.at, self._report, part)
                elif clear and message.at == now:
                    self.plant_process.inbox.append(message)
                else:
                    self._carry(self.to_plant.carry_on(message.robot, now, message), self._to_plant, message)
            elif isinstance(message, Publication):
                self.publish(message, client)
        due = bridge.next_deadline
        self.processes.due[BRIDGE] = math.inf if due is None else due

    def _report(self, report: Report) -> None:
        self._carry(self.to_plant.carry_on(report.robot, self.now, report), self._to_plant, report)

    def send_to_bridge(self, topic: str, message: FromPlant) -> None:
        """Carry a message of the plant to the bridge, over the hop between them."""
        self._carry(self.to_bridge.carry_on(topic, self.now, message.message), self._to_bridge, message)

    def _carry(self, arrivals: Iterable[float], call: Callable[[Any], None], message: Any) -> None:
        for at in arrivals:
            if at <= self.now:
                call(message)
            else:
                self.at(at, call, message)

    def _to_bridge(self, message: FromPlant) -> None:
        if self.bridge is None:
            return
        if isinstance(message.message, Heartbeat):
            self.epoch_at_bridge = max(self.epoch_at_bridge, message.message.epoch)
            if message.message.epoch == self.plant.epoch:
                self.beat_reached_bridge_at = self.now
        delivered = message if message.at == self.now else replace(message, at=self.now)
        self.broker.clients[BRIDGE].inbox.append(delivered)

    def _to_plant(self, report: Report) -> None:
        self.plant_process.post(report if report.at == self.now else report.again(self.now))

    def _add_board(self, name: str, board: Board) -> None:
        client = Client(name, board.subscriptions)
        self.broker.join(client)
        board.watch = lambda goal: self._obey(name, goal)
        self._reconnect(client)

    def _obey(self, board: str, goal: Goal) -> None:
        self.obeyed[board] = goal
        self.moment.executed.append((board, goal))

    def _reconnect(self, client: Client) -> None:
        if (
            not self.broker.is_up
            or client.name in self.processes.off
            or (client.name == BRIDGE and not self.bridge)
        ):
            return
        client.connect(True)
        self._tell_connection(client)
        self.broker.tell_retained(client)

    def _tell_connection(self, client: Client) -> None:
        if client.name not in self.processes.off:
            client.inbox.append(Connection(at=self.now, client=client.name, up=client.connected))

    def _tell_will(self, will: tuple[Client, int]) -> None:
        client, connection = will
        if client.connection == connection:
            self.publish(Publication(topic=f"{client.name}/conexion", payload=b"0", retain=True))


def _us(seconds: float) -> int:
    return round(seconds * 1e6)
