"""The driver `dobot`: two sockets and a thread around its machine."""

from __future__ import annotations

import selectors
import socket
import threading
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

from arboleda.adapters.device_feed import taking
from arboleda.drivers.dobot.machine import (
    Close,
    Closed,
    CommandNotSent,
    CommandRequest,
    ConnectionsOpened,
    DashboardReply,
    Event,
    FeedbackData,
    Machine,
    Message,
    Open,
    SendLine,
)
from arboleda.drivers.dobot.settings import Settings
from arboleda.drivers.port import Clock, Hear, NotSent, driver
from arboleda.model.commands import Command
from arboleda.model.messages import Report
from arboleda.model.plant_model import Robot

CONNECT_S = 0.5
AT_ONCE = 65536  # bytes
LONGEST_WAIT_S = 0.5


@driver("dobot", settings=Settings)
class Dobot:
    """Driver of one arm of Dobot's CR series. Commands leave in `send`; a thread connects and reads."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._lock = threading.Lock()  # around the machine and what it sends
        self._ending = threading.Event()
        self._dashboard: socket.socket | None = None
        self._selector = selectors.DefaultSelector()
        self._woken, self._waker = socket.socketpair()
        self._thread: threading.Thread | None = None

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self._hear, self._clock = hear, clock
        self._machine = Machine(devices, self._settings)
        self._selector.register(self._woken, selectors.EVENT_READ)
        self._thread = threading.Thread(target=self._run, name=f"dobot {devices[0].name}", daemon=True)
        self._thread.start()

    def listen(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        """The same without asking for control, which others may have."""
        self._settings = replace(self._settings, request_control=False)
        self.start(devices, hear, clock)

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
            events = self._heard()
            with taking([getattr(event, "data", b"") for event in events], self._lose):
                while any(isinstance(message, Open) for message in self._step(events)):
                    events = [self._connect()]

    def _lose(self, why: str) -> None:
        """Forget all that came over this connection."""
        with self._lock:
            self._hang_up()
        self._step([Closed(why=why)])

    def _step(self, events: list[Event]) -> list[Message]:
        with self._lock:
            messages = self._machine.step(self._clock(), events)
            for message in messages:
                self._do(message)
        return messages

    def _do(self, message: Message) -> None:
        if isinstance(message, Report):
            self._hear(message)
        elif isinstance(message, Close):
            self._hang_up()
        elif isinstance(message, SendLine) and self._dashboard is not None:
            with suppress(OSError):  # the thread that hears it finds it closed
                self._dashboard.sendall(message.text.encode("ascii"))

    def _heard(self) -> list[Event]:
        """Waits until the machine's next deadline; returns the bytes and closed connections until then."""
        with self._lock:
            wait_s = self._machine.next_deadline - self._clock()
        events: list[Event] = []
        for key, _ in self._selector.select(max(0.0, min(wait_s, LONGEST_WAIT_S))):
            if key.fileobj is self._woken:
                self._woken.recv(AT_ONCE)
            else:
                assert isinstance(key.fileobj, socket.socket)
                events.append(_read(key.fileobj, key.data))
        if any(isinstance(event, Closed) for event in events):
            with self._lock:
                self._hang_up()
        return events

    def _connect(self) -> Event:
        """Connect both ports, or report the reason why that is impossible."""
        opened: list[socket.socket] = []
        try:
            for port, event in (
                (self._settings.port, DashboardReply),
                (self._settings.feedback_port, FeedbackData),
            ):
                opened.append(socket.create_connection((self._settings.host, port), CONNECT_S))
                opened[-1].setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._selector.register(opened[-1], selectors.EVENT_READ, event)
        except OSError as error:
            with self._lock:
                self._hang_up()
            for each in opened:
                each.close()
            return Closed(why=f"port {port}: {error}")
        with self._lock:
            self._dashboard = opened[0]
        return ConnectionsOpened()

    def _hang_up(self) -> None:
        self._dashboard = None
        for key in list(self._selector.get_map().values()):
            if isinstance(key.fileobj, socket.socket) and key.fileobj is not self._woken:
                self._selector.unregister(key.fileobj)
                key.fileobj.close()


def _read(port: socket.socket, event: type[DashboardReply] | type[FeedbackData]) -> Event:
    try:
        data = port.recv(AT_ONCE)
    except OSError as error:
        return Closed(why=str(error))
    return event(data=data) if data else Closed(why="the controller has closed the connection")
