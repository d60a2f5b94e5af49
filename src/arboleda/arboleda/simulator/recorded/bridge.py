"""Rules of the bridge, written down once more without its short cuts, and checked board by board.

The bridge's own memory is not read. `Bridges.wrong` has the sentences on each breach, by the rule's name.
"""

from __future__ import annotations

import json
import math
from collections import OrderedDict, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cache
from typing import Any

from arboleda.dispatch.belief import Belief
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command, Home, Motion, Stop, StopMode
from arboleda.model.messages import Heartbeat, Report
from arboleda.model.plant_model import Evidence, Link, MotionState, PlantModel, Robot
from arboleda.wire import rejections
from arboleda.wire.hop import FromPlant
from arboleda.wire.rejections import FOREIGN, ForeignCommand, Rejection
from arboleda.wire.transport import Connection, Delivery, Publication

from ..world import BridgeStep
from .boards import fields, parts

EXACT = 1e-9
YEAR_2100, AHEAD_S = 4_102_444_800, 366 * 86_400  # Unix time; how far ahead another machine's clock may be
MOVING = MotionState.MOVING.value
LINGER_S = 1.0  # how long a board that names no command must report standing still
PLANT_GONE_S = 5.0  # after its last heartbeat the bridge obeys whoever commands
COPIES_S, EARLY_S = 5.0, 0.2  # how late after its original, and how early before it a copy may come
SLACK = 1e-6  # rad or m: rounding of a goal at its limit on the wire
FOREIGN_TO_ARMS, FOREIGN_TO_MOBILES = ("nodo",), ("efector", "pieza", "q1_mov")
KEPT = 200  # numbers of a board, fewer than the bridge remembers
REPORTS, COMMANDS, BEATS = "reports", "commands", "beats"
CHANNELS = {
    MoveJoints: "juntas",
    FollowPath: "camino",
    SetEffector: "efector",
    Stop: "paro",
    Home: "referencia",
}


class Bridges:
    """Follows every bridge of the plant.

    Of the last pass in which a bridge did something: `wrong` are the breaches, rule -> sentences; `of_others`
    are the commands without an id that it took in, and so obeys, while it heard no plant.
    """

    def __init__(self, model: PlantModel) -> None:
        self.wrong: defaultdict[str, list[str]] = defaultdict(list)
        self.of_others: list[Command] = []
        self._model = model
        self._bridge: Any = None
        self._known: _Bridge | None = None

    def take_over(self, bridge: Any, now: float, beliefs: Mapping[str, Belief]) -> None:
        """Take over the plant's beliefs, this once: of a bridge that ran before this record began."""
        self._bridge, self._known = bridge, _Bridge(self._model, self.wrong)
        self._known.take_over(now, beliefs)

    def look(self, passed: Iterable[BridgeStep]) -> None:
        self.wrong.clear()
        self.of_others.clear()
        for each in passed:
            if each.bridge is not self._bridge:
                self._bridge, self._known = each.bridge, _Bridge(self._model, self.wrong)
            if self._known is not None:
                self._known.take(each)
                self.of_others += self._known.of_others


