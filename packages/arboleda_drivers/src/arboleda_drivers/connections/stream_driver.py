"""Drivers at streams of bytes, serial lines or TCP connections: a thread around a machine."""

from __future__ import annotations

import selectors
import socket
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Protocol

from arboleda.drivers import Clock, Command, DriverError, Hear, NotSent, Report, Robot
from arboleda_drivers.connections.controller_machine import ControllerMachine
from arboleda_drivers.connections.device_feed import taking
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.connections.stream import Received, StreamAddress, Write

CONNECT_S, WRITE_S = 0.5, 0.5
AT_ONCE = 65536  # bytes
LONGEST_WAIT_S = 0.5
MISSING = "pyserial is not installed, which a serial line needs: pip install 'arboleda[serial]'"


class Stream(Protocol):
    """Open stream of bytes that a selector can wait for."""

    def fileno(self) -> int: ...
    def read(self) -> bytes: ...
    def write(self, data: bytes) -> None: ...
    def close(self) -> None: ...


Event = Callable[[bytes], object]
"""Event of a machine, made of bytes."""
Streams = Mapping[Stream, Event]
"""Open streams, each with the event that its bytes are."""


class TcpStream:
    """TCP connection to a serial server, or to a device that has one itself."""

    def __init__(self, host: str, port: int) -> None:
        self._socket = socket.create_connection((host, port), CONNECT_S)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def fileno(self) -> int:
        return self._socket.fileno()

    def read(self) -> bytes:
        return self._socket.recv(AT_ONCE)

    def write(self, data: bytes) -> None:
        self._socket.sendall(data)

    def close(self) -> None:
        self._socket.close()


class SerialStream:
    """Serial line by pyserial, which nobody else may open meanwhile."""

    def __init__(self, address: StreamAddress) -> None:
        try:
            import serial
        except ImportError as error:
            raise DriverError(MISSING) from error
        self._line = serial.Serial(
            address.serial, address.baud, timeout=0, write_timeout=WRITE_S, exclusive=True
        )

    def fileno(self) -> int:
        return int(self._line.fileno())

    def read(self) -> bytes:
        return bytes(self._line.read(AT_ONCE))

    def write(self, data: bytes) -> None:
        self._line.write(data)

    def close(self) -> None:
        self._line.close()


def open_stream(address: StreamAddress) -> Stream:
    """Open the stream of an address; raises OSError if it is not there, DriverError without pyserial."""
    return SerialStream(address) if address.serial else TcpStream(address.host, address.port)


class MachineDriver(ABC):
    """Driver around a machine. Commands leave in `send`; a thread connects, reads and keeps deadlines."""

    def __init__(self) -> None:
        self._lock = threading.Lock()  # around the machine and its messages
        self._ending = threading.Event()
        self._selector = selectors.DefaultSelector()
        self._woken, self._waker = socket.socketpair()
        self._thread: threading.Thread | None = None
        self._streams: Streams = {}
        self._is_to_open = False

    @abstractmethod
    def machine(self, devices: Sequence[Robot]) -> ControllerMachine:
        """The machine of these devices; raises an exception, with the reason, if they do not fit."""

    @abstractmethod
    def connect(self) -> tuple[object, Streams]:
        """The event that all is open, and the streams; raises OSError, with none open, if one is missing."""

    @abstractmethod
    def write(self, message: object) -> None:
        """Write what a message of the machine says, if it is one that does; may raise OSError."""

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self._hear, self._clock = hear, clock
        self._machine = self.machine(devices)
        self._selector.register(self._woken, selectors.EVENT_READ)
        name = f"{type(self).__name__} {devices[0].name}"
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def send(self, command: Command) -> None:
        for message in self._step([CommandRequest(command=command)]):
            if isinstance(message, CommandNotSent):
                raise NotSent(message.why)
        self._waker.send(b"!")  # its deadlines have changed

    def stop(self) -> None:
        self._ending.set()
        self._waker.send(b"!")
        if self._thread is not None:
            self._thread.join()
        self._hang_up()
        for each in (self._selector, self._woken, self._waker):
            each.close()

    def _run(self) -> None:
        while not self._ending.is_set():
            events = self._events()
            with taking([getattr(event, "data", b"") for event in events], self._lose):
                self._step(events)
                while self._opens():
                    self._step([self._connect()])

    def _lose(self, why: str) -> None:
        """Forget all that came over this stream."""
        with self._lock:
            self._hang_up()
        self._step([Closed(why=why)])

    def _step(self, events: list[object]) -> list[object]:
        with self._lock:
            messages: list[object] = self._machine.step(self._clock(), events)
            for message in messages:
                self._do(message)
        return messages

    def _do(self, message: object) -> None:
        if isinstance(message, Report):
            self._hear(message)
        elif isinstance(message, Close):
            self._hang_up()
        elif isinstance(message, Open):
            self._is_to_open = True  # by the thread that reads: `send` may be what found that it is due
        else:
            with suppress(OSError):  # the thread that reads finds it closed, or that nobody answers
                self.write(message)

    def _events(self) -> list[object]:
        """Waits until the machine's next deadline; returns the bytes that came, or that it was closed."""
        with self._lock:
            wait_s = self._machine.next_deadline - self._clock()
        events: list[object] = []
        for key, _ in self._selector.select(max(0.0, min(wait_s, LONGEST_WAIT_S))):
            if key.fileobj is self._woken:
                self._woken.recv(AT_ONCE)
            else:
                events.append(_read(key.data, self._streams[key.data]))
        if any(isinstance(event, Closed) for event in events):
            with self._lock:
                self._hang_up()
        return events

    def _opens(self) -> bool:
        """True once for each time that the machine wants its streams opened."""
        with self._lock:
            opens, self._is_to_open = self._is_to_open, False
        return opens

    def _connect(self) -> object:
        """Open all streams, or report the reason why that is impossible."""
        try:
            opened, streams = self.connect()
        except (OSError, ValueError, DriverError) as error:  # a bad speed is a ValueError of pyserial
            return Closed(why=str(error))
        with self._lock:
            self._streams = streams
            for stream in streams:
                self._selector.register(stream, selectors.EVENT_READ, stream)
        return opened

    def _hang_up(self) -> None:
        for stream in self._streams:
            self._selector.unregister(stream)
            stream.close()
        self._streams = {}


class StreamDriver(MachineDriver):
    """Driver at one stream, a serial line or a TCP connection."""

    def __init__(self, settings: StreamAddress) -> None:
        super().__init__()
        self._address = settings
        self._stream: Stream | None = None

    def open(self) -> Stream:
        """The stream, open; raises OSError if it is not there."""
        return open_stream(self._address)

    def connect(self) -> tuple[Opened, Streams]:
        self._stream = self.open()
        return Opened(), {self._stream: lambda data: Received(data=data)}

    def write(self, message: object) -> None:
        if isinstance(message, Write) and self._stream is not None:
            self._stream.write(message.data)


def _read(stream: Stream, event: Event) -> object:
    try:
        data = stream.read()
    except OSError as error:
        return Closed(why=str(error))
    return event(data) if data else Closed(why="the other end has closed the connection")
