"""Subscriptions, and the retained messages that new subscribers are sent."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from typing import Generic, TypeVar

from .limits import FILTERS, RETAINED_BYTES, TOPIC_BYTES, WILDCARDS
from .packets import Message

Client = TypeVar("Client", bound=Hashable)
ENTRY_BYTES = 64  # of a retained message beside its topic and payload
SMALL_BYTES = 64  # of a payload: presence has less


def is_filter(pattern: str) -> bool:
    """True for a valid topic filter: `+` and `#` alone in their level, `#` in the last one, not too long."""
    levels = pattern.split("/")
    good = all(level in ("+", "#") or not {"+", "#"} & set(level) for level in levels)
    return good and bool(pattern) and "#" not in levels[:-1] and len(pattern.encode()) <= TOPIC_BYTES


def is_wild(pattern: str) -> bool:
    """True if a filter has wildcards."""
    return "+" in pattern or "#" in pattern


def matches(pattern: list[str], topic: list[str]) -> bool:
    """True if a filter covers a topic, both given by levels; a leading wildcard does not match `$` topics."""
    if pattern[0] in ("+", "#") and topic[0].startswith("$"):
        return False
    for number, level in enumerate(pattern):
        if level == "#":
            return True
        if number == len(topic) or level not in ("+", topic[number]):
            return False
    return len(pattern) == len(topic)


class Subscriptions(Generic[Client]):
    """Topic filters by client."""

    def __init__(self) -> None:
        self._exact: dict[str, dict[Client, int]] = {}
        self._wild: dict[str, tuple[list[str], dict[Client, int]]] = {}
        self._count = 0

    def room(self, pattern: str) -> bool:
        """True if one more filter like this stays within the limits of all users together."""
        return self._count < FILTERS and (not is_wild(pattern) or len(self._wild) < WILDCARDS)

    def add(self, client: Client, pattern: str, qos: int) -> None:
        """Subscribe, or change the QoS."""
        if is_wild(pattern):
            holders = self._wild.setdefault(pattern, (pattern.split("/"), {}))[1]
        else:
            holders = self._exact.setdefault(pattern, {})
        self._count += client not in holders
        holders[client] = qos

    def remove(self, client: Client, patterns: Iterable[str]) -> None:
        """Unsubscribe from filters that the client subscribed to."""
        for pattern in patterns:
            wild = is_wild(pattern)
            holders = self._wild[pattern][1] if wild else self._exact[pattern]
            del holders[client]
            self._count -= 1
            if not holders:
                del (self._wild if wild else self._exact)[pattern]

    def of(self, topic: str) -> dict[Client, int]:
        """The clients that get a message on `topic`, each once, with the highest QoS of its filters."""
        found = dict(self._exact.get(topic, ()))
        levels = topic.split("/")
        for pattern, holders in self._wild.values():
            if matches(pattern, levels):
                for client, qos in holders.items():
                    found[client] = max(qos, found.get(client, 0))
        return found


class RetainedMessages:
    """The last retained message of each topic. Of the topics in `always` a small one is kept in any case, of
    all others no more than RETAINED_BYTES."""

    def __init__(self, always: frozenset[str]) -> None:
        self._always = always
        self._messages: dict[str, tuple[list[str], Message]] = {}
        self._bytes = 0

    def keep(self, message: Message) -> bool:
        """Keep a message, or forget that of its topic if it is empty; False if there is no room."""
        _, before = self._messages.pop(message.topic, (None, None))
        self._bytes -= self._size(before) if before else 0
        if not message.payload:
            return True
        size = self._size(message)
        if self._bytes + size > RETAINED_BYTES:
            return False
        self._messages[message.topic] = message.topic.split("/"), message
        self._bytes += size
        return True

    def of(self, pattern: str) -> list[Message]:
        """The retained messages that a new subscriber to this filter is sent."""
        if not is_wild(pattern):
            return [self._messages[pattern][1]] if pattern in self._messages else []
        levels = pattern.split("/")
        return [message for topic, message in self._messages.values() if matches(levels, topic)]

    def _size(self, message: Message) -> int:
        """Bytes that a message counts against the room for all; 0 for a small one that is always kept."""
        if message.topic in self._always and len(message.payload) <= SMALL_BYTES:
            return 0
        return len(message.topic.encode()) + len(message.payload) + ENTRY_BYTES
