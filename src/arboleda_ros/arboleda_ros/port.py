"""Base of the ROS 2 ports: guarded handlers, one sentence per bad message, and their health."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from arboleda.adapters.rate_limit import RateLimit
from arboleda.model.errors import PayloadError
from arboleda.runtime.host_claim import node_claim
from arboleda.wire.status import ERROR, OK, WARN
from arboleda_ros import qos, statuses
from arboleda_ros.exclusive_topics import DISCOVERY_S, ExclusiveTopics
from arboleda_ros.speakers import Speakers

NAMED = "arboleda: "  # prefix of the names of all our statuses
_DIAGNOSTICS_S = 1.0


@dataclass(frozen=True, kw_only=True)
class PortHealth:
    """Health of a port for `/diagnostics`: sentences to warn of, errors, and counts since the start."""

    warnings: tuple[str, ...]
    errors: tuple[str, ...]
    refused: int
    failures: int


class Port:
    """Topics of one node. Names are relative; no message and no handler ends the executor."""

    def __init__(self, node: Node, clock: Callable[[], float]) -> None:
        self._node = node
        self._clock = clock
        self._log = logging.getLogger(f"arboleda.ros.{node.get_name()}")
        self._alone = ExclusiveTopics(node)
        self._claim = node_claim(node.context.get_domain_id(), node.get_fully_qualified_name())
        self._refused = 0
        self._failures = 0
        self._warnings: dict[str, None] = {}
        self._seldom = RateLimit()
        self._logged: set[str] = set()
        self._intrusions: tuple[str, ...] = ()  # as told last
        self._diagnostics = self._speak(DiagnosticArray, "/diagnostics", qos.COMMAND)
        node.create_timer(_DIAGNOSTICS_S, self._tell_health, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def check_alone(self, wait_s: float = DISCOVERY_S) -> None:
        """Raise StartError as soon as another node is found that publishes what only this one may."""
        self._claim.take()
        self._alone.check(wait_s)

    def close(self) -> None:
        """End everything that others still wait for; the executor runs on until they know."""

    def destroy(self) -> None:
        """Release everything that does not end with the node; nothing is delivered any more."""
        self._claim.release()

    def health(self) -> PortHealth:
        """The health now; a node that joined topics of this port's own is logged, each time it comes."""
        errors = self._alone.look()
        for sentence in errors:
            if sentence not in self._intrusions:
                self._log.error(sentence)
        self._intrusions = errors
        return PortHealth(
            warnings=tuple(self._warnings), errors=errors, refused=self._refused, failures=self._failures
        )

    def _diagnosed(self, what: str) -> str:
        """The name of a status with its namespace, as plants of all namespaces share `/diagnostics`."""
        namespace = self._node.get_namespace().strip("/")
        return f"{NAMED}{namespace}/{what}" if namespace else f"{NAMED}{what}"

    def _publish_diagnostics(self, status: list[DiagnosticStatus]) -> None:
        message = DiagnosticArray(status=status)
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._diagnostics.publish(message)

    def _links(self) -> list[DiagnosticStatus]:
        """The diagnostic statuses of further links of this node."""
        return []

    def _tell_health(self) -> None:
        health = self.health()
        level = ERROR if health.errors else WARN if health.warnings or health.failures else OK
        sentence = "; ".join(health.errors + health.warnings) or "ready"
        counts = {"refused": str(health.refused), "failures": str(health.failures)}
        name = self._diagnosed(f"{self._node.get_name()} on ROS 2")
        here = statuses.diagnostic(name, "ros", level, sentence, counts)
        self._publish_diagnostics([here, *self._links()])

    def _listen(
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
            return self._guarded(topic, handle), None
        on_match = self._guarded(topic, partial(speakers.matched, topic))
        return self._guarded(topic, speakers.guarded(topic, handle)), on_match

    def _listen_as_offered(
        self,
        kind: type,
        topic: str,
        handle: Callable[[Any], None],
        *,
        raw: bool = False,
        speakers: Speakers | None = None,
    ) -> None:
        """Subscribe like `_listen`; reliably while every publisher offers that, else best effort."""
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

    def _speak(self, kind: type, topic: str, profile: QoSProfile, *, alone: bool = False) -> Publisher:
        """A publisher; `alone`: a second publisher of the topic is a fault."""
        if alone:
            self._alone.topics.append(topic)
        events = qos.publisher_events(lambda policy: self._incompatible(topic, "subscription", policy))
        return self._node.create_publisher(kind, topic, profile, event_callbacks=events)

    def _guarded(self, topic: str, handle: Callable[[Any], None]) -> Callable[[Any], None]:
        def guarded(message: Any) -> None:
            try:
                handle(message)
            except PayloadError as error:
                self._refused += 1
                self._log_seldom(topic, str(error))
            except Exception:  # noqa: BLE001 - one broken handler must not silence the other topics
                self._failures += 1
                self._log.exception("the handler of %s failed", self._absolute(topic))

        return guarded

    def _log_seldom(self, topic: str, sentence: str) -> None:
        if self._seldom.is_due((topic, sentence), self._clock()):
            self._log.warning("refused a message on %s: %s", self._absolute(topic), sentence)

    def _log_once(self, sentence: str, level: int) -> None:
        if sentence not in self._logged:
            self._logged.add(sentence)
            self._log.log(level, sentence)

    def _incompatible(self, topic: str, what: str, policy: str) -> None:
        sentence = (
            f"a {what} of another node on {self._absolute(topic)} has an incompatible {policy}; "
            "nothing passes between it and this plant"
        )
        if sentence not in self._warnings:
            self._warnings[sentence] = None
            self._log_once(sentence, logging.WARNING)
            self._tell_health()

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
