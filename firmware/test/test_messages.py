"""The core reads and refuses the same messages as the plant, down to the last bit of an angle."""

from __future__ import annotations

import json
from decimal import Decimal, localcontext
from pathlib import Path
from random import Random
from typing import Any

import pytest

from arboleda.model.errors import PayloadError
from arboleda.wire import payloads
from arboleda.wire.payloads import Beat, EffectorGoal, JointsGoal, StopGoal
from arboleda.wire.topics import Channel

from . import core
from .scripts import CHANNELS

VECTORS = Path(__file__).parents[2] / "wire_vectors"
MUTATIONS = 40_000
Body = tuple[float, ...] | bool | int | None
Reading = tuple[Body, int | None, int | None, int | None, str | None]
LEAST = 1e-30  # what is smaller is 0 for the core


def rows(*names: str) -> list[Any]:
    read = [row for name in names for row in json.loads((VECTORS / name).read_text(encoding="ascii"))]
    heard = [row for row in read if row["channel"] in CHANNELS and row["axes"] is not None]
    return [pytest.param(row["channel"], _raw(row), row["axes"], id=row["name"]) for row in heard]


def _raw(row: dict[str, Any]) -> bytes:
    return bytes.fromhex(row["hex"]) if "hex" in row else row["bytes"].encode()


def ours(channel: str, raw: bytes, axes: int) -> Reading | None:
    """What the core reads; None where it refuses."""
    read = core.decode(CHANNELS.index(channel), raw, axes)
    if not read.well_formed:
        return None
    bodies: dict[str, Body] = {
        "juntas": tuple(read.q_deg[:axes]),
        "efector": bool(read.on),
        "paro": read.stop,
    }
    seq = read.seq if read.has_seq and channel != "latido" else None
    heard = read.heard if read.has_heard else None
    epoch = read.epoch if read.has_epoch else None
    return bodies.get(channel), seq, epoch, heard, read.token.decode() or None


def theirs(channel: str, raw: bytes, axes: int) -> Reading | None:
    """What the plant's own reader makes of it."""
    try:
        message = payloads.decode(Channel(channel), raw, axes=axes)
    except PayloadError:
        return None
    body: Body = None
    if isinstance(message, JointsGoal):
        body = tuple(value if abs(value) >= LEAST else 0.0 for value in message.q_deg)
    elif isinstance(message, EffectorGoal):
        body = message.on
    elif isinstance(message, StopGoal):
        body = message.mode.value
    seq = None if isinstance(message, Beat) else getattr(message, "seq", None)
    epoch, heard, token = (getattr(message, name, None) for name in ("epoch", "heard", "token"))
    return body, seq, epoch, heard, token


@pytest.mark.parametrize(("channel", "raw", "axes"), rows("messages.json", "accepted.json"))
def test_a_golden_message_is_read(channel: str, raw: bytes, axes: int) -> None:
    assert ours(channel, raw, axes) is not None
    assert ours(channel, raw, axes) == theirs(channel, raw, axes)


@pytest.mark.parametrize(("channel", "raw", "axes"), rows("refused.json"))
def test_a_damaged_message_is_refused(channel: str, raw: bytes, axes: int) -> None:
    assert ours(channel, raw, axes) is None


PIECES = (
    *(
        b"{",
        b"}",
        b"[",
        b"]",
        b",",
        b":",
        b'"',
        b" ",
        b"\n",
        b"\\",
        b"\x00",
        b"\x1f",
        b"\x7f",
        b"\xef\xbb\xbf",
    ),
    *(b'"ficha":"0a",', b'"ficha":"0123456789abc",', b'"ficha":7,', b'"ficha":"\\u0041",'),
    *(b'"visto":7,', b'"visto":7.0,', b'"visto":null,', b'"visto":4294967296,'),
    *(b'"q1"', b'"\\u0071\\u0031"', b'"q1":1', b'"":[{"":{}}]', b'"\\ud83d\\ude00":1,"\xf0\x9f\x98\x80":1'),
    *(
        b"-",
        b"-0",
        b"0",
        b"01",
        b"1.",
        b".5",
        b"1e3",
        b"1E-2",
        b"1e",
        b"1e400",
        b"1e-400",
        b"0e999",
        b"4294967295",
    ),
    *(b"4294967296", b"1000000.00000000001", b"1000000.0000000001164", b"0.1", b"45.00357", b"1" * 400),
    *(b"true", b"null", b"NaN", b"-Infinity", b"\xc0\x80", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\xe2\x82"),
    *(
        b'"\\ud800"',
        b'"\\ud800\\u0041"',
        b'"\\x"',
        b'"\\u12g4"',
        b'"\t"',
        b"[" * 100 + b"]" * 100,
        b"[" * 300,
    ),
)


def mutated(chance: Random, raw: bytes) -> bytes:
    """The message with some pieces put in and some bytes taken away."""
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(raw) + 1)
        piece = chance.choice(PIECES) if chance.random() < 0.8 else b""
        raw = raw[:at] + piece + raw[at + chance.randrange(4) :]
    return raw


def test_mutated_messages_are_judged_as_by_the_plant() -> None:
    chance, seeds = Random(1), [each.values for each in rows("messages.json", "accepted.json")]
    read = 0
    for _ in range(MUTATIONS):
        channel, raw, axes = chance.choice(seeds)
        raw = mutated(chance, raw)
        assert ours(channel, raw, axes) == theirs(channel, raw, axes), (channel, raw)
        read += ours(channel, raw, axes) is not None
    assert read > MUTATIONS / 50  # else they are only noise


def number(chance: Random) -> str:
    """A decimal as nobody would write it."""
    digits = "".join(chance.choices("0123456789", k=chance.randint(1, 40)))
    text = chance.choice(("", "-")) + digits.lstrip("0")[:7].rjust(1, "0")
    text += "." + "".join(chance.choices("0123456789", k=chance.choice((1, 4, 17, 60, 300))))
    return text + chance.choice(("", "", f"e{chance.randint(-25, 3)}"))


def test_numbers_are_rounded_to_the_last_bit() -> None:
    chance = Random(2)
    with localcontext() as exact:
        exact.prec = 99
        between = [
            str(Decimal(n) + Decimal(2 * k + 1) * Decimal(2) ** -53) for n in (1, -1) for k in range(9)
        ]
    halves = (
        [*between] + [f"{n + 0.5:.1f}" for n in range(9)] + [f"{2**52 + 2 * n + 1}e-10" for n in range(99)]
    )
    for text in [*halves, *(number(chance) for _ in range(20_000))]:
        raw = f'{{"q1":{text},"q2":0,"q3":0}}'.encode()
        assert ours("juntas", raw, 3) == theirs("juntas", raw, 3), text


def test_angles_are_written_as_the_plant_writes_them() -> None:
    chance = Random(3)
    steps = [n * 0.01929 for n in range(-8000, 8000)] + [n * 0.9 for n in range(-400, 400)]
    ties = [n / 2**k for n in range(-99, 99) for k in (1, 5, 14)]
    for value in [
        *steps,
        *ties,
        0.0,
        -0.0,
        1e6,
        -1e6,
        1e-9,
        *(chance.uniform(-1e6, 1e6) for _ in range(20_000)),
    ]:
        assert core.angle(value) == repr(round(value, 4) + 0.0), value
