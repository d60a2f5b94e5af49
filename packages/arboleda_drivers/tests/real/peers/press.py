"""The press of a PLC behind a library of others, in a process of its own; nothing of Arboleda in it.

    press.py snap7 | open62541 | node_opcua COMMAND... | libmodbus LIBRARY | libmodbus LIBRARY LINE

It prints `ready PORT`, then a line for each thing it does, with the time: `begin NUMBER AT`, `end NUMBER AT`,
`drop NUMBER AT` where a stop ends work, `boot 0 AT`. Its input is told `takes SECONDS`, how long each work
takes, `refuses`, that the next order is, and `boots`.
"""

from __future__ import annotations

import ctypes
import json
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

SCAN_S = 0.004
STOPPED, MOVING, LATCHED = range(3)
OPEN, CLOSE, PRESS, MEASURE = range(1, 5)
BUSY = 1
KEPT: list[object] = []  # a server ends where nobody refers to it


@dataclass(frozen=True)
class Order:
    """Order of a client."""

    number: int
    verb: int
    strokes: int = 0


def locked(method: Callable[..., None]) -> Callable[..., None]:
    """The method, which other threads wait for."""

    def call(press: Press, *given: Any, **named: Any) -> None:
        with press.lock:
            method(press, *given, **named)

    return call


class Press:
    """It does one order at a time, for as long as it is told."""

    def __init__(self) -> None:
        self.takes_s = 0.1
        self.refuses = False
        self.boots = 0
        self.lock = threading.RLock()
        self.boot()

    @locked
    def boot(self) -> None:
        self.boots += 1
        self.state = STOPPED
        self.accepted = self.done = self.rejected = 0
        self.guard = self.strokes = 0
        self._work: Order | None = None
        self._until = 0.0
        say("boot", 0)

    @locked
    def take(self, order: Order) -> None:
        if self.refuses or self._work is not None or self.state == LATCHED:
            self.refuses = False
            self.rejected = order.number
            return
        say("begin", order.number)
        self._work, self._until = order, time.monotonic() + self.takes_s
        self.accepted, self.state = order.number, MOVING

    @locked
    def stop(self, *, latch: bool) -> None:
        if self._work is not None:
            say("drop", self._work.number)
        self._work = None
        self.state = LATCHED if latch or self.state == LATCHED else STOPPED

    @locked
    def clear(self) -> None:
        self.state = STOPPED if self.state == LATCHED else self.state

    @locked
    def work(self) -> None:
        work = self._work
        if work is None or time.monotonic() < self._until:
            return
        if work.verb in (OPEN, CLOSE):
            self.guard = int(work.verb == CLOSE)
        if work.verb == PRESS:
            self.strokes = work.strokes
        say("end", work.number)
        self._work, self.state, self.done = None, STOPPED, work.number


class Memory:
    """The press behind places that a client writes: an order is a number that becomes another one.

    A stop drops what was written with it; the number that is there first is no order.
    """

    def __init__(self, press: Press) -> None:
        self._press = press
        self._known: int | None = None

    def scan(self, order: Order, *, halt: bool, latch: bool) -> None:
        if self._known is None or halt or latch:
            self._known = order.number
        if halt or latch:
            self._press.stop(latch=latch)
            return
        self._press.clear()
        if order.number not in (0, self._known):
            self._known = order.number
            self._press.take(order)
        self._press.work()


def say(word: str, number: int) -> None:
    print(word, number, time.monotonic(), flush=True)


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as found:
        return found.getsockname()[1]


