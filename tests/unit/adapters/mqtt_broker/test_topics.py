"""Filters, who hears what, and what is kept for newcomers."""

from __future__ import annotations

import pytest

from arboleda.adapters.mqtt_broker import limits
from arboleda.adapters.mqtt_broker.packets import Message
from arboleda.adapters.mqtt_broker.topics import RetainedMessages, Subscriptions, is_filter, matches


def message(topic: str, payload: bytes = b"1") -> Message:
    return Message(topic=topic, payload=payload, qos=1, retain=True)


@pytest.mark.parametrize("pattern", ["#", "+", "a", "/", "a/+/b", "a/#", "/#", "x" * limits.TOPIC_BYTES])
def test_filters(pattern: str) -> None:
    assert is_filter(pattern)


@pytest.mark.parametrize("pattern", ["", "a#", "a/#/b", "a+/b", "#/", "x" * (limits.TOPIC_BYTES + 1)])
def test_what_is_no_filter(pattern: str) -> None:
    assert not is_filter(pattern)


@pytest.mark.parametrize(
    ("pattern", "topic", "covered"),
    [
        ("#", "a/b", True),
        ("a/#", "a", True),
        ("a/#", "a/b/c", True),
        ("a/#", "ab", False),
        ("+/b", "a/b", True),
        ("+/b", "/b", True),
        ("+", "/b", False),
        ("a/+", "a", False),
        ("a/+", "a/", True),
        ("#", "$SYS/x", False),
        ("+/x", "$SYS/x", False),
        ("$SYS/#", "$SYS/x", True),
    ],
)
def test_which_topics_a_filter_covers(pattern: str, topic: str, covered: bool) -> None:
    assert matches(pattern.split("/"), topic.split("/")) is covered


def test_a_client_gets_a_message_once_with_the_highest_qos_of_its_filters() -> None:
    subscriptions: Subscriptions[str] = Subscriptions()
    for client, pattern, qos in (("ana", "#", 0), ("ana", "a/b", 1), ("eva", "+/b", 0), ("eva", "x", 1)):
        subscriptions.add(client, pattern, qos)
    assert subscriptions.of("a/b") == {"ana": 1, "eva": 0}
    subscriptions.remove("ana", ["a/b", "#"])
    assert subscriptions.of("a/b") == {"eva": 0}


def test_all_subscriptions_together_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda.adapters.mqtt_broker.topics.FILTERS", 3)
    monkeypatch.setattr("arboleda.adapters.mqtt_broker.topics.WILDCARDS", 1)
    subscriptions: Subscriptions[str] = Subscriptions()
    subscriptions.add("ana", "a/#", 0)
    assert subscriptions.room("b") and not subscriptions.room("b/#")
    subscriptions.add("ana", "b", 0)
    subscriptions.add("ana", "b", 1)
    subscriptions.add("eva", "b", 0)
    assert not subscriptions.room("c")
    subscriptions.remove("ana", ["a/#"])
    assert subscriptions.room("c/#")


def test_retained_messages_are_limited_and_presence_is_kept_in_any_case() -> None:
    retained = RetainedMessages(frozenset({"ra_1/conexion"}))
    kept = [retained.keep(message(f"t/{n}", b"x" * 1000)) for n in range(60_000)]
    assert 0 < sum(kept) < limits.RETAINED_BYTES / 1000
    assert retained.keep(message("ra_1/conexion"))
    assert not retained.keep(message("ra_1/conexion", b"x" * 1000))
    assert retained.of("ra_1/conexion") == []  # the old one would be a lie
    assert len(retained.of("#")) == sum(kept)


def test_an_empty_message_makes_room() -> None:
    retained = RetainedMessages(frozenset())
    big = b"x" * (limits.RETAINED_BYTES - 200)
    assert retained.keep(message("a", big)) and not retained.keep(message("b", big))
    assert retained.keep(message("a", b"")) and retained.keep(message("b", big))
    assert [kept.topic for kept in retained.of("+")] == ["b"]
