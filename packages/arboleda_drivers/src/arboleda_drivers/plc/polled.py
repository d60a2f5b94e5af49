"""Driver of a PLC that is polled: a thread reads it again and again, and commands leave in `send`."""

from __future__ import annotations

import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, ClassVar, Generic, Protocol, TypeVar

from arboleda.drivers import Clock, Command, DriverError, Hear, NotSent, Report, Robot, lost
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

BEAT_S = 0.2  # period of reports without a change
AGAIN_S = 0.5
JOIN_S = 2.0
BEATS = 2**16


class RequestRefused(DriverError):
    """Error: a PLC has answered that it does not do what was asked; `word` names the reason."""

    def __init__(self, sentence: str, word: str) -> None:
        self.word = word
        super().__init__(sentence)


class Line(ABC):
    """Connection that the devices on it use in turns."""

    def __init__(self) -> None:
        self._lock = threading.RLock()

    @contextmanager
    def turn(self) -> Iterator[None]:
        """Context with the line to oneself; an error ends the connection, and so drops a late answer."""
        try:
            with self._lock:
                yield
        except (RequestRefused, UnreadableValue):
            raise
        except Exception:  # after any error: an answer may still be on its way
            self.close()
            raise

    def close(self) -> None:
        """End the connection; the next request makes a new one."""
        with self._lock:
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


class Polled(ABC, Generic[S, L]):
    """Driver of one device: a thread polls it, commands leave in `send`; subclasses speak the protocol."""

    protocol: ClassVar[str]
    lines: ClassVar[Lines[Any]]

    def __init__(self, settings: S) -> None:
        self._settings = settings
        self._ending, self._wake = threading.Event(), threading.Event()
        self._line: L | None = None
        self._poller: threading.Thread | None = None
        self._up = False
        self._beats = 0
        self._last: tuple[float, Report] | None = None

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
    def read(self, line: L, at: float) -> Report:
        """Read all mapped values, as a report."""

    @abstractmethod
    def give(self, line: L, command: Command) -> None:
        """Write what a command is; raises RequestRefused if nothing of it has begun."""

    @abstractmethod
    def beat(self, line: L, number: int) -> None:
        """Write the heartbeat to the PLC, which has to stop by itself once it ends."""

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

    def send(self, command: Command) -> None:
        line = self._line
        if line is None or not self._up:
            raise NotSent(f"{self._settings.peer} is not connected")
        with line.turn():
            try:
                self.give(line, command)
            except RequestRefused as error:
                self._refuse(command, error)
        self._wake.set()

    def stop(self) -> None:
        self._ending.set()
        self._wake.set()
        if self._poller is not None:
            self._poller.join(JOIN_S + self._settings.timeout_s)
        if self._line is not None:
            self.lines.give_back(self.address())
            self._line = None

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
        with line.turn():
            self.begin(line)
            self._up = True
        while not self._ending.is_set():
            self._wake.clear()
            with line.turn():
                report = self.read(line, self._clock())
                self._beats = (self._beats + 1) % BEATS
                self.beat(line, self._beats)
            self._say(report)
            self._wake.wait(self._settings.poll_s)

    def _say(self, report: Report) -> None:
        """Hand over a report if it is news, and otherwise from time to time."""
        if self._last is not None:
            at, before = self._last
            if report.again(before.at) == before and report.at - at < BEAT_S:
                return
        self._last = (report.at, report)
        self._hear(report)

    def _why(self, error: Exception) -> str:
        if isinstance(error, DriverError | ConnectionError):
            return str(error)
        return f"{self._settings.peer}: {error or type(error).__name__}"