class _Bridge:
    """One start of the bridge."""

    def __init__(self, model: PlantModel, wrong: defaultdict[str, list[str]]) -> None:
        reached = [robot for robot in model.robots.values() if robot.link is Link.MQTT]
        robots = [robot for robot in reached if robot.goes]
        self._wrong = wrong
        self._boards = {robot.name: _Board(robot, model.timing.stale_after_s, wrong) for robot in robots}
        self._rows = [(name, board.robot.mqtt, board) for name, board in self._boards.items()]
        self._by_topic = {
            f"{robot.mqtt}/{channel}": (robot.name, self._boards[robot.name], channel)
            for robot in robots
            for channel in ("sensores", "conexion")
        }
        self._plant: int | None = None  # whose heartbeat it hears
        self._patience_s = model.timing.stale_after_s
        self._beat_at = -math.inf
        self.of_others: list[Command] = []

    def take_over(self, now: float, beliefs: Mapping[str, Belief]) -> None:
        self._beat_at = now
        for name, board in self._boards.items():
            board.take_over(now, beliefs[name])
            self._plant = beliefs[name].plant

    def take(self, passed: BridgeStep) -> None:
        reports: defaultdict[str, list[Report]] = defaultdict(list)
        published: defaultdict[str, list[Publication]] = defaultdict(list)
        for message in passed.out:
            if isinstance(message, Report):
                reports[message.robot].append(message)
            elif isinstance(message, Publication):
                published[message.topic.partition("/")[0]].append(message)
            elif isinstance(message, Rejection | ForeignCommand):
                self._told(message, self._boards.get(message.robot))
        self.of_others.clear()
        late = False
        now = passed.now
        for event in passed.events:
            late = late or event.at < now
            if not isinstance(event, Delivery):
                self._event(event, now)
            elif event.topic in self._by_topic:
                name, board, channel = self._by_topic[event.topic]
                if board.repeats and board.hear_again(event, now, reports[name]):
                    del reports[name]
                else:
                    board.deliver(event, channel)
        for name, mqtt, board in self._rows:
            if board.touched or name in reports or mqtt in published or board.silent_at <= now:
                board.end_step(now, reports[name], published[mqtt], late=late)

    def _told(self, message: Rejection | ForeignCommand, board: _Board | None) -> None:
        if board is not None and isinstance(message, Rejection):
            board.reject(message)
        elif board is not None:
            board.obey_foreign(taken=message.sentence.key == rejections.TAKEN.key)

    def _event(self, event: Any, now: float) -> None:
        if isinstance(event, Connection):
            for board in self._boards.values():
                board.connect(event.up)
        elif isinstance(event, FromPlant) and isinstance(event.message, Heartbeat):
            self._beat(event.at, event.message.epoch, event.unix_s)
        elif isinstance(event, FromPlant):
            self._command(event, now, self._boards.get(event.message.robot))

    def _command(self, event: FromPlant, now: float, board: _Board | None) -> None:
        if not event.message.id:
            is_alone = event.at >= self._beat_at + PLANT_GONE_S and now - event.at <= self._patience_s
            self.of_others += [event.message] if is_alone else []
            if board is not None:
                board.hear_others(event.at, event.message, is_alone=is_alone)
        elif board is not None:
            if event.copied:
                board.expect_copy(event.at, event.message)
            board.command(event.message, self._plant)

    def _beat(self, at: float, epoch: int, unix_s: int | None) -> None:
        if epoch > (YEAR_2100 if unix_s is None else unix_s + AHEAD_S):
            return
        if self._plant is None or epoch >= self._plant:
            self._plant, self._beat_at = epoch, at
            for board in self._boards.values():
                board.hear_plant(epoch)


