"""Leaves of py_trees, of which every recipe is made."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.dispatch.ledger import Entry, State
from arboleda.dispatch.obstacles import Make
from arboleda.model.commands import Switch
from arboleda.model.messages import Check, Failure, Notice, Reason
from arboleda.model.sentence import NOTHING, OWN, Phrase, Sentence, as_sentence

from .cell_time import LEAST_S, CellTime
from .context import Context
from .failures import Failures
from .node_state import Keeps, command_kept
from .parts import Parts

CANCELLED = Phrase("command.cancelled", "cancelled while {doing}")
AGAIN = Phrase("command.again", "{why}; try {number} of {most} follows")
NOT_FREE = Phrase("zone.not_free", "{arm}: zone {zones} was not free within {seconds:g} s")
KEPT_BY_MACHINE = Phrase(
    "zone.kept_by_machine",
    "{arm}: zone {zones} was not free within {seconds:g} s: "
    "{device} keeps it as long as it does not report {facts}",
)
WAITS_FOR_ZONE = Phrase("zone.waits_for", "waits for zone {zone}, which {other} holds")
WAITS_FOR_ZONE_TURN = Phrase("zone.waits_for_turn", "waits for zone {zone}, which {other} asked for before")
WAITS_TO_BE_OUTSIDE = Phrase("zone.waits_outside", "waits until {arm} is seen outside zone {zone}")
WAITS_FOR_MACHINE = Phrase(
    "zone.waits_for_machine", "waits for {device}, which keeps its zone as long as it does not report {facts}"
)
WAITS_FOR_DEVICE = Phrase("device.waits", "waits for {device}, which {cell} holds")
WAITS_FOR_TURN = Phrase("device.waits_for_turn", "waits for {device}, which {cell} asked for before")
DEVICE_NOT_FREE = Phrase("device.not_free", "{cell}: {devices} was not free within {seconds:g} s")
DEVICE_STILL_HELD = Phrase(
    "device.still_held", "{cell}: {device}, which {holder} holds, was not free within {seconds:g} s"
)
PART_IN_FREE = Phrase(
    "device.part_in_free",
    "{cell}: {device}, which no cell holds, may hold a part; "
    "release {device} first, or take the part out by hand",
)
CANNOT_TAKE = Phrase("device.cannot_take", "{cell} cannot take {device}: {why}")
NOT_AT_HOME = Phrase(
    "device.not_at_home", "waits for {device}, which no cell holds and which is not seen at its home"
)
NOT_EMPTY = Phrase(
    "device.not_empty", "waits for {device}, which no cell holds and which may still hold a part"
)
WAITS_TO_GIVE_BACK = Phrase("device.waits_to_give_back", "waits until {devices} can be given back")
NOT_AT_REST = Phrase("device.not_at_rest", "{cell}: {devices} did not come to rest")
NOT_OUTSIDE = Phrase("zone.not_outside", "{arm} was not seen outside its zones")
Guard = Callable[[], "Failure | None"]
RETRYABLE = frozenset(
    {Reason.LINK_LOST, Reason.REJECTED, Reason.DEADLINE, Reason.STOPPED_SHORT, Reason.NOT_REACHED}
)
"""The reasons after which a command may be given once more."""


def titled(node: Behaviour, title: Sentence | str) -> Behaviour:
    """Give a node of py_trees its name as a sentence."""
    node.title = as_sentence(title)  # type: ignore[attr-defined]
    return node


def title_of(node: Behaviour) -> Sentence:
    """The name of a node as a sentence; its plain name where it has no title."""
    title: Sentence | None = getattr(node, "title", None)
    return OWN(text=node.name) if title is None else title


class Leaf(Keeps, Behaviour):
    """Leaf of ours. `title` is its name as a sentence, `feedback` what it does or waits for.

    `last_failure` is the sentence of its last failure, which stays when py_trees has forgotten the status.
    `began` is when a leaf that takes time began last in this start of the plant, s of the cell's time. `uses`
    is its robot, where cells share that. `proven`: its wait is known to be over.
    """

    title: Sentence
    feedback: Sentence = NOTHING
    last_failure: Sentence | None = None
    uses: str | None = None
    began = -math.inf
    proven = False

    def __init__(self, name: Sentence | str) -> None:
        super().__init__(str(name))
        self.title = as_sentence(name)

    @property
    def feedback_message(self) -> str:
        return str(self.feedback)

    @feedback_message.setter
    def feedback_message(self, text: str) -> None:
        self.feedback = as_sentence(text) if text else NOTHING

    def tick(self) -> Iterator[Behaviour]:
        """Tick the leaf as py_trees does, but without words for a log and a list of all statuses."""
        if self.status is not Status.RUNNING:
            self.initialise()
        status = self.update()
        if not isinstance(status, Status):
            self.logger.error(f"{self.name} returned what is no status: {status}")
            status = Status.INVALID
        if status is not Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def stop(self, new_status: Status) -> None:
        """End the leaf as py_trees does, but without words for a log."""
        self.terminate(new_status)
        self.status = new_status
        self.iterator = self.tick()

    def begin_anew(self) -> None:
        self.initialise()

    def failed(self, failure: Failure) -> Status:
        """FAILURE, with its sentence for people."""
        self.feedback = self.last_failure = failure.sentence
        return Status.FAILURE


class Act(Leaf):
    """One command: RUNNING while it is open, SUCCESS when it is done; it is halted if the leaf ends early.

    A failure that a retry can help is tried again as the cell's `retry` says, after its back-off. A robot
    that still moves is waited for, at most `stop_timeout_s`: its report may be older than the end of its last
    move, or the plant has just halted it, as after a timeout around the step before. `anew` makes the command
    once it may have left before. `guard` is called at every tick, and a failure that it returns fails the
    command at once. So does an effector that opened unbidden with a part. `then` is called once the command
    is done. `last` is the record of the command that left before, in an earlier start of the plant or the try
    before: a device may still prove that command where the next one does not leave. `proven`: it is known to
    be done. `number_in_tree` is the number of its node, `given_times` how often the command was given in this
    task.
    """

    ends_unkept = True

    def __init__(
        self,
        name: Sentence | str,
        context: Context,
        make: Make,
        doing: Sentence | str,
        *,
        anew: Make | None = None,
        guard: Guard | None = None,
        then: Callable[[], None] | None = None,
    ) -> None:
        super().__init__(name)
        self.context = context
        self.time = context.time
        self.failures = context.failures
        self.then = then
        self.make = make
        self.anew = anew or make
        self.doing = as_sentence(doing)
        self.guard = guard
        self.entry: Entry | None = None
        self.may_have_left = False  # its robot may have got the command
        self.may_have_left_before = False  # the same, before it was last given
        self.last: Mapping[str, Any] | None = None
        self.proven = False
        self.number_in_tree: int | None = None
        self.given_times = 0
        self.given_earlier: Mapping[str, Any] | None = None  # by an earlier start
        self.tries = 0
        self.again_at: float | None = None
        self.patient_until = 0.0

    def initialise(self) -> None:
        earlier, self.given_earlier = self.given_earlier, None
        self.tries, self.may_have_left, self.last, self.proven = 0, earlier is not None, None, False
        self.began = self.time.now
        if earlier is None or not earlier["done"]:
            self.send()
        else:
            self.entry, self.last, self.proven, self.feedback = None, earlier, True, self.doing

    def take_up(self, earlier: Mapping[str, Any], attempt: int) -> None:
        """Begin, when its turn comes, with the command that its board says an earlier start has given."""
        self.given_earlier, self.given_times = earlier, attempt
        self.context.commands.used.add(earlier["robot"])

    def kept(self) -> Mapping[str, Any] | None:
        if self.status is not Status.RUNNING:
            return None
        last = command_kept(self.entry) or self.last
        return {
            "tries": self.tries,
            "left": self.may_have_left_before,
            "last": last,
            "given": self.given_times,
        }

    @property
    def waits(self) -> bool:
        """True while another tick brings nothing before its robot reports or a time comes."""
        return self.entry is not None and self.entry.open and self.again_at is None and not self.proven

    def restore(self, state: Mapping[str, Any]) -> None:
        self.tries, self.may_have_left, self.last = state["tries"], state["left"], state["last"]
        self.given_times = state.get("given", 0)
        self.feedback = self.doing

    def begin_anew(self) -> None:
        self.send()

    def send(self) -> None:
        """Give the command, or give it anew."""
        self.feedback, self.last = self.doing, None
        self.again_at = None
        self.patient_until = self.time.now + self.context.timing.stop_timeout_s
        self._give()

    def _give(self) -> None:
        make, attempt = self.anew if self.may_have_left else self.make, self.given_times + 1
        self.entry = self.context.commands.send(make, self.doing, step=self.number_in_tree, attempt=attempt)
        self.given_times += self.entry.was_sent
        self.may_have_left_before, self.may_have_left = (
            self.may_have_left,
            self.may_have_left or self.entry.was_sent,
        )
        if self.entry.too_early:
            self.time.wake_at(self.patient_until)

    def update(self) -> Status:
        if self.proven:
            return self._done()
        if self.again_at is not None:
            return self._wait()
        if (obstacle := self._obstacle()) is not None:
            return self._failed(obstacle)
        if self.entry is not None and self.entry.too_early and self._waits_for_the_robot(self.entry):
            return Status.RUNNING
        if self.entry is None or self.entry.open:
            return Status.RUNNING
        if self.entry.state is State.DONE:
            return self._done()
        cancelled = Failure(reason=Reason.CANCELLED, sentence=CANCELLED(doing=self.doing))
        failure = self.entry.failure or cancelled
        retry = self.context.cell.retry
        if failure.reason in RETRYABLE and self.tries < retry.times:
            self.tries += 1
            self.last_failure = failure.sentence
            self.feedback = AGAIN(why=failure.sentence, number=self.tries, most=retry.times)
            self.again_at = self.time.now + max(retry.backoff_s, LEAST_S)
            self.time.wake_at(self.again_at)
            return Status.RUNNING
        return self._failed(failure)

    def _done(self) -> Status:
        robot, grips = None, None
        if self.entry is not None and self.entry.was_sent:
            command = self.entry.command
            robot, grips = command.robot, command.grips if isinstance(command, Switch) else None
        elif self.last is not None:
            robot, grips = self.last["robot"], self.last["grips"]
        if robot is not None and grips is not None:
            self.context.handling.note(robot, grips=grips)
        if self.then is not None:
            self.then()
        return Status.SUCCESS

    def _obstacle(self) -> Failure | None:
        """The reason why the command is in vain, unless it has failed for a cause of its own."""
        ended = self.entry.failure if self.entry is not None and not self.entry.open else None
        if ended is not None and ended.reason not in RETRYABLE:
            return None
        return (self.guard() if self.guard is not None else None) or self.failures.opened_effector()

    def _waits_for_the_robot(self, entry: Entry) -> bool:
        """True while the robot still moves and there is time; once it rests, it gets its command.

        Work that goes on to its end has a deadline of its own, and is waited for until then.
        """
        commands, robot = self.context.commands, entry.command.robot
        if not commands.may_come_to_rest(robot):
            self._give()
        elif self.time.now >= self.patient_until and not commands.finishes(robot):
            return False
        return self.entry is not None and self.entry.too_early

    def _wait(self) -> Status:
        if self.again_at is not None and self.time.now >= self.again_at:
            before = command_kept(self.entry) or self.last
            self.send()
            self.last = before
            return self.update()
        return Status.RUNNING

    def _failed(self, failure: Failure) -> Status:
        self.failures.add(failure, self)
        self._halt()
        return self.failed(failure)

    def _halt(self) -> None:
        if self.entry is not None and self.entry.open:
            self.context.commands.cancel(self.entry)

    def terminate(self, new_status: Status) -> None:
        if new_status is Status.INVALID:
            self._halt()


class Approach(Act):
    """Move to where the next move begins; done without a command where the robot is there already."""

    is_there: Callable[[], bool]

    def send(self) -> None:
        """Give the command, unless the robot is seen there and no command can have left before."""
        if not self.may_have_left and self.is_there():
            self.proven = True
        else:
            super().send()


class Dwell(Leaf):
    """Wait a fixed time."""

    def __init__(self, name: Sentence | str, time: CellTime, seconds: float) -> None:
        super().__init__(name)
        self.time = time
        self.seconds = seconds
        self.until = 0.0

    def initialise(self) -> None:
        self.began = self.time.now
        self.until = self.began + self.seconds
        self.time.wake_at(self.until)

    def update(self) -> Status:
        over, self.proven = self.proven or self.time.now >= self.until, False
        return Status.SUCCESS if over else Status.RUNNING


class Announce(Leaf):
    """Send one notice."""

    def __init__(self, name: Sentence | str, context: Context, notice: Notice) -> None:
        super().__init__(name)
        self.context = context
        self.notice = notice

    def update(self) -> Status:
        self.context.notify(self.notice)
        return Status.SUCCESS


class Require(Leaf):
    """Condition: SUCCESS where `obstacle()` returns None, else FAILURE with the failure that it returns."""

    def __init__(self, name: Sentence | str, failures: Failures, obstacle: Guard) -> None:
        super().__init__(name)
        self.failures = failures
        self.obstacle = obstacle

    def update(self) -> Status:
        failure = self.obstacle()
        if failure is None:
            return Status.SUCCESS
        self.failures.add(failure, self)
        return self.failed(failure)


class Unless(Leaf):
    """SUCCESS where `holds()`, else FAILURE without a cause: in a selector it skips needless steps."""

    def __init__(self, name: Sentence | str, holds: Callable[[], bool]) -> None:
        super().__init__(name)
        self.holds = holds

    def update(self) -> Status:
        return Status.SUCCESS if self.holds() else Status.FAILURE


class Await(Leaf):
    """RUNNING until `arrived()`, at most `seconds`; then FAILURE, for the cause `otherwise()` if `final`."""

    def __init__(
        self,
        name: Sentence | str,
        context: Context,
        arrived: Callable[[], bool],
        seconds: float,
        otherwise: Callable[[], Failure],
        *,
        final: bool = True,
    ) -> None:
        super().__init__(name)
        self.time = context.time
        self.failures = context.failures
        self.arrived = arrived
        self.seconds = seconds
        self.otherwise = otherwise
        self.final = final
        self.until = 0.0

    def initialise(self) -> None:
        self.began = self.time.now
        self.until = self.began + self.seconds
        self.time.wake_at(self.until)

    def update(self) -> Status:
        if self.arrived() or self.proven:
            self.proven = False
            return Status.SUCCESS
        if self.time.now < self.until:
            return Status.RUNNING
        failure = self.otherwise()
        if self.final:
            self.failures.add(failure, self)
        return self.failed(failure)


class Piece(Await):
    """Wait at most `seconds` until a robot's piece sensor freshly reports, debounced, that a piece is there.

    A robot without a sensor goes on, unless that is `needed`; the task then says that nobody checked.
    """

    def __init__(
        self,
        name: Sentence | str,
        context: Context,
        robot: str,
        seconds: float,
        failure: Failure,
        *,
        needed: bool = True,
        final: bool = True,
    ) -> None:
        super().__init__(name, context, self._seen, seconds, lambda: failure, final=final)
        self.handling = context.handling
        self.sensors = context.sensors
        self.robot = robot
        self.needed = needed

    def _seen(self) -> bool:
        if not (self.needed or self.handling.senses_pieces(self.robot)):
            self.handling.miss(Check.GRIP)
            return True
        return self.sensors.read(self.robot, self.began) is True


class Note(Leaf):
    """Call `note` once, which books something of the task."""

    def __init__(self, name: Sentence | str, note: Callable[[], None]) -> None:
        super().__init__(name)
        self.note = note

    def update(self) -> Status:
        self.note()
        return Status.SUCCESS


class Carry(Leaf):
    """Note the robot that carries the checked part from here on; None: the part has arrived."""

    def __init__(self, name: Sentence | str, parts: Parts, robot: str | None) -> None:
        super().__init__(name)
        self.parts = parts
        self.robot = robot

    def update(self) -> Status:
        self.parts.carrier = self.robot
        return Status.SUCCESS


class Take(Await):
    """Wait for zones or devices that others may hold.

    Its feedback is made when somebody reads it, since holders change without a tick of this leaf.
    """

    ended_with: Sentence = NOTHING

    @property
    def feedback(self) -> Sentence:
        return self._awaited() if self.status is Status.RUNNING else self.ended_with

    @feedback.setter
    def feedback(self, sentence: Sentence) -> None:
        self.ended_with = sentence

    def _awaited(self) -> Sentence:
        """The cause of its waiting; NOTHING where it waits for nobody."""
        raise NotImplementedError


class TakeZones(Take):
    """Wait until a robot has all zones that `needed()` names when the leaf begins.

    `recovers`: a robot in a zone goes on with the zones that it holds, to get out. One outside waits on after
    its time while those before it are at work: if it asked anew, it would be the last.
    """

    def __init__(
        self,
        name: Sentence | str,
        context: Context,
        robot: str,
        needed: Callable[[], frozenset[str]],
        *,
        recovers: bool = False,
    ) -> None:
        super().__init__(name, context, self._taken, context.cell.zone_wait_s, self._not_free)
        self.access = context.zones
        self.robot = robot
        self.needed = needed
        self.recovers = recovers
        self.zones: frozenset[str] = frozenset()

    def initialise(self) -> None:
        self.zones = self.needed()
        if self.zones or self.recovers:
            super().initialise()
        else:  # it waits for nothing, so nobody has to be woken
            self.began = self.until = self.time.now

    def update(self) -> Status:
        due = self.time.now >= self.until
        if due and self.recovers and self.access.will_come_free(self.robot):
            super().initialise()
        return super().update()

    def _taken(self) -> bool:
        return self.access.take(self.robot, self.zones, inside=self.recovers)

    def _awaited(self) -> Sentence:
        if (keeper := self.access.kept_by_machine(self.robot, self.zones)) is not None:
            machine, facts = keeper
            return WAITS_FOR_MACHINE(device=machine, facts=facts)
        if held := self.access.awaited(self.robot, self.zones):
            zone = min(held)
            return WAITS_FOR_ZONE(zone=zone, other=held[zone])
        if ahead := self.access.asked_before(self.robot):
            zone, other = ahead
            return WAITS_FOR_ZONE_TURN(zone=zone, other=other)
        own = self.access.held_by(self.robot)
        if own and not self.zones <= own:
            return WAITS_TO_BE_OUTSIDE(arm=self.robot, zone=min(own))
        return NOTHING

    def _not_free(self) -> Failure:
        zones = tuple(sorted(self.zones))
        sentence = NOT_FREE(arm=self.robot, zones=zones, seconds=self.seconds)
        if (keeper := self.access.kept_by_machine(self.robot, self.zones)) is not None:
            machine, facts = keeper
            sentence = KEPT_BY_MACHINE(
                arm=self.robot, zones=zones, seconds=self.seconds, device=machine, facts=facts
            )
        return Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=sentence)

    def terminate(self, new_status: Status) -> None:
        # py_trees also ends leaves that have succeeded long ago: their zones are in use
        if new_status is Status.FAILURE or (self.status is Status.RUNNING and new_status is Status.INVALID):
            self.access.leave(self.robot)


class LeaveZones(Await):
    """Give a robot's zones back once it is seen outside."""

    def __init__(self, name: Sentence | str, context: Context, robot: str) -> None:
        failure = Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=NOT_OUTSIDE(arm=robot))
        given_back = partial(context.zones.leave, robot)
        super().__init__(name, context, given_back, context.timing.stop_timeout_s, lambda: failure)
        self.holds = partial(context.zones.held_by, robot)

    def initialise(self) -> None:
        if self.holds():
            super().initialise()
        else:  # it waits for nothing, so nobody has to be woken
            self.began = self.until = self.time.now


