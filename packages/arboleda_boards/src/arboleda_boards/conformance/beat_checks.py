"""Checks of beats, for boards with command numbers: arms and declared devices alike."""

from __future__ import annotations

from typing import Any

from arboleda.wire import payloads, strict
from arboleda.wire.topics import Channel

from .bench import Bench, Send, Steps, Wait
from .procedures import accepted, demand, refused, stop


def beaten_off(bench: Bench[Any]) -> Steps:
    """A beat of a higher epoca has it refuse lower ones with viejo, and say epoca_min."""
    yield from accepted(bench, stop(bench, 2))
    number, newer = bench.seq + 1, bench.epoch + 1
    try:
        yield _beat(newer)
        yield Wait(seconds=1.0, until=lambda: bench.last.least_epoch == newer)
        least = bench.last.least_epoch
        demand(least == newer, f"after a beat of {newer}, its epoca_min is {least}")
        demand(bench.last.ack == bench.seq, "the beat took its ack away")
        yield from refused(bench, stop(bench, 0, seq=number), "viejo", number)
    finally:
        bench.epoch, bench.seq = newer, 0
    yield from accepted(bench, stop(bench, 2))


def far_future(bench: Bench[Any]) -> Steps:
    """A beat of an epoca that no plant can have is refused with formato, and fences nobody off."""
    yield from accepted(bench, stop(bench, 2))
    yield _beat(strict.UINT32)
    yield Wait(seconds=1.0, until=lambda: bench.last.refusal == "formato")
    report = bench.last
    yield from accepted(bench, stop(bench, 2))
    demand(report.refusal == "formato", f"it does not refuse a beat of {strict.UINT32} with formato")


def _beat(epoch: int) -> Send:
    return Send(channel=Channel.BEAT, payload=payloads.encode(payloads.Beat(epoch=epoch)))
