"""Topics of a record for ROS 2 tools: positions and states of robots, tasks and diagnostics.

Each topic says what is new; a file begins with all that was said last.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

from arboleda.drivers import Report, Robot
from arboleda.model.messages import TaskChanged
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import in_json
from arboleda.recorder.steps import Step
from arboleda.recorder.view_log import ViewSnapshot
from arboleda.views import view
from arboleda.views.diagnostics import diagnostics
from arboleda_ros import cdr, record_types

Message = tuple[str, int, bytes]  # topic, ns of Unix time, content
TASK_STATUS, DIAGNOSTICS = "/task_status", "/diagnostics"
DIAGNOSED_NS = 1_000_000_000  # between two looks at the diagnostics


class RosLog:
    """Source of messages for ROS 2 tools, made of steps and snapshots, on its `channels`."""

    def __init__(self, model: PlantModel) -> None:
        self._robots = {robot.name: _Topics(robot) for robot in model.robots.values()}
        self._statuses: dict[str, cdr.Status] = {}
        self._snapshot: dict[str, Any] | None = None  # nobody has looked at its diagnostics yet
        self._ns = self._diagnosed_ns = 0
        self.channels = (
            *(channel for robot in self._robots.values() for channel in robot.channels),
            record_types.channel(TASK_STATUS, record_types.STRING, depth=100, is_kept=True),
            record_types.channel(DIAGNOSTICS, record_types.DIAGNOSTICS),
        )

    def stepped(self, step: Step) -> Iterator[Message | None]:
        """The messages that a step makes: reports of robots, changes of tasks, and diagnostics when due."""
        self._ns = step.unix_ns
        for event in step.events:
            if isinstance(event, Report) and event.robot in self._robots:
                yield from self._robots[event.robot].news_of(event, step.unix_ns)
        for message in step.messages:
            if isinstance(message, TaskChanged):
                text = json.dumps(view.change(message), ensure_ascii=False, default=in_json)
                yield TASK_STATUS, step.unix_ns, cdr.string(text)
        if self._snapshot is not None and not 0 <= step.unix_ns - self._diagnosed_ns < DIAGNOSED_NS:
            snapshot, self._snapshot = self._snapshot, None
            self._diagnosed_ns = step.unix_ns
            yield from self._diagnosed(snapshot)

    def saw(self, snapshot: ViewSnapshot) -> Iterator[Message | None]:
        """Keep a snapshot, from which diagnostics are made later."""
        self._snapshot = snapshot.snapshot
        yield None

    def whole(self) -> Iterator[Message | None]:
        for robot in self._robots.values():
            yield from robot.again(self._ns)
        if self._statuses:
            yield DIAGNOSTICS, self._ns, cdr.diagnostics(self._ns, [*self._statuses.values()])

    def _diagnosed(self, snapshot: dict[str, Any]) -> Iterator[Message | None]:
        news = []
        for status in diagnostics(snapshot):
            if self._statuses.get(status[0]) != status:
                self._statuses[status[0]] = status
                news.append(status)
            yield None
        if news:
            yield DIAGNOSTICS, self._ns, cdr.diagnostics(self._ns, news)


class _Topics:
    """Topics of one robot, with its last messages."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._state, self._joints = f"/{robot.name}/motion_state", f"/{robot.joint_states.topic}"
        stands = robot.position_key is not None
        self._message = cdr.JointStates(robot.joint_states.joints) if stands else None
        self._position: tuple[float, ...] | None = None
        self._last_state: int | None = None
        self.channels = [record_types.channel(self._state, record_types.UINT8)]
        if stands:
            self.channels.append(record_types.channel(self._joints, record_types.JOINT_STATE))

    def news_of(self, report: Report, unix_ns: int) -> Iterator[Message]:
        """The messages for the news in a report; none for a report that the plant rejects, too."""
        if self._robot.objection(report) is not None:
            return
        if report.state is not None and report.state != self._last_state:
            self._last_state = int(report.state)
            yield self._state, unix_ns, cdr.uint8(self._last_state)
        if self._message is None:
            return
        position = self._robot.joint_states.values(report)
        if position is not None and position != self._position:
            self._position = position
            yield self._joints, unix_ns, self._message.of(unix_ns, position)

    def again(self, unix_ns: int) -> Iterator[Message]:
        """The last messages once more, for the beginning of a file."""
        if self._last_state is not None:
            yield self._state, unix_ns, cdr.uint8(self._last_state)
        if self._message is not None and self._position is not None:
            yield self._joints, unix_ns, self._message.of(unix_ns, self._position)
