"""Gripper of an arm, which is a servo, too: its switch, and what it holds."""

from __future__ import annotations

from arboleda.drivers import NotSent, SetEffector
from arboleda_drivers.connections.receipts import Receipts

from .bus import Bus
from .servos import MAKERS, Goal
from .settings import GRIPPER, Settings
from .work import NOT_TAKEN, SETTLE_S, STALL_S, STANDS_STILL, TAKE_S, TORQUE_OFF, Picture, Rest


class Gripper:
    """Gripper over one connection, if the arm has one."""

    def __init__(self, settings: Settings, bus: Bus, receipts: Receipts) -> None:
        self._servo, self._maker = settings.gripper, MAKERS[settings.protocol]
        self._bus, self._receipts = bus, receipts
        self._picture: Picture | None = None
        self._rest, self._rest_s = Rest(), 0.0
        self._command: SetEffector | None = None
        self._began_at = 0.0

    def switch(self, now: float, command: SetEffector) -> None:
        servo, picture = self._servo, self._picture
        if servo is None or picture is None:
            raise NotSent("it has no gripper in the plant file")
        if (trouble := picture.trouble) is not None:
            self._receipts.reject(command.id, trouble)
            return
        self._command, self._began_at = command, now
        position, speed = servo.closed if command.on else servo.open, float(servo.ticks_per_s)
        there = Goal(position=position, speed=speed, acceleration=4 * speed)
        self._bus.writes.append(self._maker.goals({servo.id: there}))

    def forget(self) -> None:
        """Forget a switch: a servo has lost its power."""
        self._command = None

    def see(self, now: float, picture: Picture) -> None:
        self._picture = picture
        if self._servo is not None:
            self._rest_s = self._rest.see(now, (picture.readings[self._servo.id].position,))

    def end_switch(self, now: float) -> None:
        """Find the end of a switch in what was seen last."""
        servo, picture, command = self._servo, self._picture, self._command
        if servo is None or picture is None or command is None:
            return
        reading, refusal = picture.readings[servo.id], ""
        if reading.at <= self._began_at:
            return
        if self.is_on is command.on:
            self._receipts.tell(accepted=command.id)
        elif reading.alarms or not reading.torque:
            refusal = reading.alarms[0] if reading.alarms else TORQUE_OFF
        elif reading.goal != (servo.closed if command.on else servo.open) and now - self._began_at > TAKE_S:
            refusal = NOT_TAKEN
        elif min(self._rest_s, now - self._began_at) >= STALL_S:
            refusal = STANDS_STILL
        else:
            return
        self._command = None
        if refusal:
            self._receipts.reject(command.id, f"{refusal} of {GRIPPER}")

    @property
    def hand(self) -> str | None:
        """The gripper's state: open, part (it has closed on one), empty (closed to its end), or moving."""
        servo, picture = self._servo, self._picture
        if servo is None or picture is None:
            return None
        reading = picture.readings[servo.id]
        if not reading.torque or self._rest_s < SETTLE_S:
            return "moving"
        if reading.goal == servo.open and abs(reading.position - servo.open) <= servo.near:
            return "open"
        if reading.goal != servo.closed or abs(reading.position - servo.open) <= servo.near:
            return "moving"
        return "empty" if abs(reading.position - servo.closed) <= servo.near else "part"

    @property
    def is_on(self) -> bool | None:
        return {"open": False, "part": True, "empty": True}.get(self.hand or "")