class TakeDevices(Take):
    """Wait until a cell has shared devices, all at once.

    It fails at once where a device that no cell holds may hold a part, or has lost its reference: there only
    a person helps.
    """

    def __init__(self, name: Sentence | str, context: Context, devices: frozenset[str]) -> None:
        super().__init__(name, context, self._taken, context.cell.zone_wait_s, self._not_free)
        self.cell = context.cell.name
        self.shared = context.devices
        self.robots = context.robots
        self.devices = devices

    def update(self) -> Status:
        if (failure := self._objection()) is not None:
            self.failures.add(failure, self)
            return self.failed(failure)
        return super().update()

    def _objection(self) -> Failure | None:
        """The reason why waiting for a device that no cell holds is in vain."""
        for device in self.shared.hand_over.unused(self.devices):
            if self.shared.hand_over.may_hold(device):
                sentence = PART_IN_FREE(cell=self.cell, device=device)
                return Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=sentence)
            obstacle = self.robots.obstacle(device)
            if obstacle is not None and obstacle.reason is Reason.NOT_HOMED:
                sentence = CANNOT_TAKE(cell=self.cell, device=device, why=obstacle.sentence)
                return Failure(reason=Reason.NOT_HOMED, sentence=sentence)
        return None

    def _awaited(self) -> Sentence:
        if awaited := self.shared.awaited(self.devices):
            device = min(awaited)
            return WAITS_FOR_DEVICE(device=device, cell=awaited[device])
        if ahead := self.shared.asked_before():
            device, cell = ahead
            return WAITS_FOR_TURN(device=device, cell=cell)
        held = self.shared.held()
        if held and not self.devices <= held:
            return WAITS_TO_GIVE_BACK(devices=tuple(sorted(held)))
        return NOTHING if held else self._not_as_left()

    def _not_as_left(self) -> Sentence:
        """The cause of its waiting for a device that no cell holds, and that no cell may take yet."""
        hand_over = self.shared.hand_over
        device = next((each for each in sorted(self.devices) if not hand_over.is_as_left(each)), None)
        if device is None:
            return NOTHING
        return (NOT_EMPTY if hand_over.is_home(device) else NOT_AT_HOME)(device=device)

    def _taken(self) -> bool:
        return self.shared.take(self.devices)

    def _not_free(self) -> Failure:
        cell, awaited = self.cell, self.shared.awaited(self.devices)
        sentence = DEVICE_NOT_FREE(cell=cell, devices=tuple(sorted(self.devices)), seconds=self.seconds)
        if awaited:
            device = min(awaited)
            sentence = DEVICE_STILL_HELD(
                cell=cell, device=device, holder=awaited[device], seconds=self.seconds
            )
        return Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=sentence)

    def terminate(self, new_status: Status) -> None:
        # as with zones: the devices of a leaf that has succeeded are in use
        if new_status is Status.FAILURE or (self.status is Status.RUNNING and new_status is Status.INVALID):
            self.shared.leave(frozenset())


class LeaveDevices(Await):
    """Give back the shared devices that a cell holds, once they may change hands."""

    def __init__(self, name: Sentence | str, context: Context, devices: frozenset[str]) -> None:
        sentence = NOT_AT_REST(cell=context.cell.name, devices=tuple(sorted(devices)))
        failure = Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=sentence)
        given_back = partial(context.devices.leave, devices)
        super().__init__(name, context, given_back, context.timing.stop_timeout_s, lambda: failure)
