"""Boots of which the plant has heard, of boards that report no homing."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.drivers import Evidence, MotionState, Report, Robot

from .robot import RobotTruth

NEVER = (None, None)


class Boots:
    """Boots of robots that report only the number of their boots; at `joints` the bridge counts them.

    A boot shows without a number where a robot is back at its reference after its link was lost elsewhere.
    """

    def __init__(self, robots: Iterable[RobotTruth]) -> None:
        self.mute = {each.robot.name: each for each in robots if _boots_show(each.robot)}
        self._last: dict[str, tuple[int | None, int | None]] = {}
        self._places: dict[str, tuple[float, ...]] = {}  # as they were told last
        self._lost: set[str] = set()  # those whose place was not told since their link was lost
        self._reported: set[str] = set()
        self._known: set[str] = set()  # those told before any command of this step

    def look(self, reports: Iterable[Report], *, is_question: bool) -> None:
        """Take in what the plant heard in this step; what it was asked in it may have come before that."""
        before = self._reported.copy() if is_question else None
        for report in reports:
            if report.robot in self.mute and report.boot_id is not None:
                self._hear(report)
            if report.robot in self.mute and self.mute[report.robot].robot.assume_homed:
                self._follow(report)
        if self._reported:
            self._reported = {name for name in self._reported if not self.mute[name].homed}
        self._known = self._reported if before is None else self._reported & before

    def _hear(self, report: Report) -> None:
        boot, last = (report.epoch, report.boot_id), self._last.get(report.robot, NEVER)
        if boot != last:
            self._last[report.robot] = boot
            known = last is not NEVER and self.mute[report.robot].robot.evidence is Evidence.IDS
            put_right = report.at < self.mute[report.robot].put_right_at  # it booted before it was put right
            if not put_right and (boot[0] == last[0] or (known and boot[1] != last[1])):
                self._reported.add(report.robot)

    def _follow(self, report: Report) -> None:
        """Take in the joints of a robot that counts from its reference after a boot, wherever it is then."""
        name, robot = report.robot, self.mute[report.robot].robot
        if report.state is MotionState.NO_LINK:
            self._lost.add(name)
        if report.q is None or robot.reference is None or robot.evidence is not Evidence.JOINTS:
            return
        was_there = robot.motion.stands_at(robot.reference, self._places.get(name, robot.reference))
        is_there = robot.motion.stands_at(robot.reference, report.q)
        if name in self._lost and is_there and not was_there and not self.mute[name].homed:
            self._reported.add(name)
        self._places[name] = report.q
        self._lost.discard(name)

    def restart(self) -> None:
        """Begin anew with a plant that starts: what an earlier one heard of a bridge is nothing to it."""
        self._places.clear()
        self._lost.clear()
        for name, each in self.mute.items():
            if each.robot.evidence is Evidence.JOINTS:
                self._last.pop(name, None)

    def is_known(self, robot: str) -> bool:
        """True if the plant knows that the robot booted, and nobody has put it right since."""
        return robot in self._known


def _boots_show(robot: Robot) -> bool:
    return robot.evidence is not Evidence.STATE and not robot.says_homed
