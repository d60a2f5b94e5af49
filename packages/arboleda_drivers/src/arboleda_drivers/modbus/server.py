"""Modbus server for somebody else's coils and registers: pymodbus speaks, `Memory` answers."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Literal, Protocol

from arboleda_drivers.modbus.registers import BITS

TABLES = {1: "coil", 2: "discrete", 3: "holding", 4: "input"}
TABLES |= {5: "coil", 6: "holding", 15: "coil", 16: "holding"}
STARTED_S = 10.0
SIZE = 256  # coils and registers that there are of each table
Trace = Callable[[bool, bytes], bytes]


class Memory(Protocol):
    """Coils and registers of a PLC; called in the server's thread, may return an exception code."""

    def read(self, table: str, address: int, count: int) -> list[int] | int: ...
    def write(self, table: str, address: int, values: list[int]) -> int | None: ...


class ModbusServer:
    """Serves one memory on TCP, also with the framing of RTU, or on a serial line at 19200 baud without
    parity.

    `trace` may change each packet; True: it is sent.
    """

    def __init__(
        self,
        memory: Memory,
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        serial: str = "",
        framing: Literal["tcp", "rtu"] = "tcp",
        trace: Trace | None = None,
    ) -> None:
        logging.getLogger("pymodbus.logging").setLevel(logging.CRITICAL)
        self._memory = memory
        self._where = (host, port, serial)
        self._framing = framing
        self._trace = trace
        self._loop = asyncio.new_event_loop()
        self._started: Future[int] = Future()
        self._server: Any = None
        self._thread = threading.Thread(target=self._run, name="modbus server", daemon=True)

    def start(self) -> int:
        """Listen, and return the port; raises OSError if that is impossible."""
        self._thread.start()
        return self._started.result(STARTED_S)

    def stop(self) -> None:
        """End every connection and stop listening."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(lambda: asyncio.ensure_future(self._server.shutdown()))
        self._thread.join()

    def hang_up(self) -> None:
        """End every connection; new ones are accepted."""
        self._loop.call_soon_threadsafe(self._close_connections)

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._serve())
        except Exception as error:  # noqa: BLE001 - raised again by `start`
            if not self._started.done():
                self._started.set_exception(error)
        finally:
            self._loop.close()

    async def _serve(self) -> None:
        self._server = self._made()
        if not await self._server.listen():
            host, port, serial = self._where
            where = serial or f"{host}:{port}"
            raise OSError(f"nothing can listen on {where}; name another port, or 0 for any that is free")
        listening = getattr(self._server.transport, "sockets", None)
        self._started.set_result(listening[0].getsockname()[1] if listening else 0)
        await self._server.serving
        self._close_connections()

    def _made(self) -> Any:
        from pymodbus import FramerType
        from pymodbus.server import ModbusSerialServer, ModbusTcpServer
        from pymodbus.simulator import DataType, SimData, SimDevice

        bits = [SimData(0, values=[False] * SIZE, datatype=DataType.BITS)]
        words = [SimData(0, count=SIZE, values=0, datatype=DataType.REGISTERS)]
        unit = SimDevice(id=0, simdata=(bits, bits, words, words), action=self._act)
        host, port, serial = self._where
        if serial:
            return ModbusSerialServer(
                unit, framer=FramerType.RTU, port=serial, baudrate=19200, stopbits=2, trace_packet=self._trace
            )
        framer = FramerType.RTU if self._framing == "rtu" else FramerType.SOCKET
        return ModbusTcpServer(unit, framer=framer, address=(host, port), trace_packet=self._trace)

    async def _act(
        self, code: int, start: int, address: int, count: int, held: list[int], values: list[Any] | None
    ) -> Any:
        from pymodbus.constants import ExcCodes

        table = TABLES[code]
        if values is not None:
            refused = self._memory.write(table, address, [int(value) for value in values])
            return None if refused is None else ExcCodes(refused)
        if table in BITS:
            address, count = address - address % 16, 16 * count
        found = self._memory.read(table, address, count)
        if isinstance(found, int):
            return ExcCodes(found)
        if table in BITS:
            rows = [found[at : at + 16] for at in range(0, count, 16)]
            found = [sum(bit << at for at, bit in enumerate(row)) for row in rows]
            address //= 16
        held[address - start : address - start + len(found)] = found
        return None

    def _close_connections(self) -> None:
        for each in list(self._server.active_connections.values()):
            each.close()
