"""Reports of a robot that has no `status`, from its topics that carry one thing each."""

from __future__ import annotations

import math

from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, UInt8

from arboleda.drivers import Mobile, MotionState, Report, Robot
from arboleda.extension import PayloadError
from arboleda.model.counting import counted

_AT_NODE = 0.125  # share of the pitch: a mobile farther from every node is between nodes


class PlainReports:
    """Reports of one robot, each from a message received `at`; PayloadError for one that means nothing.

    A report is made once for each state and said again with every message: to make one takes several times
    as long, and the next command may wait for it. The thread of the link reads all messages of a robot.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._names = robot.joint_states.joints
        self._last = self._nothing = Report(at=0.0, robot=robot.name)
        self._states = {int(state): self._nothing.again(0.0, state=state) for state in MotionState}
        for report in self._states.values():
            _ = report.words  # taken apart here, and not anew for each that repeats it

    def state(self, at: float, message: UInt8) -> Report:
        """The report that a `motion_state` makes."""
        known = self._states.get(message.data)
        if known is None:
            allowed = ", ".join(map(str, self._states))
            raise PayloadError(f"the value {message.data} means nothing; allowed: {allowed}")
        return known.again(at)

    def joints(self, at: float, message: JointState) -> Report:
        """The report that a `joint_states` makes; a mobile between two nodes reports no node."""
        measured = _positions(self._names, message)
        if isinstance(self._robot, Mobile):
            return self._nothing.again(at, node=_nearest(self._robot, *measured))
        repeats = measured == self._last.q
        self._last = self._last.again(at) if repeats else self._nothing.again(at, q=measured)
        return self._last

    def piece(self, at: float, message: Bool) -> Report:
        """The report that a `piece_detected` makes."""
        return self._nothing.again(at, piece=message.data)


def _positions(names: tuple[str, ...], message: JointState) -> tuple[float, ...]:
    """The positions of `names`, wherever they stand in the message."""
    if len(message.name) != len(message.position):
        named, positions = (
            counted(len(message.name), "joint name"),
            counted(len(message.position), "position"),
        )
        raise PayloadError(f"{named} but {positions}")
    found = dict(zip(message.name, message.position, strict=True))
    missing = [name for name in names if name not in found]
    if missing:
        raise PayloadError(f"joint {', '.join(missing)} is missing; needed are {', '.join(names)}")
    measured = tuple(found[name] for name in names)
    if not all(map(math.isfinite, measured)):
        raise PayloadError(f"a position of {', '.join(names)} is not a finite number")
    return measured


def _nearest(mobile: Mobile, x: float, y: float) -> int | None:
    grid = mobile.grid
    distances = [math.dist((x, y), grid.position(node)) for node in range(grid.size)]
    node = min(range(grid.size), key=distances.__getitem__)
    return node if distances[node] <= _AT_NODE * grid.pitch else None
