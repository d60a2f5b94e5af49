"""Keys of a device behind Modbus in a plant file."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from arboleda.drivers import DriverError
from arboleda_drivers.plc.limits import Watched, check_polling

from .registers import Register, Write


@dataclass(frozen=True, kw_only=True)
class Verb:
    """Writes for a verb, in order and before its number, and the register of its answer."""

    write: tuple[Write, ...] = ()
    answer: Register | None = None


@dataclass(frozen=True, kw_only=True)
class Sequence:
    """Registers for the number of a command, which is written last, and those in which the PLC echoes it."""

    write: Register
    accepted: Register
    done: Register
    rejected: Register | None = None
    reason: Register | None = None
    failed: Register | None = None
    failure: Register | None = None


@dataclass(frozen=True, kw_only=True)
class ModbusKeys(Watched):
    """Keys of the driver `modbus`: the connection, and the mapping of one device."""

    host: str = ""
    port: int = 502
    framing: Literal["tcp", "rtu"] = "tcp"
    serial: str = ""
    baud: int = 19200
    parity: Literal["even", "odd", "none"] = "even"
    unit: int = 1
    poll_s: float = 0.05
    timeout_s: float = 0.5
    state: Register | None = None
    boot: Register | None = None
    alive: Register | None = None
    alive_s: float = 1.0
    heartbeat: Register | None = None
    facts: dict[str, Register] = field(default_factory=dict)
    verbs: dict[str, Verb] = field(default_factory=dict)
    sequence: Sequence | None = None
    halt: tuple[Write, ...] = ()
    latch: tuple[Write, ...] = ()
    clear: tuple[Write, ...] = ()

    def __post_init__(self) -> None:
        if bool(self.host) == bool(self.serial):
            raise DriverError("needs either host (Modbus TCP) or serial (Modbus RTU, as /dev/ttyUSB0)")
        if self.serial and self.framing == "rtu":
            raise DriverError("framing is for host; a serial line always has that of RTU")
        check_polling(port=self.port, poll_s=self.poll_s, timeout_s=self.timeout_s)
        if not 0 <= self.unit <= 255:
            raise DriverError(f"unit is {self.unit}; allowed: 0 to 255")

    @property
    def has_numbers(self) -> bool:
        """True where each answer has the number of its request."""
        return not self.serial and self.framing == "tcp"

    @property
    def peer(self) -> str:
        """The name of the PLC for sentences."""
        return f"{self.serial} unit {self.unit}" if self.serial else f"{self.host}:{self.port}"
