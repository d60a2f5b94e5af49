"""Absolute address of a value in an S7, with its type, and the conversion of its bytes.

Addresses are written as in STEP 7 (DB1.DBX0.0, DB1.DBB1, DB1.DBW2, DB1.DBD4, M10.0, MB10, MW10, MD10, and the
same with I and Q, or E and A), the type as PLC4X and python-snap7 add it: DB1.DBD4:REAL. Values are
big-endian: the byte of the lowest address is the highest.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal, get_args

from arboleda.drivers import DriverError, Value, quoted
from arboleda_drivers.plc.variables import LIMITS, Form

Area = Literal["DB", "M", "I", "Q"]
ADDRESS = re.compile(
    r"(?:DB(?P<db>\d{1,5})\.DB(?P<data>[XBWD])|(?P<area>[MIQEA])(?P<size>[BWD]?))"
    r"(?P<byte>\d{1,5})(?:\.(?P<bit>[0-7]))?(?::(?P<type>[A-Z]+))?"
)
TYPES: dict[str, tuple[str, Form, str]] = {
    "BOOL": ("X", "bool", "?"),
    "BYTE": ("B", "byte", "B"),
    "USINT": ("B", "byte", "B"),
    "SINT": ("B", "sbyte", "b"),
    "WORD": ("W", "uint16", "H"),
    "UINT": ("W", "uint16", "H"),
    "INT": ("W", "int16", "h"),
    "DWORD": ("D", "uint32", "I"),
    "UDINT": ("D", "uint32", "I"),
    "DINT": ("D", "int32", "i"),
    "REAL": ("D", "float", "f"),
}
"""The size, the form and the code of `struct` of each type."""
PLAIN = {"X": "BOOL", "B": "BYTE", "W": "WORD", "D": "DWORD"}  # the type of an address without one
SIZES = {"X": 1, "B": 1, "W": 2, "D": 4}
ENGLISH: Mapping[str, Area] = {"E": "I", "A": "Q"}  # the German names of inputs and outputs
FORMS_OF_ADDRESS = "DB1.DBX0.0, DB1.DBB1, DB1.DBW2:INT, DB1.DBD4:REAL, M10.0 or MW12"
LAST_BYTE = 65535
LAST_DB = 65535


@dataclass(frozen=True, kw_only=True)
class Address:
    """Place of a value: its area, the number of the data block (0 outside of them), byte and bit."""

    text: str
    area: Area
    db: int
    byte: int
    bit: int | None
    type: str

    @property
    def length(self) -> int:
        """Bytes that the value takes."""
        return SIZES[TYPES[self.type][0]]

    @property
    def form(self) -> Form:
        """The form of its type."""
        return TYPES[self.type][1]

    @property
    def greatest(self) -> int:
        """The greatest number that fits; of whole numbers only."""
        return LIMITS[self.form][1]

    def value(self, raw: bytes) -> Value:
        """The value in the bytes read there."""
        if self.bit is not None:
            return bool(raw[0] >> self.bit & 1)
        (value,) = struct.unpack(f">{TYPES[self.type][2]}", raw)
        return value  # type: ignore[no-any-return]

    def raw(self, value: Value) -> bytes:
        """The bytes of a value that fits; a bit is one byte, 0 or 1."""
        return struct.pack(f">{TYPES[self.type][2]}", value)


@cache
def address(text: str) -> Address:
    """The address that a text names; raises DriverError, with the forms that there are, if it is none."""
    found = ADDRESS.fullmatch(text)
    if found is None:
        raise DriverError(f"{quoted(text)} is no address; write it as {FORMS_OF_ADDRESS}")
    size = found["data"] or found["size"] or "X"
    if (size == "X") != (found["bit"] is not None):
        what = "a bit needs its number" if size == "X" else "a number of a bit is for bits"
        raise DriverError(f"{text}: {what}; write it as {FORMS_OF_ADDRESS}")
    type = found["type"] or PLAIN[size]
    fitting = [name for name, (width, _, _) in TYPES.items() if width == size]
    if type not in fitting:
        raise DriverError(f"{text} has the type {type}; allowed there: {', '.join(fitting)}")
    area, byte, db = found["area"] or "DB", int(found["byte"]), int(found["db"] or 0)
    if byte + SIZES[size] - 1 > LAST_BYTE or not (0 < db <= LAST_DB or area != "DB"):
        raise DriverError(f"{text} is out of range; allowed: DB1 to DB{LAST_DB}, bytes 0 to {LAST_BYTE}")
    area = ENGLISH.get(area, area)
    assert area in get_args(Area)
    bit = None if found["bit"] is None else int(found["bit"])
    return Address(text=text, area=area, db=db, byte=byte, bit=bit, type=type)  # type: ignore[arg-type]
