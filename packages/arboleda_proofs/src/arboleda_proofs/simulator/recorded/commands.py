"""Every command that the plant sent and that has not ended, by its id.

`no_deadline_overrun` finds by it a cancel that gives a command more time instead of the time of a halt.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from typing import TYPE_CHECKING

from arboleda.drivers import (
    Command,
    Motion,
    MotionState,
    OnStop,
    Report,
    Stop,
    StopMode,
    Switch,
    VerbCommand,
    Work,
)
from arboleda.engine import OPEN, Entry, State
from arboleda.engine.inspection import Ledger
from arboleda.model.messages import Heartbeat, Verb
from arboleda.model.plant_model import Timing

from .robots import KnownRobot, Obstacle

if TYPE_CHECKING:
    from .cells import KnownCell

RECENT = 32  # goals per robot that may still be under way to its board


class SentCommand:
    """One command as it was sent; `state` and `entry` are what the ledger says after each step.

    `timing` are the times of its cell, which takes no others while one of its commands is open. `obstacles`
    spoke against it by what the robot had said; `verbs` are what operators asked for on its robot in the same
    step; `halts` counts the robot's halts and stops before it.
    """

    def __init__(
        self,
        command: Command,
        at: float,
        obstacles: frozenset[Obstacle],
        verbs: frozenset[Verb],
        halts: int,
        timing: Timing,
    ) -> None:
        self.command = command
        self.robot = command.robot
        self.at = at
        self.timing = timing
        self.late_s = 0.0  # between the plant's step and when it left
        self.obstacles = obstacles
        self.verbs = verbs
        self.halts = halts
        self.is_work = isinstance(command, Work)
        self.can_be_halted = isinstance(command, Work) and _on_stop(command) is OnStop.HALT
        self.finishes = self.is_work and not self.can_be_halted  # whatever stops its robot
        self.way = command.way if isinstance(command, Motion) else ()
        self.sets = command.sets
        self.rejected = False
        self.entry: Entry | None = None
        self.state: State | None = None
        self.deadline = at
        self.cancelled_at: float | None = None
        self.before: SentCommand | None = None  # the last one of its robot, a stop or halt left out

    def bind(self, entry: Entry, timing: Timing) -> None:
        """Bind it to its entry in the ledger."""
        self.entry, self.state, self.deadline, self.timing = entry, State.SENT, entry.deadline, timing

    def __str__(self) -> str:
        return f"{type(self.command).__name__} {self.command.id} to {self.robot}"


def _on_stop(command: Work) -> OnStop:
    """Its end at a stop, by the definition of its verb: what the command says of it is the engine's."""
    return command.definition.on_stop if isinstance(command, VerbCommand) else command.on_stop


class Commands:
    """`new`: commands sent in this step; `moved`: those that changed state in it, with the state before;
    `lost`: those that left the ledger without an end; `goals`: the last ones of each robot, whatever became
    of them; `soonest`: the first deadline of all, s.
    """

    def __init__(self, cells: Mapping[str, KnownCell]) -> None:
        self._cells = cells
        self.open: dict[str, SentCommand] = {}
        self.new: list[SentCommand] = []
        self.moved: list[tuple[SentCommand, State | None]] = []
        self.lost: list[SentCommand] = []
        self.goals: dict[str, deque[Command]] = {}
        self.last: dict[str, SentCommand] = {}  # of each robot, a stop or halt left out
        self.last_work: dict[str, SentCommand] = {}
        self.soonest = math.inf

    def forget(self) -> None:
        """Forget all commands, as the plant that sent them is gone."""
        self.open.clear()
        self.last.clear()
        self.last_work.clear()
        self.soonest = math.inf

    def clear_news(self) -> None:
        self.new.clear()
        self.moved.clear()
        self.lost.clear()

    def take(self, sent: SentCommand, known: KnownRobot) -> None:
        """Take in a command that the plant sent."""
        self.new.append(sent)
        command = sent.command
        known.unnamed = command.id
        if not isinstance(command, Stop):
            sent.before = self.last.get(command.robot)
            self.last[command.robot] = sent
        if sent.is_work:
            self.last_work[command.robot] = sent
        if isinstance(command, Stop):
            known.halts += command.mode is not StopMode.CLEAR
        elif not isinstance(command, Switch):
            self.goals.setdefault(command.robot, deque(maxlen=RECENT)).append(command)

    def left_late(self, message: Command | Heartbeat, late_s: float) -> None:
        """Take in that a message left so long after the step that gave it."""
        sent = None if isinstance(message, Heartbeat) else self.open.get(message.id)
        if sent is not None:
            sent.late_s = late_s

    def hear(self, report: Report, known: KnownRobot) -> None:
        """Take in a report that names the last rejected command.

        The last one may be over for the plant, as facts have proven it.
        """
        rejected, last = self.open.get(report.rejected or ""), self.last.get(report.robot)
        if rejected is None and last is not None and last.command.id == report.rejected and not last.rejected:
            rejected = last if last.state is State.DONE else None
        if rejected is not None:
            rejected.rejected = True
            known.barred |= report.refusal == "paro" and known.state is not MotionState.STOP_LATCHED

    def follow(self, ledger: Ledger, now: float) -> bool:
        """Take over from the ledger what became of open commands; True if anything changed."""
        for sent in self.new:
            entry = ledger.entries.get(sent.command.id)
            if entry is not None:
                sent.bind(entry, self._cells[entry.cell].timing)
                self.open[sent.command.id] = sent
        for sent in self.open.values():
            if sent.entry is not None and sent.entry.state is not sent.state:
                self._moved(sent, sent.entry.state, now)
        for sent, _ in self.moved:
            if sent.state not in OPEN:
                del self.open[sent.command.id]
        if len(self.open) != len(ledger.entries):
            self._lose(ledger)
        if not (self.new or self.moved or self.lost):
            return False
        deadlines = (sent.entry.deadline for sent in self.open.values() if sent.entry)
        self.soonest = min(deadlines, default=math.inf)
        return True

    def _moved(self, sent: SentCommand, state: State, now: float) -> None:
        self.moved.append((sent, sent.state))
        sent.state = state
        if state is State.CANCELLING:
            sent.cancelled_at = now

    def _lose(self, ledger: Ledger) -> None:
        self.lost += [sent for id, sent in self.open.items() if id not in ledger.entries]
        for sent in self.lost:
            del self.open[sent.command.id]
