"""Publishers of each robot's reports, from the middleware, for the rule of `speaker`."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from std_msgs.msg import UInt8

from arboleda.drivers import MotionState, Report
from arboleda.extension import Sentence
from arboleda.model.messages import Event, Interference, Uncontested
from arboleda_ros import qos
from arboleda_ros.exclusive_topics import UNNAMED, full_name
from arboleda_ros.speaker import Speaker

LOG = logging.getLogger("arboleda.ros.speakers")
Handle = Callable[[Any], None]
Known = tuple[int, int, frozenset[tuple[int, ...]]]  # how many ever came, how many are there, and who
NOBODY: Known = (0, 0, frozenset())
STATES = frozenset(map(int, MotionState)) - {int(MotionState.NO_LINK)}  # of a robot that is linked
_FRESH_S = 0.2  # within this time publishers are not looked up again for each message


class Speakers:
    """Publishers of one robot's topics. While nobody is believed, the robot counts as without link.

    That ends without a message of the robot: one that is idle may have nothing to say.
    """

    def __init__(
        self, node: Node, robot: str, clock: Callable[[], float], on_event: Callable[[Event], None]
    ) -> None:
        self._node = node
        self._robot = robot
        self._clock = clock
        self._on_event = on_event
        self._speaker = Speaker(robot)
        self._matches: dict[str, Callable[[], Any]] = {}  # by topic
        self._looked: dict[str, float] = {}  # by topic, where several publish
        self._known: dict[str, Known] = {}  # by topic
        self._said: set[MotionState] = set()  # while nobody is believed
        self._held: list[tuple[Handle, Any]] = []  # messages of that time, until the plant is told
        self._is_doubted = False  # since the plant was told, until it is told that reports count again
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._timer = node.create_timer(_FRESH_S, self._follow, clock=steady)
        self._timer.cancel()  # it runs while nobody is believed

    def guarded(self, topic: str, handle: Handle) -> Handle:
        """A handler that calls `handle`, which raises nothing, only for messages that count."""

        def believe(message: Any) -> None:
            self._look_for_news(topic)
            if not self._speaker.believed(self._clock()) or not qos.TELLS_MATCHES:
                self._look_again(topic)
                if not self._speaker.believed(self._clock()):
                    self._overhear(handle, message)
                    return
            self._believe()
            handle(message)

        return believe

    def watch(self, topic: str, matches: Callable[[], Any]) -> None:
        """Count the publishers of a topic by `matches` before each message: the event that one has come, or
        gone, may be behind that message in the executor's queue.
        """
        self._matches[topic] = matches

    def _look_for_news(self, topic: str) -> None:
        if (matches := self._matches.get(topic)) is not None:
            counts = matches()
            came, matched, _ = self._known.get(topic, NOBODY)
            if (counts.total_count, counts.current_count) != (came, matched):
                self.matched(topic, counts)

    def matched(self, topic: str, event: Any) -> None:
        """Note that a publisher came or went; one that has gone may have left messages in the queue."""
        came, matched, before = self._known.get(topic, NOBODY)
        there = self._look(topic, event.current_count)
        self._known[topic] = (event.total_count, event.current_count, there)
        stayed = max(len(there - before), event.current_count - matched)
        if event.total_count - came > stayed:
            told = self._speaker.came_and_went(self._clock(), self._absolute(topic))
            self._tell(told if not self._is_doubted else None)

    def _follow(self) -> None:
        """Look if nobody is contested any more, whether or not a message comes."""
        for topic in tuple(self._looked):
            self._look_again(topic)
        if self._speaker.believed(self._clock()):
            self._timer.cancel()
            self._believe()

    def _overhear(self, handle: Handle, message: Any) -> None:
        """Note a state that may be the robot's word. One that has no `status` may not say it again."""
        if not self._is_doubted:
            self._held.append((handle, message))
        if isinstance(message, UInt8) and message.data in STATES:
            self._said.add(MotionState(message.data))

    def _believe(self) -> None:
        """Tell the plant once that what the robot reports counts again, and what was said meanwhile.

        Where the plant was told of no contest, only nodes of one name have published: what they said counts.
        """
        if not (self._is_doubted or self._held):
            return
        said, held = tuple(sorted(self._said)), self._held
        self._said, self._held = set(), []
        if self._is_doubted:
            self._is_doubted = False
            self._on_event(Uncontested(at=self._clock(), robot=self._robot, said=said))
        for handle, message in held:
            handle(message)

    def _look_again(self, topic: str) -> None:
        if self._clock() >= self._looked.get(topic, 0.0) + _FRESH_S:
            self._look(topic, self._known.get(topic, NOBODY)[1])

    def _look(self, topic: str, matched: int) -> frozenset[tuple[int, ...]]:
        """The ids of the present publishers of a topic, as the middleware numbers them.

        A publisher may be among those `matched`, whose messages are heard, before the graph shows it.
        """
        now = self._looked[topic] = self._clock()
        found = self._node.get_publishers_info_by_topic(topic)
        names = [full_name(info) for info in found]
        nodes = [None if name == UNNAMED else name for name in names]
        nodes += [None] * (matched - len(nodes))
        self._tell(self._speaker.publishers(now, self._absolute(topic), nodes))
        self._keep_looking()
        return frozenset(tuple(info.endpoint_gid) for info in found)

    def _tell(self, sentence: Sentence | None) -> None:
        if sentence is None:
            return
        now, self._is_doubted = self._clock(), True
        self._held.clear()
        self._keep_looking()
        LOG.warning("%s", sentence)
        self._on_event(Report(at=now, robot=self._robot, state=MotionState.NO_LINK, lost=sentence))
        self._on_event(Interference(at=now, robot=self._robot, sentence=sentence))

    def _keep_looking(self) -> None:
        if self._timer.is_canceled() and not self._speaker.believed(self._clock()):
            self._timer.reset()

    def _absolute(self, topic: str) -> str:
        return self._node.resolve_topic_name(topic)
