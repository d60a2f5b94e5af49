"""Quality of service of the topics of Arboleda."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
    qos_policy_name_from_kind,
)
from rclpy.subscription import Subscription

try:
    from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
except ImportError:  # Humble keeps them elsewhere
    from rclpy.qos_event import PublisherEventCallbacks, SubscriptionEventCallbacks


def _reliable(depth: int, durability: DurabilityPolicy) -> QoSProfile:
    return QoSProfile(depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=durability)


COMMAND = _reliable(10, DurabilityPolicy.VOLATILE)
# no task may be lost to a slow reader, so all that wait are kept
TASK_REQUEST = QoSProfile(
    history=HistoryPolicy.KEEP_ALL,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
)
TASK_STATUS = _reliable(100, DurabilityPolicy.TRANSIENT_LOCAL)
VIEW = _reliable(1, DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(
    depth=100, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.VOLATILE
)
SENSOR = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.VOLATILE)


RELIABILITY = qos_policy_name_from_kind(QoSPolicyKind.RELIABILITY)


# True if a subscription is told of publishers that come and go; not so in Humble
TELLS_MATCHES = hasattr(SubscriptionEventCallbacks(), "matched")


def publisher_events(on_policy: Callable[[str], None]) -> PublisherEventCallbacks:
    """Callbacks of a publisher: `on_policy` gets the policy that a subscription is incompatible with."""
    return PublisherEventCallbacks(incompatible_qos=_naming(on_policy))


def subscription_events(
    on_policy: Callable[[str], None], on_match: Callable[[Any], None] | None = None
) -> SubscriptionEventCallbacks:
    """Callbacks of a subscription: `on_policy` gets a publisher's incompatible policy.

    `on_match` is called when publishers come and go.
    """
    events = SubscriptionEventCallbacks(incompatible_qos=_naming(on_policy))
    if on_match is not None and TELLS_MATCHES:
        events.matched = on_match
    return events


class Matches:
    """Counter of the publishers of a subscription, as the middleware counts them at this very moment."""

    def __init__(self, subscription: Subscription, on_match: Callable[[Any], None]) -> None:
        handlers: Any = subscription.event_handlers  # a list, which rclpy declares as one handler
        (handler,) = (each for each in handlers if each.callback is on_match)
        handler.add_to_wait_set(self)  # the one way in which a handler hands out its event

    def add_event(self, event: Any) -> int:
        """Take the event, as a wait set does."""
        self._event = event
        return 0

    def now(self) -> Any:
        """Numbers of publishers that ever came, and that are there: `total_count`, `current_count`."""
        with self._event:
            return self._event.take_event()


def _naming(on_policy: Callable[[str], None]) -> Callable[[Any], None]:
    return lambda event: on_policy(qos_policy_name_from_kind(event.last_policy_kind))
