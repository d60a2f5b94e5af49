"""Check of the nodes that speak for a robot on ROS 2: while several publish its reports, none is believed.

rclpy does not name the sender of a message, only the publishers of a topic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from arboleda.recipes import Phrase, Sentence

HOLD_S = 0.5  # time for messages of a gone node to leave the queues
NAMELESS_S = 1.0  # discovery may show a publisher before it knows the node
GONE = Phrase("speaker.gone", "a node that is gone")
NAMELESS = Phrase("speaker.nameless", "a node without a name")
CONTESTED = Phrase(
    "speaker.contested",
    "{robot}: more than one node publishes on {topic} ({nodes}); nothing that it reports is believed until "
    "one is left",
)
AND = Phrase("speaker.and", "{first} and {second}")


class Contest:
    """Contest of several nodes on one topic since a time; `reported` are the nodes that people were told."""

    def __init__(self, since: float) -> None:
        self.since = since
        self.reported: frozenset[str | None] = frozenset()


class Speaker:
    """Check of the nodes that speak for one robot.

    Nodes of one name count as one node: DDS lists a node for a while after its restart.
    """

    def __init__(self, robot: str) -> None:
        self._robot = robot
        self._contests: dict[str, Contest] = {}  # by topic
        self._until = -math.inf

    def believed(self, at: float) -> bool:
        """True while the robot's reports count."""
        return not self._contests and at >= self._until

    def publishers(self, at: float, topic: str, nodes: Sequence[str | None]) -> Sentence | None:
        """Take the publishers of a topic, None for one without a name yet; a sentence for a new contest."""
        names = frozenset(nodes)
        if len(names) <= 1 and nodes.count(None) <= 1:
            return self._settled(at, topic, alone=len(nodes) <= 1)
        contest = self._contests.setdefault(topic, Contest(at))
        if names == contest.reported or (None in names and at < contest.since + NAMELESS_S):
            return None
        contest.reported = names
        return self._sentence(topic, names)

    def came_and_went(self, at: float, topic: str) -> Sentence:
        """Take that a node published and is gone; the sentence on it."""
        self._until = at + HOLD_S
        return self._contested(topic, GONE())

    def _settled(self, at: float, topic: str, *, alone: bool) -> Sentence | None:
        contest = self._contests.pop(topic, None)
        if contest is None:
            return None
        self._until = at + HOLD_S
        return self._contested(topic, GONE()) if alone and not contest.reported else None

    def _sentence(self, topic: str, names: frozenset[str | None]) -> Sentence:
        named = sorted(name for name in names if name is not None)
        first: str | Sentence = ", ".join(named if None in names else named[:-1])
        last = NAMELESS() if None in names else named[-1]
        return self._contested(topic, AND(first=first, second=last) if first else last)

    def _contested(self, topic: str, nodes: str | Sentence) -> Sentence:
        return CONTESTED(robot=self._robot, topic=topic, nodes=nodes)
