"""Two hosts of a plant: the leader renews its lease in the store, the other one watches it."""

from __future__ import annotations

from arboleda.departures.leading import LOOK_S, RENEW_S, Standing, all_stand, at_work, may_leave
from arboleda.model.commands import Command
from arboleda.model.messages import Heartbeat, OperatorRequest, Verb

from ..world import BRIDGE, PLANT, World
from .change_of_leaders import change_leaders
from .database import SharedDisk, StoreRefused, StoreUnreachable
from .former_leader import FormerLeader
from .process import Host, Process

NAMES = ("host_a", "host_b")
STARTS_S = 0.4  # from a standby's lead to its first step
BACK_S = 5.0  # after which a process that ended is started again, to wait
LOOKS_S = 0.05  # how often a planned change is looked at
HELD_S = 10.0  # within which a held cell stands still
HEARD_S = 30.0  # within which robots are heard


class Hosts:
    """The two hosts of `world`, whose plant is that of `leader`; `formers` led before and still run.

    `numbers` are all numbers under which the plant was led, with the host that did.
    """

    def __init__(self, world: World, disk: SharedDisk) -> None:
        self.world, self.disk = world, disk
        self.hosts = {name: Host(name, world.now) for name in NAMES}
        first, second = self.hosts.values()
        self.leader = self._new_leader(first, disk.row.epoch, world.now)
        self.formers: list[FormerLeader] = []
        self.numbers = [(disk.row.epoch, first.name)]
        self._waits = {second.name}
        self._handing = False
        world.hosts, world.plant_process.gate = self, self._look_before_it_leaves
        disk.writes = world.moment.writes
        self._tend(first)
        self._tend(second)

    def kill(self) -> None:
        """Kill the process that leads, and its bridge with it."""
        world = self.world
        if world.is_on(PLANT) and not (world.is_stalled(PLANT) or world.is_stalled(BRIDGE)):
            world.plant_process.stop()
            world.stop_bridge()

    def hand_over(self) -> None:
        """Ask for a planned change of leaders; without a waiting process nothing happens."""
        if self._waits:
            self.disk.row.wanted = self.world.now

    # --- what each host does again and again ---

    def _tend(self, host: Host) -> None:
        """Renew the leader's lease, have the waiting process look, start ended ones again after a while."""
        world = self.world
        if host.name in self._waits:
            self._look(host)
            period_s = LOOK_S
        elif host is self.leader.host and (world.is_on(PLANT) or world.plant_process.is_ending):
            self._renew(self.leader)
            period_s = RENEW_S
        elif any(each.process.host is host and not each.over for each in self.formers):
            period_s = LOOK_S
        else:
            self._see_off(host)
            period_s = BACK_S
        world.at(world.now + period_s / host.rate, lambda _: self._tend(host))

    def _see_off(self, host: Host) -> None:
        if host is self.leader.host and self.world.bridge is not None and not self.world.is_on(PLANT):
            self.world.stop_bridge()
        self.formers = [each for each in self.formers if not each.over]
        self.world.at(self.world.now + BACK_S / 2, lambda _: self._wait(host))

    def _wait(self, host: Host) -> None:
        if host is not self.leader.host or not self.world.is_on(PLANT):
            self._waits.add(host.name)

    def _renew(self, process: Process) -> None:
        world, host = self.world, process.host
        frozen = world.is_stalled(PLANT) and world.is_stalled(BRIDGE)
        if not frozen and not world.plant_process.is_ending and host.reaches:
            sent_at = host.clock(world.now)
            world.at(world.now + host.delay_s / 2, lambda _: self._renewed(process, sent_at))

    def _renewed(self, process: Process, sent_at: float) -> None:
        """Take in that a lease was renewed; it counts from the time before the statement was sent."""
        if process is not self.leader or not self.world.is_on(PLANT):
            return
        wanted = self.disk.row.renew(process.epoch, self.world.now)
        if wanted is None or not process.host.hears:
            return
        process.lease.renewed(sent_at)
        if wanted and not self._handing:
            self._handing = True
            self._hold_all()

    def _look(self, host: Host) -> None:
        if not host.hears:
            return
        looked_at, lease = host.clock(self.world.now), self.disk.row.lease_state
        if host.silence.ends_lease(looked_at, lease) or lease[1] is None:
            self.world.at(self.world.now + host.delay_s, lambda _: self._lead(host, looked_at, lease))

    # --- a change of leaders ---

    def _lead(self, host: Host, looked_at: float, lease: tuple[int, float | None]) -> None:
        row, now = self.disk.row, self.world.now
        if host.name not in self._waits or not host.reaches:
            return
        row.end_lease(lease)
        proposed = max(0, round(now + host.wall_s))
        if (got := row.lead(proposed, now)) is None or not host.hears:
            return
        epoch, going = got
        before, left = self.leader, change_leaders(self.world, epoch)
        if left is not None:
            self.formers.append(FormerLeader(self.world, self.disk, before, left))
        self.leader = self._new_leader(host, epoch, looked_at)
        self.numbers.append((epoch, host.name))
        self._waits.discard(host.name)
        self._handing = False
        for process in (PLANT, BRIDGE):
            self.world.stall(process, STARTS_S)
        self._go_on(epoch, [*going], now + HEARD_S)

    def _new_leader(self, host: Host, epoch: int, requested_at: float) -> Process:
        leader = Process(host, epoch)
        leader.lease.renewed(requested_at)
        self.disk.writer = leader
        return leader

    def _look_before_it_leaves(self, message: Command | Heartbeat) -> None:
        """Check each message before it leaves; an unsure leader lets nothing out, and ends."""
        standing = self.leader.confirm(self.disk.row, self.world.now)
        if standing is Standing.UNSURE:
            raise StoreUnreachable("the store cannot be reached")
        if not may_leave(message, standing):
            raise StoreRefused("another process leads the plant now: this one steps down")

    # --- a planned change ---

    def _hold_all(self) -> None:
        held = at_work(self._states)
        for name in held:
            self.world.request_verb(Verb.HOLD, name)
        self._give_back_once_held(self.leader, held, self.world.now + HELD_S)

    def _give_back_once_held(self, process: Process, held: list[str], patience: float) -> None:
        world = self.world
        if process is not self.leader or not world.is_on(PLANT):
            return
        frozen = world.is_stalled(PLANT) or world.is_stalled(BRIDGE)
        stand = world.plant.now > patience - HELD_S and all_stand(self._states, held)
        if frozen or (not stand and world.now < patience):
            world.at(world.now + LOOKS_S, lambda _: self._give_back_once_held(process, held, patience))
        else:
            if process.host.reaches:
                self.disk.row.hand_over(process.epoch, held)
            self.kill()
            if process.host.reaches:
                self.disk.row.give_back(process.epoch)

    def _go_on(self, epoch: int, cells: list[str], until: float) -> None:
        """Resume what was held for the change alone, once its robots are heard."""
        world = self.world
        if not cells or epoch != self.leader.epoch or not world.is_on(PLANT) or world.now > until:
            return
        if world.plant_process.has_stepped and not world.is_stalled(PLANT):
            for name in list(cells):
                request = OperatorRequest(at=world.now, verb=Verb.RESUME, scope=name)
                if world.plant.refusal(request) is None:
                    world.request_verb(Verb.RESUME, name)
                    cells.remove(name)
        world.at(world.now + LOOKS_S, lambda _: self._go_on(epoch, cells, until))

    @property
    def _states(self) -> dict[str, str]:
        return {name: run.state for name, run in self.world.plant.cells.items()}
