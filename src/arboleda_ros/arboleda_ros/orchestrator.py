"""ROS 2 side of the plant: commands and notices out, reports, tasks and operators' requests in."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float32MultiArray, String, UInt8, UInt32

from arboleda.adapters.rate_limit import RateLimit
from arboleda.kinds.arm import Arm
from arboleda.kinds.declared import Device
from arboleda.model.commands import Command, Stop
from arboleda.model.errors import ArboledaError, PayloadError
from arboleda.model.messages import (
    Event,
    Heartbeat,
    Interference,
    Notice,
    OperatorAnswer,
    Report,
    SystemStart,
    TaskChanged,
    TaskRequest,
)
from arboleda.model.plant_model import Evidence, Link, PlantModel, Robot
from arboleda.model.sentence import in_json
from arboleda.runtime import view_text
from arboleda.views import view
from arboleda.wire import rejections
from arboleda.wire.hop import HEARTBEAT, PLAIN, kind_of
from arboleda_ros import convert, qos, statuses
from arboleda_ros.diagnostics import Diagnostic, Diagnostics
from arboleda_ros.overhear import OwnTopic
from arboleda_ros.plain_reports import PlainReports
from arboleda_ros.plant_queries import Asker
from arboleda_ros.port import NAMED, Port
from arboleda_ros.senders import Senders
from arboleda_ros.speakers import Speakers
from arboleda_ros.verbs import VerbServices

if TYPE_CHECKING:  # they are there only where the types of their messages are built
    from arboleda_ros.snapshot_streams import SnapshotStreams
    from arboleda_ros.typed.offer import Offer

LOG = logging.getLogger("arboleda.ros")
UNHEARD = qos.TASK_STATUS.depth // 2
CATCH_UP = Duration(seconds=0.02)  # a listener that is slower loses the oldest messages
TYPES = "arboleda_interfaces"
STREAM_TYPES = "py_trees_ros_interfaces"


class NoBridge(ArboledaError):
    """Error: a command was not published, and will not be sent later."""


class OrchestratorPort(Port):
    """Node `orchestrator`; `on_event` gets every core event, on the link's thread."""

    def __init__(
        self, node: Node, model: PlantModel, on_event: Callable[[Event], None], clock: Callable[[], float]
    ) -> None:
        super().__init__(node, clock)
        robots = [robot for robot in model.robots.values() if robot.link is not Link.DRIVER]
        self._robots = {robot.name: robot for robot in robots}
        self._on_event = on_event
        speak = partial(self._speak, profile=qos.COMMAND, alone=True)
        self._labelled = {
            robot.name: speak(*convert.ordered(robot)) for robot in robots if robot.link is Link.MQTT
        }
        self._commands = {
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
        self._heartbeat = speak(UInt32, HEARTBEAT)
        self._start = self._speak(UInt8, "system/start", qos.COMMAND)
        self._unheard = 0
        self._task_status = self._speak(String, "task_status", qos.TASK_STATUS)
        self._view = self._speak(String, "plant/view", qos.VIEW)
        self._listen(String, "task_request", self._on_request, qos.TASK_REQUEST)
        self._all = Diagnostics()
        self._asker = Asker(on_event, clock)
        self._verbs = VerbServices(node, self._asker)
        self._offer = self._offered([cell.name for cell in model.cells])
        self._streams = self._streamed([cell.name for cell in model.cells])
        for robot in robots:
            self._hear(robot)

    def send(self, message: Command | Notice) -> None:
        """Publish one output of the plant; raises NoBridge if a command for MQTT would reach nobody."""
        if isinstance(message, Heartbeat):
            self._heartbeat.publish(UInt32(data=message.epoch))
        elif isinstance(message, SystemStart):
            self._start.publish(UInt8(data=1))
        elif isinstance(message, TaskChanged):
            self._task_changed(message)
        elif isinstance(message, OperatorAnswer):
            self._asker.answered(message)
        elif isinstance(message, Command):
            self._command(message)

    @property
    def watched(self) -> bool:
        """True if another node listens to messages that are also published without a change."""
        is_streamed = self._streams is not None and self._streams.watched
        return self.diagnosed or is_streamed or self._view.get_subscription_count() > 0

    @property
    def diagnosed(self) -> bool:
        """True if another node listens to `/diagnostics`."""
        return self._diagnostics.get_subscription_count() > 0

    def publish_view(self, snapshot: Mapping[str, Any]) -> Iterator[None]:
        """Publish the snapshot, plain data that JSON can carry, in parts that take a moment each."""
        text = yield from view_text.in_parts(snapshot)
        self._view.publish(String(data=text))
        if self._offer is not None:
            yield
            self._offer.show(snapshot)
        if self._streams is not None:
            yield
            self._streams.show(snapshot)

    def publish_diagnostics(self, plain: Iterable[Diagnostic]) -> Iterator[None]:
        """Publish one status per robot and cell, in parts; the port's own status goes out by itself."""
        named = ((self._diagnosed(each[0].removeprefix(NAMED)), *each[1:]) for each in plain)
        data = yield from self._all.of(named, self._node.get_clock().now().to_msg())
        self._diagnostics.publish(data)

    def close(self) -> None:
        if self._offer is not None:
            self._offer.close()

    def destroy(self) -> None:
        super().destroy()
        if self._offer is not None:
            self._offer.destroy()

    def _offered(self, cells: Iterable[str]) -> Offer | None:
        """The services and topics in our own types; None, with a line in the log, if those are not built."""
        try:
            from arboleda_ros.typed.offer import Offer
        except ModuleNotFoundError as error:
            if (error.name or "").partition(".")[0] != TYPES:
                raise
            LOG.info(
                "%s is not built here: no action plant/execute_task, no typed services and topics", TYPES
            )
            return None
        return Offer(self._node, self._speak, cells, self._asker)

    def _streamed(self, cells: Iterable[str]) -> SnapshotStreams | None:
        """The streams of py_trees_ros; None, with a line in the log, if its types are not installed."""
        try:
            from arboleda_ros.snapshot_streams import SnapshotStreams
        except ModuleNotFoundError as error:
            if (error.name or "").partition(".")[0] != STREAM_TYPES:
                raise
            LOG.info("%s is not installed here: no trees for py-trees-tree-watcher", STREAM_TYPES)
            return None
        return SnapshotStreams(self._node, cells, self._clock)

    def _task_changed(self, change: TaskChanged) -> None:
        self._keep_room()
        text = json.dumps(view.change(change), ensure_ascii=False, default=in_json)
        self._task_status.publish(String(data=text))
        self._asker.answered(change)
        if self._offer is not None:
            self._offer.changed(change)

    def _keep_room(self) -> None:
        """Wait for slow listeners before a burst of changes overwrites those that they have not read."""
        self._unheard += 1
        if self._unheard > UNHEARD:
            self._task_status.wait_for_all_acked(CATCH_UP)
            self._unheard = 0

    def _command(self, command: Command) -> None:
        """Publish a command: on `command` if our bridge listens, on the plain topic for everybody else."""
        key = (command.robot, kind_of(command))
        plain, labelled = self._commands[key], self._labelled.get(command.robot)
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
        if topic == of_all and robot.name in self._labelled:
            return self._labelled[robot.name]
        return speak(convert.message_type(kind), topic)

    def _speak_plainly(self, command: Command, key: tuple[str, type[Command]]) -> None:
        message = convert.command_message(command, into=self._forms.get(key))
        own = self._own.get(key)
        if own is not None:
            own.say(message)
        self._commands[key].publish(message)

    def _hear(self, robot: Robot) -> None:
        """Subscribe to the topics that a robot's link and evidence provide, and to others' commands to it."""
        for kind in convert.commands_of(robot) if robot.link is Link.ROS else ():
            overhear = partial(self._on_command, robot, kind)
            self._listen(convert.message_type(kind), f"{robot.name}/{PLAIN[kind]}", overhear, qos.BEST_EFFORT)
        if isinstance(robot, Arm):
            self._listen(UInt8, f"{robot.name}/start", partial(self._on_trigger, robot), qos.COMMAND)
        speakers = Speakers(self._node, robot.name, self._clock, self._on_event)
        tells_facts = isinstance(robot, Device) and robot.evidence is not Evidence.STATE
        if robot.link is Link.MQTT or robot.evidence is Evidence.IDS or tells_facts:
            ear = statuses.StatusListener(robot, self._clock, self._on_event)
            topic = f"{robot.name}/status"
            if robot.link is Link.ROS:
                self._listen_as_offered(DiagnosticStatus, topic, ear, raw=True, speakers=speakers)
            else:
                self._listen(DiagnosticStatus, topic, ear, qos.COMMAND, raw=True, speakers=speakers)
            return
        reports = PlainReports(robot)
        on_state = self._reporting(reports.state)
        self._listen_as_offered(UInt8, f"{robot.name}/motion_state", on_state, speakers=speakers)
        if robot.evidence is Evidence.JOINTS:
            on_joints = self._reporting(reports.joints)
            self._listen(JointState, robot.joint_states.topic, on_joints, qos.SENSOR, speakers=speakers)
        if isinstance(robot, Arm):
            on_piece = self._reporting(reports.piece)
            self._listen(Bool, f"{robot.name}/piece_detected", on_piece, qos.SENSOR, speakers=speakers)

    def _reporting(self, read: Callable[[float, Any], Report]) -> Callable[[Any], None]:
        return lambda message: self._on_event(read(self._clock(), message))

    def _on_command(self, robot: Robot, kind: type[Command], message: Any) -> None:
        """Take a command on a topic of a robot that hears everybody: the plant's own, or somebody else's."""
        if self._own[robot.name, kind].is_own(message):
            return
        command = convert.command(kind, robot, message)
        sentence = rejections.overheard(command, self._senders.of(f"{robot.name}/{PLAIN[kind]}"))
        if self._others.is_due(sentence, self._clock()):
            self._log.warning("%s", sentence)
        self._on_event(Interference(at=self._clock(), robot=robot.name, sentence=sentence))

    def _on_request(self, message: String) -> None:
        self._on_event(TaskRequest(at=self._clock(), text=message.data))

    def _on_trigger(self, arm: Arm, message: UInt8) -> None:
        if message.data > 1:
            raise PayloadError(f"the value {message.data} means nothing; allowed: 1 to start, 0")
        if message.data:
            self._on_event(TaskRequest(at=self._clock(), text=f"{arm.name} palletizing", trigger=True))
