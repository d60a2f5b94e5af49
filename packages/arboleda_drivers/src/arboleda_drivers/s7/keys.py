"""Keys of a device behind a Siemens S7 in a plant file."""

from __future__ import annotations

from dataclasses import dataclass, field

from arboleda.drivers import DriverError
from arboleda_drivers.plc.limits import Watched, check_alive, check_polling, check_sequence
from arboleda_drivers.plc.variables import LIMITS, Form, PlcArgument, PlcVariable

from .addresses import Address, address

WHOLE = "BYTE, USINT, SINT, WORD, UINT, INT, DWORD, UDINT or DINT"


@dataclass(frozen=True, kw_only=True)
class Variable(PlcVariable):
    """Value of the PLC at an address; one of type BOOL has the numbers 0 and 1 for its words."""

    at: str

    def __post_init__(self) -> None:
        address(self.at)
        super().__post_init__()

    @property
    def place(self) -> str:
        return self.at

    def word(self, shown: object) -> object:
        return super().word(int(shown) if self.words and isinstance(shown, bool) else shown)


@dataclass(frozen=True, kw_only=True)
class Write(PlcArgument):
    """Address to write to, with the value; `$name` is the parameter of the verb."""

    at: str

    def __post_init__(self) -> None:
        check_written(self.at)
        super().__post_init__()

    @property
    def place(self) -> Address:
        return address(self.at)

    @property
    def form(self) -> Form:
        return self.place.form

    @property
    def type_name(self) -> str:
        return self.place.type


@dataclass(frozen=True, kw_only=True)
class Verb:
    """Writes for a verb, in order and before its number, and the variable with the answer to a query."""

    write: tuple[Write, ...] = ()
    answer: Variable | None = None


@dataclass(frozen=True, kw_only=True)
class Sequence:
    """Addresses of the number of a command, which is written last, and of those that echo it.

    `busy` is for a program that echoes no accepted number, `error` for one that has a code for how the last
    command ended in place of other numbers.
    """

    write: str
    done: str
    accepted: str | None = None
    busy: str | None = None
    error: Variable | None = None
    rejected: str | None = None
    reason: Variable | None = None
    failed: str | None = None
    failure: Variable | None = None

    def __post_init__(self) -> None:
        check_written(self.write)
        for key in ("write", "done", "accepted", "rejected", "failed"):
            check_whole(key, getattr(self, key))
        check_sequence(self)
        if self.busy is not None and address(self.busy).form != "bool":
            raise DriverError(f"busy is {self.busy}, which is no bit; write it as DB1.DBX0.0")

    @property
    def greatest(self) -> int:
        """The greatest number that all places of numbers hold."""
        places = (self.write, self.done, self.accepted, self.rejected, self.failed)
        return min(address(place).greatest for place in places if place is not None)

    @property
    def floats(self) -> bool:
        """False: numbers are whole."""
        return False


@dataclass(frozen=True, kw_only=True)
class S7Keys(Watched):
    """Keys of the driver `s7`: the connection, and the mapping of one device."""

    host: str
    port: int = 102
    rack: int = 0
    slot: int = 1
    poll_s: float = 0.05
    timeout_s: float = 0.5
    state: Variable | None = None
    boot: str | None = None
    alive: str | None = None
    alive_s: float = 1.0
    heartbeat: str | None = None
    facts: dict[str, Variable] = field(default_factory=dict)
    verbs: dict[str, Verb] = field(default_factory=dict)
    sequence: Sequence | None = None
    halt: tuple[Write, ...] = ()
    latch: tuple[Write, ...] = ()
    clear: tuple[Write, ...] = ()

    def __post_init__(self) -> None:
        if not self.host:
            raise DriverError("host is empty; write the address of the PLC, such as 10.0.0.40")
        check_polling(port=self.port, poll_s=self.poll_s, timeout_s=self.timeout_s)
        check_alive(self.alive_s)
        if not 0 <= self.rack <= 7 or not 0 <= self.slot <= 31:
            raise DriverError(
                f"rack and slot are {self.rack} and {self.slot}; allowed: rack 0 to 7, slot 0 to 31"
            )
        for key in ("boot", "alive", "heartbeat"):
            check_whole(key, getattr(self, key))
        if self.heartbeat is not None:
            check_written(self.heartbeat)

    @property
    def peer(self) -> str:
        """The name of the PLC for sentences."""
        return f"{self.host}:{self.port}"


def check_written(text: str) -> None:
    """Raises DriverError if an address is one of inputs: what is written there, the PLC overwrites."""
    if address(text).area == "I":
        raise DriverError(f"{text} is an input, which nobody writes; allowed: DB, M and Q")


def check_whole(key: str, text: str | None) -> None:
    """Raises DriverError if the value at an address is no whole number."""
    if text is not None and address(text).form not in LIMITS:
        raise DriverError(f"{key} is {text}, of the type {address(text).type}; allowed: {WHOLE}")