class _Board:
    """One board as the bridge should see it."""

    def __init__(self, robot: Robot, stale_after_s: float, wrong: defaultdict[str, list[str]]) -> None:
        self.robot = robot
        self._wrong = wrong
        self._by_ids = robot.evidence is Evidence.IDS
        self._patience_s = math.inf if robot.evidence is Evidence.STATE else stale_after_s
        self._connected = self._absent = self._up = False
        self._heard_at = -math.inf
        self.silent_at = math.inf  # when its silence has lasted too long, while there is a link to lose
        self._number: int | None = None
        self._boot: int | None = None
        self._least = self._least_before = -1  # the oldest epoca that the board obeys: now, and a step before
        self._returns = 0
        self._plant: int | None = None
        self._plant_before: int | None = None  # after the step before; beats may come between reports
        self._latched = False
        self._ids: OrderedDict[tuple[int, int], str] = OrderedDict()  # (epoca, seq) -> command
        self._given: dict[tuple[int, int], int] = {}  # number -> its place in `_orders`, in this step
        self._seq = 0
        self._seen: set[str] = set()
        self._refused: set[tuple[str, str]] = set()
        self._words: tuple[Any, ...] = ()  # of the last telemetry: its bytes without the number, the report
        self._telling: list[tuple[Delivery, int]] = []  # telemetry, number of orders before it in this step
        self._maybe: list[tuple[Delivery, int]] = []
        self._copies: list[tuple[float, Command]] = []  # expected copies of the plant's commands
        self._early: list[tuple[float, Command]] = []  # commands without an id whose original may still come
        self._orders: list[tuple[Command, str]] = []  # command, and the word that refuses it, or ""
        self._over = 0  # orders that came before the link was lost: their motions have ended
        self._fell = self._rose = False
        self.touched = True  # in this step
        self.repeats = False  # it stands still, and all that it says and that is reported of it is as it was
        self._late = False
        # the last telemetry as it was read: its bytes before its number, if it has one, after it, its fields
        self._parsed: tuple[bytes, bool, bytes, dict[str, Any]] | None = None
        self._was_down = True  # the link after the step before, or as a new bridge reports it
        self._rejections: list[Rejection] = []  # the bridge's rejections for it in this step
        self._foreign = (0, 0)  # commands of others that were refused, and obeyed, as people were told
        self._is_foreign_new = False  # there was a foreign command in this step
        self._may_halt = False  # the board obeyed a foreign command that the bridge may halt
        self._heard_beat = False  # in this step
        self._is_new_plant = False  # a plant is heard, and was not before this step
        self._newest: tuple[int, int] | None = None  # (epoca, seq) of the last motion
        self._motion: int | None = None  # number of a motion that surely has not ended
        self._may_move = False  # a motion may be open
        self._is_taken_over = False  # it was taken over, so its first reports are not known
        self._had_ended = False  # no motion was open after the step before
        self._moved = False  # the board has reported moving since the last motion, or a stop followed it
        self._still_since: float | None = None  # it reports standing still since then

    def take_over(self, now: float, belief: Belief) -> None:
        self._connected, self._plant, self._boot = True, belief.plant, belief.boot_id
        self._plant_before = belief.plant
        self._up, self._heard_at = belief.heard_at is not None, now
        self.silent_at = now + self._patience_s if self._up else math.inf
        self._was_down, self._is_taken_over = not self._up, True

    def connect(self, up: bool) -> None:
        self.touched = True
        self._connected, self._absent = up, False
        if not up:
            self._lose()

    def reject(self, told: Rejection) -> None:
        """Expect that people are told of a refused command."""
        self._rejections.append(told)
        self.touched = True
        if told.reason == FOREIGN:
            self._foreign, self._is_foreign_new = (self._foreign[0] + 1, self._foreign[1]), True

    def obey_foreign(self, *, taken: bool) -> None:
        """Expect that people are told of an obeyed foreign command; `taken`: it may be halted for it."""
        self._may_halt |= taken
        self._foreign, self._is_foreign_new = (self._foreign[0], self._foreign[1] + 1), True
        self.touched = True

    def hear_plant(self, epoch: int) -> None:
        self._is_new_plant |= epoch != self._plant
        self._plant = epoch
        self._heard_beat = True
        self.touched |= self._motion is not None

    def hear_again(self, delivery: Delivery, now: float, reports: list[Report]) -> bool:
        """Take in the one message of a step, if it only says the last one again, and so does the one report.

        False for anything else, which is to be compared as a whole.
        """
        if self.touched or self._is_new_plant or delivery.retain or len(reports) != 1:
            return False
        (report,), (before, number, after) = reports, parts(delivery.payload)
        words = (before, after) == self._words[:2] and report.words == self._words[2].words
        if not words or report.at != delivery.at or delivery.at + self._patience_s <= now:
            return False
        if number:
            if self._number is None or int(number) <= self._number:
                return False
            self._number = int(number)
        self._heard_at, self._heard_beat = delivery.at, False
        self.silent_at = delivery.at + self._patience_s
        self._words = (before, after, report)
        return True

    def deliver(self, delivery: Delivery, channel: str) -> None:
        self.touched = True
        if channel == "conexion":
            self._presence(delivery.payload)
        elif not delivery.retain and self._connected and not self._absent:
            self._telemetry(delivery)

    def _presence(self, payload: bytes) -> None:
        if payload in (b"0", b"1"):
            self._returns += self._absent and payload == b"1"
            self._absent = payload == b"0"
            if self._absent:
                self._lose()
            elif self._up:
                self._rose = True

    def _telemetry(self, delivery: Delivery) -> None:
        said = self._fields(delivery.payload)
        if said is None:
            return
        if self._motion in (said.get("hecho"), said.get("rechazo_seq")):
            self._motion = None
        number, boot = said.get("seq"), said.get("arranque")
        same = boot is not None and boot == self._boot
        if same and number is not None and self._number is not None and number <= self._number:
            if self._up:
                return
            # a counter that began anew counts again after some time
            self._maybe.append((delivery, len(self._orders)))
            return
        self._rose |= not self._up or (boot is not None and self._boot is not None and boot != self._boot)
        self._take(delivery, said)

    def _fields(self, payload: bytes) -> dict[str, Any] | None:
        """The fields of telemetry; if only its number differs from the last one, it is not decoded again."""
        before, number, after = parts(payload)
        last = self._parsed
        if last is not None and last[:3] == (before, number != b"", after):
            if number:
                last[3]["seq"] = int(number)
            return last[3]
        said = _read(payload, self.robot)
        if said is not None and payload.count(b'"seq"') <= 1:
            self._parsed = (before, number != b"", after, said)
        return said

    def _take(self, delivery: Delivery, said: dict[str, Any]) -> None:
        if self._may_move:
            self._follow_motion(delivery.at, said)
        self._up, self._heard_at = True, delivery.at
        self.silent_at = delivery.at + self._patience_s
        self._number = said.get("seq")
        self._boot = said.get("arranque", self._boot)
        self._least = max(said.get("epoca_ack", -1), said.get("epoca_min", -1))
        self._telling.append((delivery, len(self._orders)))

    def _follow_motion(self, at: float, said: dict[str, Any]) -> None:
        boot = said.get("arranque", self._boot)
        if None not in (boot, self._boot) and boot != self._boot:
            self._motion, self._may_move = None, False
        if self._by_ids and self._newest == (said.get("epoca_ack"), said.get("hecho")):
            self._may_move = False
        if said["estado"] == MOVING:
            self._moved, self._still_since = True, None
        elif self._moved and self._still_since is None:
            self._still_since = at

    def expect_copy(self, at: float, command: Command) -> None:
        plain = replace(command, id="", heard=None, token=None)
        early = next((each for each in self._early if each[1] == plain), None)
        if early is None:
            self._copies.append((at, plain))
        else:
            self._early.remove(early)

    def hear_others(self, at: float, command: Command, *, is_alone: bool) -> None:
        """Take in a command without an id: a copy is ignored, a stop obeyed, others if no plant is heard."""
        self.touched = True
        self._copies = [each for each in self._copies if each[0] + COPIES_S > at]
        copy = next((each for each in self._copies if each[1] == command), None)
        if copy is not None:
            self._copies.remove(copy)
            return
        self._early.append((at, command))
        stops = isinstance(command, Stop) and command.mode is not StopMode.CLEAR
        if (stops or is_alone) and not self._word_against(command):
            self._orders.append((command, ""))

    def command(self, command: Command, plant: int | None) -> None:
        self.touched = True
        if command.id in self._seen:
            return
        halts = isinstance(command, Stop) and command.mode is not StopMode.CLEAR
        if not halts and command.id.partition("-")[0] != str(plant or 0):
            self._orders.append((command, "old_epoch"))
            return
        self._seen.add(command.id)
        self._orders.append((command, self._word_against(command)))

    def _word_against(self, command: Command) -> str:
        """The word that refuses a command for this board, or ""; even a refused stop is remembered."""
        if isinstance(command, Stop) and command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
        if not self._up:
            return "no_link"
        if isinstance(command, Stop) and not self.robot.has_stop:
            return "no_stop"
        if not self._is_within(command):
            return "limite"
        grips = isinstance(command, SetEffector) and command.on
        return "paro" if self._latched and (isinstance(command, Motion) or grips) else ""

    def _is_within(self, command: Command) -> bool:
        """True if the goal is within the robot's limits, which do not bind an arm's way up."""
        if not isinstance(command, MoveJoints) or not self.robot.joints:
            return True
        rows = zip(self.robot.joints, command.q, strict=True)
        return all(joint.lower - SLACK <= value <= joint.upper + SLACK for joint, value in rows)

    def _lose(self) -> None:
        self._fell |= self._up
        self._up, self.silent_at = False, math.inf
        self._motion, self._may_move, self._over = None, False, len(self._orders)

    def end_step(
        self, now: float, reports: list[Report], published: list[Publication], *, late: bool
    ) -> None:
        """Compare all that this step should have brought with what it brought; `late`: it was away before."""
        self._late = late
        if self.silent_at <= now:
            self._lose()
        self._compare_beats(published)
        if self._orders or published:
            self._compare_orders(reports, published)
        if reports or self._telling or self._fell:
            self._compare_reports(reports)
        counted = bool(self._telling and reports) and not (self._is_new_plant or self._is_foreign_new)
        if counted:
            last = reports[-1]
            if last.foreign is not None or last.foreign_refused or last.foreign_obeyed or any(self._foreign):
                self._compare_foreign(last)
        if self._heard_at + self._patience_s <= now:
            self._up, self.silent_at = False, math.inf  # what counted only in hindsight may be too old by now
        if self._given and self._words:
            self._words = (None, None, self._words[2])  # the same bytes may name a command by now
        self._telling, self._maybe, self._orders, self._given, self._over = [], [], [], {}, 0
        if self._rejections or self._is_foreign_new:
            self._rejections, self._is_foreign_new = [], False
        self._was_down = not self._up
        if self._early:
            self._early = [each for each in self._early if each[0] + EARLY_S > now]
        self.touched = bool(self._early)
        self.repeats = counted and self._up and self._motion is None and self._had_ended
        self._fell = self._rose = self._heard_beat = self._is_new_plant = False
        self._plant_before, self._least_before = self._plant, self._least

    def _compare_foreign(self, report: Report) -> None:
        said = (report.foreign_refused or 0, report.foreign_obeyed or 0)
        if said != self._foreign or (report.foreign is None) is any(said):
            self._say(
                REPORTS, f"{said} commands of others are counted ({report.foreign}), of {self._foreign}"
            )

    def _compare_beats(self, published: list[Publication]) -> None:
        """Check the beats: a board that may move gets them; one whose motion has ended need not."""
        ended = not self._may_move
        if self._still_since is not None and not self._by_ids:
            ended |= self._heard_at >= self._still_since + LINGER_S + EXACT
        before, self._had_ended = self._had_ended, ended
        if not (published or self._heard_beat):
            return
        beats = bool(published) and any(each.topic.endswith("/latido") for each in published)
        needless = beats and not any(self._fences(each) for each in published)
        if needless and ended and before and not any(isinstance(each, Motion) for each, _ in self._orders):
            self._say(BEATS, f"{self.robot.name} is told that somebody is there, and need not move")
        if self._heard_beat and self._motion is not None and not beats and not self._late:
            self._say(BEATS, f"{self.robot.name} moves, and is not told that somebody is there")

    def _fences(self, publication: Publication) -> bool:
        """True for a beat that fences older epochs off, which the board has not confirmed yet."""
        if not self._by_ids or not publication.topic.endswith("/latido"):
            return False
        return fields(publication.payload).get("epoca", -1) > min(self._least, self._least_before)

    def _compare_orders(self, reports: list[Report], published: list[Publication]) -> None:
        orders = [each for each in published if not each.topic.endswith("/latido")]
        name = self.robot.name
        asked = sum(
            isinstance(each, Stop) and each.mode is StopMode.HALT for each, word in self._orders if not word
        )
        own = sum(map(_halts, orders)) > asked
        for place, (command, word) in enumerate(self._orders):
            if word:
                self._refused.add((command.id, word))
                if (command.id, word) not in [(each.rejected, each.refusal) for each in reports]:
                    self._say(COMMANDS, f"{command} had to be refused as {word}, and was not")
                self._check_told(command.id, word)
                continue
            if (command.id, "no_link") in [(each.rejected, each.refusal) for each in reports] and self._late:
                self._refused.add((command.id, "no_link"))  # a bridge that was away does not trust its link
                continue
            if own and _halts(orders[0]):
                own = False
                self._halt_by_itself(orders.pop(0), place)
            publication = orders.pop(0) if orders else None
            is_it = publication is not None and publication.topic.endswith("/" + CHANNELS[type(command)])
            if publication is None or not is_it:
                self._say(COMMANDS, f"{command} should have left; what left is {publication}")
                return
            self._check_body(command, publication, place)
        for publication in orders:
            if own and _halts(publication):
                own = False
                self._halt_by_itself(publication, len(self._orders))
                continue
            again = publication.topic.endswith("/paro") and b'"paro":1' in publication.payload
            if again and self._latched and (self._rose or self._is_heard_again(reports)):
                self._number_of("", publication, len(self._orders))
            else:
                self._say(COMMANDS, f"{name} is sent {publication.payload!r}, which nobody commanded")

    def _halt_by_itself(self, publication: Publication, place: int) -> None:
        """Take in a halt by the bridge itself, allowed once for each reported foreign command."""
        if not self._may_halt:
            self._say(COMMANDS, f"{self.robot.name} is halted, which nobody commanded")
        self._may_halt = False
        self._motion, self._moved = None, True
        self._number_of("", publication, place)

    def _is_heard_again(self, reports: list[Report]) -> bool:
        """True if a lost board is reported by telemetry that counts only in hindsight."""
        return any(report.at == delivery.at for delivery, _ in self._maybe for report in reports)

    def _check_body(self, command: Command, publication: Publication, place: int) -> None:
        body = json.loads(publication.payload)
        if isinstance(command, SetEffector) and body.get("efector") != int(command.on):
            self._say(COMMANDS, f"{command} left as {body}")
        if isinstance(command, Stop) and body.get("paro") != command.mode.value:
            self._say(COMMANDS, f"{command} left as {body}")
        if command.heard is not None and self._by_ids and body.get("visto") != command.heard:
            self._say(COMMANDS, f"{command} left as {body}, which names other telemetry than the plant did")
        if self._by_ids and body.get("ficha", command.token) != command.token:
            self._say(COMMANDS, f"{command} left as {body}, which carries another token")
        if publication.qos < 1:
            self._say(COMMANDS, f"{command} left with QoS {publication.qos}")
        self._number_of(command.id, publication, place)
        if isinstance(command, Motion) and place >= self._over:
            self._may_move, self._moved, self._still_since = True, False, None
            self._had_ended = False
            self._motion, self._newest = (
                (self._seq, (body["epoca"], self._seq)) if self._by_ids else (None, None)
            )
        elif isinstance(command, Stop):
            self._motion, self._moved = None, self._moved or command.mode is not StopMode.CLEAR

    def _check_told(self, id: str, word: str) -> None:
        """Check that people are told which robot refused the command, and why in words."""
        for each in self._rejections:
            said = each.sentence.values
            if (each.id, each.reason, said["robot"], said["word"]) == (id, word, self.robot.name, word):
                if str(said["why"]) in ("", word):
                    self._say(COMMANDS, f"{id} was refused without a reason: {each.sentence}")
                return
        self._say(COMMANDS, f"{id} was refused as {word}, and people are told {self._rejections}")

    def _number_of(self, id: str, publication: Publication, place: int) -> None:
        if not self._by_ids:
            return
        body = json.loads(publication.payload)
        number = (body.get("epoca"), body.get("seq"))
        self._seq += 1
        if number[1] != self._seq:
            self._say(COMMANDS, f"{publication.topic} has the number {number[1]} after {self._seq - 1}")
            self._motion = None
        self._ids[number], self._given[number] = id, place
        if len(self._ids) > KEPT:
            self._ids.popitem(last=False)

    def _compare_reports(self, reports: list[Report]) -> None:
        name, told, lost = self.robot.name, [], []
        for each in reports:
            if each.state is MotionState.NO_LINK:
                lost.append(each)
            elif each.state is not None:
                told.append(each)
        if self._fell and not lost:
            self._say(REPORTS, f"the link to {name} was lost, and nobody was told")
        if lost and self._up and not (self._fell or self._was_down):
            self._say(REPORTS, f"{name} is reported lost, and is there")
        before = [self._words[2] if self._words else None, *told]
        rest = list(zip(before, told, strict=False))
        for delivery, place in self._telling:
            for pair in rest:
                if self._says(pair[1], delivery, place):
                    rest.remove(pair)
                    break
            else:
                self._say(REPORTS, f"{delivery.payload!r} of {name} is not reported as it is: {told}")
                return
        for last, report in rest:
            if not self._is_known(report, last):
                self._say(REPORTS, f"{name} is reported with what it has not said: {report}")

    def _is_known(self, report: Report, last: Report | None) -> bool:
        """True if an unexpected report is right: a repetition for a new plant, or what may count."""
        counted = next((each for each, place in self._maybe if self._says(report, each, place)), None)
        if counted is not None:
            self._take(counted, _read(counted.payload, self.robot) or {})
            self._telling = []
            return True
        if last is None:
            return self._is_new_plant and self._is_taken_over
        return self._is_new_plant and _content(report) == _content(last)

    def _says(self, report: Report, delivery: Delivery, place: int) -> bool:
        """True if a report says what this telemetry says, which came after `place` orders of this step."""
        if report.at != delivery.at or report.plant not in (self._plant, self._plant_before):
            return False
        before, _, after = parts(delivery.payload)
        alike = self._words and not self._given and (before, after) == self._words[:2]
        if alike and report.words == self._words[2].words:
            self._words = (before, after, report)
            return True
        said = self._fields(delivery.payload)
        if said is None or not _agree(report, said, self.robot) or not self._names(report, said, place):
            return False
        self._words = (before, after, report)
        return True

    def _names(self, report: Report, said: dict[str, Any], place: int) -> bool:
        """True if a report names the commands of the board's numbers, and none without a number."""
        if not self._by_ids:
            return report.accepted is None and report.done is None
        epoch, named = said.get("epoca_ack"), []
        for key in ("ack", "hecho", "rechazo_seq"):
            number = (epoch, said.get(key))
            named.append(self._ids.get(number) if self._given.get(number, -1) < place else None)
        accepted, done, rejected = named
        if report.accepted != (accepted or None) or report.done != (done or None):
            return False
        if report.rejected is None:
            return True
        by_board = rejected == report.rejected
        by_board = by_board and said.get("rechazo") == report.refusal
        if by_board or said.get("rechazo") == "viejo":
            self._refused.add((report.rejected, report.refusal or ""))
        return (report.rejected, report.refusal) in self._refused

    def _say(self, rule: str, sentence: str) -> None:
        self._wrong[rule].append(sentence)


