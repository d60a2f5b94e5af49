"""Rule of reports: what a board publishes while it is there is reported at once, as it is; nothing else."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

from arboleda.drivers import Evidence, MotionState, Report, Robot
from arboleda.wire.transport import Delivery

from .board_link import KnownLink
from .boards import parts
from .motions import KnownMotion
from .numbers import KnownNumbers
from .telemetry import TelemetryReader, agrees, is_same, read

REPORTS = "reports"


class ReportedTelemetry:
    """Telemetry of one board, against the bridge's reports.

    `last` is the last telemetry, by its bytes before and after its number, and its report. `counted` is the
    telemetry of this step with the number of commands before it, `maybe` what may count in hindsight.
    `plant` is the plant that the bridge hears, `is_new_plant` if it did not before this step. Of others'
    commands `foreign` counts those that were refused, and obeyed, as people were told; `is_foreign_new`: they
    were told of one in this step.
    """

    def __init__(
        self,
        robot: Robot,
        link: KnownLink,
        motion: KnownMotion,
        numbers: KnownNumbers,
        wrong: defaultdict[str, list[str]],
    ) -> None:
        self.last: tuple[Any, ...] = ()
        self.counted: list[tuple[Delivery, int]] = []
        self.maybe: list[tuple[Delivery, int]] = []
        self.plant: int | None = None
        self.plants: set[int | None] = {None}  # of this step: beats of several may come between reports
        self.is_new_plant = False
        self.is_taken_over = False  # the first reports are not known
        self.foreign = (0, 0)
        self.is_foreign_new = False
        self._robot = robot
        self._by_ids = robot.evidence is Evidence.IDS
        self._link, self._motion, self._numbers = link, motion, numbers
        self._wrong = wrong
        self._reader = TelemetryReader(robot)

    def hear(self, delivery: Delivery, place: int) -> None:
        """Take telemetry that came after `place` commands of this step."""
        fields = self._reader.fields(delivery.payload)
        if fields is None:
            return
        if self._motion.number in (fields.get("hecho"), fields.get("rechazo_seq")):
            self._motion.number = None
        if self._link.hear(delivery.at, fields):
            if self._motion.is_open:
                self._motion.follow(delivery.at, fields, by_ids=self._by_ids, booted=self._link.is_boot)
            self.counted.append((delivery, place))
        elif not self._link.up:  # a counter that began anew counts again after some time
            self.maybe.append((delivery, place))

    def is_reported_late(self, reports: list[Report]) -> bool:
        """True if a lost board is reported by telemetry that counts only in hindsight."""
        return any(report.at == delivery.at for delivery, _ in self.maybe for report in reports)

    def compare(self, reports: list[Report]) -> None:
        """Compare the reports of a step with the telemetry that came in it."""
        name, lost, states = self._robot.name, False, []
        for each in reports:
            if each.state is MotionState.NO_LINK:
                lost = True
            elif each.state is not None:
                states.append(each)
        if self._link.fell and not lost:
            self._breach(f"the link to {name} was lost, and nobody was told")
        if lost and self._link.up and not (self._link.fell or self._link.was_down):
            self._breach(f"{name} is reported lost, and is there")
        before = [self.last[2] if self.last else None, *states]
        rest = list(zip(before, states, strict=False))
        for delivery, place in self.counted:
            for pair in rest:
                if self._repeats(pair[1], delivery, place):
                    rest.remove(pair)
                    break
            else:
                self._breach(f"{delivery.payload!r} of {name} is not reported as it is: {states}")
                return
        for last, report in rest:
            if not self._is_known(report, last):
                self._breach(f"{name} is reported with what it has not said: {report}")
        if reports and self.counted and not (self.is_new_plant or self.is_foreign_new):
            last = reports[-1]
            counts = (last.foreign_refused or 0, last.foreign_obeyed or 0)
            if counts != self.foreign or (last.foreign is None) is any(counts):
                text = f"commands of others are counted ({last.foreign}), of {self.foreign}"
                self._breach(f"{counts} {text}")

    def _is_known(self, report: Report, last: Report | None) -> bool:
        """True if an unexpected report is right: a repetition for a new plant, or what may count."""
        for delivery, place in self.maybe:
            if self._repeats(report, delivery, place):
                fields = read(delivery.payload, self._robot) or {}
                self._link.hear(delivery.at, fields, in_hindsight=True)
                self.counted = []
                return True
        if last is None:
            return self.is_new_plant and self.is_taken_over
        return self.is_new_plant and is_same(report, last)

    def _repeats(self, report: Report, delivery: Delivery, place: int) -> bool:
        """True if a report repeats this telemetry."""
        if report.at != delivery.at or report.plant not in self.plants:
            return False
        before, _, after = parts(delivery.payload)
        alike = self.last and not self._numbers.given and (before, after) == self.last[:2]
        if not (alike and report.words == self.last[2].words):
            fields = self._reader.fields(delivery.payload)
            if fields is None or not agrees(report, fields, self._robot):
                return False
            if not self._numbers.names(report, fields, place):
                return False
        self.last = (before, after, report)
        return True

    def _breach(self, sentence: str) -> None:
        self._wrong[REPORTS].append(sentence)
