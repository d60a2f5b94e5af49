"""OPC UA server for somebody else's variables and methods: asyncua speaks, `Program` answers."""

from __future__ import annotations

import asyncio
import logging
import threading
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from arboleda_drivers.opcua.session import TYPES

if TYPE_CHECKING:
    from asyncua import Server

STARTED_S = 120.0  # a second on a machine that has nothing else to do
TICK_S = 0.02
STOPPED_S = 10.0


@dataclass(frozen=True, kw_only=True)
class Bad:
    """Value of a variable that has none, with the name of its status code."""

    status: str


class Program(Protocol):
    """Program of a simulated PLC. All methods are called in the server's thread.

    A variable is `ns=2;s=NAME` there, a method as well, of the object `ns=2;s=Device`.
    """

    @property
    def variables(self) -> Mapping[str, str]:
        """The type of each variable, such as `uint16`, in the order in which they are set."""

    @property
    def methods(self) -> Mapping[str, Sequence[str]]:
        """The argument types of each method."""

    def show(self) -> Mapping[str, object]:
        """The present value of each variable: a value, None, or `Bad`."""

    def call(self, method: str, arguments: Sequence[object]) -> str | None:
        """Carry out a method; returns the name of a bad status code if it refuses."""

    def beat(self, value: object) -> None:
        """Take the value that a client has just written to the variable `beat`."""

    def is_mute(self) -> bool:
        """True while no request is answered."""


class OpcUaServer:
    """Serves one program to whoever comes, without a login; from `start` to `stop`.

    `kept` is a file for the nodes that every server has: the second server that uses it starts at once.
    """

    def __init__(
        self, program: Program, *, host: str = "127.0.0.1", port: int = 0, kept: Path | None = None
    ) -> None:
        logging.getLogger("asyncua").setLevel(logging.CRITICAL)
        self._program, self._host, self._port, self._kept = program, host, port, kept
        self._started: Future[int] = Future()
        self._ending = threading.Event()
        self._shown: dict[str, object] = {}
        self._thread = threading.Thread(
            target=lambda: asyncio.run(self._run()), name="opcua server", daemon=True
        )

    def start(self) -> int:
        """Listen, and return the port; raises OSError if that is impossible."""
        self._thread.start()
        return self._started.result(STARTED_S)

    def stop(self) -> None:
        """End every session and stop listening."""
        self._ending.set()
        self._thread.join(STOPPED_S)

    async def _run(self) -> None:
        try:
            server = await self._made()
            await server.start()
        except Exception as error:  # noqa: BLE001 - raised again by `start`
            where = f"{self._host}:{self._port}"
            failure = OSError(f"nothing can listen on {where}; name another port, or 0 for any that is free")
            self._started.set_exception(failure if isinstance(error, OSError) else error)
            return
        assert server.bserver is not None  # from `start` on
        self._started.set_result(server.bserver.port)
        while not self._ending.is_set():
            await self._tick(server)
            await asyncio.sleep(TICK_S)
        await server.stop()

    async def _tick(self, server: Server) -> None:
        while self._program.is_mute() and not self._ending.is_set():
            time.sleep(TICK_S)  # blocks the whole loop: connections stay open, without answers
        beat = await server.get_node("ns=2;s=beat").read_value()
        self._program.beat(beat)
        await self._show(server)

    async def _made(self) -> Server:
        from asyncua import Server, ua

        server = Server()
        await server.init(self._kept)
        server.set_endpoint(f"opc.tcp://{self._host}:{self._port}/")
        server.set_security_policy([ua.SecurityPolicyType.NoSecurity])
        await server.register_namespace("urn:arboleda:plc")
        device = await server.nodes.objects.add_object(_node("Device"), _name("Device"))
        beat = await device.add_variable(_node("beat"), _name("beat"), 0, ua.VariantType.UInt16)
        await beat.set_writable()
        for name, type in self._program.variables.items():
            await device.add_variable(_node(name), _name(name), *_first(type))
        for name, types in self._program.methods.items():
            inputs = [getattr(ua.VariantType, TYPES[type]) for type in types]
            await device.add_method(_node(name), _name(name), self._method(server, name), inputs, [])
        await self._show(server)
        return server

    def _method(self, server: Server, name: str) -> Any:
        async def called(parent: object, *arguments: Any) -> Any:
            from asyncua import ua

            refused = self._program.call(name, [each.Value for each in arguments])
            await self._show(server)
            return [] if refused is None else ua.StatusCode(getattr(ua.StatusCodes, refused))

        return called

    async def _show(self, server: Server) -> None:
        """Set the variables that have changed, in the program's order."""
        shown = self._program.show()
        for name, type in self._program.variables.items():
            if name not in self._shown or self._shown[name] != shown[name]:
                self._shown[name] = shown[name]
                await _set(server, name, _data(shown[name], type), type)


async def _set(server: Server, name: str, data: Any, type: str) -> None:
    """Set a variable, also to another type: asyncua writes no such value, but does show one."""
    from asyncua import ua

    fits = data.StatusCode.is_bad() or data.Value.VariantType == getattr(ua.VariantType, TYPES[type])
    if fits:
        await server.write_attribute_value(_node(name), data)
    else:
        server.set_attribute_value_callback(_node(name), lambda node, attribute: data)


def _node(name: str) -> Any:
    from asyncua import ua

    return ua.NodeId(ua.String(name), ua.Int16(2))


def _name(name: str) -> Any:
    from asyncua import ua

    return ua.QualifiedName(name, 2)


def _first(type: str) -> tuple[object, Any]:
    from asyncua import ua

    return ("" if type == "string" else 0, getattr(ua.VariantType, TYPES[type]))


def _data(value: object, type: str) -> Any:
    """A value in the type of its variable; a value of another type as it is."""
    from asyncua import ua

    if isinstance(value, Bad):
        return ua.DataValue(StatusCode=ua.StatusCode(getattr(ua.StatusCodes, value.status)))
    if value is None:
        return ua.DataValue(ua.Variant(None, ua.VariantType.Null))
    if isinstance(value, int) and type not in ("string", "float", "double"):
        return ua.DataValue(ua.Variant(value, getattr(ua.VariantType, TYPES[type])))
    return ua.DataValue(ua.Variant(value))
