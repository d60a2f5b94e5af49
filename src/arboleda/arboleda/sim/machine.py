"""A device of a declared kind, virtual: it does what its verbs say, in the time that they take."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from arboleda.core.commands import Command, OnStop, Stop, StopMode
from arboleda.core.facts import Facts, Value
from arboleda.core.messages import Report
from arboleda.core.model import MotionState
from arboleda.kinds.declared import Device, Effect, Told

PERIOD_S = 0.1  # of its telemetry


@dataclass(frozen=True, kw_only=True)
class Deed:
    """A command that it carries out, until `ends_at` s."""

    command: Told
    ends_at: float


class Machine:
    """One virtual device; `step` takes commands in, at a time that is handed to it, and returns reports."""

    def __init__(self, device: Device, *, now: float, boot_id: int) -> None:
        self.device = device
        self.facts: dict[str, Value] = {name: type.first for name, type in device.kind.facts.items()}
        self.boot_id = boot_id
        self.latched = False
        self.next_deadline = now
        self._next_report = now
        self._deed: Deed | None = None
        self._accepted: str | None = None
        self._done: str | None = None
        self._rejected: tuple[str, str] | None = None
        self._answered: tuple[str, Value] | None = None

    @property
    def busy(self) -> bool:
        """Whether it is carrying something out."""
        return self._deed is not None

    def step(self, now: float, commands: Iterable[Command]) -> list[Report]:
        """Take commands in at `now` s; what it reports, at least once each PERIOD_S."""
        before = self._words()
        for command in commands:
            self._take(now, command)
        self._finish(now)
        reports = []
        if now >= self._next_report or self._words() != before:
            reports.append(self._report(now))
            self._next_report = now + PERIOD_S
        ends_at = self._deed.ends_at if self._deed else self._next_report
        self.next_deadline = min(self._next_report, ends_at)
        return reports

    def _take(self, now: float, command: Command) -> None:
        if isinstance(command, Stop):
            self._stop(command.mode)
        elif isinstance(command, Told):
            refusal = self._refusal(command)
            if refusal is not None:
                self._rejected = (command.id, refusal)
                return
            self._accepted = command.id
            self._deed = Deed(command=command, ends_at=now + command.told.takes_s)

    def _refusal(self, command: Told) -> str | None:
        if self.latched and command.told.effect is not Effect.QUERY:
            return "paro"
        if self._deed is not None:
            return "busy"
        unmet = next((name for name, value in command.needs if self.facts[name] != value), None)
        return None if unmet is None else f"needs_{unmet}"

    def _stop(self, mode: StopMode) -> None:
        self.latched = mode is StopMode.LATCH or (self.latched and mode is not StopMode.CLEAR)
        halts = self._deed is not None and self._deed.command.told.on_stop is OnStop.HALT
        if mode is not StopMode.CLEAR and halts:
            self._deed = None

    def _finish(self, now: float) -> None:
        deed = self._deed
        if deed is None or now < deed.ends_at:
            return
        self._deed = None
        self.facts.update(deed.command.sets)
        if deed.command.told.effect is Effect.QUERY:
            self._answered = (deed.command.id, self.device.kind.verbs[deed.command.verb].answers[0])
        self._done = deed.command.id

    def _state(self) -> MotionState:
        if self._deed is not None and self._deed.command.told.effect in (Effect.MOTION, Effect.PROCESS):
            return MotionState.MOVING
        return MotionState.STOP_LATCHED if self.latched else MotionState.STOPPED

    def _words(self) -> Sequence[object]:
        ended = (self._accepted, self._done, self._rejected, self._answered)
        return (*ended, self._state(), tuple(self.facts.items()))

    def _report(self, now: float) -> Report:
        rejected, refusal = self._rejected or (None, None)
        answered, answer = self._answered or (None, None)
        facts: Facts = tuple(self.facts.items())
        return Report(
            at=now,
            robot=self.device.name,
            boot_id=self.boot_id,
            accepted=self._accepted,
            done=self._done,
            rejected=rejected,
            refusal=refusal,
            answered=answered,
            answer=answer,
            state=self._state(),
            facts=facts,
        )
