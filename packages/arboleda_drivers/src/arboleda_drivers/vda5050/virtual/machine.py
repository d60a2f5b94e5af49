"""Virtual vehicle of VDA 5050: its orders, driving, and messages. It has no clock of its own."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .factsheet import factsheet_of
from .faults import STANDING
from .order import UPDATE, Body, Course, RunningAction
from .words import state_of

TICK_S = 0.05
LATE_S = 1.0
EDGE_S = 1.0  # time for an edge whose length the order omits
INSTANT_ONLY = ("cancelOrder", "startPause", "stopPause", "stateRequest", "factsheetRequest")
OVER = ("FINISHED", "FAILED")


@dataclass(frozen=True, kw_only=True)
class VehicleMessage:
    """Event: a message for the vehicle; `body` is None if it does not fit the schema of its topic."""

    topic: str
    body: Body | None


@dataclass(frozen=True, kw_only=True)
class OutgoingMessage:
    """Message of the vehicle, without its header."""

    topic: str
    body: Mapping[str, Any]
    as_serial: str | None = None
    fits: bool = True  # False: it is not to fit the schema
    retain: bool = False


@dataclass(frozen=True, kw_only=True)
class Connect:
    """Message: connect to the broker; `anew`: after a boot, so that headers begin anew."""

    anew: bool


@dataclass(frozen=True, kw_only=True)
class ConnectionCut:
    """Message: lose the connection to the broker."""


Message = OutgoingMessage | Connect | ConnectionCut


class VirtualAgv:
    """Virtual vehicle, at `node` first, not paused, without a load; `speed` in m/s."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        version: str = "2.1",
        node: str = "0",
        speed: float = 0.5,
        state_s: float = 1.0,
    ) -> None:
        self._faults, self._version = faults, version
        self._speed, self._state_s = speed, state_s
        self.node, self.sequence = node, 0
        self.at: tuple[float, float] | None = None
        self.loaded, self.charging, self.battery = False, False, 90.0
        self.paused = self.driving = False
        self.course = Course()
        self.actions: dict[str, RunningAction] = {}
        self.errors: list[dict[str, Any]] = []
        self._edge_left_s: float | None = None
        self._now: float | None = None
        self._online = False
        self._off = False
        self._state_at = 0.0
        self._changed = False
        self._frozen: Mapping[str, Any] | None = None
        self._later: list[tuple[float, OutgoingMessage]] = []
        self.next_deadline = 0.0

    def step(self, now: float, events: Sequence[VehicleMessage]) -> list[Message]:
        """Drive on until now, take messages, and return others."""
        passed_s = 0.0 if self._now is None else now - self._now
        self._now = now
        messages = self._join()
        if not self._off:
            self._befall()
            for event in events:
                self._take(event)
            self._act(passed_s)
            self._drive(passed_s * (0.1 if "slow" in self._faults else 1.0))
        messages += self._speak(now)
        busy = self.course.steps or any(each.status not in OVER for each in self.actions.values())
        self.next_deadline = now + (TICK_S if busy or self._faults else min(self._state_s, 0.2))
        return messages

    # --- its connection ---

    @property
    def is_online(self) -> bool:
        """True while the broker retains that it is there."""
        return self._online

    def _join(self) -> list[Message]:
        off = "power_cycle" in self._faults
        away = off or "vanish" in self._faults
        booted, self._off = self._off and not off, off
        if booted:
            self.course, self.actions, self.errors = Course(), {}, []
            self.paused, self.sequence, self._edge_left_s = False, 0, None
        if away == (not self._online):
            return []
        self._online = not away
        self._changed = True
        return [Connect(anew=booted)] if self._online else [ConnectionCut()]

    # --- faults ---

    def _befall(self) -> None:
        under_way = self._edge_left_s is not None or (self.course.steps and self.sequence > 0)
        if "forget" in self._faults and under_way:
            self._end(Course())
        if "manual" in self._faults and self.course.steps:
            self._end(Course(id=self.course.id, update=self.course.update))
        if "lie" in self._faults and self.course.steps:
            self._end(Course(id=self.course.id, update=self.course.update))
        if "short" in self._faults and len(self.course.nodes) == 1 and under_way:
            self._end(Course(id=self.course.id, update=self.course.update))

    def _end(self, course: Course) -> None:
        self.course, self._edge_left_s, self.driving, self._changed = course, None, False, True
        for each in self.actions.values():
            if each.status not in OVER and not each.instant:
                each.status = "FAILED"

    # --- orders and instant actions ---

    def _take(self, event: VehicleMessage) -> None:
        self._changed = True
        if event.body is None:
            self._complain("validationError", {"topic": event.topic})
        elif event.topic == "order":
            self._take_order(event.body)
        elif event.topic == "instantActions":
            for action in event.body["actions"]:
                self._take_instant(action)

    def _take_order(self, body: Body) -> None:
        mine = body["orderId"] == self.course.id and self.course.id != ""
        why = self.course.objection(body, self.node)
        if "no_route" in self._faults and not mine:
            why = "noRouteError"
        if "no_update" in self._faults and mine:
            why = UPDATE
        if why is not None:
            update = str(body["orderUpdateId"])
            self._complain(why, {"orderId": body["orderId"], "orderUpdateId": update})
            return
        if not mine:
            self.errors, self.sequence = [], body["nodes"][0]["sequenceId"]
            self.actions = {}
        self.course.take(body)
        for step in self.course.steps:
            for action in step["actions"]:
                self.actions.setdefault(action["actionId"], _doing(action))
        if not mine:
            self._arrive()

    def _take_instant(self, action: Body) -> None:
        doing = _doing(action, instant=True)
        self.actions[doing.id] = doing
        if "deaf" in self._faults and doing.type in INSTANT_ONLY:
            return
        if doing.type not in INSTANT_ONLY:
            doing.status = "RUNNING"
            return
        doing.status, doing.left_s = "FINISHED", 0.0
        if doing.type in ("startPause", "stopPause"):
            self.paused = doing.type == "startPause"
        elif doing.type == "cancelOrder":
            self._cancel(doing)
        elif doing.type == "factsheetRequest":
            self._later.append(
                (
                    self._now or 0.0,
                    OutgoingMessage(topic="factsheet", body=factsheet_of(self._version), retain=True),
                )
            )

    def _cancel(self, doing: RunningAction) -> None:
        """Cancel the order at once, between two nodes if need be: line-guided vehicles may not, others do."""
        if not self.course.steps:
            doing.status = "FAILED"
            self._complain("noOrderToCancel", {"actionId": doing.id})
        self._end(Course(id=self.course.id, update=self.course.update))

    def _complain(self, word: str, about: Mapping[str, str]) -> None:
        references = [{"referenceKey": key, "referenceValue": value} for key, value in about.items()]
        self.errors = [each for each in self.errors if each["errorType"] != word]
        self.errors.append({"errorType": word, "errorLevel": "WARNING", "errorReferences": references})

    # --- driving and actions ---

    @property
    def stands(self) -> bool:
        return self.paused or bool(STANDING & set(self._faults)) or self._off

    def _act(self, passed_s: float) -> None:
        for doing in self.actions.values():
            if doing.status != "RUNNING" or "action_stalls" in self._faults:
                continue
            doing.left_s -= passed_s
            if doing.left_s <= 0:
                self._finish(doing)

    def _finish(self, doing: RunningAction) -> None:
        self._changed = True
        if "action_fails" in self._faults:
            doing.status = "FAILED"
            self._complain("actionError", {"actionId": doing.id})
            return
        doing.status = "FINISHED"
        if doing.type in ("pick", "drop"):
            self.loaded = doing.type == "pick"
        elif doing.type in ("startCharging", "stopCharging"):
            self.charging = doing.type == "startCharging"
        elif doing.type == "detectObject":
            doing.result = "loaded" if self.loaded else "empty"
        self._leave_if_done()

    def _drive(self, passed_s: float) -> None:
        was = self.driving
        while passed_s > 0 and self._may_go:
            if self._edge_left_s is None:
                self._edge_left_s = self._edge_s()
                self._begin_edge()
            part = min(passed_s, self._edge_left_s)
            self._edge_left_s -= part
            passed_s -= part
            if self._edge_left_s <= 0:
                self._pass_edge()
        self.driving = self._edge_left_s is not None and not self.stands
        self._changed = self._changed or was != self.driving

    @property
    def _may_go(self) -> bool:
        if self.stands or len(self.course.steps) < 2 or "edgeId" not in self.course.steps[0]:
            return False
        blocked = any(each.status == "RUNNING" and each.blocks for each in self.actions.values())
        return not blocked and all(step["released"] for step in self.course.steps[:2])

    def _edge_s(self) -> float:
        goal = _position(self.course.steps[1])
        if self.at is None or goal is None:
            return EDGE_S
        return max(TICK_S, math.dist(self.at, goal) / self._speed)

    def _begin_edge(self) -> None:
        self._changed = True
        for action in self.course.steps[0]["actions"]:
            self.actions[action["actionId"]].status = "RUNNING"

    def _pass_edge(self) -> None:
        self._edge_left_s = None
        self.course.steps.pop(0)
        self._arrive()

    def _arrive(self) -> None:
        """Reach the next node of the order."""
        step = self.course.steps[0]
        self.node, self.sequence, self._changed = step["nodeId"], step["sequenceId"], True
        self.at = _position(step) or self.at
        for action in step["actions"]:
            self.actions[action["actionId"]].status = "RUNNING"
        if len(self.course.steps) > 1:
            self.course.steps.pop(0)
        self._leave_if_done()

    def _leave_if_done(self) -> None:
        """End the order if its last node is reached and its actions have ended."""
        steps = self.course.steps
        ended = all(
            self.actions[each["actionId"]].status in OVER for step in steps for each in step["actions"]
        )
        if len(steps) == 1 and steps[0]["sequenceId"] == self.sequence and ended:
            self.course.steps = []

    # --- messages ---

    def _speak(self, now: float) -> list[Message]:
        if self._online and (self._changed or now >= self._state_at) and "hush" not in self._faults:
            self._changed, self._state_at = False, now + self._state_s
            late_s = LATE_S if "late" in self._faults else 0.0
            self._later += [(now + late_s, say) for say in self._states(now)]
        due: list[Message] = []
        while self._later and self._later[0][0] <= now:  # none overtakes one of before
            due.append(self._later.pop(0)[1])
        return due if self._online else []

    def _states(self, now: float) -> list[OutgoingMessage]:
        body: Mapping[str, Any] = state_of(self, self._faults, self._version)
        if "frozen" in self._faults:
            body = self._frozen = self._frozen or body
        else:
            self._frozen = None
        garbled = "garbled" in self._faults
        if garbled:
            body = {**body, "driving": "perhaps", "nodeStates": None}
        serial = "another" if "wrong_serial" in self._faults else None
        say = OutgoingMessage(topic="state", body=body, as_serial=serial, fits=not garbled)
        return [say, say] if "double" in self._faults else [say]


def _doing(action: Body, *, instant: bool = False) -> RunningAction:
    values = {each["key"]: each["value"] for each in action.get("actionParameters", ())}
    return RunningAction(
        id=action["actionId"],
        type=action["actionType"],
        instant=instant,
        blocks=action["blockingType"] != "NONE",
        values=values,
    )


def _position(step: Body) -> tuple[float, float] | None:
    position = step.get("nodePosition")
    return None if position is None else (position["x"], position["y"])
