"""Router of messages from publishers to subscribers."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Iterable
from dataclasses import replace
from typing import Protocol

from arboleda.wire.topics import Channel, topic

from .access import Access, ClientIdentity
from .packets import Message
from .topics import RetainedMessages, Subscriptions

LOG = logging.getLogger(__name__)


class Receiver(Protocol):
    """Outbox of a client, as far as the router needs to know it."""

    def __hash__(self) -> int: ...
    def send(self, message: Message) -> None: ...
    def flush(self) -> None: ...


class Router:
    """Subscriptions and retained messages of one broker. Messages to receivers leave at `flush`."""

    def __init__(self, access: Access) -> None:
        self._access = access
        self._subscriptions: Subscriptions[Receiver] = Subscriptions()
        self._retained = RetainedMessages(
            frozenset(topic(board, Channel.PRESENCE) for board in access.boards)
        )
        self._unsent: dict[Receiver, None] = {}
        self._wills: deque[tuple[ClientIdentity, Message]] = deque()

    def publish(self, who: ClientIdentity, message: Message) -> None:
        """Send a message to all subscribers; it is dropped if `who` may not write there."""
        if not self._access.may_write(who, message.topic):
            LOG.debug("%r may not write to %.80a", who.user, message.topic)
            return
        if message.retain and not self._retained.keep(message):
            LOG.debug("no room to retain %.80a", message.topic)
        live = replace(message, retain=False)
        for receiver, qos in self._subscriptions.of(message.topic).items():
            receiver.send(live if qos == message.qos else replace(live, qos=min(qos, message.qos)))
            self._unsent[receiver] = None

    def subscribe(self, receiver: Receiver, pattern: str, qos: int) -> None:
        self._subscriptions.add(receiver, pattern, qos)

    def has_room(self, pattern: str) -> bool:
        """True if one more subscription to `pattern` stays within the limit of all users together."""
        return self._subscriptions.room(pattern)

    def send_retained(self, receiver: Receiver, pattern: str, qos: int) -> None:
        """Send a new subscription the retained messages that match it."""
        for message in self._retained.of(pattern):
            receiver.send(replace(message, qos=min(qos, message.qos)))

    def unsubscribe(self, receiver: Receiver, patterns: Iterable[str]) -> None:
        self._subscriptions.remove(receiver, patterns)

    def forget(self, receiver: Receiver, patterns: Iterable[str]) -> None:
        """Forget a receiver that is gone, and the messages queued for it."""
        self._subscriptions.remove(receiver, patterns)
        self._unsent.pop(receiver, None)

    def publish_will(self, who: ClientIdentity, will: Message) -> None:
        """Publish the last will of a client that is gone."""
        self._wills.append((who, will))
        if len(self._wills) == 1:  # else this was called from the loop below: a will can end another client
            while self._wills:
                self.publish(*self._wills[0])
                self._wills.popleft()

    def flush(self) -> None:
        """Send the queued messages."""
        while self._unsent:
            self._unsent.popitem()[0].flush()
