"""Addresses of an S7: what is one, which bytes a value has, and which requests read them."""

from __future__ import annotations

import pytest

from arboleda.drivers.port import DriverError
from arboleda_drivers.s7.addresses import address
from arboleda_drivers.s7.machine import Block, blocks


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("DB1.DBX0.7", ("DB", 1, 0, 7, "BOOL")),
        ("DB12.DBB3", ("DB", 12, 3, None, "BYTE")),
        ("DB1.DBW2", ("DB", 1, 2, None, "WORD")),
        ("DB1.DBD4:REAL", ("DB", 1, 4, None, "REAL")),
        ("M10.0", ("M", 0, 10, 0, "BOOL")),
        ("MW20:INT", ("M", 0, 20, None, "INT")),
        ("IB0", ("I", 0, 0, None, "BYTE")),
        ("E0.1", ("I", 0, 0, 1, "BOOL")),
        ("AD4:DINT", ("Q", 0, 4, None, "DINT")),
    ],
)
def test_an_address_as_people_write_it(text: str, place: tuple[object, ...]) -> None:
    at = address(text)
    assert (at.area, at.db, at.byte, at.bit, at.type) == place


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("DB1.DBX0", "a bit needs its number"),
        ("DB1.DBW2.1", "a number of a bit is for bits"),
        ("DB1.DBX0.8", "is no address; write it as DB1.DBX0.0"),
        ("DB0.DBW2", "is out of range; allowed: DB1 to DB65535"),
        ("DB1.DBW65535", "is out of range"),
        ("DB1.DBW2:REAL", "has the type REAL; allowed there: WORD, UINT, INT"),
        ("DB1.DBD4:LREAL", "allowed there: DWORD, UDINT, DINT, REAL"),
        ("db1.dbw2", "is no address"),
        ("T5", "is no address"),
        ("DB1,W2", "is no address"),
    ],
)
def test_what_is_no_address_says_what_is(text: str, why: str) -> None:
    with pytest.raises(DriverError, match=why):
        address(text)


@pytest.mark.parametrize(
    ("text", "value", "raw"),
    [
        ("DB1.DBX0.0", True, b"\1"),
        ("DB1.DBB0:SINT", -2, b"\xfe"),
        ("DB1.DBW0", 258, b"\1\2"),
        ("DB1.DBW0:INT", -2, b"\xff\xfe"),
        ("DB1.DBD0", 16909060, b"\1\2\3\4"),
        ("DB1.DBD0:REAL", 1.5, b"\x3f\xc0\0\0"),
    ],
)
def test_values_are_big_endian(text: str, value: object, raw: bytes) -> None:
    assert address(text).raw(value) == raw  # type: ignore[arg-type]
    assert address(text).value(raw) == value


def test_a_bit_is_read_out_of_its_byte() -> None:
    assert address("M0.2").value(b"\x04") is True
    assert address("M0.2").value(b"\xfb") is False


def read(*places: str, most: int = 222) -> list[tuple[int, int, int]]:
    """Data block, first byte and length of each request."""
    return [(each.db, each.byte, each.length) for each in blocks([address(at) for at in places], most)]


def test_neighbours_are_read_together_upwards_only() -> None:
    assert read("DB1.DBW0", "DB1.DBW2", "DB1.DBX4.0", "DB1.DBX4.1") == [(1, 0, 5)]
    assert read("DB1.DBW0", "DB1.DBW12") == [(1, 0, 14)], "a small gap costs less than a request"
    assert read("DB1.DBW0", "DB1.DBW40") == [(1, 0, 2), (1, 40, 2)]
    assert read("DB1.DBW2", "DB1.DBW0") == [(1, 2, 2), (1, 0, 2)], "what is read first stays first"
    assert read("DB1.DBW0", "DB2.DBW2", "DB1.DBW2") == [(1, 0, 2), (2, 2, 2), (1, 2, 2)]
    assert read("DB1.DBD0", "DB1.DBB2", "DB1.DBW3") == [(1, 0, 5)]


def test_no_request_is_longer_than_a_message() -> None:
    many = [f"DB1.DBW{2 * at}" for at in range(150)]
    assert read(*many) == [(1, 0, 222), (1, 222, 78)]
    assert blocks([address("MW0")], 222) == (Block(area="M", db=0, byte=0, length=2),)