def snap7(press: Press) -> tuple[int, Callable[[], None]]:
    """The server of the original Snap7, in C: DB1 is shown, DB2 is written."""
    from snap7.server import Server
    from snap7.types import srvAreaDB

    memory = Memory(press)
    shows, orders = ((ctypes.c_uint8 * 64)() for _ in range(2))
    server, port = Server(log=False), free_port()
    server.register_area(srvAreaDB, 1, shows)
    server.register_area(srvAreaDB, 2, orders)

    def scan() -> None:
        told = bytes(orders)
        strokes, number = (int.from_bytes(told[at : at + 2], "big") for at in (2, 4))
        memory.scan(Order(number, told[0], strokes), halt=bool(told[6] & 1), latch=bool(told[7] & 1))
        if told[6] & 1:
            orders[6] &= 0xFE
        rows = (press.done, press.rejected, 0, press.accepted, BUSY, 0, press.boots, press.state)
        shown = b"".join(each.to_bytes(2, "big") for each in rows)
        ctypes.memmove(shows, shown + bytes((press.guard, 1)) + press.strokes.to_bytes(2, "big"), 20)

    scan()
    KEPT.append(server)
    server.start_to("127.0.0.1", port)
    return port, scan


class Mapping(ctypes.Structure):
    """modbus_mapping_t of libmodbus."""

    _fields_ = [
        *((f"count{number}", ctypes.c_int) for number in range(8)),
        ("coils", ctypes.POINTER(ctypes.c_uint8)),
        ("discrete", ctypes.POINTER(ctypes.c_uint8)),
        ("inputs", ctypes.POINTER(ctypes.c_uint16)),
        ("holding", ctypes.POINTER(ctypes.c_uint16)),
    ]


def libmodbus(press: Press, library: str, line: str = "") -> tuple[int, Callable[[], None]]:
    """The server of libmodbus, over TCP, or over RTU at a line."""
    modbus = ctypes.CDLL(library)
    for name in ("modbus_new_tcp", "modbus_new_rtu"):
        getattr(modbus, name).restype = ctypes.c_void_p
    modbus.modbus_mapping_new.restype = ctypes.POINTER(Mapping)
    space = modbus.modbus_mapping_new(16, 16, 16, 16)
    kept: Mapping = space.contents
    memory = Memory(press)

    def serve(context: ctypes.c_void_p, *, is_line: bool) -> None:
        asked = (ctypes.c_uint8 * 260)()
        while (length := modbus.modbus_receive(context, asked)) >= 0 or is_line:
            if length > 0:
                modbus.modbus_reply(context, asked, length, space)
        modbus.modbus_close(context)
        modbus.modbus_free(context)

    def scan() -> None:
        halt, latch = bool(kept.coils[0]), bool(kept.coils[1])
        memory.scan(Order(kept.holding[2], kept.holding[0], kept.holding[1]), halt=halt, latch=latch)
        if halt:
            kept.coils[0] = 0
        inputs = (press.boots, press.state, press.accepted, press.done, press.rejected, BUSY, 0, 0)
        kept.discrete[0] = press.guard  # facts are there before the number that says that it is over
        for at in (8, 0, 1, 2, 4, 5, 6, 7, 9, 3):
            kept.inputs[at] = (*inputs, press.strokes, 1)[at]

    scan()
    if line:
        context = ctypes.c_void_p(modbus.modbus_new_rtu(line.encode(), 19200, ord("N"), 8, 2))
        assert modbus.modbus_set_slave(context, 1) == 0 and modbus.modbus_connect(context) == 0
        threading.Thread(target=serve, args=(context,), kwargs={"is_line": True}, daemon=True).start()
        return 0, scan
    port = free_port()
    listens = ctypes.c_void_p(modbus.modbus_new_tcp(b"127.0.0.1", port))
    server = socket.socket(fileno=modbus.modbus_tcp_listen(listens, 4))
    KEPT.append(server)

    def join() -> None:
        while True:
            context = ctypes.c_void_p(modbus.modbus_new_tcp(b"127.0.0.1", port))
            modbus.modbus_set_socket(context, server.accept()[0].detach())
            threading.Thread(target=serve, args=(context,), kwargs={"is_line": False}, daemon=True).start()

    threading.Thread(target=join, daemon=True).start()
    return port, scan


def shown(press: Press) -> dict[str, object]:
    """Variables of OPC UA in the order in which they change: `done` is last, as facts are there before."""
    facts = {"strokes": press.strokes, "guard": ("open", "closed")[press.guard], "seen": "good"}
    state = {"state": ("stopped", "moving", "latched")[press.state], "boot": press.boots}
    ends = {"accepted": press.accepted, "rejected": press.rejected, "done": press.done}
    return facts | state | {"reason": BUSY, "failed": 0, "failure": 0} | ends


