"""State machine of the driver `serial_arm`: the bus, the arm's work and its stops, without a serial line.

One question is on the bus at a time. All that is written goes to several servos at once and is answered by
none of them: what a servo took is seen in the registers that are read next.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import cycle

from arboleda.drivers import HEALTH, WELL, Facts, Home, Jointed, MotionState, MoveJoints, Report, Robot
from arboleda_drivers.connections.controller import Controller
from arboleda_drivers.connections.controller_machine import ControllerMachine
from arboleda_drivers.connections.link import LinkBroken
from arboleda_drivers.connections.receipts import Look
from arboleda_drivers.connections.stream import Received, Write

from .bus import MARKS, Bus
from .gripper import Gripper
from .joint_goals import JointGoals
from .servos import MAKERS, TICKS, Reading
from .settings import GRIPPER, Settings
from .work import SETTLE_S, TAKE_S, Move, Picture, Readying, Rest

BOOT_S = 2.0  # a servo that boots is silent for a while


class Machine(ControllerMachine):
    """State machine of one arm of servos."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        """Raises ValueError unless the device is one robot of joints with a servo for each."""
        super().__init__(ServoController(devices, settings))


class ServoController(Controller):
    """Servos of one arm together: what they show, and the work that they do."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        if len(devices) != 1 or not isinstance(devices[0], Jointed):
            raise ValueError("an arm of servos is one robot of joints")
        for _, problem in settings.problems(devices[0]):
            raise ValueError(problem)
        super().__init__(devices[0], peer=settings.peer, kind="an arm of servos")
        self._settings, self._maker = settings, MAKERS[settings.protocol]
        self._joints = [servo.id for servo in settings.joints]
        self._near = dict(zip(self._joints, map(_ticks, self.robot.motion.tolerances), strict=True))
        names = [joint.name for joint in self.robot.joints]
        self._names = dict(zip((servo.id for servo in settings.servos), [*names, GRIPPER], strict=False))
        self._marks = cycle(range(MARKS))
        self._boot = 1
        self._marked: set[int] = set()

    def forget(self, now: float) -> None:
        self.bus = Bus(self.out, self._settings, self._names, now, self._marks)
        self.goals = JointGoals(self.robot, self._settings, self.bus)
        self.effector: Gripper = Gripper(self._settings, self.bus, self.receipts)
        self._picture: Picture | None = None
        self._judged_at = math.inf  # from then on it is known whether the arm stands
        self._is_judged = self._strays = False  # strays: nobody of this start told it to go where it goes
        self._rest = Rest()
        self._work: Move | Readying | None = None
        self._stopping_at: float | None = None
        self._hold: Mapping[int, int] = {}
        self._stop_id = ""

    @property
    def next_deadline(self) -> float:
        return self.bus.next_deadline

    @property
    def is_known(self) -> bool:
        return self._picture is not None and self._is_judged

    @property
    def takes_commands(self) -> bool:
        return self._picture is not None

    @property
    def is_busy(self) -> bool:
        return self._work is not None

    @property
    def may_move_on(self) -> bool:
        return isinstance(self._work, Move) or self._stopping_at is not None

    def hear(self, now: float, event: Received) -> None:
        self.bus.hear(now, event.data)

    def pass_time(self, now: float) -> None:
        for readings in self.bus.use(now):
            if readings:
                self._look(now, readings)
            boots = isinstance(self._work, Readying) and self._maker.reboots
            if why := self.bus.silence(now, BOOT_S if boots else 0.0):
                if isinstance(self._work, Move) and (held := self.goals.held(now, self._work.goals)):
                    self.out.append(Write(data=self._maker.goals(held)))
                raise LinkBroken(why)

    # Commands.

    def move(self, now: float, command: MoveJoints) -> None:
        assert self._picture is not None
        servos = self._settings.joints
        goals = {servo.id: servo.ticks(q) for servo, q in zip(servos, command.q, strict=True)}
        ends = self._maker.positions
        beyond = next((servo.id for servo in servos if not servo.can_reach(goals[servo.id], ends)), None)
        refusal = self._picture.trouble if beyond is None else f"beyond_limits of {self._names[beyond]}"
        if refusal is not None:
            self.receipts.reject(command.id, refusal)
            return
        self._work = Move(id=command.id, goals=goals, near=self._near, began_at=now)
        self._stopping_at, self._strays = None, False
        self.goals.move(now, goals, self._picture)

    def home(self, now: float, command: Home) -> None:
        self._work = Readying(id=command.id, began_at=now)
        self.receipts.tell(accepted=command.id)

    def stop(self, now: float, id: str) -> None:
        self._stop_id = id
        self._halt(now)

    def _halt(self, now: float) -> None:
        """Have each joint hold where it is."""
        self._hold = self.goals.hold(now, self._work.goals if isinstance(self._work, Move) else {})
        self._work, self._stopping_at, self._strays = None, now, False
        self.receipts.news = True

    # What its servos show.

    def _look(self, now: float, readings: Mapping[int, Reading]) -> None:
        before = self._picture
        rest_s = self._rest.see(now, tuple(readings[id].position for id in self._joints))
        returned = self.goals.watch.see({id: readings[id] for id in self._joints})
        picture = self._picture = Picture(
            readings=dict(readings), names=self._names, rest_s=rest_s, stuck=self.goals.watch.stuck()
        )
        if before is None:
            self._judged_at, self._strays = now + SETTLE_S, self._is_away(picture)
        self._is_judged = self._is_judged or now >= self._judged_at
        self.effector.see(now, picture)
        self._see_boot(readings)
        if self.has_leftover:
            self.has_leftover = False
            self._halt(now)
        elif (returned or self.goals.are_unheard) and self._work is None:
            self._halt(now)  # now it is known where it is to hold
        self._see_hold(now, picture)
        if self._work is not None:
            self._go_on(now, self._work, self._work.look(now, picture), picture)
        self.effector.end_switch(now)
        self.receipts.news = self.receipts.news or before is None or before.trouble != picture.trouble

    def _is_away(self, picture: Picture) -> bool:
        """True where a joint with torque is not at its goal: it goes there, or would if it could."""
        rows = ((picture.readings[id], near) for id, near in self._near.items())
        return any(each.torque and abs(each.goal - each.position) > near for each, near in rows)

    def _see_boot(self, readings: Mapping[int, Reading]) -> None:
        booted = {id for id in self._marked if not readings[id].marked and not readings[id].torque}
        self._marked = (self._marked - booted) | {id for id, each in readings.items() if each.marked}
        if booted and not isinstance(self._work, Readying):  # then it was told to
            self._boot += 1
            self.receipts.forget()
            self.effector.forget()
            self._work, self._stopping_at, self.has_leftover = None, None, False

    def _see_hold(self, now: float, picture: Picture) -> None:
        if self._stopping_at is None or picture.since <= self._stopping_at:
            return
        held = {id: goal for id, goal in self._hold.items() if picture.readings[id].torque}
        if picture.other_goal(held) is not None:
            if now - self._stopping_at > TAKE_S:  # what is held is the same however often it is said
                self._halt(now)
            return
        if self._stop_id:
            self.receipts.tell(accepted=self._stop_id)
            self._stop_id = ""
        if picture.rest_s >= SETTLE_S and not self.goals.watch.awaits:
            self._stopping_at, self.receipts.news = None, True

    def _go_on(self, now: float, work: Move | Readying, look: Look, picture: Picture) -> None:
        self.receipts.take(work.id, look)
        if look.done:
            self._work = None
        elif look.is_end:
            self._halt(now)
        elif isinstance(work, Readying):
            self.goals.make_ready(work.due(now, picture), picture)

    # What the plant hears.

    def _state(self, picture: Picture) -> MotionState:
        readying = isinstance(self._work, Readying)
        in_fault = picture.stuck or any(each.alarms for each in picture.readings.values())
        if in_fault and not readying:
            return MotionState.STOP_LATCHED if self.is_latched else MotionState.FAULT
        if readying or picture.trouble is not None:
            return MotionState.NOT_HOMED
        at_work = self._work is not None or self._stopping_at is not None or self._strays
        if at_work or picture.rest_s < SETTLE_S:
            return MotionState.MOVING
        return MotionState.STOP_LATCHED if self.is_latched else MotionState.STOPPED

    def report(self, now: float) -> Report:
        picture = self._picture
        assert picture is not None
        rows = zip(self._settings.joints, self._joints, strict=True)
        return Report(
            at=now,
            robot=self.robot.name,
            boot_id=self._boot,
            state=self._state(picture),
            homed=picture.trouble is None and not isinstance(self._work, Readying),
            q=tuple(servo.angle(picture.readings[id].position) for servo, id in rows),
            effector=self.effector.is_on,
            facts=self._facts(picture),
        )

    def _facts(self, picture: Picture) -> Facts:
        readings = picture.readings.values()
        torque = {each.torque for each in readings}
        loads = [abs(each.load_percent) for each in readings if each.load_percent is not None]
        shown = {
            HEALTH: (picture.trouble or WELL).split()[0],
            "torque": "partly" if len(torque) > 1 else "on" if torque == {True} else "off",
            "celsius": max(each.celsius for each in readings),
            "volts": min(each.volts for each in readings),
            "load_percent": max(loads, default=None),
            "hand": self.effector.hand,
        }
        return tuple((name, value) for name, value in shown.items() if value is not None)


def _ticks(angle: float) -> int:
    return max(1, round(angle * TICKS / math.tau))
