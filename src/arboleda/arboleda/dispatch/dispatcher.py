"""Commands out, reports in: owns the ledger and the beliefs, judges the one by the other."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

from arboleda.model.commands import (
    FRESH_S,
    Command,
    Home,
    Motion,
    Position,
    Query,
    Question,
    Stop,
    StopMode,
    Switch,
    Work,
)
from arboleda.model.facts import shown
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, Failure, MotionState, Notice, Reason, Report
from arboleda.model.plant_model import Evidence, Link, PlantModel, Pose, Timing, Workspace
from arboleda.model.sentence import BOTH, Phrase, Sentence

from . import evidence
from .belief import Belief
from .effectors import Effectors
from .evidence import Before, Verdict
from .fact_memory import FactMemory, Memory
from .interference import MOST, NEVER_GIVEN, Interferences
from .ledger import Entry, Feed, Ledger, State
from .underway import UnderWay, Unfinished, UnnamedCommands

Make = Callable[..., Command]  # called with id=<the new command's id>
Guard = Callable[[str, Callable[[], None]], None]  # runs what belongs to the cell of that name
Barrier = Callable[[Command], "Failure | None"]  # why a command must not leave its cell
HOMING = Phrase("doing.home", "homing")
NOT_GIVEN = Phrase("command.not_given", "{why}: no {doing}")
BUSY_MOVING = (
    Phrase("robot.open_motion", "{robot} has an open motion command"),
    Phrase("robot.had_open_motion", "{robot} had an open motion command"),
)
BUSY_WORKING = (
    Phrase("robot.open_work", "{robot} has not ended its last work"),
    Phrase("robot.had_open_work", "{robot} had not ended its last work"),
)
BUSY_SWITCHING = (
    Phrase("robot.open_switch", "{robot} has not ended switching {fact}"),
    Phrase("robot.had_open_switch", "{robot} had not ended switching {fact}"),
)
NEEDS = Phrase("robot.needs", "{robot} needs {fact} to be {value}, and says {told}")
NEEDED = Phrase("robot.needed", "{robot} needs {fact} to be {value}, and said {told}")
NEEDS_UNSAID = Phrase("robot.needs_unsaid", "{robot} needs {fact} to be {value}, and never said it")
MAY_LET_GO = Phrase(
    "tool.may_let_go", "{robot} stays where it is: {tool} was told to let go and may still do it"
)
NO_TELEMETRY = Phrase("command.no_telemetry", "{robot}: no telemetry for {seconds:g} s while {doing}")
NOT_FINISHED = Phrase("command.not_finished", "{robot}: did not finish within {seconds:.1f} s while {doing}")
NOT_STOPPED = Phrase(
    "command.not_stopped", "{robot}: did not confirm that it stopped within {seconds:.1f} s while {doing}"
)
UNSENT = (Link.NONE, Link.SCREEN)  # nothing leaves the plant for these
LATCHED, CLEARED = "on", "cleared"  # a stop as it is kept: until clear, and until reset
DISPLACED = "true"
NOT_GIVEN_KEPT = 16  # of the last commands that never left
HOMING_S = 30.0  # a slow search for the switch, and back off it
BROKEN_OFF = frozenset({Reason.LINK_LOST, Reason.REBOOTED, Reason.STOPPED, Reason.CANCELLED, Reason.INTERNAL})
"""What befell a command that its device might have carried out."""
UNWELL = frozenset({MotionState.FAULT, MotionState.NO_LINK})
KNOWN_STILL = frozenset({Reason.STOPPED_SHORT, Reason.NOT_REACHED, Reason.STOPPED})


def unguarded(cell: str, act: Callable[[], None]) -> None:
    """Act without a guard: an exception goes to the caller."""
    act()


def _unbarred(command: Command) -> None:
    """Nothing is in the way of a command."""


class Dispatcher:
    """Every robot's belief, open commands and latch; `outbox` collects what must leave, in order."""

    def __init__(self, model: PlantModel, epoch: int, memory: Memory) -> None:
        self.model = model
        self.epoch = epoch
        self.ledger = Ledger()
        self.outbox: list[Command | Notice] = []
        self.memory = FactMemory(memory, self.outbox)
        # by cell: a cell takes those of another version when it is at rest
        self.timings = {cell.name: model.timing for cell in model.cells}
        self.version = 0  # changes whenever something other than a position changed
        stale_after_s = model.timing.stale_after_s
        self.beliefs = {name: Belief(robot, stale_after_s, epoch) for name, robot in model.robots.items()}
        self._cells_of = {name: {cell.name for cell in cells} for name, cells in model.cells_of.items()}
        for name in memory.get(Fact.DISPLACED, {}).keys() & self.beliefs.keys():
            self.beliefs[name].displaced = True
        for name, boot in memory.get(Fact.BOOT, {}).items():
            if name in self.beliefs and boot.isdigit():
                self.beliefs[name].boot_id = int(boot)
        self._stale_at: dict[str, float] = {}  # of those beliefs that can get stale
        self.interference = Interferences()
        self.effectors = Effectors(model, memory, self.memory, self.ledger, self.interference)
        stopped = memory.get(Fact.LATCH, {})
        self.latched = {name for name in self.beliefs if stopped.get(name) == LATCHED}
        self.cleared = {name for name in self.beliefs if stopped.get(name) == CLEARED}
        self.reached: dict[str, Position] = {}  # the goal of each robot's last motion, once it is done
        self.under_way = UnderWay(model)
        self.unfinished = Unfinished(model)
        self.unnamed = UnnamedCommands(model)
        # By robot, the facts that a command was to set which has failed: what is reported of them may be old.
        self._doubtful_facts: dict[str, set[str]] = {}
        self.unheard_clears: set[str] = set()  # robots whose stop was cleared while they were offline
        self.last_sent: dict[str, Entry] = {}  # each robot's last command, a stop or halt left out
        self._last_work: dict[str, Entry] = {}  # of each robot
        # how often a robot refused a command, and the last why
        self.rejected: dict[str, tuple[int, Sentence | None]] = {}
        self.not_given: deque[Entry] = deque(maxlen=NOT_GIVEN_KEPT)  # commands of tasks that never left
        self.not_given_count = 0
        self._count = 0

    @property
    def next_deadline(self) -> float:
        """The time at which a command is due or a silence too long, s of the plant's clock; else inf."""
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
        barrier: Barrier = _unbarred,
        token: str | None = None,
    ) -> Entry:
        """Give a command its id and let it go, unless its robot is not ready for one or `barrier` objects.

        By hand, on an operator's word, an effector is opened even while its arm is stopped. A board that
        numbers its commands echoes `token`.
        """
        command = make(id=self._new_id())
        deadline = now + self._allowed_s(command, self.timings[cell])
        entry = Entry(command, cell=cell, doing=doing, sent_at=now, deadline=deadline)
        obstacle = self._obstacle_to(command, by_hand=by_hand, was=True) or barrier(command)
        if obstacle is not None:
            failure = replace(obstacle, sentence=NOT_GIVEN(why=obstacle.sentence, doing=doing))
            entry.refuse(failure, too_early=self.may_come_to_rest(command.robot))
            if not by_hand:
                self.not_given.append(entry)
                self.not_given_count += 1
            return entry
        if isinstance(command, Switch) and (doubtful := self._doubtful_facts.get(command.robot)):
            entry.must_be_named = any(name in doubtful for name, _ in command.sets)
        entry.origin = self.beliefs[command.robot].position
        entry.before = self.beliefs[command.robot].receipt
        entry.settles_at = self._settles_at(entry, now)
        self.ledger.open(entry)
        self.last_sent[command.robot] = entry
        if entry.is_work:
            self._last_work[command.robot] = entry
        if isinstance(command, Switch) and command.grips is not None:
            self.effectors.command(command)
        elif isinstance(command, Motion):
            self._forget_place(command.robot)
        self._leave(command, token)
        return entry

    def objection(self, make: Make, *, barrier: Barrier = _unbarred) -> Failure | None:
        """The reason for which a command would not leave now."""
        command = make(id="")
        return self._obstacle_to(command, by_hand=False) or barrier(command)

    def left_late(self, id: str, late_s: float) -> None:
        """Count the time in which a command settles from when it left, be it past its deadline."""
        entry = self.ledger.entries.get(id)
        if entry is not None and entry.settles_at is not None:
            entry.settles_at += late_s
            entry.deadline = max(entry.deadline, entry.settles_at)
            self.ledger.plan(entry)

    def cancel(self, entry: Entry, now: float) -> None:
        """Ask an open command to end, once: work that can be halted is, a query is forgotten."""
        entry.is_abandoned = True
        if entry.state is State.CANCELLING or entry.finishes:
            return
        self.ledger.feed(entry.command.id, Feed.CANCEL, now)
        if isinstance(entry.command, Query):
            self.ledger.feed(entry.command.id, Feed.HALTED, now)
            return
        entry.settles_at = None if entry.halts else entry.settles_at
        entry.cancelled_after = self.beliefs[entry.command.robot].moment(now)
        entry.deadline = now + self.timings[entry.cell].stop_timeout_s
        self.ledger.plan(entry)
        if entry.halts and entry.command.robot not in self.latched:
            self._stop(entry.command.robot, StopMode.HALT)

    def cancel_all(self, cell: str, now: float) -> None:
        """Ask every command of a cell to end."""
        for entry in self.ledger.of_cell(cell):
            self.cancel(entry, now)

    def obstacle(self, robot: str, *, was: bool = False) -> Failure | None:
        """Why a robot takes no command now; `was`: in words that stay true."""
        if robot in self.latched:
            return self.beliefs[robot].stopped(was=was)
        return self.beliefs[robot].obstacle(was=was)

    def work_of(self, robot: str) -> Entry | None:
        """The work of a robot that has not ended."""
        for entry in self.ledger.of_robot(robot):
            if entry.is_work:
                return entry
        return None

    def finishes(self, robot: str) -> bool:
        """True while a robot does work that goes on even when it is stopped, until it is finished."""
        work = self.work_of(robot)
        return work is not None and work.finishes

    def obstacle_to_opening(self, robot: str) -> Failure | None:
        """Why an effector cannot be opened by hand now."""
        return self._obstacle_to(self.model.robots[robot].let_go(id=""), by_hand=True)

    def latch(self, robot: str) -> None:
        """Stop a robot and let nothing move it until `unlatch`, whatever restarts meanwhile."""
        self.latched.add(robot)
        self.unheard_clears.discard(robot)
        self.memory.remember(Fact.LATCH, robot, LATCHED)
        self._stop(robot, StopMode.LATCH)

    def unlatch(self, robot: str) -> None:
        """Clear a robot's stop; it moves nothing, and the cell still needs its reset."""
        self.latched.discard(robot)
        self.beliefs[robot].barred = False
        if not self.beliefs[robot].online:
            self.unheard_clears.add(robot)
        self.memory.remember(Fact.LATCH, robot, CLEARED)
        self._stop(robot, StopMode.CLEAR)

    def forget_stop(self, robot: str) -> None:
        """A cleared robot's cell was reset: the stop is over."""
        self.memory.remember(Fact.LATCH, robot, None)

    def home(self, robot: str, cell: str, now: float) -> Entry:
        """Have a robot run its homing routine, on the word of its cell."""
        return self.send(partial(Home, robot=robot), cell, HOMING(), now)

    def _displace(self, belief: Belief, *, displaced: bool) -> None:
        """Remember if the position of a robot has lost its meaning, which it cannot report itself."""
        belief.displaced = displaced
        self.memory.remember(Fact.DISPLACED, belief.robot.name, DISPLACED if displaced else None)

    def declare_homed(self, robot: str) -> None:
        """An operator has put a robot that cannot say so at its reference, wherever it stood before."""
        belief = self.beliefs[robot]
        self._displace(belief, displaced=False)
        self._forget_place(robot)
        stands = belief.state in (None, MotionState.STOPPED)
        if belief.robot.reference is not None and not belief.supervised and stands:
            self.reached[robot] = belief.robot.reference
        self.wake([robot])

    def wake(self, holders: Iterable[str]) -> None:
        """Have the trees of these cells, and of these robots' cells, look again."""
        for name in holders:
            self.ledger.changed |= self._cells_of.get(name, {name})

    def place(self, workspace: Workspace) -> Pose | None:
        """The zone-free pose at, or above, which its robot stands, as far as its evidence goes.

        What it said last may be older than a move that it was just given, or than its last stop.
        """
        robot = workspace.robot
        belief = self.beliefs[robot.name]
        given = robot.name in self.under_way.ids or self.work_of(robot.name) is not None
        restless = belief.state is MotionState.MOVING or given
        if not belief.online or belief.unhomed or restless:
            return None
        here = belief.position if belief.supervised else self.reached.get(robot.name)
        if here is None or (belief.supervised and not belief.is_sure):
            return None
        return next((pose for spot, pose in workspace.free_spots if robot.motion.stands_at(here, spot)), None)

    def report(self, report: Report, now: float) -> None:
        """Merge a report and book what it proves.

        Reports of unknown or only drawn robots are ignored, and those that say what such a robot cannot.
        """
        belief = self.beliefs.get(report.robot)
        if belief is None or belief.drawn:
            return
        was_sure = belief.is_sure
        if belief.hear_again(report):
            if belief.is_sure and not was_sure:  # only now `place` and interlocks go by it
                self.wake([report.robot])
            self._prove(belief, report, now)
            return
        if belief.robot.objection(report) is not None:
            self.ledger.ignored["report"] += 1
            return
        before, facts = Before.of(belief), self._facts_shown(belief)
        was_held, held_since_boot = belief.held_in(belief), belief.held_boot
        self._hear_of_others(report)
        was_online, latched = belief.online, report.robot in self.latched
        new_link = latched and _is_new_link(belief, report)
        belief.merge(report)
        if report.robot in self.effectors.grips.opening:
            self.effectors.settle_opening(before, belief, report)
        if was_held and belief.held_in(belief) is False:
            self.effectors.note_opening(belief, rebooted=belief.held_boot != held_since_boot)
        if not belief.supervised and report.state not in (None, MotionState.STOPPED):
            self._moves_again(report.robot)
        goal = self.reached.get(report.robot)
        astray = goal is not None and evidence.strayed(before, belief, report, goal)
        if astray or evidence.displaced(before, belief, report):
            self._displace(belief, displaced=True)
        if belief.boot_id is not None and evidence.tells_boots_only(belief.robot):
            self.memory.remember(Fact.BOOT, report.robot, str(belief.boot_id))
        self._prove(belief, report, now, before)
        if latched and (new_link or (belief.online and not was_online)):  # it may have forgotten its stop
            self._stop(report.robot, StopMode.LATCH)
        if belief.is_sure and not was_sure:
            self.wake([report.robot])
        if self._facts_shown(belief) != facts:
            self.version += 1
            self.ledger.changed |= self._cells_of[report.robot]

    def interfere(self, robot: str, sentence: Sentence, now: float, *, obeyed: bool) -> None:
        """Somebody else commanded a robot; what it did of that may be why an open command fails."""
        self.interference.note(robot, sentence, now, obeyed=obeyed)
        self.version += 1
        for entry in self.ledger.of_robot(robot) if obeyed else ():
            entry.interference = sentence

    def question(self, robot: str) -> Entry | None:
        """The open question to a person; None where there is none, or this is no person."""
        questions = (e for e in self.ledger.of_robot(robot) if isinstance(e.command, Question) and e.open)
        return next(questions, None)

    def answer(self, robot: str, answer: str, now: float) -> None:
        """A person has answered what is being asked."""
        entry = self.question(robot)
        if entry is not None:
            self.report(Report(at=now, robot=robot, answered=entry.command.id, answer=answer), now)

    def _hear_of_others(self, report: Report) -> None:
        """A bridge counts the commands of others; each count that rose is news."""
        if report.foreign is not None:
            refused, obeyed = self.interference.rise(report)
            if refused or obeyed:
                self.interfere(report.robot, report.foreign, report.at, obeyed=obeyed)
        number = self.interference.forged(report, self.epoch, self._count)
        if number is not None:
            self._halt_forged(report, number)

    def _halt_forged(self, report: Report, number: int) -> None:
        """Somebody commanded a robot in the plant's name: it is halted, and the next numbers are higher."""
        sentence = NEVER_GIVEN(robot=report.robot, id=report.accepted or "")
        self.interfere(report.robot, sentence, report.at, obeyed=True)
        if number < MOST:
            self._count = number
        self._stop(report.robot, StopMode.HALT)

    def _prove(self, belief: Belief, report: Report, now: float, before: Before | None = None) -> None:
        """Book what a report proves; `before` is None where it only repeats what was believed."""
        name = report.robot
        if belief.stale_at is not None:
            self._stale_at[name] = belief.stale_at
        for entry in self.ledger.by_robot[name]:
            if report.accepted == entry.command.id and report.receipt is not None:
                entry.number = report.receipt[:2]
            verdict = evidence.judge(entry, before, belief, report)
            if verdict is not None:
                self._book(entry, verdict, now)
        if self.unnamed.ids.get(name):
            self.unnamed.hear(report)
        if name in self.unfinished.by_device:
            was_heard = before is None or before.online
            is_well = was_heard and belief.state not in UNWELL
            if self.unfinished.hear(report, now, is_well=is_well, unnamed=self.under_way.ids.get(name, ())):
                self.version += 1
                self.ledger.changed |= self._cells_of[name]
        if name in self.under_way.ids or name in self.unheard_clears:
            self.under_way.hear(report, now)
            if belief.online:
                self._say_again(belief, now)
        held = belief.held_in(belief)
        if held is not None and belief.online:  # what it said before its link was lost may be older
            self.effectors.settle(belief.robot.name, Grip.ON if held else Grip.OFF)

    def give_up(self, cell: str, failure: Failure, now: float) -> None:
        """Fail every open command of a cell, and halt what moves: nobody can judge them any more."""
        for entry in self.ledger.of_cell(cell):
            self._book(entry, Verdict(feed=Feed.FAILED, failure=failure), now)

    def _moves_again(self, robot: str) -> None:
        """A robot that tells no position moves, or cannot: it is no longer where its last move ended."""
        self._forget_place(robot)
        for entry in self.ledger.of_robot(robot):
            if entry.is_work and entry.settles_at is not None:
                entry.settles_at = None
                self.ledger.plan(entry)

    def _forget_place(self, robot: str) -> None:
        self.reached.pop(robot, None)

    def undelivered(self, id: str, robot: str, sentence: Sentence, now: float) -> None:
        """Fail a command that could not leave this process; one that was being cancelled has ended so."""
        failure = Failure(reason=Reason.LINK_LOST, sentence=sentence)
        for entry in self.ledger.of_robot(robot):
            if entry.command.id == id:
                self.effectors.grips.will_not_open(robot, id)
                feed = Feed.HALTED if entry.state is State.CANCELLING else Feed.FAILED
                self._book(entry, Verdict(feed=feed, failure=failure), now)

    def expire(self, limit: float, now: float, guard: Guard = unguarded) -> None:
        """End what is due up to and including `limit`: settling times, deadlines, silence."""
        if self.next_deadline > limit:
            return
        for entry in [entry for entry in self.ledger.entries.values() if entry.next_deadline <= limit]:
            guard(entry.cell, partial(self._end_overdue, entry, now))
        for name, belief in self.beliefs.items():
            if belief.stale_at is not None and belief.stale_at <= limit:
                guard(self.model.cell_of[name].name, partial(self._went_stale, belief, now))

    def _end_overdue(self, entry: Entry, now: float) -> None:
        verdict = _overdue(entry)
        entry.settled = verdict.feed is Feed.DONE
        self._book(entry, verdict, now)

    def _new_id(self) -> str:
        self._count += 1
        return f"{self.epoch}-{self._count}"

    def _stop(self, robot: str, mode: StopMode) -> None:
        self._leave(Stop(id=self._new_id(), robot=robot, mode=mode))

    def _leave(self, command: Command, token: str | None = None) -> None:
        link = self.model.robots[command.robot].link
        if link in UNSENT:
            return
        number = None if isinstance(command, Stop) else self.beliefs[command.robot].number
        if number is not None or (token is not None and link is Link.DRIVER):
            command = replace(command, heard=number, token=token)
        self.outbox.append(command)
        self.under_way.left(command)
        self.unnamed.left(command)

    def _say_again(self, belief: Belief, now: float) -> None:
        """A robot that is heard may have missed a clear, or the last command of all."""
        name = belief.robot.name
        if name in self.unheard_clears:
            self.unheard_clears.discard(name)
            if belief.state is MotionState.STOP_LATCHED:
                self._stop(name, StopMode.CLEAR)
        elif self.under_way.is_overdue(name, now) and not self.ledger.of_robot(name):
            is_awaited = self.unfinished.may_be_news(name, self.under_way.ids[name])
            if is_awaited or name in self.under_way.movers:
                self._stop(name, StopMode.HALT)

    def _facts_shown(self, belief: Belief) -> tuple[object, ...]:
        """The part of a belief to which trees and screens react: everything but positions."""
        return (belief.trouble, belief.piece, belief.effector, belief.facts_no)

    def _obstacle_to(self, command: Command, *, by_hand: bool, was: bool = False) -> Failure | None:
        robot = command.robot
        if (busy := self._busy_with(command)) is not None:
            now, before = BUSY_MOVING if isinstance(busy.command, Motion) else BUSY_WORKING
            return Failure(reason=Reason.REJECTED, sentence=(before if was else now)(robot=robot))
        if not by_hand and (fact := self._open_switch_of(command)) is not None:
            now, before = BUSY_SWITCHING
            sentence = (before if was else now)(robot=robot, fact=fact)
            return Failure(reason=Reason.REJECTED, sentence=sentence)
        if isinstance(command, Query):
            return self.beliefs[robot].unreachable(was=was) or self._unmet(command, was=was)
        if isinstance(command, Work) and (tool := self.effectors.opening_tool(robot)) is not None:
            return Failure(reason=Reason.REJECTED, sentence=MAY_LET_GO(robot=robot, tool=tool))
        obstacle = self.obstacle(robot, was=was)
        led_out = isinstance(command, Home) and self.beliefs[robot].is_led_out_by_homing
        if led_out and robot not in self.latched:
            obstacle = None
        moving = obstacle is not None and obstacle.reason is Reason.REJECTED
        if moving and self._shows_its_own_end(command) and not self._breaks_its_work(command):
            obstacle = None  # its last code may be older than the end of its last move, which was proven
        elif by_hand and obstacle:
            obstacle = self.beliefs[robot].obstacle_besides_stop(was=was)
        return obstacle or self._unmet(command, was=was)

    def _busy_with(self, command: Command) -> Entry | None:
        """The command that keeps a robot from another one: its work; from a query, only another query."""
        if not isinstance(command, Query):
            return self.work_of(command.robot)
        queries = (e for e in self.ledger.of_robot(command.robot) if isinstance(e.command, Query))
        return next(queries, None)

    def _open_switch_of(self, command: Command) -> str | None:
        """The fact of a switch that another one, which is still open, switches, too."""
        if not isinstance(command, Switch) or not self.ledger.of_robot(command.robot):
            return None
        facts = {name for name, _ in command.sets}
        others = (e.command for e in self.ledger.of_robot(command.robot) if isinstance(e.command, Switch))
        return next((name for other in others for name, _ in other.sets if name in facts), None)

    def _unmet(self, command: Command, *, was: bool) -> Failure | None:
        """The need of a command that its robot does not report as met."""
        belief = self.beliefs[command.robot]
        for name, value in command.needs:
            reported = belief.fact(name)
            if reported != value:
                robot, wanted = command.robot, shown(value)
                if reported is None:
                    sentence = NEEDS_UNSAID(robot=robot, fact=name, value=wanted)
                else:
                    needs = NEEDED if was else NEEDS
                    sentence = needs(robot=robot, fact=name, value=wanted, told=shown(reported))
                return Failure(reason=Reason.PRECONDITION, sentence=sentence)
        return None

    def may_come_to_rest(self, robot: str) -> bool:
        """True where a robot takes a command soon: it may have ended its last move, or nobody waits any more
        for what it does.
        """
        abandoned = any(entry.is_abandoned for entry in self.ledger.of_robot(robot))
        return abandoned or self._may_be_the_end_of_its_last_move(robot)

    def _may_be_the_end_of_its_last_move(self, robot: str) -> bool:
        """True where "moving" may be a late report of a move that the position has already proved done.

        At `state` nothing but that code proves a move: who says it again after its end is not to be trusted.
        """
        belief = self.beliefs[robot]
        return belief.moves and belief.robot.evidence is Evidence.JOINTS

    def _shows_its_own_end(self, command: Command) -> bool:
        """True where the end of an earlier move cannot be taken for that of this command."""
        evidence_level = self.beliefs[command.robot].robot.evidence
        if evidence_level is Evidence.JOINTS:
            return isinstance(command, Switch)
        return evidence_level is Evidence.IDS

    def _breaks_its_work(self, command: Command) -> bool:
        """True for a command that would end a need of its robot's last work, whose end nothing has proven."""
        work, sets = self._last_work.get(command.robot), dict(command.sets)
        if work is None or work.state is State.DONE:
            return False
        return any(sets.get(name, value) != value for name, value in work.command.needs)

    def _allowed_s(self, command: Command, timing: Timing) -> float:
        """The time that a command may take: its own, or by its distance, then not below `timeout_s`."""
        robot = self.model.robots[command.robot]
        if command.at_most_s is not None:
            return command.at_most_s
        if not isinstance(command, Work):
            return timing.effector_timeout_s
        here = self.beliefs[robot.name].known_position
        way = command.way if isinstance(command, Motion) else ()
        travel_s = robot.motion.travel_s(here, way) / robot.pace if way else HOMING_S
        return max(robot.timeout_s, travel_s * timing.deadline_factor + timing.deadline_floor_s)

    def _settles_at(self, entry: Entry, now: float) -> float | None:
        """The time at which a command without an answer counts as done; None where the robot must report.

        So does a switch of which nothing is reported, after the time that it takes; and a move, by a robot
        that tells no position, to where its last move ended: it may have nothing to say, and has
        `stop_timeout_s` to say that it moves.
        """
        command, timing = entry.command, self.timings[entry.cell]
        belief = self.beliefs[command.robot]
        evidence_level = belief.robot.evidence
        if evidence_level is Evidence.STATE and self._is_there(command):
            return min(now + timing.stop_timeout_s, entry.deadline)
        if not isinstance(command, Switch) or evidence_level is Evidence.IDS:
            return None
        has_facts = command.sets and all(belief.fact(name) is not None for name, _ in command.sets)
        if evidence_level is Evidence.JOINTS and has_facts:
            return None
        return now + timing.effector_settle_s + command.takes_s

    def _is_there(self, command: Command) -> bool:
        """True for a motion that ends where the robot's last one, which was done, has left it."""
        return isinstance(command, Motion) and command.way == (self.reached.get(command.robot),)

    def _book(self, entry: Entry, verdict: Verdict, now: float) -> None:
        """Feed the ledger; a motion that failed and may still be under way is halted."""
        before = entry.state
        entry.answer = verdict.answer
        self.ledger.feed(entry.command.id, verdict.feed, now, _explained(entry, verdict.failure))
        self.version += entry.state is not before
        if entry.state in (State.DONE, State.CANCELLED):
            self.under_way.ended(entry.command)
        if _lets_go(entry.command) and entry.state is State.FAILED and not was_broken_off(entry):
            self.effectors.unopened.add(entry.command.robot)
        if entry.state is State.DONE:
            self._done(entry.command)
        elif verdict.feed is Feed.REJECTED:
            self._reject(entry.command.robot, verdict.failure)
        failed = entry.state is State.FAILED and verdict.feed is not Feed.REJECTED
        if failed:
            self._doubt(entry)
        called_off = entry.state is State.CANCELLED and verdict.feed is Feed.HALTED and not verdict.failure
        if failed or called_off:
            self._expect_late(entry, verdict, now)
        if failed and entry.halts and verdict.failure and verdict.failure.reason not in KNOWN_STILL:
            self._stop(entry.command.robot, StopMode.HALT)

    def _expect_late(self, entry: Entry, verdict: Verdict, now: float) -> None:
        """Expect a command that is over for the plant, where its device may still carry it out.

        Reports of before it came show its device at rest. Where it is halted, its halt comes after it.
        """
        lasts_s = 0.0 if _ended_by_boot(verdict) else _arrives_s(entry, now)
        if entry.state is State.FAILED and _may_go_on(entry, verdict):
            lasts_s += self._allowed_s(entry.command, self.timings[entry.cell])
        if lasts_s > 0:
            self.unfinished.expect(entry.command, lasts_s, now)

    def _doubt(self, entry: Entry) -> None:
        """Take what is reported of the facts of a failed command for old, until another of them is done."""
        if entry.sets:
            facts = self._doubtful_facts.setdefault(entry.command.robot, set())
            facts.update(name for name, _ in entry.sets)

    def _reject(self, robot: str, failure: Failure | None) -> None:
        count, _ = self.rejected.get(robot, (0, None))
        self.rejected[robot] = (count + 1, failure.sentence if failure else None)
        belief, stopped = self.beliefs[robot], failure is not None and failure.reason is Reason.STOPPED
        belief.barred |= stopped and belief.state is not MotionState.STOP_LATCHED

    def _done(self, command: Command) -> None:
        if doubtful := self._doubtful_facts.get(command.robot):
            doubtful.difference_update(name for name, _ in command.sets)
        if command.robot in self.unfinished.by_device:
            self.unfinished.done(command)
        if not self.beliefs[command.robot].is_sure and isinstance(command, Work):
            self.beliefs[command.robot].be_sure()
        if isinstance(command, Switch) and command.grips is not None:
            self.effectors.set(command.robot, Grip.ON if command.grips else Grip.OFF)
        elif isinstance(command, Motion) and command.way:
            self.reached[command.robot] = command.way[-1]
        elif isinstance(command, Home):
            self._displace(self.beliefs[command.robot], displaced=False)

    def _went_stale(self, belief: Belief, now: float) -> None:
        belief.fall_silent()
        del self._stale_at[belief.robot.name]
        self.version += 1
        self.ledger.changed |= self._cells_of[belief.robot.name]
        for entry in self.ledger.of_robot(belief.robot.name):
            name, silence_s = belief.robot.name, belief.stale_after_s
            sentence = NO_TELEMETRY(robot=name, seconds=silence_s, doing=entry.doing)
            failure = Failure(reason=Reason.LINK_LOST, sentence=sentence)
            self._book(entry, Verdict(feed=Feed.FAILED, failure=failure), now)


