"""Topics that a node must have to itself, and the watch for others that publish there."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from typing import Any

from rclpy.node import Node

from arboleda.drivers import plain
from arboleda.extension import StartError

_POLL_S = 0.02
# Fast DDS answers a new node once, often too early, and announces itself again after 3 s
DISCOVERY_S = 3.2
_NAME_S = 3.0  # further wait for the name of a publisher that was found
_SETTLED_S = 1.0  # a new node tells its publishers within this time, on a busy machine, too
_UNSETTLED_S = 10.0  # greatest further wait while nodes come and go
UNNAMED = "a node without a name"  # discovery may show a publisher before it knows the node
_LOOKED_AT = 5  # topics in one look; the time for each grows with the whole graph
_ALERT = 5  # looks at a node that has come; what it publishes is discovered a little later
_UNKNOWN = "_UNKNOWN_"  # in the name of a node of which discovery has shown only an endpoint


class ExclusiveTopics:
    """Watch over `topics` (relative names), to be made as soon as the node is."""

    def __init__(self, node: Node) -> None:
        self.topics: list[str] = []
        self._node = node
        self._born = time.monotonic()
        self._intruders: dict[str, list[str]] = {}  # by topic, as of the last look at it
        self._next = 0
        self._nodes = Counter[tuple[str, str]]()
        self._alert: dict[tuple[str, str], int] = {}  # looks that are left at each node that has come
        self._relative: dict[str, str] = {}  # the topics by their absolute names

    def others(self) -> list[tuple[str, str]]:
        """The (topic, node name) of every other publisher now."""
        return [(self._absolute(topic), name) for topic in self.topics for name in self._others(topic)]

    def check(self, wait_s: float) -> None:
        """Raise StartError as soon as discovery names another publisher.

        Returns `wait_s` after this was made, or later where nodes have come or gone within _SETTLED_S; a time
        shorter than DISCOVERY_S misses publishers that were there before, about one in two.
        """
        until = self._born + wait_s
        latest = until + _UNSETTLED_S
        nodes = self._node.get_node_names_and_namespaces()
        while not _named(found := self.others()):
            now, known = time.monotonic(), nodes
            nodes = self._node.get_node_names_and_namespaces()
            if sorted(nodes) != sorted(known):
                until = min(max(until, now + _SETTLED_S), latest)
            if now >= until + (_NAME_S if found else 0.0):
                break
            time.sleep(_POLL_S)
        for topic, name in _named(found) or found:
            raise StartError(
                f"another node already commands {topic}: {name}; stop it, "
                "or give this plant a ROS_DOMAIN_ID of its own"
            )

    def look(self) -> tuple[str, ...]:
        """A sentence for each other node that publishes; to be called every second.

        Each call looks at _LOOKED_AT topics in turn, and at those that a node publishes which has come.
        """
        for topic in self._to_look_at():
            alone = self._node.count_publishers(topic) <= 1  # a quarter of the price of asking for names
            if others := [] if alone else self._others(topic):
                self._intruders[topic] = others
            else:
                self._intruders.pop(topic, None)
        return tuple(_intrusion(name, topics) for name, topics in self._by_name().items())

    def _to_look_at(self) -> list[str]:
        found = self._node.get_node_names_and_namespaces()
        nodes = Counter((name, namespace) for name, namespace in found)
        self._alert |= dict.fromkeys(nodes - self._nodes, _ALERT)
        self._nodes = nodes
        topics = [*self._intruders, *self._in_turn()]
        for node in self._alert:
            topics += self._published_by(*node)
        self._alert = {node: looks - 1 for node, looks in self._alert.items() if looks > 1}
        return list(dict.fromkeys(topics))

    def _in_turn(self) -> list[str]:
        begin, self._next = self._next, self._next + _LOOKED_AT
        if self._next >= len(self.topics):
            self._next = 0
        return self.topics[begin : begin + _LOOKED_AT]

    def _published_by(self, name: str, namespace: str) -> Sequence[str]:
        """Those of the topics that another node publishes; all if nobody can ask for it by its name."""
        if _UNKNOWN in name or self._nodes[name, namespace] > 1:
            return self.topics
        if f"{namespace.rstrip('/')}/{name}" == self._node.get_fully_qualified_name():
            return []
        try:
            published = self._node.get_publisher_names_and_types_by_node(name, namespace)
        except RuntimeError:  # it has gone
            return []
        if len(self._relative) < len(self.topics):
            self._relative = {self._absolute(topic): topic for topic in self.topics}
        return [self._relative[topic] for topic, _ in published if topic in self._relative]

    def _by_name(self) -> dict[str, list[str]]:
        found: dict[str, list[str]] = {}
        for topic, names in self._intruders.items():
            for name in names:
                found.setdefault(name, []).append(self._absolute(topic))
        return found

    def _others(self, topic: str) -> list[str]:
        names = [full_name(info) for info in self._node.get_publishers_info_by_topic(topic)]
        own = self._node.get_fully_qualified_name()
        if own in names:  # once: a second node of the same name is another one
            names.remove(own)
        return names

    def _absolute(self, topic: str) -> str:
        return self._node.resolve_topic_name(topic)


def _intrusion(name: str, topics: list[str]) -> str:
    more = f" and {len(topics) - 1} more topics" if len(topics) > 1 else ""
    return f"another node commands {topics[0]}{more}: {name}"


def _named(publishers: list[tuple[str, str]]) -> list[tuple[str, str]]:
    return [(topic, name) for topic, name in publishers if name != UNNAMED]


def full_name(info: Any) -> str:
    """The name of the node that an endpoint belongs to, with its namespace."""
    if _UNKNOWN in info.node_name:
        return UNNAMED
    return plain(f"{info.node_namespace.rstrip('/')}/{info.node_name}")  # whoever joins DDS chooses it
