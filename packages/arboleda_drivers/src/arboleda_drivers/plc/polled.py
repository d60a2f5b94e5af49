"""Driver of a PLC that is polled: a thread reads it again and again, and commands leave in `send`.

An order is several telegrams, and each waits for its answer. Before each one is asked whether the order may
still go on: not after a stop of its device, and not on another connection, as the plant has given it up then.
What is half written is not completed. A stop is the next telegram on the line, whoever else waits for it.
"""

from __future__ import annotations

import logging
import math
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, ClassVar, Generic, Protocol, TypeVar

from arboleda.drivers import (
    Clock,
    Command,
    DriverError,
    Hear,
    NotSent,
    Report,
    Robot,
    Stop,
    StopMode,
    lost,
)
from arboleda_drivers.plc.plc_snapshot import UnreadableValue, W, Writing

BEAT_S = 0.2  # period of reports without a change
AGAIN_S = 0.5
JOIN_S = 2.0
BEATS = 2**16
LOG = logging.getLogger("arboleda.drivers")


class RequestRefused(DriverError):
    """Error: a PLC has answered that it does not do what was asked; `word` names the reason."""

    def __init__(self, sentence: str, word: str) -> None:
        self.word = word
        super().__init__(sentence)


class Overtaken(Exception):
    """Error: this must not leave any more; the text says why."""


class Line(ABC):
    """Connection that the devices on it use in turns, of one telegram and its answer each.

    `connection` counts the connections. Whoever holds an order back for a stop is among the `stopping`: until
    that stop has left, nothing else leaves.
    """

    def __init__(self) -> None:
        self.connection = 0
        self._free = threading.Condition()
        self._holder: int | None = None  # the thread that has its turn
        self._stopping: set[object] = set()

    def hold_back(self, user: object) -> None:
        """Let nothing leave until `let_go`, but for the stop of this user; never waits."""
        with self._free:
            self._stopping.add(user)
            self._free.notify_all()

    def let_go(self, user: object) -> None:
        """The stop of this user has left, or never will. Idempotent."""
        with self._free:
            self._stopping.discard(user)
            self._free.notify_all()

    @contextmanager
    def turn(self, user: object = None, *, stops: bool = False) -> Iterator[None]:
        """Context with the line to oneself; an error ends the connection, and so drops a late answer.

        `stops`: for a stop, which goes before all others. An order of `user` whose stop goes before it has no
        turn any more: Overtaken. Within a turn of the same thread there is no other one to wait for.
        """
        if self._holder == threading.get_ident():
            yield
            return
        with self._free:
            while self._holder is not None or (self._stopping and not stops):
                if user in self._stopping and not stops:
                    raise Overtaken("a stop came first")
                self._free.wait()
            self._holder = threading.get_ident()
        try:
            yield
        except (RequestRefused, UnreadableValue, Overtaken):
            raise
        except Exception:  # after any error: an answer may still be on its way
            self._end_connection()
            raise
        finally:
            with self._free:
                self._holder = None
                self._free.notify_all()

    def close(self) -> None:
        """End the connection; the next request makes a new one."""
        with self.turn(stops=True):
            self._end_connection()

    def _end_connection(self) -> None:
        self.connection += 1
        self.hang_up()

    @abstractmethod
    def hang_up(self) -> None:
        """End the connection, if there is one; called with the line to itself."""


L = TypeVar("L", bound=Line)


