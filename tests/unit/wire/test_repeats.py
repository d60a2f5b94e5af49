"""Telemetry that repeats the one before: known by its bytes exactly where reading it would say the same."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.core.errors import PayloadError
from arboleda.core.model import Evidence
from arboleda.wire.payloads import Telemetry, decode
from arboleda.wire.repeats import Words
from arboleda.wire.topics import Channel

from .test_bridge_any_order import BOARDS, HAPPENINGS

PLAIN = b'{"nodo":4,"estado":0,"seq":9,"arranque":1}'
NUMBERS = st.sampled_from(["0", "7", "07", "-1", "4294967295", "4294967296", "1e3", "1.0", "", "x", '"5"'])
PIECES = st.sampled_from(
    [
        '"nodo":4',
        '"estado":0',
        '"arranque":1',
        '"x":{"seq":3}',
        '"y\\"seq":3',
        '"\\u0073eq":5',
        '"seq" :6',
        '"z":"seq"',
        " ",
    ]
)


def read(raw: bytes) -> Telemetry | None:
    try:
        said = decode(Channel.TELEMETRY, raw, axes=None)
    except PayloadError:
        return None
    assert isinstance(said, Telemetry)
    return said


@st.composite
def messages(draw: st.DrawFn) -> tuple[bytes, bytes]:
    """Two that differ at most in a number, however odd the rest is."""
    pieces = draw(st.lists(PIECES, max_size=5).map(lambda odd: ['"nodo":4', '"estado":0', *odd]))
    pieces.insert(draw(st.integers(0, len(pieces))), '"seq":@')
    text = "{" + ",".join(draw(st.permutations(pieces))) + "}"
    first, second = (text.replace("@", draw(NUMBERS | st.integers(0, 99).map(str))) for _ in range(2))
    return first.encode(), second.encode()


@given(two=messages())
def test_what_is_known_again_reads_the_same_but_for_its_number(two: tuple[bytes, bytes]) -> None:
    first, second = two
    said = read(first)
    words = Words.of(first, said) if said else None
    number = words.number(second) if words else None
    if said and number is not None:
        assert read(second) == replace(said, seq=number if said.seq is not None else None)


@pytest.mark.parametrize("seq", [0, 10, 4294967295])
def test_a_plain_repeat_is_known_again(seq: int) -> None:
    said = read(PLAIN)
    assert said is not None
    words = Words.of(PLAIN, said)
    assert words is not None and words.number(PLAIN.replace(b"9", b"%d" % seq)) == seq


@pytest.mark.parametrize(
    "other",
    [
        PLAIN.replace(b"4", b"5"),
        PLAIN.replace(b"9", b"09"),
        PLAIN.replace(b"9", b""),
        PLAIN.replace(b"9", b"-9"),
        PLAIN.replace(b"9", b"4294967296"),
        PLAIN.replace(b"9", b"9" * 500),
        PLAIN[:-1],
        b"",
    ],
)
def test_another_message_is_not(other: bytes) -> None:
    said = read(PLAIN)
    assert said is not None
    words = Words.of(PLAIN, said)
    assert words is not None and words.number(other) is None


def test_a_message_without_a_number_is_known_by_all_its_bytes() -> None:
    raw = b'{"nodo":4,"estado":0}'
    said = read(raw)
    assert said is not None
    words = Words.of(raw, said)
    assert words is not None and (words.number(raw), words.number(raw + b" ")) == (0, None)


AGAIN = st.tuples(st.just("tell"), BOARDS)


@pytest.mark.parametrize("evidence", Evidence, ids=lambda level: level.value)
@given(happenings=st.lists(AGAIN | HAPPENINGS, max_size=30))
def test_a_bridge_that_knows_repeats_says_what_one_that_reads_all_would(
    make_linked, evidence: Evidence, happenings: list
) -> None:
    quick, thorough = make_linked(evidence=evidence), make_linked(evidence=evidence)
    for verb, *rest in happenings:
        for board in thorough.bridge._boards.values():
            board._words = None
        said, read = (
            bench.tell(rest[0], **(rest[1] if rest[1:] else {}))
            if verb == "tell"
            else getattr(bench, verb)(*rest)
            for bench in (quick, thorough)
        )
        assert said == read
        assert quick.bridge.counters == thorough.bridge.counters
        assert quick.bridge.next_deadline == thorough.bridge.next_deadline
