"""The golden messages of wire_vectors/, which the firmware reads too, and `<board>/<channel>`, both ways."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.model.errors import PayloadError
from arboleda.wire.payloads import decode, encode
from arboleda.wire.topics import Channel, parse, topic

VECTORS = Path(__file__).parents[3] / "wire_vectors"


def rows(name: str) -> list:
    read = json.loads((VECTORS / name).read_text(encoding="ascii"))
    return [pytest.param(row, id=row["name"]) for row in read]


def raw(row: dict) -> bytes:
    return bytes.fromhex(row["hex"]) if "hex" in row else row["bytes"].encode()


def value(payload: object) -> dict:
    """The fields that were said, as JSON knows them."""
    fields = asdict(payload).items()  # type: ignore[call-overload]
    said = {key.removesuffix("_deg"): field for key, field in fields if field is not None}
    return json.loads(json.dumps(said))


@pytest.mark.parametrize("row", rows("messages.json") + rows("accepted.json"))
def test_bytes_mean_their_value(row: dict) -> None:
    assert value(decode(Channel(row["channel"]), raw(row), axes=row["axes"])) == row["value"]


@pytest.mark.parametrize("row", rows("messages.json"))
def test_a_value_is_written_as_these_bytes(row: dict) -> None:
    payload = decode(Channel(row["channel"]), raw(row), axes=row["axes"])
    assert encode(payload) == raw(row)


@pytest.mark.parametrize("row", rows("refused.json"))
def test_bytes_are_refused_by_name(row: dict) -> None:
    with pytest.raises(PayloadError, match=row["names"]):
        decode(Channel(row["channel"]), raw(row), axes=row["axes"])


@pytest.mark.parametrize("channel", Channel)
def test_a_topic_reads_back(channel: Channel) -> None:
    assert parse(topic("ra_1", channel)) == ("ra_1", channel)


@pytest.mark.parametrize(
    "text",
    ["", "ra_1", "/juntas", "ra_1/", "ra_1/otro", "ra_1/juntas/x", "a/ra_1/juntas", "+/juntas", "ra 1/paro"],
)
def test_any_other_topic_is_refused(text: str) -> None:
    with pytest.raises(PayloadError):
        parse(text)


@given(st.text())
def test_whatever_the_topic_the_answer_is_a_channel_or_a_payload_error(text: str) -> None:
    try:
        board, channel = parse(text)
    except PayloadError:
        return
    assert topic(board, channel) == text
