"""One device behind a driver: what it may be told, what is believed of what comes back, its stop latch."""

from __future__ import annotations

import math
from collections import OrderedDict
from dataclasses import replace

from arboleda.model.commands import Command, OnStop, Stop, StopMode, Work, needs_clear
from arboleda.model.messages import Report
from arboleda.model.plant_model import Evidence, MotionState, Robot
from arboleda.model.sentence import Sentence

REMEMBERED = 256  # commands; an open one is never that old
IDS = ("accepted", "done", "rejected", "failed", "answered")
SILENCE = "silencio"  # what a board gives its work up with that hears no plant
WORDS = {"rejected": "refusal", "failed": "failure", "answered": "answer"}  # what goes with an id


class DrivenDevice:
    """Its link is up while reports come, at most `stale_after_s` apart; at `state` silence means nothing."""

    def __init__(self, robot: Robot, *, epoch: int, stale_after_s: float) -> None:
        self.robot = robot
        self.up = False
        self.stale_at = math.inf
        self._epoch = epoch
        self._silence_s = math.inf if robot.evidence is Evidence.STATE else stale_after_s
        self._longest_s = stale_after_s
        self._said_at = -math.inf
        self._boot_id: int | None = None
        self._known: OrderedDict[str, None] = OrderedDict()  # the ids of the commands that it was given
        self._work: Work | None = None  # what may still move it
        self._unwatched = False  # it was halted for want of a plant
        self._latched = False
        self._why: Sentence | None = None  # why there is no link

    def repeated(self, command: Command) -> bool:
        """Whether a command of this id came before; it counts as known from now on."""
        if command.id in self._known:
            return True
        self._known[command.id] = None
        if len(self._known) > REMEMBERED:
            self._known.popitem(last=False)
        return False

    def refusal(self, command: Command) -> str | None:
        """The word that refuses a command, None where it may leave; a stop is remembered in any case."""
        if isinstance(command, Stop):
            if command.mode is not StopMode.HALT:
                self._latched = command.mode is StopMode.LATCH
            if not self.robot.has_stop:
                return "no_stop"
        if not self.up:
            return "no_link"
        return "paro" if self._latched and needs_clear(command) else None

    def leaves(self, command: Command) -> None:
        """A command is handed to the driver."""
        if isinstance(command, Work):
            self._work, self._unwatched = command, False

    def refuse(self, at: float, command: Command, word: str) -> Report:
        state, why = (None, None) if self.up else (MotionState.NO_LINK, self._why)
        said = Report(at=at, robot=self.robot.name, state=state, lost=why, rejected=command.id, refusal=word)
        return self._stamped(said)

    def halt(self) -> Stop | None:
        """What ends the work that may still go on."""
        if self._work is None or not self._can_stop:
            return None
        return Stop(id="", robot=self.robot.name, mode=StopMode.HALT)

    @property
    def needs_plant(self) -> bool:
        """Whether it does what must not go on once the plant is not heard."""
        work = self._work
        return work is not None and work.on_stop is OnStop.HALT and not self._unwatched and self._can_stop

    def give_up(self, at: float) -> tuple[Report, Stop]:
        """What a board does by itself that hears no plant: its work has failed, and what moves is halted."""
        assert self._work is not None
        self._unwatched = True
        name = self.robot.name
        failed = Report(at=at, robot=name, failed=self._work.id, failure=SILENCE)
        return self._stamped(failed), Stop(id="", robot=name, mode=StopMode.HALT)

    def lose(self, at: float, why: Sentence) -> list[Report]:
        """There is no link any more, and whatever was open is nobody's; nothing is sent again."""
        return [self.no_link(at, why)] if self.up else []

    def say_lost(self, at: float, why: Sentence) -> list[Report]:
        """The driver says that there is no link; where there was none before, only another reason is news."""
        return [self.no_link(at, why)] if self.up or why != self._why else []

    def no_link(self, at: float, why: Sentence) -> Report:
        """The report that there is none, whether that is new or not."""
        self.up, self.stale_at, self._work, self._why = False, math.inf, None, why
        return self._stamped(Report(at=at, robot=self.robot.name, state=MotionState.NO_LINK, lost=why))

    def is_late(self, report: Report, now: float) -> bool:
        """Whether something newer was heard, or it is as old as a silence that loses the link."""
        return report.at < self._said_at or now - report.at > self._longest_s

    def hear(self, report: Report) -> tuple[Report, Stop | None]:
        """The report as the plant is to have it, and the stop that a device has to hear once more.

        One that comes back, or has booted, may have forgotten its latch; the operator has not.
        """
        booted = report.boot_id is not None and report.boot_id != self._boot_id
        returned = booted or not self.up
        self.up, self._said_at, self.stale_at = True, report.at, report.at + self._silence_s
        self._boot_id = self._boot_id if report.boot_id is None else report.boot_id
        ended = (report.done, report.rejected, report.failed)
        if booted or (self._work is not None and self._work.id in ended):
            self._work = None
        again = returned and self._latched and self.robot.has_stop
        stop = Stop(id="", robot=self.robot.name, mode=StopMode.LATCH) if again else None
        return self._stamped(self._of_ours(report)), stop

    @property
    def _can_stop(self) -> bool:
        return self.up and self.robot.has_stop

    def _of_ours(self, report: Report) -> Report:
        """Without what it says of commands that it was not given: they are of another start, or of others."""
        strange = [
            name for name in IDS if (id := getattr(report, name)) is not None and id not in self._known
        ]
        if not strange:
            return report
        gone = [*strange, *(WORDS[name] for name in strange if name in WORDS)]
        return report.again(report.at, **dict.fromkeys(gone))

    def _stamped(self, report: Report) -> Report:
        """The plant runs this itself: its own start is the one that is heard."""
        return replace(
            report,
            epoch=self._epoch,
            plant=self._epoch,
            receipt=None,
            foreign=None,
            foreign_refused=None,
            foreign_obeyed=None,
        )