class Lines(Generic[L]):
    """Lines in use: devices of the same address share one."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._lines: dict[Hashable, tuple[L, int]] = {}

    def take(self, address: Hashable, make: Callable[[], L]) -> L:
        """The line of an address, made if nobody has it yet."""
        with self._lock:
            line, users = self._lines.get(address) or (make(), 0)
            self._lines[address] = (line, users + 1)
            return line

    def give_back(self, address: Hashable) -> None:
        """Give a line back; the last user closes it."""
        with self._lock:
            line, users = self._lines.pop(address)
            if users > 1:
                self._lines[address] = (line, users - 1)
                return
        line.close()


class PollSettings(Protocol):
    """Settings that polling needs."""

    @property
    def poll_s(self) -> float: ...
    @property
    def timeout_s(self) -> float: ...
    @property
    def peer(self) -> str:
        """The name of the PLC for sentences."""


S = TypeVar("S", bound=PollSettings)


class Polled(ABC, Generic[S, L, W]):
    """Driver of one device: a thread polls it, commands leave in `send`; subclasses speak the protocol."""

    protocol: ClassVar[str]
    lines: ClassVar[Lines[Any]]

    def __init__(self, settings: S) -> None:
        self._settings = settings
        self._ending, self._wake = threading.Event(), threading.Event()
        self._machine = threading.Lock()  # around what is known of the device's commands
        self._line: L | None = None
        self._poller: threading.Thread | None = None
        self._up = False
        self._beats = 0
        self._beat_at = -math.inf
        self._last: Report | None = None

    @abstractmethod
    def prepare(self, device: Robot) -> None:
        """Make the machine of the device; raises DriverError if the library is missing."""

    @abstractmethod
    def address(self) -> Hashable:
        """The address whose line is shared."""

    @abstractmethod
    def make_line(self) -> L:
        """A new line, not connected yet."""

    @abstractmethod
    def begin(self, line: L) -> None:
        """Connect, and read what the PLC still shows of commands before."""

    @abstractmethod
    def reads(self, line: L) -> Iterator[None]:
        """Read all mapped values, a telegram at each step."""

    @abstractmethod
    def report(self, at: float) -> Report:
        """The report that the values read make."""

    @abstractmethod
    def writing(self, command: Command) -> Writing[W]:
        """The values that a command is; raises NotSent if there are none."""

    @abstractmethod
    def write(self, line: L, put: W) -> None:
        """Write one of them; raises RequestRefused if the PLC does not take it."""

    @abstractmethod
    def heartbeat(self, number: int) -> W | None:
        """The heartbeat to write, after whose end the PLC has to stop by itself; None without one."""

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        if len(devices) != 1:
            raise DriverError("a mapping is for one device")
        self._name, self._hear, self._clock = devices[0].name, hear, clock
        self.prepare(devices[0])
        self._line = self.lines.take(self.address(), self.make_line)
        self._poller = threading.Thread(target=self._poll, name=f"{self.protocol} {self._name}", daemon=True)
        self._poller.start()

    def listen(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """The same without a heartbeat: to the PLC nobody is there."""
        settings: Any = self._settings
        self._settings = replace(settings, heartbeat=None)
        self.start(devices, hear, clock)

    def interrupt(self, robot: str) -> None:
        """Let nothing leave before the stop that comes."""
        if self._line is not None:
            self._line.hold_back(self)

    def send(self, command: Command) -> None:
        line = self._line
        stops = isinstance(command, Stop) and command.mode is not StopMode.CLEAR
        try:
            if line is None or not self._up:
                raise NotSent(f"{self._settings.peer} is not connected")
            with self._machine:
                writing = self.writing(command)
            if stops:
                with line.turn(stops=True):
                    self._write(line, command, writing)
            else:
                self._write(line, command, writing)
        finally:
            if stops and line is not None:
                line.let_go(self)
        self._wake.set()

    def stop(self) -> None:
        self._ending.set()
        self._wake.set()
        if self._line is not None:
            self._line.let_go(self)
        if self._poller is not None:
            self._poller.join(JOIN_S + self._settings.timeout_s)
        if self._line is not None:
            self.lines.give_back(self.address())
            self._line = None

    def _write(self, line: L, command: Command, writing: Writing[W]) -> None:
        """Write what a command is, as long as it may go on."""
        connection = line.connection
        for number, put in enumerate(writing.puts):
            may_have_begun = number > 0 and not writing.begins_last
            try:
                with line.turn(self):
                    if line.connection != connection or not self._up:
                        raise Overtaken(f"{self._settings.peer} was lost meanwhile")
                    self.write(line, put)
            except Overtaken as error:
                if isinstance(command, Stop) or not may_have_begun:
                    raise NotSent(str(error)) from error
                LOG.warning("%s: half of an order has left, and may have begun: %s", self._name, error)
                return
            except RequestRefused as error:
                if isinstance(command, Stop):
                    line.close()
                    raise ConnectionError(f"{error}; it was a stop") from error
                if may_have_begun:
                    line.close()
                    raise ConnectionError(f"{error}; what was written before may have begun") from error
                self._refuse(command, error)
                return

    def _refuse(self, command: Command, error: RequestRefused) -> None:
        """Report a refusal with the present time: with the command's it would be older than a poll."""
        if command.id:
            self._hear(Report(at=self._clock(), robot=self._name, rejected=command.id, refusal=error.word))

    def _poll(self) -> None:
        assert self._line is not None
        while not self._ending.is_set():
            try:
                self._serve(self._line)
            except Exception as error:  # noqa: BLE001 - libraries raise their own and others; all mean: no link
                self._up, self._last = False, None
                self._hear(lost(self._name, at=self._clock(), why=self._why(error)))
            self._ending.wait(AGAIN_S)

    def _serve(self, line: L) -> None:
        """Report the values of the PLC until the end, or until something breaks."""
        self.begin(line)
        self._up = True
        while not self._ending.is_set():
            self._wake.clear()
            began = self._clock()
            for _ in self.reads(line):
                if self._clock() >= self._beat_at + BEAT_S:  # one poll may be many slow answers
                    self._beat(line)
            with self._machine:
                report = self.report(began)
            self._beat(line)
            self._say(report)
            self._wake.wait(self._settings.poll_s)

    def _beat(self, line: L) -> None:
        self._beats, self._beat_at = (self._beats + 1) % BEATS, self._clock()
        beat = self.heartbeat(self._beats)
        if beat is not None:
            self.write(line, beat)

    def _say(self, report: Report) -> None:
        """Hand over a report if it is news, and otherwise from time to time."""
        before = self._last
        if before is not None and report.again(before.at) == before and report.at - before.at < BEAT_S:
            return
        self._last = report
        self._hear(report)

    def _why(self, error: Exception) -> str:
        if isinstance(error, DriverError | ConnectionError):
            return str(error)
        return f"{self._settings.peer}: {error or type(error).__name__}"
