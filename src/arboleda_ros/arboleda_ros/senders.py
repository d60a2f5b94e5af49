"""Possible senders of a message: rclpy does not tell the sender, only who publishes on the topic."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.node import Node

from arboleda.wire.hop import HEARTBEAT
from arboleda_ros.exclusive_topics import full_name

_FRESH_S = 1.0  # a flood of messages must not ask the graph for each of them
_SHOWN = 3
_LONGEST = 80  # characters of a name


class Senders:
    """Publishers of a topic, without the plant itself."""

    def __init__(self, node: Node, clock: Callable[[], float]) -> None:
        self._node = node
        self._clock = clock
        self._known: dict[str, tuple[float, str]] = {}

    def of(self, topic: str) -> str:
        """The senders as text, `/teleop` or `/teleop or /panel`; "" if discovery names nobody."""
        now = self._clock()
        at, names = self._known.get(topic, (0.0, ""))
        if not names or now >= at + _FRESH_S:
            names = self._look(topic)
            self._known[topic] = (now, names)
        return names

    def _look(self, topic: str) -> str:
        plants = {full_name(info) for info in self._node.get_publishers_info_by_topic(HEARTBEAT)}
        found = dict.fromkeys(full_name(info) for info in self._node.get_publishers_info_by_topic(topic))
        others = [ascii(name)[1:-1][:_LONGEST] for name in found if name not in plants]
        more = [f"{len(others) - _SHOWN} more"] if len(others) > _SHOWN else []
        return " or ".join([*others[:_SHOWN], *more])
