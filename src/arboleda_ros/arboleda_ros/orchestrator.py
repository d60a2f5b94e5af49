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
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, String, UInt8, UInt32

from arboleda.drivers import Arm, Command, Device, Evidence, Report, Robot
from arboleda.extension import PayloadError
from arboleda.model.messages import (
    Event,
    Heartbeat,
    Notice,
    OperatorAnswer,
    SystemStart,
    TaskChanged,
    TaskRequest,
)
from arboleda.model.plant_model import Link, PlantModel
from arboleda.model.sentence import in_json
from arboleda.views import view
from arboleda.wire.hop import HEARTBEAT
from arboleda_ros import qos, statuses, view_text
from arboleda_ros.command_topics import CommandTopics
from arboleda_ros.diagnostics import Diagnostic, Diagnostics
from arboleda_ros.plain_reports import PlainReports
from arboleda_ros.plant_queries import Asker
from arboleda_ros.port import NAMED, Port
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


class OrchestratorPort(Port):
    """Node `orchestrator`; `on_event` gets every core event, on the link's thread."""

    def __init__(
        self, node: Node, model: PlantModel, on_event: Callable[[Event], None], clock: Callable[[], float]
    ) -> None:
        super().__init__(node, clock)
        robots = [robot for robot in model.robots.values() if robot.link is not Link.DRIVER]
        self._on_event = on_event
        self.commands = CommandTopics(node, self.topics, robots, on_event, clock)
        self._heartbeat = self.topics.speak(UInt32, HEARTBEAT, qos.COMMAND, alone=True)
        self._start = self.topics.speak(UInt8, "system/start", qos.COMMAND)
        self._unheard = 0
        self._task_status = self.topics.speak(String, "task_status", qos.TASK_STATUS)
        self._view = self.topics.speak(String, "plant/view", qos.VIEW)
        self.topics.listen(String, "task_request", self._on_request, qos.TASK_REQUEST)
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
            self.commands.send(message)

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
        return Offer(self._node, self.topics.speak, cells, self._asker)

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

    def _hear(self, robot: Robot) -> None:
        """Subscribe to the topics that a robot's link and evidence provide."""
        if isinstance(robot, Arm):
            self.topics.listen(UInt8, f"{robot.name}/start", partial(self._on_trigger, robot), qos.COMMAND)
        speakers = Speakers(self._node, robot.name, self._clock, self._on_event)
        tells_facts = isinstance(robot, Device) and robot.evidence is not Evidence.STATE
        if robot.link is Link.MQTT or robot.evidence is Evidence.IDS or tells_facts:
            ear = statuses.StatusListener(robot, self._clock, self._on_event)
            topic = f"{robot.name}/status"
            if robot.link is Link.ROS:
                self.topics.listen_as_offered(DiagnosticStatus, topic, ear, raw=True, speakers=speakers)
            else:
                self.topics.listen(DiagnosticStatus, topic, ear, qos.COMMAND, raw=True, speakers=speakers)
            return
        reports = PlainReports(robot)
        on_state = self._reporting(reports.state)
        self.topics.listen_as_offered(UInt8, f"{robot.name}/motion_state", on_state, speakers=speakers)
        if robot.evidence is Evidence.JOINTS:
            on_joints = self._reporting(reports.joints)
            self.topics.listen(JointState, robot.joint_states.topic, on_joints, qos.SENSOR, speakers=speakers)
        if isinstance(robot, Arm):
            on_piece = self._reporting(reports.piece)
            self.topics.listen(Bool, f"{robot.name}/piece_detected", on_piece, qos.SENSOR, speakers=speakers)

    def _reporting(self, read: Callable[[float, Any], Report]) -> Callable[[Any], None]:
        return lambda message: self._on_event(read(self._clock(), message))

    def _on_request(self, message: String) -> None:
        self._on_event(TaskRequest(at=self._clock(), text=message.data))

    def _on_trigger(self, arm: Arm, message: UInt8) -> None:
        if message.data > 1:
            raise PayloadError(f"the value {message.data} means nothing; allowed: 1 to start, 0")
        if message.data:
            self._on_event(TaskRequest(at=self._clock(), text=f"{arm.name} palletizing", trigger=True))
