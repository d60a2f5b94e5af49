"""State machine of the driver `serial_arm`: the bus, the arm's work and its stops, without a serial line.

One question is on the bus at a time. All that is written goes to several servos at once and is answered by
none of them: what a servo took is seen in the registers that are read next.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from arboleda.drivers.port import lost
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import Jointed, MoveJoints
from arboleda.model.commands import Command, Home, Stop, StopMode
from arboleda.model.facts import HEALTH, WELL, Facts
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Robot
from arboleda_drivers.connections.link import Close, Closed, CommandNotSent, CommandRequest, Open, Opened
from arboleda_drivers.connections.stream import Event, Message, Write

from .packets import Packet, PacketReader
from .position_watch import Plan, PositionWatch
from .servos import MAKERS, TICKS, Goal, Reading, read, reboot
from .settings import GRIPPER, Settings
from .work import (
    NOT_TAKEN,
    SETTLE_S,
    STALL_S,
    STANDS_STILL,
    TAKE_S,
    TORQUE_OFF,
    Look,
    Move,
    Picture,
    Readying,
    Switching,
    hand,
)

AGAIN_S = 0.5  # between two tries to open the line
SILENT_S = 0.4  # a servo answers in milliseconds
BOOT_S = 2.0  # one that boots is silent for a while
REPORT_S = 0.1
REST_TICKS = 3  # less than this is no motion
HOLD_RAMP_S = 0.1  # the ramp of a hold
LEAST_TICKS_S = 1.0  # speed of a servo that holds without a position: no servo takes 0 for standing


@dataclass(frozen=True, kw_only=True)
class Question:
    """Question to one servo that is not answered yet."""

    id: int
    at: float
    length: int  # bytes of the answer


@dataclass(kw_only=True)
class Rest:
    """Positions that stand still, and since when."""

    since: float = -math.inf
    positions: tuple[int, ...] = ()

    def see(self, now: float, positions: tuple[int, ...]) -> float:
        """Take the positions read now; returns how long they have stood, s."""
        pairs = zip(self.positions, positions, strict=False)
        if not self.positions or any(abs(a - b) > REST_TICKS for a, b in pairs):
            self.since, self.positions = now, positions
        return now - self.since


class Machine:
    """State machine of one arm of servos; `step` takes events and returns actions and reports."""

    def __init__(self, devices: Sequence[Robot], settings: Settings) -> None:
        """Raises ValueError unless the device is one robot of joints with a servo for each."""
        if len(devices) != 1 or not isinstance(devices[0], Jointed):
            raise ValueError("an arm of servos is one robot of joints")
        for _, problem in settings.problems(devices[0]):
            raise ValueError(problem)
        self._arm, self._settings = devices[0], settings
        self._maker = MAKERS[settings.protocol]
        self._joints = [servo.id for servo in settings.joints]
        self._ids = [servo.id for servo in settings.servos]
        self._near = dict(zip(self._joints, map(_ticks, self._arm.motion.tolerances), strict=True))
        names = [joint.name for joint in self._arm.joints]
        self._names = dict(zip(self._ids, [*names, GRIPPER], strict=False))
        self._out: list[Message] = []
        self._open, self._open_at = False, -math.inf
        self._boot = 1
        self._marked: set[int] = set()
        self._latched = self._left_at_work = self._news = False
        self._reported_at = -math.inf
        self._receipts: dict[str, str] = {}
        self._forget_link(0.0)

    @property
    def next_deadline(self) -> float:
        """The time (s) at which `step` is due even without events."""
        if not self._open:
            return self._open_at
        return self._round_at if self._question is None else self._question.at + self._settings.reply_s

    def step(self, now: float, events: Sequence[Event]) -> list[Message]:
        """Take events and the time, and return messages to act on; at most one is a report of the arm."""
        for event in events:
            self._take(now, event)
        self._pass_time(now)
        due = self._news or now >= self._reported_at + REPORT_S
        if self._open and self._picture is not None and self._is_judged and due:
            self._out.append(self._report(now, self._picture))
        out, self._out = self._out, []
        return out

    def _forget_link(self, now: float) -> None:
        self._packets = PacketReader(self._maker.framing, replies=True)
        self._writes: deque[bytes] = deque()
        self._question: Question | None = None
        self._question_count, self._round_at, self._opened_at = len(self._ids), now, now
        self._modes: set[int] | None = set()  # None: all are known
        self._answered_at: dict[int, float] = {}
        self._readings: dict[int, Reading] = {}  # of this round
        self._latest: dict[int, Reading] = {}
        self._picture: Picture | None = None
        self._judged_at = math.inf  # from then on it is known whether the arm stands
        self._is_judged = self._strays = False  # strays: nobody of this start told it to go where it goes
        self._round_began_at = self._last_round_at = now
        self._watch, self._holds_unheard = PositionWatch(), False
        self._speeds: Mapping[int, float] = {}  # of the last move, ticks/s
        self._rest, self._grip_rest = Rest(), Rest()
        self._grip_rest_s = 0.0
        self._work: Move | Readying | None = None
        self._switching: Switching | None = None
        self._stopping_at: float | None = None
        self._hold: Mapping[int, int] = {}
        self._stop_id = ""

    def _take(self, now: float, event: Event) -> None:
        if isinstance(event, CommandRequest):
            self._command(now, event.command)
        elif isinstance(event, Opened):
            self._forget_link(now)
            self._open = True
        elif isinstance(event, Closed):
            if self._open or self._open_at == math.inf:  # else it was closed from here
                self._lose(now, event.why)
        elif self._open:
            for packet in self._packets.feed(event.data):
                self._hear(now, packet)

    def _pass_time(self, now: float) -> None:
        if not self._open:
            if self._open_at <= now:
                self._open_at = math.inf
                self._out.append(Open())
            return
        if self._question is not None and now >= self._question.at + self._settings.reply_s:
            self._packets.clear()
            self._question = None  # the others are asked, and this one again in the next round
        self._use_bus(now)

    # The bus.

    def _use_bus(self, now: float) -> None:
        """Write what is due, then ask the next servo, unless an answer is awaited."""
        while self._open and self._question is None:
            if self._writes:
                self._out.append(Write(data=self._writes.popleft()))
            elif self._question_count < len(self._ids):
                self._ask(now, self._ids[self._question_count])
                self._question_count += 1
            elif now >= self._round_at:
                self._end_round(now)
            else:
                return

    def _ask(self, now: float, id: int) -> None:
        address, length = (self._maker.mode[0], 1) if self._modes is not None else self._maker.block
        self._question = Question(id=id, at=now, length=length)
        self._out.append(Write(data=read(self._maker, id, address, length)))

    def _hear(self, now: float, packet: Packet) -> None:
        question = self._question
        if question is None or packet.id != question.id or len(packet.data) != question.length:
            return  # the echo of a question, or an answer that came too late
        self._question, self._answered_at[packet.id] = None, now
        if self._modes is None:
            self._readings[packet.id] = self._latest[packet.id] = self._maker.reading(now, packet)
        elif packet.data[0] in self._maker.mode[1]:
            self._modes.add(packet.id)
        else:
            servo = f"servo {packet.id} ({self._names[packet.id]})"
            self._close(now, f"{servo} is in operating mode {packet.data[0]}, which holds no position")

    def _end_round(self, now: float) -> None:
        """Judge a round in which all servos answered, and begin the next one."""
        self._question_count, self._round_at = 0, now + self._settings.poll_s
        self._last_round_at, self._round_began_at = self._round_began_at, now
        readings, self._readings = self._readings, {}
        if self._modes is not None:
            self._modes = None if len(self._modes) == len(self._ids) else self._modes
        elif len(readings) == len(self._ids):
            self._look(now, readings)
        # Nobody is heard more often than once in a round, however long the silent ones make it.
        patience_s = max(SILENT_S, len(self._ids) * self._settings.reply_s + self._settings.poll_s)
        if isinstance(self._work, Readying) and self._maker.reboots:
            patience_s = max(patience_s, BOOT_S)
        silent = [id for id in self._ids if now - self._answered_at.get(id, self._opened_at) > patience_s]
        if silent and self._open:
            self._give_up(now, silent)

    def _give_up(self, now: float, silent: Sequence[int]) -> None:
        if isinstance(self._work, Move) and (held := self._held(self._joints)):
            self._out.append(Write(data=self._maker.goals(held)))
        if len(silent) == len(self._ids):
            self._close(now, "no servo answers; is the arm powered, and the baud rate right?")
        else:
            self._close(now, f"servo {silent[0]} ({self._names[silent[0]]}) does not answer")

    def _close(self, now: float, why: str) -> None:
        self._out.append(Close())
        self._lose(now, why)

    def _lose(self, now: float, why: str) -> None:
        self._left_at_work = (
            self._left_at_work or isinstance(self._work, Move) or self._stopping_at is not None
        )
        self._open, self._open_at = False, now + AGAIN_S
        self._forget_link(now)
        self._out.append(lost(self._arm.name, at=now, why=f"{self._settings.peer}: {why}"))

    # Commands.

    def _command(self, now: float, command: Command) -> None:
        if self._picture is None:
            self._out.append(CommandNotSent(why=f"{self._settings.peer} is not connected"))
        elif isinstance(command, Stop):
            self._stop(now, command)
        elif isinstance(command, SetEffector):
            self._switch(now, command)
        elif self._work is not None:
            self._reject(command.id, "busy")
        elif isinstance(command, MoveJoints):
            self._move(now, command, self._picture)
        elif isinstance(command, Home):
            self._work = Readying(id=command.id, began_at=now)
            self._tell(accepted=command.id)
        else:
            self._out.append(CommandNotSent(why=f"an arm has no word for {type(command).__name__}"))

    def _move(self, now: float, command: MoveJoints, picture: Picture) -> None:
        servos = self._settings.joints
        goals = {servo.id: servo.ticks(q) for servo, q in zip(servos, command.q, strict=True)}
        ends = self._maker.positions
        beyond = next((servo.id for servo in servos if not servo.can_reach(goals[servo.id], ends)), None)
        refusal = picture.trouble if beyond is None else f"beyond_limits of {self._names[beyond]}"
        if refusal is not None:
            self._reject(command.id, refusal)
            return
        self._work = Move(id=command.id, goals=goals, near=self._near, began_at=now)
        self._stopping_at, self._strays = None, False
        self._writes.append(self._maker.goals(self._paced(now, goals, picture)))

    def _paced(self, now: float, goals: Mapping[int, int], picture: Picture) -> dict[int, Goal]:
        """The goals with speeds by which all joints arrive together, at the share of the model's speed."""
        share = self._settings.model_speed_share
        rows = list(zip(self._joints, self._arm.joints, strict=True))
        ways = {id: abs(goals[id] - picture.readings[id].position) for id in self._joints}
        time_s = max(ways[id] / (_per_s(joint.speed) * share) for id, joint in rows)
        ramp_s = max(joint.speed * share / joint.acceleration for _, joint in rows)
        self._speeds = speeds = {id: ways[id] / time_s if time_s > 0 else 1.0 for id in self._joints}
        begins_at = now + ramp_s / 2  # as if it had all of its speed at once
        self._watch.begin(Plan(goals=goals, speeds=speeds, begins_at=begins_at, ends_at=begins_at + time_s))
        return {
            id: Goal(position=goals[id], speed=speed, acceleration=speed / ramp_s)
            for id, speed in speeds.items()
        }

    def _switch(self, now: float, command: SetEffector) -> None:
        gripper, picture = self._settings.gripper, self._picture
        if gripper is None or picture is None:
            self._out.append(CommandNotSent(why="it has no gripper in the plant file"))
            return
        if (trouble := picture.trouble) is not None:
            self._reject(command.id, trouble)
            return
        self._switching = Switching(id=command.id, on=command.on, began_at=now)
        speed = float(gripper.ticks_per_s)
        there = Goal(
            position=gripper.closed if command.on else gripper.open, speed=speed, acceleration=4 * speed
        )
        self._writes.append(self._maker.goals({gripper.id: there}))

    def _stop(self, now: float, command: Stop) -> None:
        if command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
            self._news = True
        if command.mode is StopMode.CLEAR:
            self._tell(accepted=command.id)
            return
        self._stop_id = command.id
        self._halt(now)

    def _halt(self, now: float) -> None:
        """Have each joint hold where it is, before anything else that waits."""
        self._holds_unheard = False
        held = self._held(self._joints)
        self._watch.end()
        self._hold = {id: goal.position for id, goal in held.items()}
        self._work, self._stopping_at, self._news, self._strays = None, now, True, False
        self._writes.clear()
        if held:
            self._writes.append(self._maker.goals(held))

    def _held(self, ids: Iterable[int]) -> dict[int, Goal]:
        """The goals by which servos hold; a servo without torque has none.

        Each holds at its position, to which it goes at the speed of the move. A servo whose position is older
        than a round may be far from there by now: it keeps its goal, at the least speed that it has, until it
        tells where it is.
        """
        held = {}
        for id, reading in self._latest.items():
            if id not in set(ids) or not reading.torque:
                continue
            is_heard, is_old = reading.at >= self._last_round_at, self._watch.is_old(id)
            if is_heard and not is_old:
                held[id] = self._goal(reading.position, self._speeds.get(id, self._usual_ticks_s))
            else:
                self._holds_unheard = self._holds_unheard or not is_heard
                if is_old:
                    self._watch.unknown.add(id)
                goals = self._work.goals if isinstance(self._work, Move) else {}
                held[id] = self._goal(goals.get(id, reading.goal), LEAST_TICKS_S)
        return held

    def _goal(self, position: int, speed: float) -> Goal:
        least, most = self._maker.positions
        quick = _per_s(max(joint.speed for joint in self._arm.joints)) / HOLD_RAMP_S
        return Goal(position=min(max(position, least), most), speed=speed, acceleration=quick)

    @property
    def _usual_ticks_s(self) -> float:
        """The speed of a joint where no move of this connection has told another one."""
        return _per_s(min(joint.speed for joint in self._arm.joints)) * self._settings.model_speed_share

    # What its servos show.

    def _look(self, now: float, readings: Mapping[int, Reading]) -> None:
        before = self._picture
        rest_s = self._rest.see(now, tuple(readings[id].position for id in self._joints))
        returned = self._watch.see({id: readings[id] for id in self._joints})
        picture = self._picture = Picture(
            readings=dict(readings), names=self._names, rest_s=rest_s, stuck=self._watch.stuck()
        )
        if before is None:
            self._judged_at, self._strays = now + SETTLE_S, self._is_away(picture)
        self._is_judged = self._is_judged or now >= self._judged_at
        if self._settings.gripper is not None:
            grip = readings[self._settings.gripper.id]
            self._grip_rest_s = self._grip_rest.see(now, (grip.position,))
        self._see_boot(readings)
        if self._left_at_work:  # nobody waits for that work any more
            self._left_at_work = False
            self._halt(now)
        elif (returned or self._holds_unheard) and self._work is None:
            self._halt(now)  # now it is known where it is to hold
        self._see_hold(now, picture)
        if self._work is not None:
            self._go_on(now, self._work, self._work.look(now, picture), picture)
        if self._switching is not None:
            self._see_switch(now, self._switching, picture)
        self._news = self._news or before is None or before.trouble != picture.trouble

    def _is_away(self, picture: Picture) -> bool:
        """True where a joint with torque is not at its goal: it goes there, or would if it could."""
        rows = ((picture.readings[id], near) for id, near in self._near.items())
        return any(each.torque and abs(each.goal - each.position) > near for each, near in rows)

    def _see_boot(self, readings: Mapping[int, Reading]) -> None:
        booted = {id for id in self._marked if not readings[id].marked and not readings[id].torque}
        self._marked = (self._marked - booted) | {id for id, each in readings.items() if each.marked}
        if booted and not isinstance(self._work, Readying):  # then it was told to
            self._boot += 1
            self._receipts, self._work, self._switching, self._stopping_at = {}, None, None, None
            self._left_at_work, self._news = False, True

    def _see_hold(self, now: float, picture: Picture) -> None:
        if self._stopping_at is None or picture.since <= self._stopping_at:
            return
        held = {id: goal for id, goal in self._hold.items() if picture.readings[id].torque}
        if picture.other_goal(held) is not None:
            if now - self._stopping_at > TAKE_S:  # what is held is the same however often it is said
                self._halt(now)
            return
        if self._stop_id:
            self._tell(accepted=self._stop_id)
            self._stop_id = ""
        if picture.rest_s >= SETTLE_S and not self._watch.awaits:
            self._stopping_at, self._news = None, True

    def _go_on(self, now: float, work: Move | Readying, look: Look, picture: Picture) -> None:
        if look.accepted:
            self._tell(accepted=work.id)
        if look.done:
            self._work = None
            self._tell(done=work.id)
        elif look.refused is not None:
            self._reject(work.id, look.refused)
            self._halt(now)
        elif look.failed is not None:
            self._tell(failed=work.id, failure=look.failed)
            self._halt(now)
        elif isinstance(work, Readying):
            self._make_ready(work.due(now, picture), picture)

    def _make_ready(self, ids: Sequence[int], picture: Picture) -> None:
        """Have servos hold where they are; one with an alarm boots first, where that ends its alarm."""
        if alarmed := [id for id in ids if picture.readings[id].alarms and self._maker.reboots]:
            self._writes.extend(reboot(self._maker, id) for id in alarmed)
        if ready := [id for id in ids if id not in alarmed]:
            # Its goal first: with the one of before it would jump there.
            rows = {id: picture.readings[id].position for id in ready}
            slow = {id: LEAST_TICKS_S if id in picture.stuck else self._usual_ticks_s for id in ready}
            self._writes.append(self._maker.goals({id: self._goal(at, slow[id]) for id, at in rows.items()}))
            self._watch.excuse(ready)
            self._writes.append(self._maker.torque(ready, on=True))

    def _see_switch(self, now: float, switching: Switching, picture: Picture) -> None:
        gripper = self._settings.gripper
        assert gripper is not None
        grip, refusal = picture.readings[gripper.id], None
        goal = gripper.closed if switching.on else gripper.open
        if grip.at <= switching.began_at:
            return
        if self._effector(picture) is switching.on:
            self._tell(accepted=switching.id)
        elif grip.alarms or not grip.torque:
            refusal = grip.alarms[0] if grip.alarms else TORQUE_OFF
        elif grip.goal != goal and now - switching.began_at > TAKE_S:
            refusal = NOT_TAKEN
        elif min(self._grip_rest_s, now - switching.began_at) >= STALL_S:
            refusal = STANDS_STILL
        else:
            return
        self._switching = None
        if refusal is not None:
            self._reject(switching.id, f"{refusal} of {GRIPPER}")

    # What the plant hears.

    def _tell(self, **ids: str) -> None:
        self._receipts |= {name: id for name, id in ids.items() if id}
        self._news = True

    def _reject(self, id: str, word: str) -> None:
        if id:
            self._tell(rejected=id, refusal=word)

    def _hand(self, picture: Picture) -> str | None:
        gripper = self._settings.gripper
        return None if gripper is None else hand(gripper, picture.readings[gripper.id], self._grip_rest_s)

    def _effector(self, picture: Picture) -> bool | None:
        return {"open": False, "part": True, "empty": True}.get(self._hand(picture) or "")

    def _state(self, picture: Picture) -> MotionState:
        readying = isinstance(self._work, Readying)
        in_fault = picture.stuck or any(each.alarms for each in picture.readings.values())
        if in_fault and not readying:
            return MotionState.STOP_LATCHED if self._latched else MotionState.FAULT
        if readying or picture.trouble is not None:
            return MotionState.NOT_HOMED
        at_work = self._work is not None or self._stopping_at is not None or self._strays
        if at_work or picture.rest_s < SETTLE_S:
            return MotionState.MOVING
        return MotionState.STOP_LATCHED if self._latched else MotionState.STOPPED

    def _report(self, now: float, picture: Picture) -> Report:
        self._news, self._reported_at = False, now
        rows = zip(self._settings.joints, self._joints, strict=True)
        report = Report(
            at=now,
            robot=self._arm.name,
            boot_id=self._boot,
            state=self._state(picture),
            homed=picture.trouble is None and not isinstance(self._work, Readying),
            q=tuple(servo.angle(picture.readings[id].position) for servo, id in rows),
            effector=self._effector(picture),
            facts=self._facts(picture),
        )
        return report.again(now, **self._receipts)

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
            "hand": self._hand(picture),
        }
        return tuple((name, value) for name, value in shown.items() if value is not None)


def _ticks(angle: float) -> int:
    return max(1, round(angle * TICKS / math.tau))


def _per_s(speed: float) -> float:
    """The speed in ticks/s of one in rad/s."""
    return speed * TICKS / math.tau
