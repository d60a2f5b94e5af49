"""A driver for controllers that speak JSON over TCP, one object in a line; controller.py is one."""

from __future__ import annotations

import json
import socket
import threading
from collections.abc import Iterator, Sequence
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

TIMEOUT_S = 0.5
AGAIN_S = 0.5
LONGEST = 4096  # bytes of a line
STATES = {
    "stopped": MotionState.STOPPED,
    "moving": MotionState.MOVING,
    "fault": MotionState.FAULT,
    "latched": MotionState.STOP_LATCHED,
}
STOPS = {StopMode.HALT: "halt", StopMode.LATCH: "latch", StopMode.CLEAR: "clear"}


@dataclass(frozen=True, kw_only=True)
class Settings:
    """The keys of the plant file."""

    host: str
    port: int = 4711

    def __post_init__(self) -> None:
        if not 0 < self.port < 65536:
            raise ValueError(f"port is {self.port}; allowed: 1 to 65535")


@driver("line_tcp", settings=Settings)
class LineTcp:
    """One controller, one device: commands leave in `send`, a thread reads what the controller says."""

    def __init__(self, settings: Settings) -> None:
        self._settings = settings
        self._ending = threading.Event()
        self._line: socket.socket | None = None
        self._reader: threading.Thread | None = None

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        if len(devices) != 1:
            raise ValueError(f"a line has one device, not {len(devices)}")
        self._name, self._hear, self._clock = devices[0].name, hear, clock
        self._reader = threading.Thread(target=self._read, name=f"line_tcp {self._name}", daemon=True)
        self._reader.start()

    def send(self, command: Command) -> None:
        line = self._line
        if line is None:
            raise NotSent(f"{self._peer} is not connected")
        try:
            line.sendall(json.dumps(order(command)).encode() + b"\n")
        except OSError as error:
            raise NotSent(f"{self._peer}: {error}") from error

    def stop(self) -> None:
        self._ending.set()
        if self._line is not None:
            with suppress(OSError):
                self._line.shutdown(socket.SHUT_RDWR)  # wakes the reader
        if self._reader is not None:
            self._reader.join()

    @property
    def _peer(self) -> str:
        return f"{self._settings.host}:{self._settings.port}"

    def _read(self) -> None:
        while not self._ending.is_set():
            try:
                self._serve()
                why = "the controller has closed the connection"
            except (OSError, ValueError) as error:
                why = f"{self._peer}: {error}"
            self._hear(lost(self._name, at=self._clock(), why=why))
            self._ending.wait(AGAIN_S)

    def _serve(self) -> None:
        with socket.create_connection((self._settings.host, self._settings.port), TIMEOUT_S) as line:
            line.settimeout(None)  # how long silence may last is for the plant to say
            self._line = line
            try:
                for said in lines(line):
                    self._hear(report(self._name, self._clock(), said))
            finally:
                self._line = None


def lines(line: socket.socket) -> Iterator[dict[str, Any]]:
    """Each line as an object, until the other side closes; ValueError for what is none."""
    rest = b""
    while data := line.recv(LONGEST):
        *whole, rest = (rest + data).split(b"\n")
        if len(rest) > LONGEST:
            raise ValueError("a line is too long")
        for each in whole:
            said = json.loads(each)
            if not isinstance(said, dict):
                raise ValueError("a line is no object")
            yield said


def order(command: Command) -> dict[str, Any]:
    """A command as a line has it."""
    if isinstance(command, Stop):
        return {"id": command.id, "stop": STOPS[command.mode]}
    if isinstance(command, VerbCommand):
        return {"id": command.id, "do": command.verb, "with": dict(command.values)}
    raise NotSent(f"a line has no word for {type(command).__name__}")


def report(name: str, at: float, said: dict[str, Any]) -> Report:
    """What a line says, as the plant has it: each id with its word, facts as pairs."""
    rejected, refusal = said.get("rejected", (None, None))
    failed, failure = said.get("failed", (None, None))
    answered, answer = said.get("answered", (None, None))
    return Report(
        at=at,
        robot=name,
        boot_id=said.get("boot"),
        state=STATES.get(said.get("state", "")),
        accepted=said.get("accepted"),
        done=said.get("done"),
        rejected=rejected,
        refusal=refusal,
        failed=failed,
        failure=failure,
        answered=answered,
        answer=answer,
        facts=tuple(said.get("facts", {}).items()),
    )
