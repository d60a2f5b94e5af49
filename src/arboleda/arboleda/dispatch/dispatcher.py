"""Commands out, reports in: sends commands, and books what each report proves of them."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import partial

from arboleda.model.commands import Command, Home, Motion, Position, Query, StopMode, Switch
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, Failure, MotionState, Notice, Reason, Report
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import Phrase, Sentence

from . import evidence
from .belief import Belief
from .booking import Booking
from .effectors import Effectors
from .evidence import Before, CommandVerdict
from .fact_memory import FactMemory, Memory
from .interference import MOST, NEVER_GIVEN, Interferences
from .latches import Latches
from .lateness import Pauses, short_because
from .ledger import Entry, Feed, Ledger, State
from .obstacles import Barrier, Make, Obstacles, unbarred
from .outlet import Outlet
from .stillness import ReportMoment
from .time_limits import TimeLimits
from .underway import UnderWay, Unfinished, UnnamedCommands
from .whereabouts import Whereabouts

Guard = Callable[[str, Callable[[], None]], None]  # runs a function for the cell of that name
HOMING = Phrase("doing.home", "homing")
NOT_GIVEN = Phrase("command.not_given", "{why}: no {doing}")
NO_TELEMETRY = Phrase("command.no_telemetry", "{robot}: no telemetry for {seconds:g} s while {doing}")
NOT_GIVEN_KEPT = 16  # of the last commands that never left
UNWELL = frozenset({MotionState.FAULT, MotionState.NO_LINK})


def unguarded(cell: str, act: Callable[[], None]) -> None:
    """Act without a guard: an exception goes to the caller."""
    act()


class Dispatcher:
    """Beliefs and open commands of all robots; `outbox` has the messages to send, in order.

    `not_given` are the last commands of tasks that never left, `not_given_count` how many there were.
    """

    def __init__(self, model: PlantModel, epoch: int, memory: Memory) -> None:
        self.model = model
        self.ledger = Ledger()
        self.outbox: list[Command | Notice] = []
        self.memory = FactMemory(memory, self.outbox)
        stale_after_s = model.timing.stale_after_s
        self.beliefs = {name: Belief(robot, stale_after_s, epoch) for name, robot in model.robots.items()}
        for name, boot in memory.get(Fact.BOOT, {}).items():
            if name in self.beliefs and boot.isdigit():
                self.beliefs[name].boot_id = int(boot)
        self.beat_pauses = Pauses()  # in which the plant sent no heartbeat
        self.interference = Interferences()
        self.effectors = Effectors(model, memory, self.memory, self.ledger, self.interference)
        self.under_way, self.unnamed = UnderWay(model), UnnamedCommands(model)
        self.unfinished = Unfinished(model)
        self.outlet = Outlet(epoch, self.beliefs, self.outbox, self.under_way, self.unnamed)
        self.latches = Latches(self.beliefs, memory, self.memory, self.outlet)
        self.whereabouts = Whereabouts(self.beliefs, memory, self.memory, self.ledger, self.under_way)
        self.limits = TimeLimits(model, self.beliefs, self.whereabouts)
        self.obstacles = Obstacles(self.beliefs, self.latches, self.ledger, self.effectors)
        self.booking = Booking(
            beliefs=self.beliefs,
            ledger=self.ledger,
            effectors=self.effectors,
            outlet=self.outlet,
            under_way=self.under_way,
            unfinished=self.unfinished,
            whereabouts=self.whereabouts,
            limits=self.limits,
        )
        self.not_given: deque[Entry] = deque(maxlen=NOT_GIVEN_KEPT)
        self.not_given_count = 0
        self._cells_of = {name: {cell.name for cell in cells} for name, cells in model.cells_of.items()}
        self._stale_at: dict[str, float] = {}  # of robots that can fall silent

    @property
    def next_deadline(self) -> float:
        """The time at which a command is due, or a silence too long, s of the plant's clock; inf for none."""
        stale_at = min(self._stale_at.values()) if self._stale_at else math.inf
        return min(self.ledger.next_deadline, stale_at)

    def send(
        self,
        make: Make,
        cell: str,
        doing: Sentence,
        now: float,
        *,
        by_hand: bool = False,
        barrier: Barrier = unbarred,
        token: str | None = None,
    ) -> Entry:
        """Give a command its id and send it; the entry has failed where its robot or `barrier` objects.

        `by_hand`: an operator opens an effector, even while its arm is stopped. A board that numbers its
        commands echoes `token`.
        """
        command = make(id=self.outlet.new_id())
        deadline = now + self.limits.allowed_s(command, self.limits.timings[cell])
        entry = Entry(command, cell=cell, doing=doing, sent_at=now, deadline=deadline)
        obstacle = self.obstacles.to(command, by_hand=by_hand, was=True) or barrier(command)
        if obstacle is not None:
            failure = replace(obstacle, sentence=NOT_GIVEN(why=obstacle.sentence, doing=doing))
            entry.refuse(failure, too_early=self.obstacles.may_come_to_rest(command.robot))
            if not by_hand:
                self.not_given.append(entry)
                self.not_given_count += 1
            return entry
        if isinstance(command, Switch) and (doubtful := self.booking.doubtful.get(command.robot)):
            entry.must_be_named = any(name in doubtful for name, _ in command.sets)
        belief = self.beliefs[command.robot]
        entry.origin, entry.before = belief.position, belief.receipt
        entry.settles_at = self.limits.settles_at(entry, now)
        self.ledger.open(entry)
        if isinstance(command, Switch) and command.grips is not None:
            self.effectors.command(command)
        elif isinstance(command, Motion):
            self.whereabouts.set_out(command.robot)
        elif command.makes_part:
            self.effectors.make(command.robot)
        self.outlet.leave(command, token)
        return entry

    def left_late(self, id: str, late_s: float) -> None:
        """Let a command that left late settle later by that, even after its deadline.

        Settling stands for the time in which its device acts, and that begins when the command leaves.
        """
        entry = self.ledger.entries.get(id)
        if entry is not None and entry.settles_at is not None:
            entry.settles_at += late_s
            entry.deadline = max(entry.deadline, entry.settles_at)
            self.ledger.plan(entry)

    def cancel(self, entry: Entry, now: float) -> None:
        """Ask an open command to end, once. Work that can be halted is halted, and a query is forgotten."""
        entry.is_abandoned = True
        if entry.state is State.CANCELLING or entry.finishes:
            return
        self.ledger.feed(entry.command.id, Feed.CANCEL, now)
        if isinstance(entry.command, Query):
            self.ledger.feed(entry.command.id, Feed.HALTED, now)
            return
        entry.settles_at = None if entry.halts else entry.settles_at
        entry.cancelled_after = ReportMoment(self.beliefs[entry.command.robot].reports, now)
        entry.deadline = now + self.limits.timings[entry.cell].stop_timeout_s
        self.ledger.plan(entry)
        if entry.halts and entry.command.robot not in self.latches.stopped:
            self.outlet.stop(entry.command.robot, StopMode.HALT)

    def cancel_all(self, cell: str, now: float) -> None:
        """Ask every command of a cell to end."""
        for entry in self.ledger.of_cell(cell):
            self.cancel(entry, now)

    def home(self, robot: str, cell: str, now: float) -> Entry:
        """Have a robot run its homing routine, on the word of its cell."""
        return self.send(partial(Home, robot=robot), cell, HOMING(), now)

    def declare_homed(self, robot: str, home: Position | None = None) -> None:
        """Take a robot that cannot report it for put at its reference, on an operator's word.

        One without a reference is put at `home`.
        """
        self.whereabouts.put_at_reference(robot, home)
        self.wake([robot])

    def wake(self, holders: Iterable[str]) -> None:
        """Have the trees of these cells, and of these robots' cells, look again."""
        for name in holders:
            self.ledger.changed |= self._cells_of.get(name, {name})

    def report(self, report: Report, now: float) -> None:
        """Merge a report and book what it proves.

        It is ignored for an unknown robot, for one that is only drawn, and where the robot's kind objects.
        """
        belief = self.beliefs.get(report.robot)
        if belief is None or belief.drawn:
            return
        was_sure, was_moving = belief.stillness.is_sure, belief.state is MotionState.MOVING
        if belief.hear_again(report):
            if (
                belief.stillness.is_sure and not was_sure
            ):  # `place` and interlocks go by its place from here on
                self.wake([report.robot])
            self._prove(belief, report, now)
            return
        if belief.robot.objection(report) is not None:
            self.ledger.ignored["report"] += 1
            return
        before, facts = Before.of(belief), _facts_shown(belief)
        was_held, held_since_boot = belief.held_in(belief), belief.held_boot
        if report.foreign is not None or report.accepted != self.interference.accepted.get(report.robot):
            self._hear_of_others(report)
        was_online, latched = belief.online, report.robot in self.latches.stopped
        new_link = latched and _is_new_link(belief, report)
        belief.merge(report)
        if report.robot in self.effectors.grips.opening:
            self.effectors.settle_opening(before, belief, report)
        if was_held and belief.held_in(belief) is False:
            self.effectors.note_opening(belief, rebooted=belief.held_boot != held_since_boot)
        if not belief.supervised and report.state not in (None, MotionState.STOPPED):
            self.whereabouts.moves_again(report.robot)
        if belief.is_unplaced and belief.position_in(report) is not None:
            self.whereabouts.hear_after_silence(before, belief, report)
        if belief.may_be_displaced and evidence.displaced(before, belief, report):
            self.whereabouts.displace(belief, displaced=True)
        if belief.tells_boots_only and belief.boot_id is not None:
            self.memory.remember(Fact.BOOT, report.robot, str(belief.boot_id))
        self._prove(belief, report, now, before)
        if latched and (new_link or (belief.online and not was_online)):  # its board may have lost the stop
            self.outlet.stop(report.robot, StopMode.LATCH)
        came = was_moving or _stands_elsewhere(before, belief)
        stands_there = came and belief.state is not MotionState.MOVING
        if belief.stillness.is_sure and (stands_there or not was_sure):
            self.wake([report.robot])  # a step may wait to see it there, whoever has moved it
        if _facts_shown(belief) != facts:
            self.ledger.version += 1
            self.ledger.changed |= self._cells_of[report.robot]

    def believe_again(self, robot: str, said: Sequence[MotionState]) -> None:
        """Go by what a robot said before its reports did not count, as it may say nothing until it works.

        `said` is what was said for it meanwhile. One that may have moved stands nobody knows where, if the
        plant does not see it.
        """
        belief = self.beliefs.get(robot)
        if belief is None or belief.state is not MotionState.NO_LINK:
            return
        may_have_moved = belief.find_again(said)
        if may_have_moved and belief.may_be_displaced and not belief.supervised:
            self.whereabouts.displace(belief, displaced=True)
        if belief.online and robot in self.latches.stopped:
            self.outlet.stop(robot, StopMode.LATCH)
        self.ledger.version += 1
        self.wake([robot])

    def interfere(self, robot: str, sentence: Sentence, now: float, *, obeyed: bool) -> None:
        """Note that somebody else commanded a robot; a command that it obeyed may make open ones fail."""
        self.interference.note(robot, sentence, now, obeyed=obeyed)
        self.ledger.version += 1
        for entry in self.ledger.of_robot(robot) if obeyed else ():
            entry.interference = sentence

    def answer(self, robot: str, answer: str, now: float) -> None:
        """Book the answer of a person to the open question."""
        entry = self.ledger.question(robot)
        if entry is not None:
            self.report(Report(at=now, robot=robot, answered=entry.command.id, answer=answer), now)

    def _hear_of_others(self, report: Report) -> None:
        """Note commands of others, which a bridge counts, and forged ones in the plant's name."""
        if report.foreign is not None:
            refused, obeyed = self.interference.rise(report)
            if refused or obeyed:
                self.interfere(report.robot, report.foreign, report.at, obeyed=obeyed)
        number = self.interference.forged(report, self.outlet.epoch, self.outlet.count)
        if number is not None:
            self._halt_forged(report, number)

    def _halt_forged(self, report: Report, number: int) -> None:
        """Halt a robot that took a forged command; go on with higher numbers, as no number may come twice."""
        sentence = NEVER_GIVEN(robot=report.robot, id=report.accepted or "")
        self.interfere(report.robot, sentence, report.at, obeyed=True)
        if number < MOST:
            self.outlet.count = number
        self.outlet.stop(report.robot, StopMode.HALT)

    def _with_lateness(
        self, verdict: CommandVerdict, failure: Failure, entry: Entry, belief: Belief
    ) -> CommandVerdict:
        """The verdict; of work that stopped short, and that nobody else cut short, it names what was late."""
        if failure.reason is not Reason.STOPPED_SHORT or entry.interference is not None:
            return verdict
        why = short_because(entry, self.beat_pauses, belief.pauses)
        return replace(verdict, failure=replace(failure, sentence=why))

    def _prove(self, belief: Belief, report: Report, now: float, before: Before | None = None) -> None:
        """Book what a report proves; `before` is None for a report that repeats the last one."""
        name = report.robot
        if belief.stale_at is not None:
            self._stale_at[name] = belief.stale_at
        for entry in self.ledger.by_robot[name]:
            if report.accepted == entry.command.id and report.receipt is not None:
                entry.number = report.receipt[:2]
            verdict = evidence.judge(entry, before, belief, report)
            if verdict is not None:
                if verdict.failure is not None:
                    verdict = self._with_lateness(verdict, verdict.failure, entry, belief)
                self.booking.book(entry, verdict, now)
        if report.rejected is not None:
            self.booking.refused_after_all(report)
        if self.unnamed.ids.get(name):
            self.unnamed.hear(report)
        if name in self.unfinished.by_device:
            was_heard = before is None or before.online
            is_well = was_heard and belief.state not in UNWELL
            if self.unfinished.hear(report, now, is_well=is_well, unnamed=self.under_way.ids.get(name, ())):
                self.ledger.version += 1
                self.ledger.changed |= self._cells_of[name]
        if name in self.under_way.ids or name in self.latches.unheard:
            self.under_way.hear(report, now)
            if belief.online:
                self._say_again(belief, now)
        held = belief.held_in(belief)
        if held is not None and belief.online:  # a word from before its link was lost may be too old
            self.effectors.settle(belief.robot.name, Grip.ON if held else Grip.OFF)
            if held and belief.piece is not None and belief.state is MotionState.MOVING:
                timing = self.limits.timings[self.model.cell_of[name].name]
                self.effectors.feel(belief, debounce_s=timing.piece_debounce_s)

    def expire(self, limit: float, now: float, guard: Guard = unguarded) -> None:
        """Book the settling times, deadlines and silences that are due up to and including `limit`."""
        if self.next_deadline > limit:
            return
        for entry in [entry for entry in self.ledger.entries.values() if entry.next_deadline <= limit]:
            guard(entry.cell, partial(self.booking.end_overdue, entry, now))
        for name, belief in self.beliefs.items():
            if belief.stale_at is not None and belief.stale_at <= limit:
                guard(self.model.cell_of[name].name, partial(self._went_stale, belief, now))

    def _say_again(self, belief: Belief, now: float) -> None:
        """Send again what a robot may have missed: a clear, or a halt that has it name its last command."""
        name = belief.robot.name
        if name in self.latches.unheard:
            self.latches.unheard.discard(name)
            if belief.state is MotionState.STOP_LATCHED:
                self.outlet.stop(name, StopMode.CLEAR)
        elif self.under_way.is_overdue(name, now) and not self.ledger.of_robot(name):
            is_awaited = self.unfinished.may_be_news(name, self.under_way.ids[name])
            if is_awaited or name in self.under_way.movers:
                self.outlet.stop(name, StopMode.HALT)

    def _went_stale(self, belief: Belief, now: float) -> None:
        belief.fall_silent()
        del self._stale_at[belief.robot.name]
        self.ledger.version += 1
        self.ledger.changed |= self._cells_of[belief.robot.name]
        for entry in self.ledger.of_robot(belief.robot.name):
            name, silence_s = belief.robot.name, belief.stale_after_s
            sentence = NO_TELEMETRY(robot=name, seconds=silence_s, doing=entry.doing)
            failure = Failure(reason=Reason.LINK_LOST, sentence=sentence)
            self.booking.book(entry, CommandVerdict(feed=Feed.FAILED, failure=failure), now)


def _facts_shown(belief: Belief) -> tuple[object, ...]:
    """The part of a belief to which trees and screens react; positions are no part of it."""
    return (belief.trouble, belief.piece, belief.effector, belief.facts_no)


def _stands_elsewhere(before: Before, belief: Belief) -> bool:
    """True where a robot stands at another position than before; encoders differ in the last digits."""
    here, was = belief.position, before.position
    if here == was or here is None or was is None:
        return here != was
    return not belief.robot.motion.stands_at(here, was)


def _is_new_link(belief: Belief, report: Report) -> bool:
    """True where a robot is heard through a new bridge or boot."""
    new_bridge = report.epoch is not None and report.epoch != belief.epoch
    return new_bridge or (report.boot_id is not None and report.boot_id != belief.boot_id)
