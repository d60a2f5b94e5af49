"""Drives one pure machine: a thread, an inbox, and the clock that the machine never reads."""

from __future__ import annotations

import logging
import math
import threading
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any, Generic, Protocol, TypeVar

from arboleda.adapters.clock import seconds

log = logging.getLogger(__name__)

Event = TypeVar("Event", contravariant=True)
Message = TypeVar("Message")
Result = TypeVar("Result")


class StepInFlight(Exception):
    """The messages of the last step are still being sent."""


class Machine(Protocol[Event, Message]):
    """The interface that Plant, Bridge and Devices have in common."""

    def step(self, now: float, events: Sequence[Event]) -> list[Message]: ...

    @property
    def next_deadline(self) -> float | None: ...


def log_send_error(message: object, error: Exception) -> None:
    """Log a message that could not be sent; the default."""
    log.warning("%s was not sent: %s", message, error)


def log_crash(name: str, error: BaseException) -> None:
    """Log a crash; the default."""
    log.critical("%s has stopped on an internal error: %r", name, error)
    log.debug("%s crashed here", name, exc_info=error)


class Loop(Generic[Event, Message]):
    """Sleeps until an event arrives or a deadline passes, steps once, sends what comes out.

    A `step` (or an error handler) that raises ends the loop: `on_crash(name, error)`. A `send` that raises
    does not: `on_send_error(message, error)`. `arrange(messages)` gives what comes out of a step in the order
    in which it is sent, `on_step(now, events, messages)` sees every step after that. All of them are called
    in the loop's thread. `wait(condition, timeout_s)` is there for tests that move time by hand.
    """

    def __init__(
        self,
        name: str,
        machine: Machine[Event, Message],
        send: Callable[[Any], None],
        *,
        clock: Callable[[], float] = seconds,
        on_crash: Callable[[str, BaseException], None] = log_crash,
        on_send_error: Callable[[Any, Exception], None] = log_send_error,
        arrange: Callable[[Sequence[Any]], Sequence[Any]] | None = None,
        on_step: Callable[[float, Sequence[Any], Sequence[Any]], None] | None = None,
        wait: Callable[[threading.Condition, float | None], object] = threading.Condition.wait,
    ) -> None:
        self.name = name
        self._machine = machine
        self._send = send
        self._clock = clock
        self._on_crash = on_crash
        self._on_send_error = on_send_error
        self._arrange = arrange
        self._on_step = on_step
        self._wait = wait
        self._inbox: deque[Event] = deque()
        self._inbox_lock = threading.RLock()  # entered without a call, which a condition is not
        self._awake = threading.Condition(self._inbox_lock)
        self._ending = False
        self._inbox_due = math.inf
        self._sleeps_until = math.inf
        self._step_by: float | None = None
        self._between_steps = threading.Lock()
        self._handed_on = threading.Condition(self._between_steps)
        self._handing_on_since: float | None = None  # while the messages of a step are being sent
        self._readers = 0  # threads that wait until they are sent
        self.busy = False  # from the moment in which a step takes what waits to the end of what follows it
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        self._thread.start()

    @property
    def running(self) -> bool:
        """True if the loop was started and has not ended."""
        return self._thread.is_alive()

    def post(self, event: Any, within_s: float = 0.0) -> None:
        """Put an event into the inbox; from any thread, never blocks; after the end it is dropped.

        The next step takes it, within `within_s` at the latest.
        """
        due = self._clock() + within_s if within_s else -math.inf
        with self._inbox_lock:
            if self._ending:
                return
            self._inbox.append(event)
            self._inbox_due = min(due, self._inbox_due)
            if due < self._sleeps_until:
                self._sleeps_until = due
                self._awake.notify()

    def wake(self) -> None:
        """Step soon, even without an event; from any thread."""
        with self._inbox_lock:
            self._inbox_due = -math.inf
            if self._sleeps_until > -math.inf:
                self._sleeps_until = -math.inf
                self._awake.notify()

    def read(self, fn: Callable[[Any], Result]) -> Result:
        """`fn(machine)` between two steps, from any thread; `fn` changes nothing and does not read again."""
        with self._between_steps:
            return fn(self._machine)

    def read_handed_on(self, fn: Callable[[Any], Result], within_s: float) -> Result:
        """Read as `read`, but after a step whose messages are all sent; not in the loop's thread.

        StepInFlight if they are not all sent `within_s` after the step.
        """
        with self._between_steps:
            while (since := self._handing_on_since) is not None:
                left_s = since + within_s - self._clock()
                if left_s <= 0:
                    raise StepInFlight
                self._readers += 1
                self._handed_on.wait(left_s)
                self._readers -= 1
            return fn(self._machine)

    def wake_by(self, at: float) -> None:
        """Step by `at` at the latest, even without an event; from `on_step` only."""
        self._step_by = at

    def stop(self) -> None:
        """Step what was posted so far, end, and wait for the end; idempotent."""
        self._end()
        if self._thread.ident is not None and self._thread is not threading.current_thread():
            self._thread.join()

    def turn(self) -> None:
        """One step with everything that waits; `start` calls it, tests may."""
        self.busy = True
        with self._inbox_lock:
            events = tuple(self._inbox)
            self._inbox.clear()
            self._inbox_due, self._step_by = math.inf, None
        now = self._clock()
        with self._between_steps:
            messages = self._machine.step(now, events)
            if messages:
                self._handing_on_since = now
        if messages:
            for message in messages if self._arrange is None else self._arrange(messages):
                try:
                    self._send(message)
                except Exception as error:  # noqa: BLE001 - whatever the port raises, its message failed
                    self._on_send_error(message, error)
            with self._between_steps:
                self._handing_on_since = None
                if self._readers:
                    self._handed_on.notify_all()
        if self._on_step is not None:
            self._on_step(now, events, messages)
        self.busy = False

    def _run(self) -> None:
        try:
            while self._sleep():
                self.turn()
        except BaseException as error:  # noqa: BLE001 - handed over whole, a SystemExit of some library too
            self._end()
            self._on_crash(self.name, error)

    def _sleep(self) -> bool:
        """Sleep until there is something to step; False at the end."""
        with self._inbox_lock:
            while not self._ending:
                deadline = self._sleeps_until = self._deadline()
                timeout = None if deadline == math.inf else deadline - self._clock()
                if timeout is not None and timeout <= 0:
                    return True
                self._wait(self._awake, timeout)
            return bool(self._inbox)

    def _deadline(self) -> float:
        due = (self._inbox_due, self._machine.next_deadline, self._step_by)
        return min(at for at in due if at is not None)

    def _end(self) -> None:
        with self._awake:
            self._ending = True
            self._awake.notify()