def methods(press: Press) -> dict[str, tuple[Callable[..., None], tuple[str, ...]]]:
    """Methods of OPC UA: orders and stops, each with its arguments."""

    def order(verb: int) -> Callable[..., None]:
        return lambda *given: press.take(Order(given[-1], verb, given[0]))

    return {
        "Open": (order(OPEN), ("number",)),
        "Close": (order(CLOSE), ("number",)),
        "Press": (order(PRESS), ("strokes", "number")),
        "Measure": (order(MEASURE), ("number",)),
        "Halt": (lambda: press.stop(latch=False), ()),
        "Latch": (lambda: press.stop(latch=True), ()),
        "Clear": (press.clear, ()),
    }


def open62541(press: Press) -> tuple[int, Callable[[], None]]:
    """The server of open62541, by its Python library o6."""
    o6: Any = import_module("o6")
    argument: Any = import_module("o6.ns").ns0.datatypes.Argument
    port = free_port()
    server = o6.Server(port=port)
    device = server.addObject("Device", server.objectsNode, nodeId="ns=1;s=Device")

    def typed(value: object) -> object:
        return o6.UInt16(value) if isinstance(value, int) else value

    def act(does: Callable[..., None]) -> Callable[..., tuple[object, ...]]:
        def call(_node: object, *given: int) -> tuple[object, ...]:
            does(*map(int, given))
            return (o6.StatusCode(0),)

        return call

    nodes = {
        name: server.addVariable(name, server.objectsNode, typed(value), nodeId=f"ns=1;s={name}")
        for name, value in shown(press).items()
    }
    for name, (does, given) in methods(press).items():
        arguments = [argument(name=each, dataType=o6.UInt16, valueRank=-1) for each in given]
        server.addMethod(name, device, act(does), inputArgs=arguments, nodeId=f"ns=1;s={name}")
    before: dict[str, object] = {}

    def scan() -> None:
        press.work()
        now = shown(press)
        for name, value in now.items():
            if before.get(name) != value:
                nodes[name](typed(value))
        before.update(now)

    scan()
    server.start()
    KEPT.append(server)
    return port, scan


def node_opcua(press: Press, *command: str) -> tuple[int, Callable[[], None]]:
    """The server of node-opcua, in a process that hands its calls over."""
    server = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert server.stdin is not None and server.stdout is not None
    calls, answers = server.stdout, server.stdin
    acts, before = methods(press), shown(press)

    @locked
    def tell(press: Press, **more: object) -> None:
        before.update(shown(press))
        print(json.dumps({"shown": before, **more}), file=answers, flush=True)

    def hear() -> None:
        for line in calls:  # the server prints others, too
            word, *call = line.split() or [""]
            if word == "call":
                acts[call[0]][0](*map(int, call[1:]))
                tell(press, answers=True)

    def scan() -> None:
        press.work()
        if shown(press) != before:
            tell(press)

    tell(press, methods={name: given for name, (_, given) in acts.items()})
    port = next(int(line.split()[1]) for line in calls if line.startswith("ready"))
    threading.Thread(target=hear, daemon=True).start()
    return port, scan


PEERS: dict[str, Callable[..., tuple[int, Callable[[], None]]]] = {
    each.__name__: each for each in (snap7, libmodbus, open62541, node_opcua)
}


def main(name: str, *where: str) -> None:
    press = Press()
    port, scan = PEERS[name](press, *where)

    def run() -> None:
        while True:
            scan()
            time.sleep(SCAN_S)

    threading.Thread(target=run, daemon=True).start()
    print("ready", port, flush=True)
    for line in sys.stdin:
        word, *value = line.split()
        if word == "takes":
            press.takes_s = float(value[0])
        elif word == "refuses":
            press.refuses = True
        elif word == "boots":
            press.boot()


main(*sys.argv[1:])
