"""Shared zones as one cell uses them: asked for before a way, given back once its robot is seen outside."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import filterfalse

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.zones import Zones
from arboleda.model.commands import Command
from arboleda.model.messages import Failure, Reason
from arboleda.model.plant_model import Cell, is_homed_by_word
from arboleda.model.sentence import Phrase

from .cell_devices import CellDevices
from .cell_robots import CellRobots
from .interlocks import Interlocks
from .parts import Parts
from .zone_needs import ZoneNeeds

NOT_HELD = Phrase(
    "zone.not_held", "{robot} does not hold zone {zones}, into which this leads; nothing was sent"
)
ASTRAY = Phrase("zone.astray", "{arm} is not seen at a pose outside the shared zones; home {arm} mends that")
ASTRAY_BY_HAND = Phrase(
    "zone.astray_by_hand",
    "{arm} is not seen at a pose outside the shared zones; "
    "home {arm} --by-hand, once it stands at its reference, mends that",
)
ASTRAY_SHARED = Phrase(
    "zone.astray_shared", "{arm}, which cells share, is not seen at its home; home {arm} mends that"
)
ASTRAY_SHARED_BY_HAND = Phrase(
    "zone.astray_shared_by_hand",
    "{arm}, which cells share, is not seen at its home; "
    "home {arm} --by-hand, once it stands at its reference, mends that",
)


class CellZones:
    """Zones of the robots and machines of one cell; `at_work(holder)`: the holder's work ends by itself."""

    def __init__(
        self,
        cell: Cell,
        dispatcher: Dispatcher,
        zones: Zones,
        devices: CellDevices,
        robots: CellRobots,
        parts: Parts,
        at_work: Callable[[str], bool],
    ) -> None:
        self.interlocks = Interlocks(cell, dispatcher)
        self.needs = ZoneNeeds(cell, dispatcher.whereabouts, robots, parts)
        self._cell = cell
        self._dispatcher = dispatcher
        self._zones = zones
        self._devices = devices
        self._robots = robots
        self._parts = parts
        self._at_work = at_work
        self._occupied: dict[str, frozenset[str]] = {}  # by interlocked device, as last seen

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on."""
        self._cell = cell
        self.needs.revise(cell)

    def held_by(self, robot: str) -> frozenset[str]:
        """The zones that a robot, or a machine, holds."""
        return self._zones.held_by(robot)

    def take(self, robot: str, zones: frozenset[str], *, inside: bool = False) -> bool:
        """Ask for zones, all at once; True once the robot has them.

        `inside`: a robot in a zone goes on with the zones that it holds, to get out, unless an override has
        freed one of them. A robot outside that still holds a part of the zones, after an override or a
        restart, gives that part back and asks for all.
        """
        held = self._zones.held_by(robot)
        if not held:
            taken = self._zones.acquire(robot, zones)
        elif robot not in self._cell.workspaces and not zones <= held:
            trusted = not any(map(self._zones.is_quarantined, held))
            taken = trusted and self._zones.acquire(robot, zones, moves_over=True)
        else:
            taken = self._zones.regain(robot, zones) if inside else zones <= held
            if not (taken or inside) and robot in self._zones.robbed and self.leave(robot):
                taken = self._zones.acquire(robot, zones)
        if taken:
            self._remember(robot)
        return taken

    def claim(self, robot: str) -> None:
        """Take every zone that a robot may get into, for a way from an unknown place; all must be free."""
        self._claim(robot, self._cell.workspaces[robot].zones)

    def enter(self, command: Command) -> None:
        """Have a machine hold the zones that a command may lead it into; all must be free."""
        self._claim(command.robot, self.needs.of(command))

    def claim_free(self, robot: str) -> None:
        """Take the free zones of those that a robot may get into."""
        zones = self._cell.workspaces[robot].zones
        self._claim(robot, frozenset(zone for zone in zones if self._zones.holder(zone) is None))

    def taken_by_others(self, robot: str) -> dict[str, str]:
        """The zones that a robot may get into and another robot occupies, each with that robot.

        A robot of this cell that is seen outside of its zones occupies none.
        """
        space = self._cell.workspaces.get(robot)
        awaited = {} if space is None else self.awaited(robot, space.zones)
        return {zone: holder for zone, holder in awaited.items() if not self._is_outside(holder)}

    def make_room(self, robot: str) -> None:
        """Have a robot hold every zone that it may get into; others of the cell give back what they left."""
        space = self._cell.workspaces.get(robot)
        if space is None or not space.zones:
            return
        for holder in {*self.awaited(robot, space.zones).values()}:
            self.leave(holder)
        self._claim(robot, space.zones)

    def leave(self, robot: str) -> bool:
        """Stop waiting for zones, and give back those that a robot is seen outside of; True once it has none.

        A command that is done proves nothing here: the robot's place has to be reported after its last stop.
        """
        granted = self._zones.withdraw(robot)
        held = self._seen_outside(robot, self._zones.held_by(robot))
        if held:
            granted += self._zones.give_back(held)
            self._dispatcher.memory.vacate(held)
            self._dispatcher.wake(self._zones.robbed)
        self._dispatcher.wake(granted)
        return not self._zones.held_by(robot)

    def objection(self, command: Command) -> Failure | None:
        """Objection, whatever the tree does, to a command into a zone that its robot does not hold."""
        needed = self.needs.of(command)
        missing = needed - self._zones.held_by(command.robot)
        if not missing:
            if needed and command.robot in self._cell.interlocked:  # it may be over before `follow` looks
                self._occupied[command.robot] = self._occupied.get(command.robot, frozenset()) | needed
            return None
        sentence = NOT_HELD(robot=command.robot, zones=tuple(sorted(missing)))
        return Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=sentence)

    def astray(self) -> tuple[str, Failure] | None:
        """A robot that is not seen outside the shared zones, so that it may not set out; and why.

        A shared robot that no other cell holds has to be at home, even without shared zones.
        """
        for robot in self._cell.shared_movers:
            if not (self._devices.is_lent(robot) or self._devices.hand_over.is_home(robot)):
                known = self._dispatcher.beliefs[robot].robot
                says_homed = known.says_homed and not is_homed_by_word(known)
                astray = ASTRAY_SHARED if says_homed else ASTRAY_SHARED_BY_HAND
                return robot, Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=astray(arm=robot))
        for robot in self._cell.zone_users:
            if robot in self._cell.shared:
                continue
            space, belief = self._cell.workspaces[robot], self._dispatcher.beliefs[robot]
            unknown = not belief.supervised and robot not in self._dispatcher.whereabouts.reached
            if unknown or self._dispatcher.whereabouts.place(space) is not None:
                continue
            says_homed = belief.robot.says_homed and not is_homed_by_word(belief.robot)
            astray = ASTRAY if says_homed else ASTRAY_BY_HAND
            return robot, Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=astray(arm=robot))
        return None

    def awaited(self, robot: str, zones: Iterable[str]) -> dict[str, str]:
        """The zones of these that another robot holds, each with its holder."""
        return self._zones.awaited(robot, zones)

    def asked_before(self, robot: str) -> tuple[str, str] | None:
        """A zone that a waiting robot asked for, and the first of those that asked for it before."""
        return self._zones.queue.asked_before(robot)

    def kept_by_machine(self, robot: str, zones: Iterable[str]) -> tuple[str, tuple[str, ...]] | None:
        """A machine at rest that occupies one of these zones, and the facts that it would have to report."""
        zones = frozenset(zones)
        for holder in self.awaited(robot, zones).values():
            if holder in self._cell.interlocked and (facts := self.interlocks.in_the_way(holder, zones)):
                return holder, facts
        return None

    def awaited_by_recovery(self) -> dict[str, str]:
        """The zones that a recovery would wait for, with their holders; a robot in a zone waits for none."""
        awaited: dict[str, str] = {}
        for robot in filter(self._devices.has, self._cell.zone_users):
            if not self._zones.held_by(robot) or robot in self._zones.robbed:
                awaited |= self.awaited(robot, self.needs.for_recovery(robot))
        return awaited

    def will_come_free(self, robot: str) -> bool:
        """True where all zones that a robot waits for come free without help: everybody before it is at work.

        A holder whose cell waits for zones counts as no help: it may wait for this robot.
        """
        requests = dict(self._zones.queue.waiting)
        zones = requests.get(robot)
        if zones is None or any(self._zones.is_quarantined(zone) for zone in zones):
            return False
        holders = self.awaited(robot, zones).values()
        cells_of = self._dispatcher.model.cells_of
        cells = [cell for holder in holders for cell in cells_of.get(holder, ())]
        waits = any(user in requests for cell in cells for user in (cell.name, *cell.zone_users))
        return not waits and all(map(self._at_work, (*holders, *self._zones.queue.ahead_of(robot))))

    def is_quarantined(self, zone: str) -> bool:
        """True while a silent robot may be in a zone."""
        return self._zones.is_quarantined(zone)

    def follow(self, device: str) -> None:
        """Give an interlocked device the free zones that it occupies, and take back those that it left."""
        occupied, before = self.interlocks.occupied_by(device), self._occupied.get(device, frozenset())
        self._occupied[device] = occupied
        if self._dispatcher.beliefs[device].online:
            self._zones.lift_quarantine(device)
        free = frozenset(zone for zone in occupied if self._zones.holder(zone) is None)
        if free:
            self._claim(device, free)
        if before - occupied:
            self.leave(device)

    def is_for_task(self, zone: str) -> bool:
        """True for a zone that a machine holds for the task of this cell, and does not occupy."""
        holder = self._zones.holder(zone)
        return holder in self._cell.interlocked and zone not in self.interlocks.occupied_by(holder)

    def forsake(self) -> None:
        """Give back the zones that machines hold for a task and do not occupy, now or by their commands."""
        self.interlocks.reserved = {}
        for machine in filterfalse(self._devices.is_lent, self._cell.interlocked):
            self.leave(machine)

    def _seen_outside(self, robot: str, held: frozenset[str]) -> frozenset[str]:
        """The zones of these that a robot, or a machine, is seen outside of."""
        space = self._cell.workspaces.get(robot)
        if space is None:
            return self.interlocks.left_by(robot, held)
        return held if self._dispatcher.whereabouts.place(space) is not None else frozenset()

    def _is_outside(self, robot: str) -> bool:
        """True for a robot of this cell that is seen outside of all zones."""
        space = self._cell.workspaces.get(robot)
        return space is not None and self._dispatcher.whereabouts.place(space) is not None

    def _claim(self, robot: str, zones: frozenset[str]) -> None:
        self._zones.claim(robot, zones)
        self._remember(robot)

    def _remember(self, robot: str) -> None:
        self._dispatcher.memory.occupy(self._zones.held_by(robot), robot)
