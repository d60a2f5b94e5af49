"""Commands of a plant on topics, and those of others to robots that hear everybody."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import Float32MultiArray

from arboleda.adapters.rate_limit import RateLimit
from arboleda.drivers import Command, Robot, Stop
from arboleda.extension import ArboledaError
from arboleda.model.messages import Event, Interference
from arboleda.model.plant_model import Link
from arboleda.wire import rejections
from arboleda.wire.hop import PLAIN, kind_of
from arboleda_ros import convert, qos
from arboleda_ros.node_topics import NodeTopics
from arboleda_ros.overhear import OwnTopic
from arboleda_ros.senders import Senders


class NoBridge(ArboledaError):
    """Error: a command was not published, and will not be sent later."""


class CommandTopics:
    """Topics of the commands to `robots`; `labelled` are those that bridges listen to, by robot, and
    `plain` those of plain goals, by robot and class of command.

    `on_event` is told of commands that somebody else gives to a robot which hears everybody.
    """

    def __init__(
        self,
        node: Node,
        topics: NodeTopics,
        robots: Sequence[Robot],
        on_event: Callable[[Event], None],
        clock: Callable[[], float],
    ) -> None:
        self._robots = {robot.name: robot for robot in robots}
        self._log = topics.log
        self._on_event = on_event
        self._clock = clock
        speak = partial(topics.speak, profile=qos.COMMAND, alone=True)
        self.labelled = {
            robot.name: speak(*convert.ordered(robot)) for robot in robots if robot.link is Link.MQTT
        }
        self.plain = {
            (robot.name, kind): self._plain(robot, kind, speak)
            for robot in robots
            for kind in convert.commands_of(robot)
        }
        # Publishing copies a message, and to make one takes longer than to fill it. A stop makes its own: it
        # may leave in another thread meanwhile.
        self._forms = {
            (robot.name, kind): Float32MultiArray()
            for robot in robots
            for kind in convert.commands_of(robot)
            if kind is not Stop
        }
        self._senders = Senders(node, clock)
        self._others = RateLimit()  # a stream of goals is one piece of news
        self._own = {
            (robot.name, kind): OwnTopic()
            for robot in robots
            if robot.link is Link.ROS
            for kind in convert.commands_of(robot)
        }
        for robot, kind in ((self._robots[name], kind) for name, kind in self._own):
            topic = f"{robot.name}/{PLAIN[kind]}"
            topics.listen(
                convert.message_type(kind), topic, partial(self._on_command, robot, kind), qos.BEST_EFFORT
            )

    def send(self, command: Command) -> None:
        """Publish a command: on `command` if our bridge listens, on the plain topic for everybody else.

        Raises NoBridge if a command for MQTT would reach nobody.
        """
        key = (command.robot, kind_of(command))
        plain, labelled = self.plain[key], self.labelled.get(command.robot)
        if labelled is None:
            self._speak_plainly(command, key)
            return
        bridges, listeners = labelled.get_subscription_count(), plain.get_subscription_count()
        if not bridges and not listeners:
            raise NoBridge(f"no bridge listens to {labelled.topic_name}")
        if not bridges:
            self._speak_plainly(command, key)
            return
        copied = listeners > bridges  # a bridge listens to both
        robot = self._robots[command.robot]
        labelled.publish(convert.labelled_message(robot, command, copied=copied, into=self._forms.get(key)))
        if copied:
            plain.publish(convert.command_message(command, copy=True))

    def _plain(self, robot: Robot, kind: type[Command], speak: Callable[..., Publisher]) -> Publisher:
        """The publisher of a plain topic; that of a device's orders serves for all its commands."""
        _, of_all = convert.ordered(robot)
        topic = f"{robot.name}/{PLAIN[kind]}"
        if topic == of_all and robot.name in self.labelled:
            return self.labelled[robot.name]
        return speak(convert.message_type(kind), topic)

    def _speak_plainly(self, command: Command, key: tuple[str, type[Command]]) -> None:
        message = convert.command_message(command, into=self._forms.get(key))
        own = self._own.get(key)
        if own is not None:
            own.say(message)
        self.plain[key].publish(message)

    def _on_command(self, robot: Robot, kind: type[Command], message: Any) -> None:
        """Take a command on a topic of a robot that hears everybody: the plant's own, or somebody else's."""
        if self._own[robot.name, kind].is_own(message):
            return
        command = convert.command(kind, robot, message)
        sentence = rejections.overheard(command, self._senders.of(f"{robot.name}/{PLAIN[kind]}"))
        if self._others.is_due(sentence, self._clock()):
            self._log.warning("%s", sentence)
        self._on_event(Interference(at=self._clock(), robot=robot.name, sentence=sentence))
