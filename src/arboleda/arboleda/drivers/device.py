"""Device behind a driver: checks its commands and reports, and keeps its stop latch."""

from __future__ import annotations

import math
from collections import OrderedDict
from dataclasses import replace

from arboleda.model import refusals
from arboleda.model.commands import Command, OnStop, Stop, StopMode, Work, needs_clear
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Evidence, Robot
from arboleda.model.sentence import Sentence

REMEMBERED = 256  # commands; an open one is never that old
IDS = ("accepted", "done", "rejected", "failed", "answered")
SILENCE = "silencio"  # the word of a board that gives up its work without a plant
WORDS = {"rejected": "refusal", "failed": "failure", "answered": "answer"}  # the field beside each id


class DrivenDevice:
    """Device of a driver; its link is up while reports come at most `stale_after_s` apart, or at `state`."""

    def __init__(self, robot: Robot, *, epoch: int, stale_after_s: float) -> None:
        self.robot = robot
        self.up = False
        self.stale_at = math.inf
        calls = (make(id="") for make in robot.calls.values())
        finishes = any(isinstance(call, Work) and call.on_stop is OnStop.FINISH for call in calls)
        watches = robot.driver is not None and robot.driver.watches_plant
        self._may_be_at_work = finishes or (watches and robot.evidence is Evidence.IDS)
        self._epoch = epoch
        self._silence_s = math.inf if robot.evidence is Evidence.STATE else stale_after_s
        self._longest_s = stale_after_s
        self._reported_at = -math.inf
        self._boot_id: int | None = None
        self._known: OrderedDict[str, None] = OrderedDict()  # the ids of the commands that it was given
        self._work: Work | None = None  # the work that may still move it
        self._unwatched = False  # it was halted for want of a plant
        self._unseen = True  # it has not said since its link is up whether it moves
        self._latched = False
        self._why: Sentence | None = None  # the reason for a missing link

    def repeated(self, command: Command) -> bool:
        """True if a command of this id came before; remembers the id."""
        if command.id in self._known:
            return True
        self._known[command.id] = None
        if len(self._known) > REMEMBERED:
            self._known.popitem(last=False)
        return False

    def refusal(self, command: Command) -> str | None:
        """The word that refuses a command; None if it may leave. A stop is remembered in either case."""
        if isinstance(command, Stop):
            if command.mode is not StopMode.HALT:
                self._latched = command.mode is StopMode.LATCH
            if not self.robot.has_stop:
                return refusals.NO_STOP
        if not self.up:
            return refusals.NO_LINK
        return refusals.STOPPED if self._latched and needs_clear(command) else None

    def leaves(self, command: Command) -> None:
        """Note that a command is handed to the driver."""
        if isinstance(command, Work):
            self._work, self._unwatched = command, False

    def refuse(self, at: float, command: Command, word: str) -> Report:
        state, why = (None, None) if self.up else (MotionState.NO_LINK, self._why)
        reply = Report(at=at, robot=self.robot.name, state=state, lost=why, rejected=command.id, refusal=word)
        return self._stamped(reply)

    def halt(self) -> Stop | None:
        """The stop that ends work which may still go on; None if there is none, or the device cannot stop."""
        if self._work is None or not self._can_stop:
            return None
        return Stop(id="", robot=self.robot.name, mode=StopMode.HALT)

    @property
    def needs_plant(self) -> bool:
        """True while the device does work that must not go on once the plant has fallen silent."""
        work = self._work
        return work is not None and work.on_stop is OnStop.HALT and not self._unwatched and self._can_stop

    def give_up(self, at: float) -> tuple[Report, Stop]:
        """A report that the work has failed, and a stop that halts it: as a board does without its plant."""
        assert self._work is not None
        self._unwatched = True
        name = self.robot.name
        failed = Report(at=at, robot=name, failed=self._work.id, failure=SILENCE)
        return self._stamped(failed), Stop(id="", robot=name, mode=StopMode.HALT)

    def lose(self, at: float, why: Sentence) -> list[Report]:
        """Lose the link: open work is forgotten, and nothing is sent again."""
        return [self.no_link(at, why)] if self.up else []

    def say_lost(self, at: float, why: Sentence) -> list[Report]:
        """The report of a lost link, on the driver's word; without a link before, only for a new reason."""
        return [self.no_link(at, why)] if self.up or why != self._why else []

    def no_link(self, at: float, why: Sentence) -> Report:
        """The report that there is no link, even if that is known."""
        self.up, self.stale_at, self._work, self._why = False, math.inf, None, why
        self._unseen = True
        return self._stamped(Report(at=at, robot=self.robot.name, state=MotionState.NO_LINK, lost=why))

    def is_overtaken(self, report: Report) -> bool:
        """True if a newer report was heard."""
        return report.at < self._reported_at

    def is_old(self, report: Report, now: float) -> bool:
        """True for a report so old that its age alone would lose the link.

        Once it is lost, a report is old after half that time: the next one must come before this one is old,
        or the link would be lost again each time.
        """
        return now - report.at > (self._longest_s if self.up else self._longest_s / 2)

    def hear(self, report: Report) -> tuple[Report, Stop | None]:
        """The report for the plant, and a stop to send because of it; None for no stop.

        A device that comes back, or has booted, may have forgotten its latch; the operator has not. A robot
        that moves as its link comes up does what nobody of this start waits for: its driver may have been
        begun anew since, and know nothing of that work.
        """
        booted = report.boot_id is not None and report.boot_id != self._boot_id
        returned = booted or not self.up
        self.up, self._reported_at, self.stale_at = True, report.at, report.at + self._silence_s
        self._boot_id = self._boot_id if report.boot_id is None else report.boot_id
        ended = (report.done, report.rejected, report.failed)
        if booted or (self._work is not None and self._work.id in ended):
            self._work = None
        strays = self._strays(report)
        mode = StopMode.LATCH if returned and self._latched else StopMode.HALT if strays else None
        stop = Stop(id="", robot=self.robot.name, mode=mode) if mode and self.robot.has_stop else None
        return self._stamped(self._of_ours(report)), stop

    def _strays(self, report: Report) -> bool:
        """True for a device at work as its link comes up.

        Not where its work may have to end by itself, or a device that numbers its work would have ended it
        without its plant: what it then says of that work is still believed.
        """
        if report.state is None:
            return False
        unseen, self._unseen = self._unseen, False
        is_at_work = report.state is MotionState.MOVING
        return unseen and self._work is None and is_at_work and not self._may_be_at_work

    @property
    def _can_stop(self) -> bool:
        return self.up and self.robot.has_stop

    def _of_ours(self, report: Report) -> Report:
        """The report without commands that this device was not given: another start's, or others'."""
        strange = [
            name for name in IDS if (id := getattr(report, name)) is not None and id not in self._known
        ]
        if not strange:
            return report
        gone = [*strange, *(WORDS[name] for name in strange if name in WORDS)]
        return report.again(report.at, **dict.fromkeys(gone))

    def _stamped(self, report: Report) -> Report:
        """The report with this start of the plant as the one that the device hears."""
        return replace(
            report,
            epoch=self._epoch,
            plant=self._epoch,
            foreign=None,
            foreign_refused=None,
            foreign_obeyed=None,
        )
