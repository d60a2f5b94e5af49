"""Dashboard of a virtual Dobot: a line is told, and a line is answered."""

from __future__ import annotations

import math
import re
from collections.abc import Collection

from arboleda_drivers.dobot.frames import Mode
from arboleda_drivers.virtual.joint_path import Joints

from .arm import Arm, QueuedMove

LINE = re.compile(r"\s*(\w+)\s*\((.*)\)\s*", re.DOTALL)
JOINTS = re.compile(r"joint=\{([^}]*)\}(.*)")
UNKNOWN, WRONG_COUNT, WRONG_TYPE, OUT_OF_RANGE = -10000, -20000, -30001, -40001
OTHER_MODE = "Control Mode Is Not Tcp"
BUTTON_LINE = "emergency" + "stop"  # the maker's name of the robot's own button, which nothing of ours has
QUERIES = ("robotmode", "getangle", "geterrorid", "getcurrentcommandid", "gettooldo")


class ErrorReply(Exception):
    """Error: the controller replies with an ErrorID other than 0."""

    def __init__(self, error: int) -> None:
        super().__init__(error)
        self.error = error


class Dashboard:
    """Answers lines, and does to the arm what they say."""

    def __init__(self, arm: Arm, faults: Collection[str]) -> None:
        self._arm, self._faults = arm, faults

    def reply(self, now: float, line: str) -> tuple[str, bool]:
        """The reply to a line, and True if the connections end with it."""
        found = LINE.fullmatch(line)
        if found is None:
            return f"{UNKNOWN},{{}},{line.strip()[:40]};", False
        name = found[1].lower()
        if "not_tcp" in self._faults and name not in QUERIES:
            return OTHER_MODE, False
        try:
            does = getattr(self, f"_do_{'button' if name == BUTTON_LINE else name}", None)
            if does is None:
                raise ErrorReply(UNKNOWN)
            value = does(now, found[2])
            error = 0
        except ErrorReply as refused:
            value, error = "", refused.error
        if name == "geterrorid" and "no_brace" in self._faults:
            return f"{error},{{{value},GetErrorId();", False
        hangs_up = name == "movj" and error == 0 and "hang_up" in self._faults
        return f"{error},{{{value}}},{found[1]}({found[2]});", hangs_up

    def _do_requestcontrol(self, now: float, values: str) -> str:
        if self._arm.mode not in (Mode.POWER_OFF, Mode.DISABLED):
            raise ErrorReply(-1)
        return ""

    def _do_poweron(self, now: float, values: str) -> str:
        self._arm.power(now)
        return ""

    def _do_enablerobot(self, now: float, values: str) -> str:
        self._check(power=True)
        self._arm.enable(now)
        return ""

    def _do_disablerobot(self, now: float, values: str) -> str:
        self._arm.halt(now, disable=True)
        return ""

    def _do_clearerror(self, now: float, values: str) -> str:
        self._arm.alarms.clear()
        self._arm.has_collided = False
        self._arm.befall(now)
        return ""

    def _do_button(self, now: float, values: str) -> str:
        if values.strip() == "1":
            self._arm.press_button(now)
        return ""

    def _do_stop(self, now: float, values: str) -> str:
        if "deaf" not in self._faults:
            self._arm.halt(now)
        return ""

    def _do_pause(self, now: float, values: str) -> str:
        arm = self._arm
        if arm.drive.path is None:
            raise ErrorReply(-1)
        if not arm.is_paused:
            self._resumes = QueuedMove(number=arm.command, goal=arm.drive.path.goal)
            arm.drive.brake(now)
            arm.is_paused = True
        return ""

    def _do_continue(self, now: float, values: str) -> str:
        if not self._arm.is_paused:
            raise ErrorReply(-1)
        self._arm.queue.appendleft(self._resumes)
        self._arm.is_paused = False
        return ""

    def _do_speedfactor(self, now: float, values: str) -> str:
        (ratio,) = _numbers(values, 1)
        if not 1 <= ratio <= 100:
            raise ErrorReply(OUT_OF_RANGE)
        self._arm.speed_percent = ratio
        return ""

    def _do_robotmode(self, now: float, values: str) -> str:
        return str(int(self._arm.mode))

    def _do_getangle(self, now: float, values: str) -> str:
        return ",".join(f"{each:.6f}" for each in self._arm.drive.joints)

    def _do_geterrorid(self, now: float, values: str) -> str:
        alarms = ",".join(str(each) for each in sorted(self._arm.alarms))
        return f"[[{alarms}],[],[],[],[],[],[]]"

    def _do_getcurrentcommandid(self, now: float, values: str) -> str:
        return str(self._arm.command)

    def _do_movj(self, now: float, values: str) -> str:
        self._check(power=True, moves=True)
        found = JOINTS.fullmatch(values.strip())
        if found is None:  # poses need the arm's kinematics, which are not played here
            raise ErrorReply(WRONG_TYPE)
        goal = _numbers(found[1], 6)
        options = dict(re.findall(r"(\w+)=([\d.]+)", found[2]))
        before = self._arm.last_number
        queued = QueuedMove(
            number=self._arm.next_number(),
            goal=goal,
            speed_percent=float(options.get("v", 100)),
            acceleration_percent=float(options.get("a", 100)),
        )
        self._arm.queue.append(queued)
        return str(before if "wrong_number" in self._faults else queued.number)

    def _do_tooldoinstant(self, now: float, values: str) -> str:
        self._check(power=True)
        index, on = _numbers(values, 2)
        bit = self._bit(index)
        if "stuck_output" not in self._faults:
            self._arm.outputs = self._arm.outputs | bit if on else self._arm.outputs & ~bit
        return ""

    def _do_gettooldo(self, now: float, values: str) -> str:
        self._check(power=True)
        if "script" in self._faults:
            raise ErrorReply(-5)
        (index,) = _numbers(values, 1)
        return "1" if self._arm.outputs & self._bit(index) else "0"

    def _bit(self, index: float) -> int:
        if index not in (1, 2, 3, 4):
            raise ErrorReply(OUT_OF_RANGE)
        return 1 << (int(index) - 1)

    def _check(self, *, power: bool = False, moves: bool = False) -> None:
        """Raises ErrorReply if a command is impossible in this state."""
        if "stop_button" in self._faults:
            raise ErrorReply(-3)
        if self._arm.alarms or self._arm.has_collided:
            raise ErrorReply(-2)
        if power and not self._arm.is_powered:
            raise ErrorReply(-4)
        if moves and "script" in self._faults:
            raise ErrorReply(-5)
        if moves and ("refuse" in self._faults or not self._arm.is_enabled or self._arm.is_paused):
            raise ErrorReply(-1)


def lines(text: str) -> list[str]:
    """The commands in a text of several."""
    found = re.findall(r"[^()]*\([^()]*\)", text)
    return found or [text]


def _numbers(text: str, count: int) -> Joints:
    parts = text.split(",")
    if len(parts) != count:
        raise ErrorReply(WRONG_COUNT)
    try:
        numbers = tuple(float(part) for part in parts)
    except ValueError as error:
        raise ErrorReply(WRONG_TYPE) from error
    if not all(map(math.isfinite, numbers)):
        raise ErrorReply(WRONG_TYPE)
    return numbers