def was_broken_off(entry: Entry) -> bool:
    """True for a command that failed by something from outside, or was halted: not by its device."""
    return entry.failure is None or entry.failure.reason in BROKEN_OFF


def _may_go_on(entry: Entry, verdict: Verdict) -> bool:
    """True where a device may carry out a command to its end that has failed.

    A boot ends all, and work that does not go on to its end is halted; but of a link that was lost nobody
    knows if the command, or word of its beginning, is still on its way.
    """
    lost = verdict.failure is not None and verdict.failure.reason is Reason.LINK_LOST
    return lost if entry.halts else not _ended_by_boot(verdict)


def _ended_by_boot(verdict: Verdict) -> bool:
    return verdict.failure is not None and verdict.failure.reason is Reason.REBOOTED


def _arrives_s(entry: Entry, now: float) -> float:
    """The time in which a command may still come to its device, which has not named it as accepted."""
    return 0.0 if entry.accepted_at is not None else max(0.0, entry.sent_at + FRESH_S - now)


def _lets_go(command: Command) -> bool:
    return isinstance(command, Switch) and command.grips is False


def _is_new_link(belief: Belief, report: Report) -> bool:
    """True where a robot is heard through a new bridge or boot."""
    new_bridge = report.epoch is not None and report.epoch != belief.epoch
    return new_bridge or (report.boot_id is not None and report.boot_id != belief.boot_id)


def _explained(entry: Entry, failure: Failure | None) -> Failure | None:
    """A failure that a command of somebody else may have caused says so."""
    if failure is None or entry.interference is None:
        return failure
    return replace(failure, sentence=BOTH(first=failure.sentence, second=entry.interference))


def _overdue(entry: Entry) -> Verdict:
    if entry.settles_at is not None and entry.settles_at <= entry.deadline:
        return Verdict(feed=Feed.DONE)
    stopping = entry.state is State.CANCELLING
    what = NOT_STOPPED if stopping else NOT_FINISHED
    waited = entry.deadline - (entry.cancelled_at if entry.cancelled_at is not None else entry.sent_at)
    sentence = what(robot=entry.command.robot, seconds=waited, doing=entry.doing)
    reason = Reason.STOP_UNCONFIRMED if stopping else Reason.DEADLINE
    return Verdict(feed=Feed.FAILED, failure=Failure(reason=reason, sentence=sentence))
