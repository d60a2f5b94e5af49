"""State machine of the driver `pylabrobot`: calls and looks of one machine become reports.

A call that returned is done once a look that began after it has read the facts. What PyLabRobot counts, and a
call was to change that did not return, is unknown until a call that sets it returns. While a call is under
way nothing is read, unless the backend takes questions beside it; an empty look then proves that the event
loop runs. A call or a look without an end is silence.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence

from arboleda.drivers import (
    Command,
    Device,
    Effect,
    Facts,
    MotionState,
    Report,
    Robot,
    Stop,
    StopMode,
    VerbCommand,
    Work,
    lost,
    plain,
)
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.meaning import UnreadableValue

from .messages import (
    BeginCalls,
    Begun,
    CancelCalls,
    Event,
    Look,
    Looked,
    LookFailed,
    Message,
    Raised,
    Returned,
)
from .settings import Call, MachineMapping
from .tasks import Task, Tasks, UnknownFacts

AGAIN_S = 2.0  # between two tries to set a machine up, or to read one that could not be read
BEAT_S = 0.5  # period of reports while a look takes its time
LONGEST = 160  # characters of an exception


class Machine:
    """State machine of one machine of PyLabRobot; `step` takes events and returns actions and reports."""

    def __init__(self, devices: Sequence[Robot], settings: MachineMapping) -> None:
        """Raises ValueError unless the device is one of a declared kind that the mapping fits."""
        if len(devices) != 1 or not isinstance(devices[0], Device):
            raise ValueError("a mapping is for one device of a declared kind")
        self._device, self._settings = devices[0], settings
        self._paths = tuple(dict.fromkeys(reading.read for reading in settings.facts.values()))
        self._paths += () if settings.boot is None else (settings.boot,)
        self._out: list[Message] = []
        self._open_at, self._open_until, self._open = -math.inf, math.inf, False
        self._numbers, self._looks = 0, 0
        self._boot, self._boot_shown = 0, None  # type: int, object
        self._latched = False
        self._receipts: dict[str, object] = {}
        self._reported_at = -math.inf
        self._unknown = UnknownFacts(name for name, one in settings.facts.items() if one.is_counted)
        self._tasks = Tasks(side_by_side=settings.side_by_side)
        self._forget(0.0)

    def _forget(self, now: float) -> None:
        """Forget the machine: its calls end with it."""
        for task in self._tasks.values():
            self._unknown.end(task)
        self._tasks = Tasks(side_by_side=self._settings.side_by_side)
        self._stops: deque[Stop] = deque()  # that wait for the end of another
        self._up = False
        self._look_at, self._looking_since = now, math.inf
        self._is_full_look = self._is_overdue = False
        self._facts: Facts | None = None

    @property
    def next_deadline(self) -> float:
        """The time (s) at which `step` is due even without events."""
        if not self._open:
            return min(self._open_at, self._open_until)
        overdue_at = math.inf if self._is_overdue else self._looking_since + self._settings.timeout_s
        ends = [task.until for task in self._tasks.values() if self._up and task.over is None]
        beat_at = self._reported_at + BEAT_S if self._up else math.inf
        return min(overdue_at if self._is_looking else self._look_at, beat_at, *ends)

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Take events and the time, and return messages to act on."""
        for event in events:
            self._take(now, event)
        self._pass_time(now)
        out, self._out = self._out, []
        return out

    def _take(self, now: float, event: Event) -> None:
        if isinstance(event, CommandRequest):
            self._command(now, event.command)
        elif isinstance(event, Opened):
            self._forget(now)
            self._open, self._open_until = True, math.inf
            self._boot += 1
            self._receipts = {}
        elif isinstance(event, Closed):
            self._out.append(Close())
            self._shut(now, event.why)
        elif isinstance(event, Looked | LookFailed):
            if self._open and event.number == self._looks:
                self._look_ended(now, event)
        elif self._open:
            self._call_changed(now, event)

    def _pass_time(self, now: float) -> None:
        if not self._open:
            if self._open_at <= now:
                self._open_at, self._open_until = math.inf, now + self._settings.setup_s
                self._out.append(Open())
            elif self._open_until <= now:
                self._out.append(Close())
                self._shut(now, f"its setup has not come back for {self._settings.setup_s:g} s")
            return
        late = self._tasks.late(now)
        if late is not None and self._up:
            self._lose(now, f"a call has not come back for {now - late.began_at:.0f} s")
        elif not self._is_overdue and now >= self._looking_since + self._settings.timeout_s:
            self._is_overdue = True
            self._lose(now, f"it has not been read for {self._settings.timeout_s:g} s")
        if self._open and not self._is_looking and now >= self._look_at:
            self._looks += 1
            self._looking_since, self._is_full_look = now, not self._tasks.are_disturbed
            self._out.append(Look(number=self._looks, paths=self._paths if self._is_full_look else ()))
        if self._up and now >= self._reported_at + BEAT_S:
            self._report(now)

    # The link.

    @property
    def _waits_for_person(self) -> bool:
        """True where its setup has failed, and is called again once a person says so."""
        return not self._open and self._open_at == self._open_until == math.inf

    @property
    def _is_looking(self) -> bool:
        return self._looking_since < math.inf

    def _shut(self, now: float, why: str) -> None:
        """Note that the machine could not be set up, or is gone."""
        name, again = self._device.name, self._settings.setup_again
        hint = (
            f"; setup is not called again by itself, as it may move: see to it, then stop {name} and "
            f"clear {name}, which calls it"
        )
        self._forget(now)
        self._open, self._open_until = False, math.inf
        self._open_at = now + AGAIN_S if again else math.inf
        self._say_lost(now, why if again else why + hint)

    def _lose(self, now: float, why: str, *, gone: bool = True) -> None:
        """Report silence; a machine that is gone is made anew where that is allowed."""
        self._up = False
        self._stops.clear()
        self._tasks.disown()
        if gone and self._settings.setup_again:
            self._out.append(Close())
            self._shut(now, why)
        else:
            self._say_lost(now, why)

    def _say_lost(self, now: float, why: str) -> None:
        self._out.append(lost(self._device.name, at=now, why=plain(f"{self._settings.peer}: {why}")))

    # Looks.

    def _look_ended(self, now: float, event: Looked | LookFailed) -> None:
        self._looking_since, self._is_overdue = math.inf, False
        self._look_at = now + (self._settings.poll_s if self._up else AGAIN_S)
        if isinstance(event, LookFailed):
            self._lose(now, event.why)
            return
        try:
            self._read(event.values)
        except UnreadableValue as error:
            self._lose(now, str(error), gone=False)
            return
        if self._tasks.late(now) is not None:
            return  # the event loop runs, and a call hangs
        self._up, self._look_at = True, now + self._settings.poll_s
        for task in list(self._tasks.values()):
            if task.over is not None and self._is_full_look and task.first_look <= event.number:
                del self._tasks[task.number]
                self._settle(task, task.over)
        if self._tasks and not self._tasks.are_disturbed:
            self._look_at = now  # it ended after this look had begun
        self._report(now)

    def _read(self, values: Mapping[str, object]) -> None:
        """Take over what a look has read; an empty one says nothing."""
        if not self._is_full_look:
            return
        kinds = self._device.kind.facts
        facts = ((name, one) for name, one in self._settings.facts.items() if name not in self._unknown.names)
        self._facts = tuple((name, one.value_of(values.get(one.read), kinds[name])) for name, one in facts)
        boot = None if self._settings.boot is None else str(values.get(self._settings.boot))
        if self._boot_shown is not None and boot != self._boot_shown:
            self._boot += 1
            self._receipts = {}
            self._stops.clear()
            self._tasks.disown()
        self._boot_shown = boot

    # Commands.

    def _command(self, now: float, command: Command) -> None:
        if not self._up:
            if self._waits_for_person and isinstance(command, Stop) and command.mode is StopMode.CLEAR:
                self._open_at = now
            self._out.append(CommandNotSent(why=f"{self._settings.peer} is not there"))
        elif isinstance(command, Stop):
            self._stop(now, command)
        elif not isinstance(command, VerbCommand) or command.verb not in self._settings.verbs:
            self._out.append(CommandNotSent(why=f"nothing is called for {command.word or 'this'}"))
        elif not self._tasks.takes(command):
            self._tell(now, rejected=command.id, refusal="busy")
        else:
            verb = self._settings.verbs[command.verb]
            calls = tuple(call.filled(dict(command.values)) for call in verb.calls)
            self._begin(now, command, calls, "" if verb.answer is None else verb.answer.read)

    def _begin(
        self, now: float, command: VerbCommand | Stop, calls: Sequence[Call], result: str = ""
    ) -> None:
        self._numbers += 1
        longest = command.at_most_s if isinstance(command, VerbCommand) else None
        allowed = math.inf if longest is None else longest + self._settings.timeout_s
        until = now + min(allowed, self._settings.call_s or math.inf)
        if isinstance(command, Stop):
            until = now + self._settings.timeout_s
        self._tasks[self._numbers] = Task(
            number=self._numbers,
            began_at=now,
            until=until,
            command=command,
            is_work=isinstance(command, Work),
            sets=frozenset(name for name, _ in command.sets),
        )
        self._facts = None  # until they are read again
        beside = isinstance(command, Stop)
        self._out.append(BeginCalls(number=self._numbers, calls=calls, result=result, beside=beside))

    def _stop(self, now: float, command: Stop) -> None:
        if command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
        if command.mode is not StopMode.CLEAR and any(task.finishes for task in self._tasks.values()):
            self._tell(now, accepted=command.id)  # it goes on to its own end
            return
        if command.mode is not StopMode.CLEAR:
            for task in self._tasks.values():
                self._drop(task)
        if self._tasks.stops:
            self._stops.append(command)
        else:
            self._call_stop(now, command)

    def _drop(self, task: Task) -> None:
        """Forget what a work was for: halted, it is never done."""
        if task.is_work:
            task.command = None
            if self._settings.cancels and task.over is None:
                self._out.append(CancelCalls(number=task.number))

    def _call_stop(self, now: float, command: Stop) -> None:
        settings = self._settings
        calls = settings.clear
        if command.mode is not StopMode.CLEAR:
            calls = (settings.latch or settings.halt) if command.mode is StopMode.LATCH else settings.halt
        if calls:
            self._begin(now, command, calls)
        else:
            self._tell(now, accepted=command.id)

    # Calls.

    def _call_changed(self, now: float, event: Begun | Returned | Raised) -> None:
        task = self._tasks.get(event.number)
        if task is None or task.over is not None:
            return
        if isinstance(event, Begun):
            if isinstance(task.command, VerbCommand):
                self._tell(now, accepted=task.command.id)
            return
        task.over = event
        self._unknown.end(task, began=not (isinstance(event, Raised) and self._refuses(event)))
        if isinstance(task.command, Stop):
            self._stop_ended(now, task, task.command, event)
            return
        task.first_look = self._looks + 1
        self._look_at = now

    def _refuses(self, raised: Raised) -> bool:
        """True for an exception that says that nothing has begun."""
        return raised.first and raised.name in self._settings.refusals

    def _stop_ended(self, now: float, task: Task, stop: Stop, event: Returned | Raised) -> None:
        del self._tasks[task.number]
        if isinstance(event, Raised):
            self._lose(now, f"its stop was not taken: {event.name}: {event.text}")
            return
        self._tell(now, accepted=stop.id)
        if self._stops:
            self._call_stop(now, self._stops.popleft())

    def _settle(self, task: Task, event: Returned | Raised) -> None:
        """Say how a call has ended, with the facts that were read after it."""
        command = task.command
        if not isinstance(command, VerbCommand):
            return
        if isinstance(event, Raised):
            word = plain(f"{event.name}: {event.text}" if event.text else event.name, LONGEST)
            if self._refuses(event):
                self._receipts |= {"rejected": command.id, "refusal": word}
            else:
                self._receipts |= {"failed": command.id, "failure": word}
            return
        self._receipts["accepted"] = command.id
        answer = self._settings.verbs[command.verb].answer
        if command.definition.effect is not Effect.QUERY or answer is None:
            self._receipts["done"] = command.id
            return
        try:
            self._receipts |= {
                "answered": command.id,
                "answer": answer.value_of(event.result, command.definition.answer_type),
            }
        except UnreadableValue as error:
            self._receipts |= {"failed": command.id, "failure": plain(str(error), LONGEST)}

    # What the plant hears.

    def _tell(self, now: float, **ids: str) -> None:
        if all(ids.values()):
            self._receipts |= ids
            self._report(now)

    def _state(self) -> MotionState:
        if self._tasks.works or self._tasks.stops:
            return MotionState.MOVING
        return MotionState.STOP_LATCHED if self._latched else MotionState.STOPPED

    def _report(self, now: float) -> None:
        self._reported_at = now
        report = Report(at=now, robot=self._device.name, boot_id=self._boot, state=self._state())
        unknown = tuple(sorted(self._unknown.names))
        self._out.append(report.again(now, facts=self._facts, unknown=unknown, **self._receipts))