def _halts(publication: Publication) -> bool:
    return publication.topic.endswith("/paro") and b'"paro":2' in publication.payload


def _content(report: Report) -> tuple[Any, ...]:
    return (report.state, report.q, report.node, report.homed, report.effector, report.piece, report.boot_id)


def _read(payload: bytes, robot: Robot) -> dict[str, Any] | None:
    """The fields of telemetry; None if it is to be refused, for the reasons that occur in simulations."""
    try:
        said = json.loads(payload)
    except ValueError:
        return None
    place = _place_keys(len(robot.joints))
    if not isinstance(said, dict) or len(payload) > 512 or not said.keys() >= place:
        return None
    if not said.keys().isdisjoint(FOREIGN_TO_ARMS if robot.joints else FOREIGN_TO_MOBILES):
        return None
    if robot.floor_grid and not 0 <= said["nodo"] < robot.grid.size:
        return None
    for key in place:
        if type(said[key]) not in (int, float) or not math.isfinite(said[key]):
            return None
    return said if type(said.get("estado")) is int and 0 <= said["estado"] <= 4 else None


@cache
def _place_keys(joints: int) -> frozenset[str]:
    return frozenset(f"q{number}_mov" for number in range(1, joints + 1)) if joints else frozenset({"nodo"})


def _agree(report: Report, said: dict[str, Any], robot: Robot) -> bool:
    for flag, key in ((report.homed, "ref"), (report.effector, "efector"), (report.piece, "pieza")):
        if flag != (None if key not in said else said[key] == 1):
            return False
    if report.state is None or report.state != said["estado"]:
        return False
    if not robot.joints:
        return report.node == said["nodo"] and report.q is None
    if report.q is None or report.node is not None:
        return False
    for number, (joint, value) in enumerate(zip(robot.joints, report.q, strict=True), start=1):
        told = math.radians(said[f"q{number}_mov"]) * (joint.pinion_radius_m or 1.0)
        if not abs(value - told) < EXACT:
            return False
    return True
