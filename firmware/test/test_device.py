"""The core's board of a declared device says and reads what the plant's virtual board of it does."""

from __future__ import annotations

import json
import os
from random import Random

import pytest

from arboleda.model.errors import PayloadError
from arboleda.sim.machine import MachineBody
from arboleda.wire import payloads
from arboleda.wire.payloads import DEVICE, VerbGoal
from arboleda.wire.topics import Channel

from . import device_core
from .device_scripts import Author, Reference, valve
from .test_messages import VECTORS, mutated

SCRIPTS = int(os.environ.get("ARBOLEDA_SCRIPTS", "600"))
GROUPS = 4
MUTATIONS = 40_000
ORDERS = (
    b'{"verbo":"open","seq":1,"epoca":2}',
    b'{"verbo":"dose","valores":{"ml":5},"seq":1,"epoca":2}',
    b'{"verbo":"dose","valores":{"ml":10,"x":true,"y":"a b","z":-1.5e3},"seq":1,"epoca":2}',
    b'{"seq":4294967295,"epoca":0,"valores":{},"verbo":"level"}',
    b'{"verbo":"close","seq":1,"epoca":2,"visto":4294967295}',
)
PIECES = (
    *(b'"ml":5', b'"ml":10.0', b'"ml":1e1', b'"\\u006dl":5', b'"dos\\u0065"', b"true", b"false", b"null"),
    *(
        b"{}",
        b"[]",
        b'{"a":{}}',
        b'""',
        b'"\\""',
        b'"\xc3\xa9"',
        b'"\\u00e9\\ud83d\\ude00"',
        b'"\\ud83d"',
        b'"\xc2\xa0"',
        b'"' + b"\xc3\xa9" * 16 + b'"',
        b'"' + b"\xc3\xa9" * 16 + b'x"',
        b'"' + b"x" * 33 + b'"',
        b"-0",
        b"-4294967295",
    ),
    *(
        b"-4294967296",
        b"4294967296",
        b"1000000000.0",
        b"1000000000.5",
        b"1e400",
        b'"a":1,',
        b'"valores":{"ml":5},',
    ),
)


@pytest.mark.timeout(3600)
@pytest.mark.parametrize("group", range(GROUPS))
def test_boards_of_a_device_say_the_same_under_random_scripts(group: int) -> None:
    late = 0
    for seed in range(group, SCRIPTS, GROUPS):
        author = Author(seed)
        now_us = author.now_us
        script = author.script()
        wanted = Reference(now_us).run(script)
        assert device_core.run(script) == wanted, f"script {seed}"
        assert len(wanted) > 2
        late += any('"rechazo":"tarde"' in line for line in wanted)
    assert late > SCRIPTS / GROUPS / 10  # else the scripts are too short to say


def theirs(raw: bytes) -> VerbGoal | None:
    """What the plant's own reader makes of an order."""
    try:
        said = payloads.decode(Channel.ORDER, raw, axes=DEVICE)
    except PayloadError:
        return None
    assert isinstance(said, VerbGoal)
    return said


def same(raw: bytes) -> bool:
    """Whether both read the same; and whether it is an order to a valve."""
    ours, plant = device_core.decode(raw), theirs(raw)
    assert bool(ours.well_formed) is (plant is not None), raw
    if plant is None:
        return False
    stamp = ((ours.seq, ours.has_seq), (ours.epoch, ours.has_epoch), (ours.heard, ours.has_heard))
    read = [number if known else None for number, known in stamp]
    assert read == [plant.seq, plant.epoch, plant.heard], raw
    assert (ours.token.decode() or None) == plant.token, raw
    command = MachineBody(valve().kind).command(plant)
    assert bool(ours.known) is (command is not None), raw
    if command is not None and command.values:
        assert (5, 10)[int(ours.value)] == command.values[0][1], raw
    return command is not None


def rows(name: str) -> list[bytes]:
    read = json.loads((VECTORS / name).read_text(encoding="ascii"))
    raw = [row for row in read if row["channel"] == "orden"]
    return [bytes.fromhex(row["hex"]) if "hex" in row else row["bytes"].encode() for row in raw]


def test_golden_orders_are_read_as_by_the_plant() -> None:
    golden = [raw for name in ("messages.json", "accepted.json", "refused.json") for raw in rows(name)]
    assert len(golden) > 10
    for raw in (*golden, *ORDERS):
        same(raw)


def test_mutated_orders_are_judged_as_by_the_plant() -> None:
    chance, read = Random(5), 0
    for _ in range(MUTATIONS):
        raw = chance.choice(ORDERS)
        if chance.random() < 0.6:
            at = chance.randrange(len(raw) + 1)
            raw = raw[:at] + chance.choice(PIECES) + raw[at + chance.randrange(6) :]
        read += same(raw if chance.random() < 0.4 else mutated(chance, raw))
    assert read > MUTATIONS / 50  # else they are only noise
