"""Drivers of PLCs at bad lines: a real driver, a relay, and a virtual PLC whose true state is looked at."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import product
from typing import Any

import pytest
from tests.lengths import length
from tests.patience import PATIENCE_S, until

from arboleda.drivers import Command, MotionState, NotSent, Report, Stop, StopMode
from arboleda.drivers.port import Interruptible
from arboleda.kinds.declared import Device
from arboleda_drivers.modbus.adapter import Modbus
from arboleda_drivers.modbus.server import ModbusServer
from arboleda_drivers.modbus.virtual.memory import BeltMemory as Registers
from arboleda_drivers.opcua.adapter import OpcUa
from arboleda_drivers.opcua.server import OpcUaServer
from arboleda_drivers.opcua.virtual.program import BeltProgram
from arboleda_drivers.plc.virtual.machine import STOPPED, Belt
from arboleda_drivers.s7.adapter import S7
from arboleda_drivers.s7.server import S7Server
from arboleda_drivers.s7.virtual.memory import BeltMemory as Blocks
from arboleda_lines.line import FORMS, TIMED, Form
from arboleda_lines.relay import TcpRelay

from .driven import Heard, belt_of, driven, is_heard, is_lost, mapping, order

pytestmark = [pytest.mark.system, pytest.mark.requires("pymodbus", "snap7", "asyncua")]

TIMEOUT_S = 0.4
SHARES = (0.5, 1.1, 3.0)  # of the time that a driver waits for an answer
LASTS_S = 4 * TIMEOUT_S
STOP_AFTER_S = 0.05
MOMENTS = ("written", "at_work", "reconnect")


@dataclass(kw_only=True)
class TrueBelt(Belt):
    """Belt that keeps when each order began."""

    began: list[tuple[float, int]] = field(default_factory=list)

    def order(self, now: float, number: int, verb: int, to: int = 0, speed_mm_s: int = 0) -> None:
        before = self.shown.accepted
        super().order(now, number, verb, to, speed_mm_s)
        if self.shown.accepted != before:
            self.began.append((now, number))


def modbus(belt: TrueBelt, framing: str) -> Any:
    memory = Registers((), time.monotonic, tcp=framing == "tcp", belt=belt)
    return ModbusServer(memory, framing=framing)  # type: ignore[arg-type]


def s7(belt: TrueBelt) -> Any:
    return S7Server(Blocks((), time.monotonic, belt=belt))


def opcua(belt: TrueBelt) -> Any:
    return OpcUaServer(BeltProgram((), time.monotonic, belt=belt))


@dataclass(frozen=True, kw_only=True)
class Kind:
    """Kind of line: the plant file with its mapping, its server, its driver, and the keys for a port."""

    file: str
    serve: Callable[[TrueBelt], Any]
    driver: Callable[[Any], Any]
    keys: Callable[[int], dict[str, Any]] = lambda port: {"port": port}


KINDS = {
    "modbus": Kind(file="plant.yaml", serve=partial(modbus, framing="tcp"), driver=Modbus),
    "modbus_rtu": Kind(
        file="plant.yaml",
        serve=partial(modbus, framing="rtu"),
        driver=Modbus,
        keys=lambda port: {"port": port, "framing": "rtu"},
    ),
    "s7": Kind(file="s7.yaml", serve=s7, driver=S7),
    "opcua": Kind(
        file="opcua.yaml",
        serve=opcua,
        driver=OpcUa,
        keys=lambda port: {"url": f"opc.tcp://127.0.0.1:{port}"},
    ),
}
WORDS = [word for word in FORMS if word != "echo"]  # which is of two wires, and these are TCP


def forms() -> Iterator[Form]:
    for word in WORDS:
        for share in SHARES if word in TIMED else (0.0,):
            yield Form(word=word, delay_s=round(share * TIMEOUT_S, 3))


WHOLE = list(product(KINDS, forms(), MOMENTS, (True, False)))
SHORT = [case for number, case in enumerate(WHOLE) if number % 20 == 0]


class Order:
    """Order sent in a thread of its own, as a plant does; `left`: whether it has, None where nobody knows."""

    def __init__(self, driver: Any, command: Command) -> None:
        self.left: bool | None = None
        self._driver, self._command = driver, command
        self._thread = threading.Thread(target=self._send)
        self._thread.start()

    def _send(self) -> None:
        try:
            self._driver.send(self._command)
            self.left = True
        except NotSent:
            self.left = False
        except Exception:  # noqa: BLE001 - a driver raises what its library does, and nobody knows then
            self.left = None

    def end(self) -> None:
        self._thread.join(PATIENCE_S)
        assert not self._thread.is_alive()


class Story:
    """A PLC behind a bad line: what was sent to it, what it did, and what its driver said."""

    def __init__(self, driver: Any, heard: Heard, device: Device, belt: TrueBelt, relay: TcpRelay) -> None:
        self.driver, self.heard, self.device, self.belt, self.relay = driver, heard, device, belt, relay
        self.stopped_at: float | None = None

    def run(self, form: Form, moment: str, *, stops: bool) -> None:
        self.heard.until(is_heard)
        if moment != "written":
            sent = Order(self.driver, order(self.device, "load", id="c1"))
            self.heard.until(lambda report: report.state is MotionState.MOVING)
        if moment == "reconnect":
            self.relay.cut()
        with self.relay.bad(form):
            if moment == "written":
                sent = Order(self.driver, order(self.device, "load", id="c1"))
            time.sleep(STOP_AFTER_S)
            if stops:
                self.stop()
            time.sleep(LASTS_S)
        sent.end()
        self._lead_out()

    def stop(self) -> None:
        """Stop it as a plant does; a stop that could not leave is said again once the link is back."""
        stop = Stop(id="s1", robot=self.device.name, mode=StopMode.LATCH)
        self._interrupt()
        sent = Order(self.driver, stop)
        sent.end()
        if sent.left:
            self.stopped_at = time.monotonic()

    def _interrupt(self) -> None:
        if isinstance(self.driver, Interruptible):
            self.driver.interrupt(self.device.name)

    def _lead_out(self) -> None:
        """Bring it to rest and clear it; the next order is done."""
        self.heard.all.clear()
        self.heard.until(lambda report: report.state is not MotionState.NO_LINK)
        self._say(StopMode.LATCH)
        self._say(StopMode.CLEAR)
        self.heard.until(is_heard)
        self.driver.send(order(self.device, "load", id="c2"))
        self.heard.until(lambda report: report.done == "c2")

    def _say(self, mode: StopMode) -> None:
        """Say a word of stop again until it has left: a driver may find only now that its link is broken."""

        def left() -> bool:
            if mode is StopMode.LATCH:
                self._interrupt()
            try:
                self.driver.send(Stop(id=f"s {mode.value}", robot=self.device.name, mode=mode))
            except NotSent:
                return False
            return True

        until(left)


@contextmanager
def served(kind: Kind, belt: TrueBelt) -> Iterator[int]:
    server = kind.serve(belt)
    try:
        yield server.start()
    finally:
        server.stop()


@pytest.mark.parametrize(("name", "form", "moment", "stops"), length(SHORT, WHOLE), ids=str)
def test_a_bad_line(name: str, form: Form, moment: str, *, stops: bool) -> None:
    kind, belt = KINDS[name], TrueBelt()
    device = belt_of(kind.file)
    with served(kind, belt) as port, TcpRelay(port) as relay:
        settings = mapping(device, timeout_s=TIMEOUT_S, **kind.keys(relay.port))
        with driven(kind.driver(settings), device) as (driver, heard):
            story = Story(driver, heard, device, belt, relay)
            told: list[Report] = []
            heard.all = told
            story.run(form, moment, stops=stops)
    assert [number for at, number in belt.began if at > (story.stopped_at or at)][:-1] == []
    assert len(belt.began) <= 2, "an order was begun twice"
    assert belt.shown.state == STOPPED and belt.shown.done == belt.began[-1][1]
    assert {dict(each.facts or ()).get("mm_s", 0) for each in told} == {0}
    assert all(str(relay.port) in str(each.lost) for each in told if is_lost(each))
