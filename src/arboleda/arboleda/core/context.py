"""What the leaves of a cell's trees may touch."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

from py_trees.behaviour import Behaviour

from . import zone_plan
from .belief import Moment
from .dispatcher import Dispatcher, Make
from .grips import Grip
from .ledger import Entry
from .messages import Fact, Failure, Notice, Reason
from .model import Cell, Evidence, MotionState, Pose, Timing
from .sentence import Phrase
from .zones import Zones

__all__ = ["Context", "Make"]
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

    def __init__(self, cell: Cell, dispatcher: Dispatcher, zones: Zones, clock: Callable[[], float]) -> None:
        self.cell = cell
        self.timing: Timing = dispatcher.model.timing
        self.wakes: list[float] = []
        self.next_deadline: float | None = None
        self.sent = 0
        self.awaits_piece = False  # for a report newer than the last one that had it
        self.carried = False  # a part that was seen in the effector is on its way
        self.delivers = True  # what runs is work; a recovery does what is left to do without the part, too
        self.back: Pose | None = None  # where the part of the last order came from; None: not known here
        self.failure: Failure | None = None
        self.failed_leaf: Behaviour | None = None
        self.last_failure: Failure | None = None
        self._dispatcher = dispatcher
        self._zones = zones
        self._clock = clock
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
        self.wakes, self.awaits_piece, self.carried = [], False, False
        self.delivers = True
        self._dispatcher.opened.pop(self.cell.arm.name, None)
        self.failure = self.failed_leaf = self.last_failure = None
        self._plan()

    def send(self, make: Make, doing: str) -> Entry:
        """Send the command that `make(id=...)` returns; an already failed entry where it may not leave."""
        self.sent += 1
        return self._dispatcher.send(make, self.cell.name, doing, self._clock())

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

    def node(self) -> int | None:
        """Where the cell's mobile robot is known to stand."""
        return self._dispatcher.beliefs[self.cell.mobile.name].known_node

    def obstacle(self, robot: str, *, was: bool = False) -> Failure | None:
        """Why a robot takes no command now; `was`: in words that stay true."""
        return self._dispatcher.obstacle(robot, was=was)

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

    @property
    def grip(self) -> Grip:
        """What the arm's effector is known to be."""
        return self._dispatcher.grips[self.cell.arm.name]

    def holding(self) -> bool:
        """Whether a part may hang in the arm's effector."""
        return self._dispatcher.grips.holding(self.cell.arm.name)

    @property
    def stored(self) -> frozenset[int]:
        """The stations with a part: put there, and not said to have been taken out."""
        kept = (self._dispatcher.kept(Fact.STORED, self.cell.name) or "").split()
        return frozenset(number for number in range(len(self.cell.stations)) if str(number) in kept)

    def store(self, pose: Pose) -> None:
        """The arm has put its part down at a pose; where that is a station, it stays there."""
        numbers = {number for number, station in enumerate(self.cell.stations) if station.name == pose.name}
        self._keep_stored(self.stored | numbers)

    def unload(self, station: int | None = None) -> None:
        """Somebody has taken the part out of a station, or of all."""
        self._keep_stored(frozenset() if station is None else self.stored - {station})

    def _keep_stored(self, numbers: frozenset[int]) -> None:
        value = " ".join(map(str, sorted(numbers))) or None
        self._dispatcher.remember(Fact.STORED, self.cell.name, value)

    def part_gone(self) -> Failure | None:
        """Why the part that was gripped is lost: its effector opened, and this plant did not say so."""
        sentence = self._dispatcher.opened.get(self.cell.arm.name)
        if sentence is None or not self.delivers or self.failure is not None:
            return None
        return Failure(reason=Reason.PART_LOST, sentence=sentence)

    def recovery_zones(self) -> frozenset[str]:
        """What the way of a recovery needs, from where the arm stands now."""
        return zone_plan.recovery_zones(self.cell, self._dispatcher.place(self.cell), self.way_back())

    def way_back(self) -> Pose:
        """Where a recovery brings a part: back where it came from, or to where the mobile robot stands."""
        return self.back or self.cell.pickup_over(self.node())

    def standing(self) -> Pose:
        """The zone-free pose at which the arm's next way begins: where it is seen, else home."""
        return self._dispatcher.place(self.cell) or self.cell.home

    def moments(self) -> dict[str, Moment]:
        """Now, as each robot of the cell tells the time, for `moving_since`."""
        beliefs = self._dispatcher.beliefs
        return {robot.name: beliefs[robot.name].moment(self._clock()) for robot in self.cell.robots}

    def moving_since(self, moments: dict[str, Moment]) -> list[str]:
        """The online robots of the cell that were not seen still since then."""
        beliefs = {name: self._dispatcher.beliefs[name] for name in moments}
        return [name for name, b in beliefs.items() if b.online and not b.still_since(moments[name])]

    def reports_a_latch(self) -> bool:
        """Whether an online robot of the cell still says that it is stopped and latched."""
        beliefs = [self._dispatcher.beliefs[robot.name] for robot in self.cell.robots]
        return any(belief.online and belief.state is MotionState.STOP_LATCHED for belief in beliefs)

    def risen(self) -> tuple[float, ...]:
        """Where the arm stands, its prismatic joints as high as the highest approach; home where unknown."""
        here = self._dispatcher.beliefs[self.cell.arm.name].known_q
        heights = [pose.above for pose in self.cell.poses if pose.above]
        if here is None or not heights:
            return self.cell.home.q
        rows = zip(self.cell.arm.joints, here, *heights, strict=True)
        return tuple(joint.higher(q, *above) for joint, q, *above in rows)

    def piece(self, since: float) -> bool | None:
        """The debounced word of the arm's piece sensor, fresh since then; None while there is none."""
        belief, arm = self._dispatcher.beliefs[self.cell.arm.name], self.cell.arm
        fresh = arm.piece_on_change or belief.piece_at - self._paused_s >= since
        self.awaits_piece = self.awaits_piece or not fresh  # a change of a fresh word wakes the tree anyway
        if belief.piece is None or not belief.online or not fresh:
            return None
        settled_at = belief.piece_since + self.timing.piece_debounce_s - self._paused_s
        if self.now < settled_at:
            self.wake_at(settled_at)
            return None
        return belief.piece

    def astray(self) -> Failure | None:
        """Why no way may begin where the arm stands: in a cell with zones it must be seen outside them."""
        cell, arm = self.cell, self.cell.arm.name
        unknown = not self._dispatcher.beliefs[arm].supervised and arm not in self._dispatcher.reached
        if not self.cell.zones or unknown or self._dispatcher.place(cell) is not None:
            return None
        astray = ASTRAY if cell.arm.says_homed else ASTRAY_BY_HAND
        return Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=astray(arm=arm))

    def take_zones(self, zones: frozenset[str], *, inside: bool = False) -> bool:
        """Ask for zones, all at once; whether the arm has them.

        `inside`: an arm that stands in a zone may go on with what it holds, to get out, unless an operator
        has freed a part of that meanwhile.
        """
        arm = self.cell.arm.name
        held = self._zones.held_by(arm)
        if not held:
            taken = self._zones.request(arm, zones)
        else:
            taken = self._zones.regain(arm, zones) if inside else zones <= held
        if not taken:
            return False
        self._keep_zones()
        return True

    def awaited_zones(self, zones: Iterable[str]) -> dict[str, str]:
        """Those of the zones that somebody else holds, and who."""
        holders = {zone: self._zones.holder(zone) for zone in zones}
        return {zone: arm for zone, arm in holders.items() if arm is not None and arm != self.cell.arm.name}

    def awaited_by_recovery(self) -> dict[str, str]:
        """The zones that a recovery would wait for, and who holds them; inside its zones it needs no more."""
        arm = self.cell.arm.name
        if self._zones.held_by(arm) and arm not in self._zones.robbed:
            return {}
        return self.awaited_zones(self.recovery_zones())

    def is_quarantined(self, zone: str) -> bool:
        """Whether a silent robot may be in a zone."""
        return self._zones.is_quarantined(zone)

    def claim_zones(self) -> None:
        """Take every zone the arm may get into, for a way that begins where nobody knows; it must be free."""
        self._zones.claim(self.cell.arm.name, self.cell.zones)
        self._keep_zones()

    def _keep_zones(self) -> None:
        arm = self.cell.arm.name
        for zone in sorted(self._zones.held_by(arm)):
            self._dispatcher.remember(Fact.QUARANTINE, zone, arm)

    def leave_zones(self) -> bool:
        """Stop waiting for zones, and give them back if the arm is seen outside; whether it holds none."""
        arm = self.cell.arm.name
        granted = self._zones.withdraw(arm)
        held = self._zones.held_by(arm)
        if held and self._dispatcher.place(self.cell) is not None:
            granted += self._zones.restore(arm) + self._zones.release(arm)
            for zone in sorted(held):
                self._dispatcher.remember(Fact.QUARANTINE, zone, None)
            self._dispatcher.wake(self._zones.robbed)
        self._dispatcher.wake(granted)
        return not self._zones.held_by(arm)

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

    def fail(self, failure: Failure, leaf: Behaviour | None = None) -> None:
        """Name the cause of a failure; the first one named counts. What was carried is now for recovery."""
        if self.failure is None:
            self.failure, self.failed_leaf = failure, leaf
        self.last_failure = failure
        self.carried = False
