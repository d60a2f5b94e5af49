"""Property of commands: each leaves as it is, under the next number, or is refused with a true word.

`commands_are_passed_on` finds by it a clear of an old plant that passes the fence.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator, Mapping
from typing import Any

from arboleda.drivers import (
    Command,
    Evidence,
    FollowPath,
    Home,
    Motion,
    MoveJoints,
    Report,
    Robot,
    SetEffector,
    Stop,
    StopMode,
)
from arboleda.wire.hop import is_stop, without_id
from arboleda.wire.rejections import ForeignCommand, Rejection
from arboleda.wire.transport import Publication

from .board_step import BoardStep
from .boards import fields as fields_of

COMMANDS = "commands"
KEPT = 200  # numbers of a board, fewer than the bridge remembers
COPY_S = 5.0  # within it a command without an id may be a copy of one with an id
SLACK = 1e-6  # rad or m: rounding of a goal at its limit on the wire
CHANNELS = {
    MoveJoints: "juntas",
    FollowPath: "camino",
    SetEffector: "efector",
    Stop: "paro",
    Home: "referencia",
}
NOBODY: frozenset[str | None] = frozenset([None])
Number = tuple[Any, Any]  # (epoca, seq)


class PassedCommands:
    """Commands for one board; `_commands`: those that may have a number, None for one of nobody.

    `_refused` are the commands that were refused, with the word. `_latched`: a stop is latched, None if
    nobody can tell. `_may_halt`: the board obeyed a foreign command that the bridge may halt.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._by_ids = robot.evidence is Evidence.IDS
        self._seq = 0
        self._boot: int | None = None
        self._commands: OrderedDict[Number, frozenset[str | None]] = OrderedDict()
        self._new: set[Number] = set()  # numbers of this step
        self._ids: set[str] = set()
        self._refused: set[tuple[str, str | None]] = set()
        self._stops: list[tuple[float, Command]] = []  # those of the plant, without their ids
        self._latched: bool | None = False
        self._may_halt = False

    def breaches(self, step: BoardStep) -> Iterator[str]:
        if self._new:
            self._new.clear()
        if step.notices:
            self._may_halt |= any(isinstance(each, ForeignCommand) for each in step.notices)
        if step.orders or step.strangers or step.published:
            yield from self._passed(step)
        for report, fields in step.told:
            self._boot = report.boot_id
            if not self._names(report, fields):
                yield f"{report} names other commands than {fields}"

    def _passed(self, step: BoardStep) -> Iterator[str]:
        was_latched, orders = self._latched, list[Command]()
        self._hear_strangers(step)
        for command, plant in step.orders:
            if command.id not in self._ids:
                self._ids.add(command.id)
                yield from self._judge(command, plant, step, orders)
        self._hear_strangers(step)
        can_latch = not (was_latched is self._latched is False) or any(map(_latches, orders))
        yield from self._left(step, orders, can_latch=can_latch)

    def _hear_strangers(self, step: BoardStep) -> None:
        """Take in stops without an id, which may be copies."""
        for _, command in step.strangers:
            if isinstance(command, Stop) and command.mode is not StopMode.HALT:
                self._latched = self._latched if self._latched is (command.mode is StopMode.LATCH) else None

    def _judge(
        self, command: Command, plant: int | None, step: BoardStep, orders: list[Command]
    ) -> Iterator[str]:
        """Judge whether a command is refused; if not, it is one of the `orders` that have to leave."""
        is_old = not is_stop(command) and command.id.partition("-")[0] != str(plant or 0)
        if isinstance(command, Stop) and not is_old:
            self._stops = [*self._stops[-9:], (step.now, without_id(command))]
            if command.mode is not StopMode.HALT:
                self._latched = command.mode is StopMode.LATCH
        must, words = (True, {"old_epoch"}) if is_old else self._words_against(command, step)
        refused = {each.rejected: each.refusal for each in step.reports}
        if command.id not in refused:
            orders.append(command)
            if must:
                yield f"{command} had to be refused as {words}, and was not"
            return
        word = refused[command.id]
        self._refused.add((command.id, word))
        if word not in words:
            yield f"{command} was refused as {word}"
        if not any(self._tells(each, command, word) for each in step.notices):
            yield f"{command.id} was refused as {word}, and people are told {step.notices}"

    def _words_against(self, command: Command, step: BoardStep) -> tuple[bool, set[str]]:
        """True if a command must be refused, and the words that may be true of it."""
        if not step.was_up and not step.told:
            return True, {"no_link"}
        words = set() if step.is_surely_up and not step.late else {"no_link"}
        if isinstance(command, Stop) and not self._robot.has_stop:
            return True, words | {"no_stop"}
        if not self._is_within(command):
            return True, words | {"limite"}
        begins = isinstance(command, Motion) or (isinstance(command, SetEffector) and command.on)
        if begins and self._latched is not False:
            return self._latched is True, words | {"paro"}
        return False, words

    def _is_within(self, command: Command) -> bool:
        """True if the goal is within the robot's limits, which do not bind an arm's way up."""
        if not isinstance(command, MoveJoints) or not self._robot.joints:
            return True
        rows = zip(self._robot.joints, command.q, strict=True)
        return all(joint.lower - SLACK <= value <= joint.upper + SLACK for joint, value in rows)

    def _tells(self, notice: object, command: Command, word: str | None) -> bool:
        """True if people are told by this which robot refused a command, and why."""
        if not isinstance(notice, Rejection) or (notice.id, notice.reason) != (command.id, word):
            return False
        values = notice.sentence.values
        rightly = (values["robot"], values["word"]) == (self._robot.name, word)
        return rightly and str(values["why"]) not in ("", word)

    def _left(self, step: BoardStep, orders: list[Command], *, can_latch: bool) -> Iterator[str]:
        """Judge what left for the board: the orders, in their row, and what others or the bridge may send."""
        strangers = [command for _, command in step.strangers]
        booted = any(report.boot_id != self._boot for report, _ in step.told)
        can_latch &= booted or not step.was_up or step.is_stirred
        stops: set[str | None] = {each.id for each in orders if isinstance(each, Stop)}
        for each in step.published:
            if each.topic.endswith("/latido"):
                continue
            yield from self._number(each)
            names: frozenset[str | None] = NOBODY | stops if each.topic.endswith("/paro") else NOBODY
            stranger = next((one for one in strangers if self._is(one, each)), None)
            if orders and self._is(orders[0], each):
                id = orders.pop(0).id
                names = names if id in names else frozenset([id])
            elif stranger is not None:
                strangers.remove(stranger)
            elif not self._is_own(each, can_latch=can_latch):
                yield f"{self._robot.name} is sent {each.payload!r}, and not {orders[:1] or strangers}"
            self._keep(each, names)
        yield from (f"{command} should have left" for command in orders)
        if step.is_surely_up and self._robot.has_stop:
            copies = [command for at, command in self._stops if at + COPY_S > step.now]
            stops_of_others = [each for each in strangers if is_stop(each) and each not in copies]
            yield from (f"{command} of others should have left" for command in stops_of_others)

    def _number(self, publication: Publication) -> Iterator[str]:
        number = fields_of(publication.payload).get("seq")
        if self._by_ids and number != self._seq + 1:
            yield f"{publication.topic} has the number {number} after {self._seq}"
        self._seq = number or 0

    def _keep(self, publication: Publication, names: frozenset[str | None]) -> None:
        body = fields_of(publication.payload)
        number = (body.get("epoca"), body.get("seq"))
        self._commands[number] = names
        self._new.add(number)
        if len(self._commands) > KEPT:
            self._commands.popitem(last=False)

    def _is(self, command: Command, publication: Publication) -> bool:
        """True if this message is this command as it was given."""
        body = fields_of(publication.payload)
        if not publication.topic.endswith("/" + CHANNELS.get(type(command), "?")) or publication.qos < 1:
            return False
        if isinstance(command, SetEffector) and body.get("efector") != int(command.on):
            return False
        if isinstance(command, Stop) and body.get("paro") != command.mode.value:
            return False
        if not self._by_ids:
            return True
        seen = command.heard is None or body.get("visto") == command.heard
        return seen and body.get("ficha", command.token) == command.token

    def _is_own(self, publication: Publication, *, can_latch: bool) -> bool:
        """True for a halt, once for each reported foreign command, and the latch of a board that is back."""
        mode = fields_of(publication.payload).get("paro")
        if mode == StopMode.HALT.value and self._may_halt:
            self._may_halt = False
            return True
        return can_latch and mode == StopMode.LATCH.value

    def _names(self, report: Report, fields: Mapping[str, Any]) -> bool:
        """True if a report names the commands of the numbers that its telemetry names."""
        if not self._by_ids:
            return report.accepted is None and report.done is None
        epoch, rows = fields.get("epoca_ack"), ((report.accepted, "ack"), (report.done, "hecho"))
        for name, key in rows:
            number = epoch, fields.get(key)
            if name not in self._commands.get(number, NOBODY) and (name or number not in self._new):
                return False
        if report.rejected is None:
            return True
        word, refused = fields.get("rechazo"), (report.rejected, report.refusal)
        names = self._commands.get((epoch, fields.get("rechazo_seq")), NOBODY)
        if word == "viejo" or (report.rejected in names and word == report.refusal):
            self._refused.add(refused)
        return refused in self._refused


def _latches(command: Command) -> bool:
    return isinstance(command, Stop) and command.mode is StopMode.LATCH
