"""A driver for a meter that speaks SCPI over TCP, and tests a part against limits of its own.

SCPI knows no ids: the driver keeps the id of the question that the meter works on. The meter ends a
measurement that nobody waits for any more, so the next question waits for that.
"""

from __future__ import annotations

import socket
import threading
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from arboleda.drivers import (
    Clock,
    Command,
    Hear,
    MotionState,
    NotSent,
    Report,
    Robot,
    Stop,
    StopMode,
    VerbCommand,
    driver,
    lost,
)

TIMEOUT_S, AGAIN_S, POLL_S = 1.0, 0.5, 0.1
COMPLETE, DEVICE_ERROR, REFUSED, POWER_ON = 1, 8, 16 | 32, 128  # events of IEEE 488.2, which reading clears
MEASURING = 16  # of the condition register
FUNCTIONS = {"resistance": "RES", "voltage": "VOLT", "continuity": "CONT"}
WORDS = {"0": "good", "1": "bad"}


@dataclass(frozen=True, kw_only=True)
class Settings:
    """The keys of the plant file."""

    host: str
    port: int = 5025


@driver("scpi_meter", settings=Settings)
class ScpiMeter:
    """One meter: orders leave in `send`, a thread asks what came of them."""

    def __init__(self, settings: Settings) -> None:
        self._at = (settings.host, settings.port)
        self._ending = threading.Event()
        self._lock = threading.RLock()
        self._line: socket.socket | None = None
        self._work: Command | None = None  # what the meter works on
        self._next: Command | None = None
        self._begun = self._latched = False
        self._said: dict[str, Any] = {}

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        (device,) = devices
        self._name, self._hear, self._clock = device.name, hear, clock
        self._boot = int(1000 * clock())
        self._reader = threading.Thread(target=self._run, name=f"scpi {self._name}", daemon=True)
        self._reader.start()

    def send(self, command: Command) -> None:
        with self._lock:
            if isinstance(command, Stop):
                self._stop(command)
            elif isinstance(command, VerbCommand):
                self._next = command
                self._go_on()
            else:
                raise NotSent(f"the meter has no word for {type(command).__name__}")

    def stop(self) -> None:
        self._ending.set()
        with self._lock, suppress(OSError):
            if self._line is not None:
                self._line.shutdown(socket.SHUT_RDWR)  # wakes the reader
        self._reader.join()

    def heard(self, asked: Command | None, events: int, condition: int, error: str, failed: str) -> None:
        """Say what came of the work that there was when the meter was asked."""
        with self._lock:
            is_busy = bool(condition & MEASURING)
            if events & POWER_ON:
                self._boot, self._work, self._next = self._boot + 1, None, None
            elif asked is not None and asked is self._work:
                self._judge(asked.id, events, error, failed, is_busy)
            state = MotionState.STOP_LATCHED if self._latched else MotionState.STOPPED
            if is_busy and self._work is None:
                state = MotionState.MOVING  # at what nobody asked for
            said = Report(at=self._clock(), robot=self._name, boot_id=self._boot, state=state, **self._said)
        self._hear(said)

    def _judge(self, id: str, events: int, error: str, failed: str, is_busy: bool) -> None:
        if events & REFUSED:
            self._end(rejected=id, refusal=error)
        elif events & DEVICE_ERROR:
            self._end(failed=id, failure=error)
        elif events & COMPLETE:
            self._end(accepted=id, answered=id, answer=WORDS[failed])
        elif is_busy:
            self._begun, self._said["accepted"] = True, id
        elif self._begun:
            self._end(failed=id, failure="aborted")

    def _end(self, **words: object) -> None:
        self._said |= words
        self._work = None
        self._go_on()

    def _go_on(self) -> None:
        if self._work is None and self._next is not None:
            self._work, self._next, self._begun = self._next, None, False
            self._write(f"CONF:{FUNCTIONS[self._work.word]};:INIT;*OPC")

    def _stop(self, stop: Stop) -> None:
        if stop.mode is not StopMode.CLEAR:
            self._work = self._next = None
            self._write("ABOR;*CLS")
        self._latched = stop.mode is StopMode.LATCH or (stop.mode is StopMode.HALT and self._latched)
        self._said["accepted"] = stop.id

    def _write(self, text: str) -> None:
        with self._lock:
            if self._line is None:
                raise NotSent("the meter is not connected")
            try:
                self._line.sendall(f"{text}\n".encode("ascii"))
            except OSError as error:
                raise NotSent(f"the meter does not take it: {error}") from error

    def _run(self) -> None:
        while not self._ending.is_set():
            try:
                with socket.create_connection(self._at, TIMEOUT_S) as line:
                    self._serve(line)
            except (OSError, LookupError, ValueError, NotSent) as error:
                self._hear(lost(self._name, at=self._clock(), why=f"{type(error).__name__}: {error}"))
            self._ending.wait(AGAIN_S)

    def _serve(self, line: socket.socket) -> None:
        with self._lock:
            self._line, self._work, self._next = line, None, None
            self._write("*CLS")
        try:
            with line.makefile("r", encoding="ascii") as said:
                while not self._ending.wait(POLL_S):
                    asked = self._work
                    events, condition = map(int, self._ask("*ESR?;:STAT:OPER:COND?", said).split(";"))
                    error = self._ask("SYST:ERR?", said) if events & (REFUSED | DEVICE_ERROR) else ""
                    failed = self._ask("CALC:LIM:FAIL?", said) if events & COMPLETE else ""
                    self.heard(asked, events, condition, error, failed)
        finally:
            self._line = None

    def _ask(self, text: str, said: Any) -> str:
        self._write(text)
        answer: str = said.readline()
        if not answer.endswith("\n"):
            raise ConnectionError("the meter has closed the connection")
        return answer.strip()
