"""Board as the bridge should see it: what befalls it in a step, and the three rules that judge the step."""

from __future__ import annotations

from collections import defaultdict

from arboleda.drivers import Command, Evidence, Report, Robot
from arboleda.engine import Belief
from arboleda.wire.rejections import Rejection
from arboleda.wire.transport import Delivery, Publication

from .board_link import KnownLink
from .boards import parts
from .motions import Beats, KnownMotion
from .numbers import KnownNumbers
from .passed_commands import PassedCommands
from .reported_telemetry import ReportedTelemetry


class BridgedBoard:
    """One board; `wrong` takes the breaches, rule -> sentences.

    `touched`: something befell it in this step; `repeats`: it stands still, and all that it publishes and
    that is reported of it is as it was.
    """

    def __init__(self, robot: Robot, stale_after_s: float, wrong: defaultdict[str, list[str]]) -> None:
        self.robot = robot
        self.link = KnownLink(robot, stale_after_s)
        self.touched, self.repeats = True, False
        by_ids = robot.evidence is Evidence.IDS
        self._motion, numbers = KnownMotion(), KnownNumbers(are_used=by_ids)
        self._numbers = numbers
        self._telemetry = ReportedTelemetry(robot, self.link, self._motion, numbers, wrong)
        self._commands = PassedCommands(robot, self.link, self._motion, numbers, wrong)
        self._beats = Beats(robot, self._motion, by_ids=by_ids, wrong=wrong)

    def take_over(self, now: float, belief: Belief) -> None:
        """Begin with what the plant believes."""
        self.link.take_over(now, belief)
        self._telemetry.plant, self._telemetry.plants = belief.plant, {belief.plant}
        self._telemetry.is_taken_over = True

    def connect(self, up: bool) -> None:
        self.touched = True
        self.link.connect(up)
        if not up:
            self._lose()

    def reject(self, rejection: Rejection) -> None:
        """Expect that people are told of a refused command."""
        self.touched = True
        self._commands.rejections.append(rejection)
        if rejection.reason == "foreign":
            self._count_foreign(refused=1)

    def obey_foreign(self, *, taken: bool) -> None:
        """Expect that people are told of an obeyed foreign command; `taken`: it may be halted for it."""
        self.touched = True
        self._commands.may_halt |= taken
        self._count_foreign(obeyed=1)

    def _count_foreign(self, *, refused: int = 0, obeyed: int = 0) -> None:
        before = self._telemetry.foreign
        self._telemetry.foreign = before[0] + refused, before[1] + obeyed
        self._telemetry.is_foreign_new = True

    def hear_plant(self, epoch: int) -> None:
        self._telemetry.is_new_plant |= epoch != self._telemetry.plant
        self._telemetry.plant = epoch
        self._telemetry.plants.add(epoch)
        self._beats.has_arrived = True
        self.touched |= self._motion.number is not None

    def hear_again(self, delivery: Delivery, now: float, reports: list[Report]) -> bool:
        """Take in the one message of a step, if it only repeats the last one, and so does the one report.

        False for anything else, which is to be compared as a whole.
        """
        telemetry, link = self._telemetry, self.link
        if self.touched or telemetry.is_new_plant or delivery.retain or len(reports) != 1:
            return False
        (report,), (before, number, after) = reports, parts(delivery.payload)
        words = (before, after) == telemetry.last[:2] and report.words == telemetry.last[2].words
        if not words or report.at != delivery.at or delivery.at + link.patience_s <= now:
            return False
        if number:
            if link.number is None or int(number) <= link.number:
                return False
            link.number = int(number)
        link.telemetry_at, self._beats.has_arrived = delivery.at, False
        link.silent_at = delivery.at + link.patience_s
        telemetry.last = (before, after, report)
        return True

    def deliver(self, delivery: Delivery, channel: str) -> None:
        self.touched = True
        if channel == "conexion":
            self.link.presence(delivery.payload)
            if delivery.payload == b"0":
                self._lose()
        elif not delivery.retain and self.link.is_open:
            self._telemetry.hear(delivery, len(self._commands.orders))

    def expect_copy(self, at: float, command: Command) -> None:
        self._commands.copies.expect(at, command)

    def hear_others(self, at: float, command: Command, sender: str, *, is_alone: bool) -> None:
        """Take in a command without an id; `is_alone`: no plant is heard."""
        self.touched = True
        self._commands.take_unnamed(at, command, sender, is_alone=is_alone)

    def command(self, command: Command, plant: int | None) -> None:
        self.touched = True
        self._commands.take(command, plant)

    def _lose(self) -> None:
        self.link.lose()
        self._motion.lose()
        self._commands.over = len(self._commands.orders)

    def end_step(
        self, now: float, reports: list[Report], published: list[Publication], *, late: bool
    ) -> None:
        """Compare all that this step should have brought with what it brought; `late`: it was away before."""
        link, telemetry, commands = self.link, self._telemetry, self._commands
        if link.silent_at <= now:
            self._lose()
        begins = bool(commands.orders) and commands.begins
        returned_late = bool(telemetry.maybe) and telemetry.is_reported_late(reports)
        self._beats.compare(published, link, begins=begins or returned_late, late=late)
        if commands.orders or published:
            commands.compare(reports, published, returned=link.rose or returned_late, late=late)
        if reports or telemetry.counted or link.fell:
            telemetry.compare(reports)
        new = telemetry.is_new_plant or telemetry.is_foreign_new
        counted = bool(telemetry.counted and reports) and not new
        if commands.orders or published or commands.rejections or new:
            self._forget_commands()
        if link.up and link.telemetry_at + link.patience_s <= now:
            link.lose()  # what counted only in hindsight may be too old by now
        link.was_down, link.fell, link.rose, link.least_before = not link.up, False, False, link.least
        telemetry.counted, telemetry.maybe, telemetry.plants = [], [], {telemetry.plant}
        if commands.copies.early:
            commands.copies.end_step(now)
        self.touched = bool(commands.copies.early)
        self.repeats = counted and link.up and self._motion.number is None and self._motion.had_ended

    def _forget_commands(self) -> None:
        """Forget which commands, and of which others, came in one step."""
        telemetry, commands = self._telemetry, self._commands
        if self._numbers.given:
            self._numbers.given = {}
            if telemetry.last:  # the same bytes may name a command by now
                telemetry.last = (None, None, telemetry.last[2])
        commands.orders, commands.rejections, commands.over = [], [], 0
        telemetry.is_new_plant = telemetry.is_foreign_new = False
