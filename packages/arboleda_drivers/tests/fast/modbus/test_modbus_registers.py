"""Values as coils and registers hold them."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.drivers.port import DriverError
from arboleda_drivers.modbus.registers import Register, Write
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

ONE_OF = "needs exactly one of coil, discrete, holding, input with its address, has "


@pytest.mark.parametrize(
    ("where", "value", "raw"),
    [
        ({"type": "uint16"}, 65535, (0xFFFF,)),
        ({"type": "int16"}, -2, (0xFFFE,)),
        ({"type": "uint32"}, 0x12345678, (0x1234, 0x5678)),
        ({"type": "uint32", "word_order": "little"}, 0x12345678, (0x5678, 0x1234)),
        ({"type": "uint32", "byte_order": "little"}, 0x12345678, (0x3412, 0x7856)),
        ({"type": "int64"}, -1, (0xFFFF,) * 4),
        ({"type": "float32"}, 1.5, (0x3FC0, 0x0000)),
        ({"type": "float64", "word_order": "little", "byte_order": "little"}, 1.5, (0, 0, 0, 0xF83F)),
        ({"type": "int16", "scale": 0.1, "offset": -20.0}, 4.5, (245,)),
        ({"words": {"open": 0, "closed": 7}}, "closed", (7,)),
    ],
)
def test_a_value_is_written_and_read_again(where: dict[str, Any], value: Any, raw: tuple[int, ...]) -> None:
    place = Register(holding=4, **where)
    assert place.raw(value) == raw
    assert place.read(raw, type(value)) == pytest.approx(value)


def test_a_bit_of_a_register_is_read() -> None:
    assert Register(input=1, bit=3).read([0b1000], bool) is True
    assert Register(input=1, bit=2).read([0b1000], bool) is False


@pytest.mark.parametrize(
    ("place", "raw", "of", "why"),
    [
        (
            Register(input=1, words={"open": 0}),
            (3,),
            str,
            "input 1 is 3, for which there is no word (open)",
        ),
        (Register(input=1), (3,), bool, "input 1 is 3; a bool is 0 or 1"),
        (Register(input=1, type="float32"), (0x7FC0, 0), float, "input 1 is nan, which is no number"),
    ],
)
def test_what_has_no_meaning_is_unreadable(place: Register, raw: tuple[int, ...], of: type, why: str) -> None:
    with pytest.raises(UnreadableValue) as raised:
        place.read(raw, of)
    assert str(raised.value) == why


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({}, f"{ONE_OF}none"),
        ({"coil": 1, "input": 2}, f"{ONE_OF}coil and input"),
        ({"holding": 65536}, "holding 65536 is out of range; allowed: 0 to 65535"),
        ({"holding": 65535, "type": "float32"}, "holding 65535 is out of range; allowed: 0 to 65534"),
        ({"coil": 1, "type": "int16"}, "a coil is one bit: it has neither type nor bit"),
        (
            {"input": 1, "bit": 16},
            "bit 16 is not in a register of type uint16; allowed: 0 to 15",
        ),
        ({"input": 1, "scale": 0.0}, "scale must be a number other than 0, and offset a number"),
        ({"input": 1, "words": {"a": 1, "b": 1}}, "two words have the same number"),
        ({"input": 1, "words": {"a": 70000}}, "a: 70000 does not fit into input 1"),
    ],
)
def test_a_place_that_cannot_be_is_refused(given: dict[str, object], why: str) -> None:
    with pytest.raises(DriverError) as raised:
        Register(**given)
    assert str(raised.value) == why


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"input": 1, "value": 1}, "no input can be written; allowed: coil, holding"),
        (
            {"holding": 1, "bit": 1, "value": 1},
            "one bit of a register cannot be written alone; have the PLC take a coil",
        ),
        ({"holding": 1, "value": 70000}, "70000 does not fit into holding 1; allowed: 0 to 65535"),
        ({"holding": 1, "value": "fast"}, "holding 1 has no word for 'fast'; there are none"),
    ],
)
def test_what_cannot_be_written_is_refused(given: dict[str, object], why: str) -> None:
    with pytest.raises(DriverError) as raised:
        Write(**given)
    assert str(raised.value) == why
