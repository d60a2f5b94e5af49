"""Property of reports: each repeats telemetry of its step, and all of a board that is there is reported.

`telemetry_is_reported` finds by it retained telemetry that is believed, as it repeats the last.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from arboleda.drivers import Evidence, MotionState, Report, Robot
from arboleda.engine import Belief
from arboleda.wire.rejections import ForeignCommand, Rejection

from .board_step import BoardStep
from .boards import fields as fields_of
from .boards import parts

REPORTS = "reports"
EXACT = 1e-9
FOREIGN_TO_ARMS, FOREIGN_TO_MOBILES = ("nodo",), ("efector", "pieza", "q1_mov")
FLAGS = (("homed", "ref"), ("effector", "efector"), ("piece", "pieza"))
SAME = ("state", "q", "node", "homed", "effector", "piece", "boot_id")


class ReportedTelemetry:
    """Last report of the bridge on one board: `_last`, by telemetry with these `_words`.

    `silent_at`: when the silence of a board that is there has lasted too long.
    """

    def __init__(self, robot: Robot, stale_after_s: float) -> None:
        self.silent_at = -math.inf
        self._robot = robot
        self._patience_s = math.inf if robot.evidence is Evidence.STATE else stale_after_s
        self._number: int | None = None
        self._boot: int | None = None
        self._last: Report | None = None
        self._words: tuple[object, ...] = ()  # of the last telemetry and of its report
        self._is_taken_over = False  # the first reports are not known
        self._foreign = (0, 0)  # commands of others that were refused, and obeyed, as people were told

    def take_over(self, now: float, belief: Belief) -> None:
        """Begin with what the plant believes."""
        self.silent_at, self._boot, self._is_taken_over = now + self._patience_s, belief.boot_id, True

    def is_told_again(self, step: BoardStep) -> bool:
        """True if all in a step is newer telemetry that says the same, and a report that says it again."""
        if step.is_stirred or step.orders or step.strangers or step.published or step.notices:
            return False
        if not step.was_up or len(step.plants) != 1 or len(step.heard) != 1 or len(step.reports) != 1:
            return False
        (delivery,), (report,) = step.heard, step.reports
        before, number, after = parts(delivery.payload)
        if delivery.retain or self._words != (before, after, *report.words) or report.at != delivery.at:
            return False
        if not number or self._number is None or not self._number < int(number) == report.number:
            return False
        self._last, self._number, self.silent_at = report, report.number, delivery.at + self._patience_s
        return step.now < self.silent_at

    def breaches(self, step: BoardStep) -> Iterator[str]:
        last, is_sure = self._last, step.was_up and not step.is_stirred and not step.is_lost
        for delivery in step.heard:
            fields = None if delivery.retain else read(delivery.payload, self._robot)
            if fields is None:
                continue
            before, _, after = parts(delivery.payload)
            number, boot = fields.get("seq"), fields.get("arranque")
            is_newer = boot is None or boot != self._boot
            is_newer = is_newer or number is None or self._number is None or number > self._number
            told: Report | None = None
            for report in step.states:
                if (report.at, report.number) == (delivery.at, number) and (
                    self._words == (before, after, *report.words) or agrees(report, fields, self._robot)
                ):
                    self._last, self._words = report, (before, after, *report.words)
                    self._number, self._boot = number, boot if boot is not None else self._boot
                    self.silent_at = delivery.at + self._patience_s
                    step.states.remove(report)
                    step.told.append((report, fields))
                    told = report
                    break
            if is_sure and is_newer is (told is None):
                word = "reported, and is overtaken" if told else "not reported as it is"
                name = self._robot.name
                yield f"the telemetry {delivery.payload!r} of {name} is {word}: {step.reports}"
            if told is not None and told.plant not in step.plants:
                yield f"{self._robot.name} is reported to another plant than {step.plants}: {told}"
        for report in step.states:
            if len(step.plants) == 1 or not self._is_said_again(report, last, step):
                yield f"{self._robot.name} is reported with what it has not said: {report}"
        if step.was_up:
            is_silent = self.silent_at <= step.now
            if (is_silent or step.is_shut) and not step.is_lost:
                yield f"the link to {self._robot.name} was lost, and nobody was told"
            if step.is_lost and not (is_silent or step.is_stirred):
                yield f"{self._robot.name} is reported lost, and is there"
        if step.notices:
            self._count(step)
        elif step.told and len(step.plants) == 1:
            last = step.reports[-1]
            counts = (last.foreign_refused or 0, last.foreign_obeyed or 0)
            if counts != self._foreign or (last.foreign is None) is any(counts):
                yield f"{counts} commands of others are counted ({last.foreign}), of {self._foreign}"

    def _is_said_again(self, report: Report, last: Report | None, step: BoardStep) -> bool:
        """True if a report says to another plant what was said just before it; `last`: before this step."""
        for each in step.reports:
            if each is report:
                break
            last = last if each.state in (None, MotionState.NO_LINK) else each
        return self._is_taken_over if last is None else is_same(report, last)

    def _count(self, step: BoardStep) -> None:
        """Count the commands of others of which people are told."""
        refused, obeyed = self._foreign
        for each in step.notices:
            refused += isinstance(each, Rejection) and each.reason == "foreign"
            obeyed += isinstance(each, ForeignCommand)
        self._foreign = refused, obeyed


def read(payload: bytes, robot: Robot) -> Mapping[str, Any] | None:
    """The fields of telemetry; None if it is to be refused, for the reasons that occur in simulations."""
    fields, place = fields_of(payload), _place_keys(len(robot.joints))
    if len(payload) > 512 or not fields.keys() >= place:
        return None
    if not fields.keys().isdisjoint(FOREIGN_TO_ARMS if robot.joints else FOREIGN_TO_MOBILES):
        return None
    grid = robot.floor_grid
    if grid and not 0 <= fields["nodo"] < grid.size:
        return None
    for key in place:
        if type(fields[key]) not in (int, float) or not math.isfinite(fields[key]):
            return None
    return fields if type(fields.get("estado")) is int and 0 <= fields["estado"] <= 4 else None


def agrees(report: Report, fields: Mapping[str, Any], robot: Robot) -> bool:
    """True if a report has the state, the place and the flags of this telemetry."""
    for flag, key in FLAGS:
        if getattr(report, flag) != (None if key not in fields else fields[key] == 1):
            return False
    if report.state is None or report.state != fields["estado"]:
        return False
    if not robot.joints:
        return report.node == fields["nodo"] and report.q is None
    if report.q is None or report.node is not None:
        return False
    for number, (joint, value) in enumerate(zip(robot.joints, report.q, strict=True), start=1):
        published = math.radians(fields[f"q{number}_mov"]) * (joint.pinion_radius_m or 1.0)
        if not abs(value - published) < EXACT:
            return False
    return True


def is_same(report: Report, other: Report) -> bool:
    """True if two reports say the same of a robot."""
    return all(getattr(report, name) == getattr(other, name) for name in SAME)


@cache
def _place_keys(joints: int) -> frozenset[str]:
    return frozenset(f"q{number}_mov" for number in range(1, joints + 1)) if joints else frozenset({"nodo"})
