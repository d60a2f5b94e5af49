"""What the leaves of a cell's trees may touch."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from py_trees.behaviour import Behaviour

from arboleda.dispatch.belief import Belief, Moment
from arboleda.dispatch.dispatcher import Dispatcher, Make
from arboleda.dispatch.ledger import Entry
from arboleda.dispatch.zones import Zones
from arboleda.model.commands import Command, Motion, Position, Query
from arboleda.model.facts import Value, shown
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, Failure, Notice, Reason, TaskAnswer
from arboleda.model.plant_model import Cell, Evidence, MotionState, Pose, Timing
from arboleda.model.sentence import Phrase, Sentence

from . import zone_plan
from .handling import Handling
from .trail import Known, Planned, Trail

__all__ = ["Context", "Make"]
MOST_ANSWERS = 100  # that are kept of a task
PART_LOST = Phrase("part.lost", "{arm}: the part was lost on the way")
NOT_HELD = Phrase(
    "zone.not_held", "{robot} does not hold zone {zones}, into which this leads; nothing was sent"
)
DEVICE_NOT_HELD = Phrase(
    "device.not_held", "{cell} does not hold {device}, which cells share; nothing was sent"
)
DEVICE_OF_OTHER = Phrase(
    "device.of_other", "{cell} does not hold {device}, which {holder} holds; nothing was sent"
)
DEVICE_NOT_RESET = Phrase(
    "device.not_reset", "{device} was stopped, and a cell that was stopped with it is not reset"
)
ASTRAY = Phrase("zone.astray", "{arm} is not seen at a pose outside the shared zones; home {arm} mends that")
ASTRAY_BY_HAND = Phrase(
    "zone.astray_by_hand",
    "{arm} is not seen at a pose outside the shared zones; "
    "home {arm} --by-hand, once it stands at its reference, mends that",
)


class Context:
    """A cell's own time, and its ways to send, cancel, wait, ask and fail.

    The cell's time stands still while the cell is held, so what waits in a tree waits on. `next_deadline`
    is when the tree is to be woken, s of the plant's time; None while held.
    """

    def __init__(
        self,
        cell: Cell,
        dispatcher: Dispatcher,
        zones: Zones,
        clock: Callable[[], float],
        at_work: Callable[[str], bool],
    ) -> None:
        self.cell = cell
        self.timing: Timing = dispatcher.model.timing
        self.wakes: list[float] = []
        self.next_deadline: float | None = None
        self.sent = 0
        self.awaits_piece = False  # for a report newer than the last one that had it
        self.carrier: str | None = None  # who is on its way with a part that was seen in its effector
        self.delivers = True  # what runs is work; a recovery does what is left to do without the part, too
        self.back: dict[str, Pose] = {}  # where what a robot holds came from, as far as this is known here
        self.origins: set[str] = set()  # the robots whose place in `back` is where they last went empty
        self.used: set[str] = set()  # the robots that the task has told to do something
        self.handling = Handling(dispatcher.beliefs)
        self.answers: list[TaskAnswer] = []  # those of the task that runs
        self.as_planned: Planned | None = None  # where robots count as standing, while a tree is made anew
        self._occupied: dict[str, frozenset[str]] = {}  # by interlocked device, as it was seen last
        self._reserved: Mapping[str, Sequence[str]] = {}  # what a task of an earlier start had taken for them
        self.failure: Failure | None = None
        self.failed_leaf: Behaviour | None = None
        self.last_failure: Failure | None = None
        self._dispatcher = dispatcher
        self._zones = zones
        self._clock = clock
        self._at_work = at_work  # whether what a robot does comes to an end by itself
        self._paused_s = 0.0
        self._paused_at: float | None = None

    @property
    def now(self) -> float:
        """The cell's time, s."""
        at = self._clock() if self._paused_at is None else self._paused_at
        return at - self._paused_s

    @property
    def plant_now(self) -> float:
        """The plant's time, s; it never stands still."""
        return self._clock()

    def pause(self, at: float | None = None) -> None:
        """The cell's time stands still from now on, or since `at`, s of the plant's time."""
        if self._paused_at is None:
            self._paused_at = self._clock() if at is None else at
            self._plan()

    def go_on(self) -> None:
        """The cell's time passes again."""
        if self._paused_at is not None:
            self._paused_s += self._clock() - self._paused_at
            self._paused_at = None
            self._plan()

    def woken(self) -> bool:
        """Whether a time that the tree waits for has come; each is told once, and none while held."""
        if self.next_deadline is None or min(self.wakes) > self.now:
            return False
        now = self.now
        self.wakes = [at for at in self.wakes if at > now]
        self._plan()
        return True

    def start_afresh(self) -> None:
        """Forget what the last tree waited for and why it failed."""
        self.wakes, self.awaits_piece, self.carrier = [], False, None
        self.used = set()
        self.handling.begin()
        self.delivers = True
        for robot in self.cell.holders:
            self._dispatcher.opened.pop(robot, None)
        self.failure = self.failed_leaf = self.last_failure = None
        self._plan()

    def send(self, make: Make, doing: Sentence) -> Entry:
        """Send the command that `make(id=...)` returns; an already failed entry where it may not leave."""
        self.sent += 1
        entry = self._dispatcher.send(make, self.cell.name, doing, self._clock(), barrier=self._barrier)
        if not isinstance(entry.command, Query):
            self.used.add(entry.command.robot)
        return entry

    def note(self, answer: TaskAnswer) -> None:
        """Keep what was answered with the task that runs; of very many the last ones."""
        self.answers.append(answer)
        del self.answers[:-MOST_ANSWERS]

    def _barrier(self, command: Command) -> Failure | None:
        """Why a command must not leave, whatever the tree says: it leads into a zone that is not held."""
        if (stop := self._not_reset(command.robot)) is not None:
            return stop
        if (other := self._device_of_other(command.robot)) is not None:
            return Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=other)
        missing = self._zones_of(command) - self._zones.held_by(command.robot)
        if not missing:
            return None
        sentence = NOT_HELD(robot=command.robot, zones=tuple(sorted(missing)))
        return Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=sentence)

    def _not_reset(self, device: str) -> Failure | None:
        """Why nothing may use a shared device yet, though its stop is cleared."""
        if device not in self.cell.shared or not self.is_stopped(device):
            return None
        return Failure(reason=Reason.STOPPED, sentence=DEVICE_NOT_RESET(device=device))

    def _device_of_other(self, device: str) -> Sentence | None:
        """Why a cell may not command a device that it shares: it does not hold it now."""
        holder = self._zones.holder(device) if device in self.cell.shared else self.cell.name
        if holder == self.cell.name:
            return None
        if holder is None:
            return DEVICE_NOT_HELD(cell=self.cell.name, device=device)
        return DEVICE_OF_OTHER(cell=self.cell.name, device=device, holder=holder)

    def _zones_of(self, command: Command) -> frozenset[str]:
        """The zones that its robot has to hold for a command."""
        space = self.cell.workspaces.get(command.robot)
        if space is not None and isinstance(command, Motion) and command.way:
            return zone_plan.entered(space, self._dispatcher.place(space), command.way)
        locks = self.cell.interlocks_of(command.robot)
        return frozenset(each.zone for each in locks if each.is_ended_by(command))

    def cancel(self, entry: Entry) -> None:
        """Halt an open command."""
        self._dispatcher.cancel(entry, self._clock())

    def cancel_all(self) -> None:
        """Ask every command of the cell to end; what moves is halted."""
        self._dispatcher.cancel_all(self.cell.name, self._clock())

    def cancel_motions(self) -> None:
        """Halt what can be halted; an effector may finish switching, a machine its work."""
        for entry in self.open_commands():
            if entry.halts and entry.cancelled_at is None:
                self.cancel(entry)

    def open_commands(self) -> list[Entry]:
        """The cell's commands that have not ended."""
        return self._dispatcher.ledger.of_cell(self.cell.name)

    def position(self, robot: str) -> Position | None:
        """Where a robot is known to be."""
        if self.as_planned is not None:
            return self.as_planned.positions.get(robot)
        return self._dispatcher.beliefs[robot].known_position

    def obstacle(self, robot: str, *, was: bool = False) -> Failure | None:
        """Why a robot takes no command now; `was`: in words that stay true.

        That a shared device moves is none: another cell may be using it.
        """
        shares = robot in self.cell.shared and robot not in self._dispatcher.latched
        if shares and (stop := self._not_reset(robot)) is not None:
            return stop
        if shares and self._dispatcher.beliefs[robot].moves:
            return None
        return self._dispatcher.obstacle(robot, was=was)

    def obstacle_at_work(self, robot: str) -> Failure | None:
        """The same for a robot of a cell at work: that it moves is none."""
        return None if self._dispatcher.beliefs[robot].moves else self.obstacle(robot)

    def obstacle_besides_stop(self, robot: str) -> Failure | None:
        """The same, were it not stopped."""
        return self._dispatcher.beliefs[robot].obstacle_besides_stop()

    def says_unhomed(self, robot: str) -> bool:
        """Whether a robot's board says that it is not homed."""
        return self._dispatcher.beliefs[robot].says_unhomed

    def is_displaced(self, robot: str) -> bool:
        """Whether a robot must have rebooted and cannot say so, until somebody says that it is homed."""
        return self._dispatcher.beliefs[robot].displaced

    def homes_by_routine(self, robot: str) -> bool:
        """Whether a robot finds its reference by itself; else somebody puts it there and says so."""
        belief = self._dispatcher.beliefs[robot]
        return belief.robot.evidence is Evidence.IDS and (belief.robot.says_homed or belief.says_unhomed)

    def moves(self, robot: str) -> bool:
        """Whether a robot says that it is still moving."""
        return self._dispatcher.beliefs[robot].moves

    def fact(self, robot: str, name: str) -> Value | None:
        """What a robot says of a fact; None where it said nothing, or is not heard."""
        belief = self._dispatcher.beliefs[robot]
        return belief.fact(name) if belief.online else None

    def grip(self, robot: str) -> Grip:
        """What the effector of a robot that has one is known to be."""
        return self._dispatcher.grips[robot]

    @property
    def holding(self) -> list[str]:
        """The robots of the cell in whose effector a part may hang."""
        return [robot for robot in self.cell.holders if self._dispatcher.grips.holding(robot)]

    def told(self, robot: str) -> Entry | None:
        """The first command that a robot has not ended."""
        return next(iter(self._dispatcher.ledger.of_robot(robot)), None)

    @property
    def unopened(self) -> list[str]:
        """Those of them that were told last to let go, and could not."""
        return [robot for robot in self.holding if robot in self._dispatcher.unopened]

    def obstacle_to_opening(self, robot: str) -> Failure | None:
        """Why a robot cannot be told now to let go."""
        return self._dispatcher.obstacle_to_opening(robot)

    def opening_tool(self, robot: str) -> str | None:
        """The tool of a robot that may still let go of a part because it was told to."""
        return self._dispatcher.opening_tool(robot)

    @property
    def stored(self) -> frozenset[int]:
        """The stations with a part: put there, and not said to have been taken out."""
        kept = (self._dispatcher.kept(Fact.STORED, self.cell.name) or "").split()
        return frozenset(number for number in range(len(self.cell.stations)) if str(number) in kept)

    def store(self, pose: Pose) -> None:
        """A part was put down at a pose; where that is a station, it stays there."""
        numbers = {number for number, station in enumerate(self.cell.stations) if station.name == pose.name}
        self._keep_stored(self.stored | numbers)

    def store_where(self, robot: str) -> None:
        """A part was put down where a robot stands; where that is a station, it stays there."""
        here, device = self.position(robot), self.cell.reach[robot].robot
        for station in self.cell.stations:
            if here is not None and device.stands_at(here, device.held_at(station.q)):
                self.store(station)

    def unload(self, station: int | None = None) -> None:
        """Somebody has taken the part out of a station, or of all."""
        self._keep_stored(frozenset() if station is None else self.stored - {station})

    def _keep_stored(self, numbers: frozenset[int]) -> None:
        value = " ".join(map(str, sorted(numbers))) or None
        self._dispatcher.remember(Fact.STORED, self.cell.name, value)

    def part_lost(self) -> Failure | None:
        """Why the part that is being carried is no longer there, by the word of the piece sensor."""
        robot = self.carrier
        if robot is None or self.piece(robot, 0.0) is not False:
            return None
        return Failure(reason=Reason.PART_LOST, sentence=PART_LOST(arm=robot))

    @property
    def lost_by(self) -> str | None:
        """The robot whose effector opened with a part in it, and this plant did not say so."""
        return next((robot for robot in self.cell.holders if robot in self._dispatcher.opened), None)

    def part_gone(self) -> Failure | None:
        """Why a part that was gripped is lost."""
        robot = self.lost_by
        if robot is None or not self.delivers or self.failure is not None:
            return None
        return Failure(reason=Reason.PART_LOST, sentence=self._dispatcher.opened[robot])

    def recovery_zones(self, robot: str) -> frozenset[str]:
        """What the way of a recovery needs, from where the robot stands now."""
        space = self.cell.workspaces[robot]
        place, back = self._dispatcher.place(space), self.way_back(robot)
        between = self.zones_between(robot, *((back,) if back else ()), space.home)
        return zone_plan.recovery_zones(space, place, back) | between

    def zones_between(self, robot: str, *goals: Pose) -> frozenset[str]:
        """The zones that a robot comes by to each of these poses from where it is, which may be no pose."""
        space, here = self.cell.reach[robot], self.position(robot)
        return frozenset[str]().union(*(zone_plan.passed(space, here, goal.q) for goal in goals))

    def way_back(self, robot: str) -> Pose | None:
        """Where a recovery brings what a robot holds: back where it came from, else as the cell says."""
        if robot in self.origins and self.cell.workspaces[robot].hand.name not in self.holding:
            return None  # it went there, and took nothing
        return self.back.get(robot) or self.cell.back(robot, self.position)

    def standing(self, robot: str) -> Pose:
        """The zone-free pose at which a robot's next way begins: where it is seen, else home."""
        space = self.cell.workspaces[robot]
        if self.as_planned is not None:
            name = self.as_planned.standing.get(robot)
            return next((pose for pose in space.poses if pose.name == name), space.home)
        return self._dispatcher.place(space) or space.home

    def planned(self) -> Planned:
        """Where its robots stand now, as a recipe may plan by it."""
        standing = {robot: self.standing(robot).name for robot in self.cell.workspaces}
        known = {robot: self.position(robot) for robot in self.cell.reach}
        return Planned(
            standing=standing, positions={name: at for name, at in known.items() if at is not None}
        )

    def take_over(self, trail: Trail) -> None:
        """The task of an earlier start stands there; its time stands still until somebody says more."""
        self.start_afresh()
        self.pause()
        self.carrier, self.origins, self.used = trail.carrier, set(trail.origins), set(trail.used)
        self.handling.begin(trail.taken, trail.unchecked)
        self.answers[:] = trail.answers
        self._reserved = trail.zones
        poses = {robot: {pose.name: pose for pose in space.poses} for robot, space in self.cell.reach.items()}
        named = {robot: poses.get(robot, {}).get(name) for robot, name in trail.back.items()}
        self.back = {robot: pose for robot, pose in named.items() if pose is not None}

    def leave_unsettled(self, robot: str, *, told: Mapping[str, Value]) -> None:
        """An earlier start was switching what a robot holds with, to `told`: its change is no news.

        A tool that was told to grip does not let go late.
        """
        if robot in self.cell.holders:
            self._dispatcher.cut_off.add(robot)
            if told.get(self._dispatcher.model.robots[robot].held_fact or ""):
                self._dispatcher.grips.forget_opening(robot)

    def forsake(self) -> None:
        """The task cannot go on: what its machines keep for it and are not in the way of is given back."""
        self._reserved = {}
        for machine in self.cell.interlocked:
            self.leave_zones(machine)

    def keeps_for_task(self, zone: str) -> bool:
        """Whether a zone is held for the task of this cell alone, by a machine that is not in its way."""
        holder = self._zones.holder(zone)
        return holder in self.cell.interlocked and zone not in self.occupied_by(holder)

    def settle(self) -> None:
        """What was being switched when an earlier start ended is as it is said now."""
        self._reserved = {}
        for robot in self._dispatcher.cut_off.intersection(self.cell.holders):
            self._dispatcher.settle_grip(robot)

    def belief(self, robot: str) -> Belief:
        """What is known of a robot."""
        return self._dispatcher.beliefs[robot]

    def has(self, robot: str) -> bool:
        """Whether a robot is the cell's now: its own, or a shared one that it holds."""
        return robot in self.cell.own or (robot in self.cell.shared and self.has_device(robot))

    def zones_of(self, robot: str) -> frozenset[str]:
        """The zones that a robot, or a machine, holds."""
        return self._zones.held_by(robot)

    @property
    def numbered(self) -> list[str]:
        """The robots of the cell whose boards number their commands, and have been heard."""
        beliefs = [self._dispatcher.beliefs[robot.name] for robot in self.cell.reached]
        return [each.robot.name for each in beliefs if each.numbers_commands]

    def known(self, robot: str) -> Known:
        """What a robot has told of its commands, as it is kept."""
        return Known.of(self._dispatcher.beliefs[robot], self._dispatcher.unnamed.of(robot))

    def moments(self) -> dict[str, Moment]:
        """Now, as each robot of the cell tells the time, for `moving_since`."""
        beliefs = self._dispatcher.beliefs
        return {robot.name: beliefs[robot.name].moment(self._clock()) for robot in self.cell.robots}

    def moving_since(self, moments: dict[str, Moment]) -> list[str]:
        """The online robots of the cell not seen still since then; who finishes its work may move."""
        ending = [name for name in moments if not self._dispatcher.finishes(name)]
        beliefs = {name: self._dispatcher.beliefs[name] for name in ending}
        return [name for name, b in beliefs.items() if b.online and not b.still_since(moments[name])]

    def reports_a_latch(self) -> bool:
        """Whether an online robot of the cell still says that it is stopped and latched."""
        stopped = self._dispatcher.latched  # by another cell, where a cell that was cleared shares them
        names = [robot.name for robot in self.cell.robots if robot.name not in stopped]
        beliefs = [self._dispatcher.beliefs[name] for name in names]
        return any(belief.online and belief.state is MotionState.STOP_LATCHED for belief in beliefs)

    def risen(self, robot: str) -> Position:
        """Where a robot stands, lifted as high as its highest approach; home where unknown."""
        space, here = self.cell.workspaces[robot], self.position(robot)
        heights = [pose.above for pose in space.poses if pose.above]
        return space.robot.lifted(here, heights) if here is not None and heights else space.home.q

    def piece(self, robot: str, since: float) -> bool | None:
        """The debounced word of a robot's piece sensor, fresh since then; None while there is none."""
        belief = self._dispatcher.beliefs[robot]
        fresh = belief.robot.piece_on_change or belief.piece_at - self._paused_s >= since
        self.awaits_piece = self.awaits_piece or not fresh  # a change of a fresh word wakes the tree anyway
        if belief.piece is None or not (belief.senses_pieces and belief.online and fresh):
            return None
        settled_at = belief.piece_since + self.timing.piece_debounce_s - self._paused_s
        if self.now < settled_at:
            self.wake_at(settled_at)
            return None
        return belief.piece

    def astray(self) -> tuple[str, Failure] | None:
        """A robot that shares zones and is not seen outside them, so that no way of it may begin, and why."""
        for robot in self.cell.zone_users:
            space, belief = self.cell.workspaces[robot], self._dispatcher.beliefs[robot]
            unknown = not belief.supervised and robot not in self._dispatcher.reached
            if unknown or self._dispatcher.place(space) is not None:
                continue
            astray = ASTRAY if belief.robot.says_homed else ASTRAY_BY_HAND
            return robot, Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=astray(arm=robot))
        return None

    def take_zones(self, robot: str, zones: frozenset[str], *, inside: bool = False) -> bool:
        """Ask for zones, all at once; whether the robot has them.

        `inside`: a robot that stands in a zone may go on with what it holds, to get out, unless an operator
        has freed a part of that meanwhile.
        """
        held = self._zones.held_by(robot)
        if not held:
            taken = self._zones.request(robot, zones)
        elif robot not in self.cell.workspaces and not zones <= held:
            heard = not any(map(self._zones.is_quarantined, held))
            taken = heard and self._zones.request(robot, zones, moves_over=True)
        else:
            taken = self._zones.regain(robot, zones) if inside else zones <= held
        if not taken:
            return False
        self._keep_zones(robot)
        return True

    def will_come_free(self, robot: str) -> bool:
        """Whether all that a robot waits for comes free without anybody's help: who is before it is at work.

        Whoever holds a zone and waits, for another arm of its cell, may wait for this one.
        """
        asked = dict(self._zones.waiting)
        zones = asked.get(robot)
        if zones is None or any(self._zones.is_quarantined(zone) for zone in zones):
            return False
        holders = self.awaited_zones(robot, zones).values()
        cells_of = self._dispatcher.model.cells_of
        cells = [cell for holder in holders for cell in cells_of.get(holder, ())]
        waits = any(user in asked for cell in cells for user in (cell.name, *cell.zone_users))
        return not waits and all(map(self._at_work, (*holders, *self._zones.ahead_of(robot))))

    def awaited_zones(self, robot: str, zones: Iterable[str]) -> dict[str, str]:
        """Those of the zones that somebody else holds, and who."""
        holders = {zone: self._zones.holder(zone) for zone in zones}
        return {zone: other for zone, other in holders.items() if other is not None and other != robot}

    def awaited_by_recovery(self) -> dict[str, str]:
        """The zones that a recovery would wait for, and who holds them; inside its zones it needs no more."""
        awaited: dict[str, str] = {}
        for robot in self.cell.zone_users:
            if not self._zones.held_by(robot) or robot in self._zones.robbed:
                awaited |= self.awaited_zones(robot, self.recovery_zones(robot))
        return awaited

    def is_quarantined(self, zone: str) -> bool:
        """Whether a silent robot may be in a zone."""
        return self._zones.is_quarantined(zone)

    def claim_zones(self, robot: str) -> None:
        """Take every zone a robot may get into, for a way that begins where nobody knows; it must be free."""
        self._zones.claim(robot, self.cell.workspaces[robot].zones)
        self._keep_zones(robot)

    def _keep_zones(self, robot: str) -> None:
        for zone in sorted(self._zones.held_by(robot)):
            self._dispatcher.remember(Fact.QUARANTINE, zone, robot)

    def occupied_by(self, device: str) -> frozenset[str]:
        """The zones that a device may be in the way of: it does not say the contrary, or was told to be.

        What moves without a command of this plant may be on its way there.
        """
        belief = self._dispatcher.beliefs[device]
        told = [entry.command for entry in self._dispatcher.ledger.of_robot(device)]
        return frozenset(
            each.zone
            for each in self.cell.interlocks_of(device)
            if not belief.online
            or (belief.state is MotionState.MOVING and self._dispatcher.work_of(device) is None)
            or any(belief.fact(name) != value for name, value in each.free_while)
            or any(map(each.is_ended_by, told))
        )

    def in_the_way(self, device: str, zones: Iterable[str]) -> tuple[str, ...] | None:
        """What a device that is heard and does nothing does not say, so that it keeps one of the zones; else
        None.
        """
        belief = self._dispatcher.beliefs[device]
        wanted = self.occupied_by(device).intersection(zones)
        if not belief.online or belief.moves or self._dispatcher.ledger.of_robot(device) or not wanted:
            return None
        unsaid = [
            f"{name} {shown(value)}"
            for each in self.cell.interlocks_of(device)
            if each.zone in wanted
            for name, value in each.free_while
            if belief.fact(name) != value
        ]
        return tuple(dict.fromkeys(unsaid)) or None

    def keep_interlocks(self, device: str) -> None:
        """A device in the way of a zone where nobody is has it; one that no longer is gives it back."""
        occupied, before = self.occupied_by(device), self._occupied.get(device, frozenset())
        self._occupied[device] = occupied
        if self._dispatcher.beliefs[device].online:
            self._zones.is_heard(device)
        free = frozenset(zone for zone in occupied if self._zones.holder(zone) is None)
        if free:
            self._zones.claim(device, free)
            self._keep_zones(device)
        if before - occupied:
            self.leave_zones(device)

    def _left(self, robot: str, held: frozenset[str]) -> frozenset[str]:
        """Those of the zones that a robot, or a machine, is seen outside of."""
        space = self.cell.workspaces.get(robot)
        if space is None:
            return held - self.occupied_by(robot) - frozenset(self._reserved.get(robot, ()))
        return held if self._dispatcher.place(space) is not None else frozenset()

    def leave_zones(self, robot: str) -> bool:
        """Stop waiting for zones, and give them back if the robot is seen outside; whether it holds none."""
        granted = self._zones.withdraw(robot)
        held = self._left(robot, self._zones.held_by(robot))
        if held:
            granted += self._zones.give_back(held)
            for zone in sorted(held):
                self._dispatcher.remember(Fact.QUARANTINE, zone, None)
            self._dispatcher.wake(self._zones.robbed)
        self._dispatcher.wake(granted)
        return not self._zones.held_by(robot)

    def take_devices(self, devices: frozenset[str]) -> bool:
        """Ask for shared devices, all at once; whether the cell has them.

        What a step that failed has left it goes back before: no cell waits for one while it holds another.
        """
        name = self.cell.name
        held = self._zones.held_by(name)
        if devices <= held:
            return True
        if held and not self.leave_devices(held):
            return False
        if not self._zones.request(name, devices):
            return False
        self._keep_zones(name)
        return True

    def leave_devices(self, devices: frozenset[str]) -> bool:
        """Stop waiting for shared devices, and give back those that are heard and do nothing; whether the
        cell holds none of them any more.
        """
        name = self.cell.name
        granted = self._zones.withdraw(name)
        held = self._zones.held_by(name) & devices
        quiet = frozenset(filter(self._does_nothing, held))
        if quiet:
            waiting = tuple(other for other, asked in self._zones.waiting if asked & quiet)
            granted += self._zones.give_back(quiet) + waiting  # who still waits names another holder now
            for device in sorted(quiet):
                self._dispatcher.remember(Fact.QUARANTINE, device, None)
        self._dispatcher.wake(granted)
        return held == quiet

    def has_device(self, device: str) -> bool:
        """Whether the cell holds a device that it shares."""
        return self._zones.holder(device) == self.cell.name

    def is_stopped(self, robot: str) -> bool:
        """Whether a stop of a robot is not over: it is not cleared, or a cell of it is not reset."""
        return self._dispatcher.kept(Fact.LATCH, robot) is not None

    def keep_device(self, device: str, *, ended: bool) -> None:
        """A shared device that the cell holds is quarantined while it is not heard; `ended`: what used it
        has come to its end, so it goes back.
        """
        if not self._dispatcher.beliefs[device].online:
            self._zones.quarantine_device(device)
        elif ended:
            self.leave_devices(frozenset({device}))

    def awaited_device(self, devices: Iterable[str]) -> tuple[str, str, bool] | None:
        """The first of the devices that another cell holds, or asked for before this one; which cell that is,
        and whether it holds it.
        """
        name, asked = self.cell.name, dict(self._zones.waiting)
        for device in sorted(devices):
            holder = self._zones.holder(device)
            if holder not in (None, name):
                return device, holder, True
            ahead = self._zones.ahead_of(name) if name in asked else ()
            if earlier := [other for other in ahead if device in asked[other]]:
                return device, earlier[0], False
        return None

    def _does_nothing(self, device: str) -> bool:
        belief = self._dispatcher.beliefs[device]
        works = belief.moves or bool(self._dispatcher.ledger.of_robot(device))
        return belief.online and not works and device not in self._dispatcher.latched

    def wake_at(self, at: float) -> None:
        """Have the tree ticked again at `at`, s of `now`."""
        self.wakes.append(at)
        self._plan()

    def _plan(self) -> None:
        """Work out the next deadline; rounding must not wake the plant an instant before `now` gets there."""
        if self._paused_at is not None or not self.wakes:
            self.next_deadline = None
            return
        at = min(self.wakes)
        self.next_deadline = at + self._paused_s
        while self.next_deadline - self._paused_s < at:
            self.next_deadline = math.nextafter(self.next_deadline, math.inf)

    def notify(self, notice: Notice) -> None:
        """Tell the outside."""
        self._dispatcher.outbox.append(notice)

    def forgive(self) -> None:
        """A failure that the recipe has an answer to: the task goes on."""
        self.failure = self.failed_leaf = None

    def fail(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        """Name the cause of a failure; the first one named counts. What was carried is now for recovery."""
        if self.failure is None:
            self.failure, self.failed_leaf = failure, leaf
        self.last_failure = failure
        self.carrier = None
