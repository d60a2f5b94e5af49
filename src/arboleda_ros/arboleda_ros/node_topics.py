"""Topics of one ROS 2 node: guarded handlers, and one sentence per bad message."""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from arboleda.adapters.rate_limit import RateLimit
from arboleda.extension import PayloadError
from arboleda_ros import qos
from arboleda_ros.exclusive_topics import ExclusiveTopics
from arboleda_ros.speakers import Speakers


class NodeTopics:
    """Topics of a node, with relative names; no message and no handler ends the executor.

    `alone`: those that no other node may publish. `refused` messages and `failures` of handlers are counted
    since the start; `on_warning` is called when `warnings` has one more.
    """

    def __init__(self, node: Node, clock: Callable[[], float], on_warning: Callable[[], None]) -> None:
        self.alone = ExclusiveTopics(node)
        self.log = logging.getLogger(f"arboleda.ros.{node.get_name()}")
        self.refused = 0
        self.failures = 0
        self.warnings: dict[str, None] = {}
        self._node = node
        self._clock = clock
        self._on_warning = on_warning
        self._seldom = RateLimit()
        self._logged: set[str] = set()

    def listen(
        self,
        kind: type,
        topic: str,
        handle: Callable[[Any], None],
        profile: QoSProfile,
        *,
        raw: bool = False,
        speakers: Speakers | None = None,
    ) -> None:
        """Subscribe `handle` to a topic; `raw` messages come as bytes.

        With `speakers` it is called only for messages that count.
        """
        handle, on_match = self._spoken(topic, handle, speakers)
        events = qos.subscription_events(
            lambda policy: self._incompatible(topic, "publisher", policy), on_match
        )
        made = self._node.create_subscription(kind, topic, handle, profile, event_callbacks=events, raw=raw)
        _watch(made, topic, speakers, on_match)

    def _spoken(
        self, topic: str, handle: Callable[[Any], None], speakers: Speakers | None
    ) -> tuple[Callable[[Any], None], Callable[[Any], None] | None]:
        """The callbacks for a topic's messages, and for publishers that come or go (None without
        speakers)."""
        if speakers is None:
            return self.guarded(topic, handle), None
        on_match = self.guarded(topic, partial(speakers.matched, topic))
        handle = self.guarded(topic, handle)  # a message may be held back, and come from a timer
        return self.guarded(topic, speakers.guarded(topic, handle)), on_match

    def listen_as_offered(
        self,
        kind: type,
        topic: str,
        handle: Callable[[Any], None],
        *,
        raw: bool = False,
        speakers: Speakers | None = None,
    ) -> None:
        """Subscribe like `listen`; reliably while every publisher offers that, else best effort."""
        guarded, on_match = self._spoken(topic, handle, speakers)

        def make(profile: QoSProfile, on_policy: Callable[[str], None]) -> Subscription:
            events = qos.subscription_events(on_policy, on_match)
            made = self._node.create_subscription(
                kind, topic, guarded, profile, event_callbacks=events, raw=raw
            )
            _watch(made, topic, speakers, on_match)
            return made

        def refuse(policy: str) -> None:
            self._incompatible(topic, "publisher", policy)

        def adapt(policy: str) -> None:
            if policy != qos.RELIABILITY:
                refuse(policy)
            elif reliable and self._node.executor is not None:
                # not from here: this callback belongs to the subscription that goes
                self._node.executor.create_task(partial(replace, reliable.pop()))

        def replace(old: Subscription) -> None:
            self._node.destroy_subscription(old)
            make(qos.BEST_EFFORT, refuse)

        reliable = [make(qos.COMMAND, adapt)]

    def speak(self, kind: type, topic: str, profile: QoSProfile, *, alone: bool = False) -> Publisher:
        """A publisher; `alone`: a second publisher of the topic is a fault."""
        if alone:
            self.alone.topics.append(topic)
        events = qos.publisher_events(lambda policy: self._incompatible(topic, "subscription", policy))
        return self._node.create_publisher(kind, topic, profile, event_callbacks=events)

    def guarded(self, topic: str, handle: Callable[[Any], None]) -> Callable[[Any], None]:
        def guarded(message: Any) -> None:
            try:
                handle(message)
            except PayloadError as error:
                self.refused += 1
                self._log_seldom(topic, str(error))
            except Exception:  # one broken handler must not silence the other topics
                self.failures += 1
                self.log.exception("the handler of %s failed", self._absolute(topic))

        return guarded

    def _log_seldom(self, topic: str, sentence: str) -> None:
        if self._seldom.is_due((topic, sentence), self._clock()):
            self.log.warning("refused a message on %s: %s", self._absolute(topic), sentence)

    def log_once(self, sentence: str, level: int) -> None:
        if sentence not in self._logged:
            self._logged.add(sentence)
            self.log.log(level, sentence)

    def _incompatible(self, topic: str, what: str, policy: str) -> None:
        sentence = (
            f"a {what} of another node on {self._absolute(topic)} has an incompatible {policy}; "
            "nothing passes between it and this plant"
        )
        if sentence not in self.warnings:
            self.warnings[sentence] = None
            self.log_once(sentence, logging.WARNING)
            self._on_warning()

    def _absolute(self, topic: str) -> str:
        return self._node.resolve_topic_name(topic)


def _watch(
    subscription: Subscription,
    topic: str,
    speakers: Speakers | None,
    on_match: Callable[[Any], None] | None,
) -> None:
    """Have speakers count the publishers of a subscription, where the middleware tells of them."""
    if speakers is not None and on_match is not None and qos.TELLS_MATCHES:
        speakers.watch(topic, qos.Matches(subscription, on_match).now)
