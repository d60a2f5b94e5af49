"""Publisher of one robot's reports on its topics.

Publishing copies a message, and to make one takes longer than to fill it: so each is made once, and changed
from report to report by the one thread that publishes.
"""

from __future__ import annotations

from collections.abc import Callable

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.clock import Clock
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, UInt8

from arboleda.drivers import Arm, MotionState, Report, Robot
from arboleda.wire.status import NUMBER, to_status, written_number

Speak = Callable[..., Publisher]  # (type, topic), `alone` where nobody else may publish there
_STATES = {state: UInt8(data=int(state)) for state in MotionState}
_PIECES = {piece: Bool(data=piece) for piece in (False, True)}


class RobotPublisher:
    """The publishers of one robot; only arms have a piece sensor, and devices no joints."""

    def __init__(self, robot: Robot, speak: Speak, clock: Clock) -> None:
        self._words, self._clock = StatusMessage(robot), clock
        self._position = JointsMessage(robot) if robot.position_key is not None else None
        self.status = speak(DiagnosticStatus, f"{robot.name}/status", alone=True)
        self.state = speak(UInt8, f"{robot.name}/motion_state")
        stands = robot.position_key is not None
        self.joints = speak(JointState, robot.joint_states.topic) if stands else None
        self.piece = speak(Bool, f"{robot.name}/piece_detected") if isinstance(robot, Arm) else None

    def say(self, report: Report) -> None:
        """Publish one report on every topic that carries a part of it."""
        self.status.publish(self._words.of(report))
        if report.state is not None:
            self.state.publish(_STATES[report.state])
        position = self._position.of(report, self._clock) if self._position is not None else None
        if self.joints is not None and position is not None:
            self.joints.publish(position)
        if self.piece is not None and report.piece is not None:
            self.piece.publish(_PIECES[report.piece])


class StatusMessage:
    """Message `status` of a robot, which is used again and again."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._message = DiagnosticStatus()
        self._pairs: dict[str, KeyValue] = {}
        self._words: tuple[object, ...] = ()

    def of(self, report: Report) -> DiagnosticStatus:
        """The message for one report; the next call changes it."""
        if report.words != self._words or (report.number is None) == (NUMBER in self._pairs):
            self._write(report)
            self._words = report.words
        elif report.number is not None:
            self._pairs[NUMBER].value = written_number(report.number)
        return self._message

    def _write(self, report: Report) -> None:
        plain, message = to_status(self._robot, report), self._message
        message.name, message.hardware_id, message.message = plain.name, plain.hardware_id, plain.message
        message.level = bytes([plain.level])
        if plain.values.keys() != self._pairs.keys():
            self._pairs = {key: KeyValue(key=key) for key in plain.values}
            message.values = list(self._pairs.values())
        for key, value in plain.values.items():
            self._pairs[key].value = value


class JointsMessage:
    """Message `joint_states` of a robot, with measured values only."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._message = JointState(name=list(robot.joint_states.joints))

    def of(self, report: Report, clock: Clock) -> JointState | None:
        """The message for a report, None if nothing was measured; the next call changes it."""
        measured = self._robot.joint_states.values(report)
        if measured is None:
            return None
        self._message.position = measured
        stamp = self._message.header.stamp
        stamp.sec, stamp.nanosec = clock.now().seconds_nanoseconds()
        return self._message
