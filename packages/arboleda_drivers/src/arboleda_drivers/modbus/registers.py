"""Place of a value in a PLC: its coils or registers, and its encoding."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from arboleda.drivers import DriverError, Value, quoted
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

Order = Literal["big", "little"]
Form = Literal["uint16", "int16", "uint32", "int32", "float32", "uint64", "int64", "float64"]
TABLES = ("coil", "discrete", "holding", "input")
BITS = ("coil", "discrete")
FORMATS = {"uint16": "H", "int16": "h", "uint32": "I", "int32": "i", "float32": "f"}
FORMATS |= {"uint64": "Q", "int64": "q", "float64": "d"}
LAST = 65535
ValueType = type[Value]


@dataclass(frozen=True, kw_only=True)
class Register:
    """Keys of a place in the plant file: table, address, and encoding of the value."""

    coil: int | None = None
    discrete: int | None = None
    holding: int | None = None
    input: int | None = None
    type: Form = "uint16"
    bit: int | None = None
    scale: float = 1.0
    offset: float = 0.0
    words: dict[str, int] = field(default_factory=dict)
    word_order: Order = "big"
    byte_order: Order = "big"

    def __post_init__(self) -> None:
        tables = [name for name in TABLES if getattr(self, name) is not None]
        if len(tables) != 1:
            what = " and ".join(tables) or "none"
            raise DriverError(f"needs exactly one of {', '.join(TABLES)} with its address, has {what}")
        last = LAST - self.length + 1
        if not 0 <= self.address <= last:
            raise DriverError(f"{self.table} {self.address} is out of range; allowed: 0 to {last}")
        self._check_form()

    @property
    def table(self) -> str:
        return next(name for name in TABLES if getattr(self, name) is not None)

    @property
    def address(self) -> int:
        return int(getattr(self, self.table))

    @property
    def length(self) -> int:
        """The number of coils or registers that this value takes."""
        return 1 if self.table in BITS else struct.calcsize(FORMATS[self.type]) // 2

    @property
    def is_bit(self) -> bool:
        return self.table in BITS or self.bit is not None

    @property
    def form(self) -> tuple[object, ...]:
        """The encoding that two values at the same address must share."""
        return (self.type, self.word_order, self.byte_order)

    def limits(self) -> tuple[float, float]:
        """The least and the greatest value that fits."""
        if self.is_bit:
            return (0, 1)
        if self.type.startswith("float"):
            return (-math.inf, math.inf)
        bits = 16 * self.length
        low, high = (0, 2**bits) if self.type.startswith("u") else (-(2 ** (bits - 1)), 2 ** (bits - 1))
        ends = sorted((low * self.scale + self.offset, (high - 1) * self.scale + self.offset))
        return (ends[0], ends[1])

    def number(self, raw: Sequence[int]) -> int | float:
        """The number that the PLC holds there, decoded from the registers read."""
        if self.table in BITS:
            return int(raw[0])
        if self.bit is not None:
            return raw[0] >> self.bit & 1
        packed = struct.pack(f">{self.length}H", *(raw if self.word_order == "big" else raw[::-1]))
        (value,) = struct.unpack(f">{FORMATS[self.type]}", self._bytes(packed))
        return value  # type: ignore[no-any-return]

    def read(self, raw: Sequence[int], of: ValueType) -> Value:
        """The value read there, as that type; raises UnreadableValue if it is none."""
        number = self.number(raw)
        if self.words:
            return self._word(number)
        if of is bool:
            if number in (0, 1):
                return bool(number)
            raise UnreadableValue(f"{self} is {number}; a bool is 0 or 1")
        scaled = number * self.scale + self.offset
        if not math.isfinite(scaled):
            raise UnreadableValue(f"{self} is {number}, which is no number")
        if of is int and self.scale == 1 and float(self.offset).is_integer():
            return int(scaled)
        if of is int and abs(scaled - round(scaled)) > 1e-6:
            raise UnreadableValue(f"{self} is {scaled:g}, which is no whole number")
        return round(scaled) if of is int else float(scaled)

    def raw(self, value: Value) -> tuple[int, ...]:
        """The registers for a value; raises DriverError if it does not fit."""
        number = self.words[value] if isinstance(value, str) and value in self.words else value
        if isinstance(number, str):
            known = ", ".join(self.words) or "none"
            raise DriverError(f"{self} has no word for {quoted(value)}; there are {known}")
        if self.table in BITS:
            return (int(bool(number)),)
        scaled = number if self.words else (number - self.offset) / self.scale
        whole = scaled if self.type.startswith("float") else round(scaled)
        try:
            packed = struct.pack(f">{FORMATS[self.type]}", whole)
        except (struct.error, OverflowError) as error:
            low, high = self.limits()
            allowed = f"allowed: {low:g} to {high:g}"
            raise DriverError(f"{quoted(value)} does not fit into {self}; {allowed}") from error
        words = struct.unpack(f">{self.length}H", self._bytes(packed))
        return words if self.word_order == "big" else words[::-1]

    def __str__(self) -> str:
        return f"{self.table} {self.address}" + ("" if self.bit is None else f" bit {self.bit}")

    def _word(self, number: float) -> str:
        word = next((word for word, held in self.words.items() if held == number), None)
        if word is None:
            known = ", ".join(self.words)
            raise UnreadableValue(f"{self} is {number}, for which there is no word ({known})")
        return word

    def _bytes(self, packed: bytes) -> bytes:
        if self.byte_order == "big":
            return packed
        return b"".join(packed[at + 1 : at + 2] + packed[at : at + 1] for at in range(0, len(packed), 2))

    def _check_form(self) -> None:
        if self.table in BITS and (self.type != "uint16" or self.bit is not None):
            raise DriverError(f"a {self.table} is one bit: it has neither type nor bit")
        if self.bit is not None and not (self.type == "uint16" and 0 <= self.bit <= 15):
            raise DriverError(f"bit {self.bit} is not in a register of type uint16; allowed: 0 to 15")
        if self.scale == 0 or not math.isfinite(self.scale) or not math.isfinite(self.offset):
            raise DriverError("scale must be a number other than 0, and offset a number")
        if len(set(self.words.values())) < len(self.words):
            raise DriverError("two words have the same number")
        low, high = self.limits() if self.scale == 1 and self.offset == 0 else (-math.inf, math.inf)
        wrong = next((word for word, held in self.words.items() if not low <= held <= high), None)
        if wrong is not None:
            raise DriverError(f"{wrong}: {self.words[wrong]} does not fit into {self}")


@dataclass(frozen=True, kw_only=True)
class Write(Register):
    """Place to write to, with the value; `$name` is the parameter of the verb."""

    value: bool | int | float | str

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.table not in ("coil", "holding"):
            raise DriverError(f"no {self.table} can be written; allowed: coil, holding")
        if self.bit is not None:
            raise DriverError("one bit of a register cannot be written alone; have the PLC take a coil")
        if self.parameter is None:
            self.raw(self.value)

    @property
    def parameter(self) -> str | None:
        value = self.value
        return value[1:] if isinstance(value, str) and value.startswith("$") else None
