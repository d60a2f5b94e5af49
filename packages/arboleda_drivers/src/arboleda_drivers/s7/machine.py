"""Device behind a Siemens S7: the writes for a command, and the requests that read what is mapped."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arboleda.drivers import Command, Robot, Stop
from arboleda_drivers.plc.handshake import Handshake, Read, stop_order
from arboleda_drivers.plc.plc_snapshot import Writing

from .addresses import Address, Area, address
from .settings import Settings

OVERHEAD = 18  # bytes of an answer besides the values: 12 of its header, 2 of parameters, 4 before the values
LEAST_PDU = 240  # bytes of the shortest message that an S7 agrees to
GAP = 16  # bytes that are read needlessly rather than by another request


@dataclass(frozen=True, kw_only=True)
class Block:
    """Bytes that are read with one request."""

    area: Area
    db: int
    byte: int
    length: int


@dataclass(frozen=True, kw_only=True)
class WriteRequest:
    """Value to write with one request."""

    place: Address
    raw: bytes


class S7Device(Handshake):
    """Device behind a Siemens S7: makes writes of commands and reports of values read."""

    def __init__(self, device: Robot, settings: Settings) -> None:
        super().__init__(device, settings)
        self._mapping = settings
        self._addresses = {place: address(place) for place in self.places}

    def blocks(self, pdu: int) -> tuple[Block, ...]:
        """The requests that read all places, in their order, for messages of at most `pdu` bytes."""
        return blocks(tuple(self._addresses.values()), pdu - OVERHEAD)

    def values(self, raw: Mapping[Block, bytes]) -> Read:
        """The value at each place, out of the bytes of the blocks; the block that was read first counts."""
        read: dict[str, object] = {}
        for place, at in self._addresses.items():
            block = next(block for block in raw if holds(block, at))
            begin = at.byte - block.byte
            read[place] = at.value(raw[block][begin : begin + at.length])
        return read

    def order(self, command: Command) -> Writing[WriteRequest]:
        """The writes for a command, in order; raises NotSent if the mapping does not know it."""
        if isinstance(command, Stop):
            stop = stop_order(self._mapping, command.mode)
            puts = tuple(WriteRequest(place=put.place, raw=put.place.raw(put.filled({}))) for put in stop)
            return Writing(puts=puts, begins_last=False)
        called, sequence = self.verb(command), self._mapping.sequence
        values = dict(called.values)
        puts = tuple(
            WriteRequest(place=put.place, raw=put.place.raw(put.filled(values)))
            for put in self._mapping.verbs[called.verb].write
        )
        if sequence is None:
            return Writing(puts=puts, begins_last=len(puts) == 1)
        there = address(sequence.write)
        number = WriteRequest(place=there, raw=there.raw(self.number(called)))
        return Writing(puts=(*puts, number), begins_last=True)


def holds(block: Block, at: Address) -> bool:
    """True if the value at an address is within a block."""
    within = block.byte <= at.byte and at.byte + at.length <= block.byte + block.length
    return (block.area, block.db) == (at.area, at.db) and within


def blocks(places: Sequence[Address], most: int) -> tuple[Block, ...]:
    """The requests that read these places, in their order, each of at most `most` bytes.

    A request goes on upwards only: what comes first in the order is never read after what follows it.
    """
    out: list[Block] = []
    for at in places:
        if any(holds(block, at) for block in out):
            continue
        last = out[-1] if out else None
        longer = None if last is None else _longer(last, at)
        if longer is not None and longer.length <= most:
            out[-1] = longer
        else:
            out.append(Block(area=at.area, db=at.db, byte=at.byte, length=at.length))
    return tuple(out)


def _longer(block: Block, at: Address) -> Block | None:
    """The block made longer, up to the end of a value; None if that is elsewhere, below it or far above."""
    end = block.byte + block.length
    if (block.area, block.db) != (at.area, at.db) or not block.byte <= at.byte <= end + GAP:
        return None
    length = max(end, at.byte + at.length) - block.byte
    return Block(area=block.area, db=block.db, byte=block.byte, length=length)
