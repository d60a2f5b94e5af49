"""`<board>/<channel>`, both ways."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.model.errors import PayloadError
from arboleda.wire.topics import Channel, parse, topic


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
