"""Registers that one request over Modbus reads, and those that one writes."""

from __future__ import annotations

from arboleda_drivers.modbus.machine import Block, WriteRequest, blocks, joined
from arboleda_drivers.modbus.registers import Register

from ..plc.plcs import PLCS


def test_neighbours_are_read_together_and_gaps_are_not_read() -> None:
    places = [Register(input=3), Register(input=4, type="uint32"), Register(input=7), Register(holding=6)]
    assert blocks(places) == (
        Block(table="input", address=3, length=3),
        Block(table="input", address=7, length=1),
        Block(table="holding", address=6, length=1),
    )


def test_what_says_that_it_is_done_is_read_before_the_facts() -> None:
    tables = [(block.table, block.address) for block in PLCS["modbus"].made().blocks]
    assert tables == [("input", 0), ("input", 10), ("discrete", 0)]


def test_writes_keep_their_order() -> None:
    first, second = (
        WriteRequest(table="holding", address=5, values=(1,)),
        WriteRequest(table="holding", address=4, values=(2,)),
    )
    assert joined([first, second]) == (first, second)


def test_a_number_apart_from_its_verb_is_written_last() -> None:
    *_, last = PLCS["modbus"].made().order(PLCS["modbus"].told("load"))
    assert last == WriteRequest(table="holding", address=3, values=(1,))
