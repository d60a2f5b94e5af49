"""Rule of commands: the bridge sends each on, under the next number, or refuses it with the true word."""

from __future__ import annotations

import json
from collections import defaultdict

from arboleda.drivers import (
    Command,
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
from arboleda.wire.hop import is_stop
from arboleda.wire.rejections import Rejection
from arboleda.wire.transport import Publication

from .board_link import KnownLink
from .copies import KnownCopies
from .motions import KnownMotion
from .numbers import KnownNumbers

COMMANDS = "commands"
SLACK = 1e-6  # rad or m: rounding of a goal at its limit on the wire
CHANNELS = {
    MoveJoints: "juntas",
    FollowPath: "camino",
    SetEffector: "efector",
    Stop: "paro",
    Home: "referencia",
}


class PassedCommands:
    """Commands to one board, against what left for it.

    `orders` are those of this step, each with the word that refuses it, or "". `over` of them came before the
    link was lost, so that their motions have ended. `rejections`: of which people were told in this step.
    `may_halt`: the board obeyed a foreign command that the bridge may halt.
    """

    def __init__(
        self,
        robot: Robot,
        link: KnownLink,
        motion: KnownMotion,
        numbers: KnownNumbers,
        wrong: defaultdict[str, list[str]],
    ) -> None:
        self.orders: list[tuple[Command, str]] = []
        self.over = 0
        self.rejections: list[Rejection] = []
        self.may_halt = False
        self.copies = KnownCopies()
        self._robot = robot
        self._link, self._motion, self._numbers = link, motion, numbers
        self._wrong = wrong
        self._latched = self._was_latched = False  # now, and as the step began
        self._ids: set[str] = set()  # ids of commands

    @property
    def begins(self) -> bool:
        """True if a motion was given in this step."""
        return any(isinstance(command, Motion) for command, _ in self.orders)

    def take(self, command: Command, plant: int | None) -> None:
        """Take a command with an id; `plant` is the one that the bridge hears."""
        if command.id in self._ids:
            return
        if not is_stop(command) and command.id.partition("-")[0] != str(plant or 0):
            self.orders.append((command, "old_epoch"))
            return
        self._ids.add(command.id)
        self.orders.append((command, self._word_against(command)))

    def take_unnamed(self, at: float, command: Command, sender: str, *, is_alone: bool) -> None:
        """Take a command without an id: a copy is ignored, a stop obeyed, others if no plant is heard."""
        if self.copies.take(at, command, sender):
            return
        if (is_stop(command) or is_alone) and not self._word_against(command):
            self.orders.append((command, ""))

    def _word_against(self, command: Command) -> str:
        """The word that refuses a command for this board, or ""; even a refused stop is remembered."""
        self._latched = _latched_after(command, self._latched)
        if not self._link.up:
            return "no_link"
        if isinstance(command, Stop) and not self._robot.has_stop:
            return "no_stop"
        if not self._is_within(command):
            return "limite"
        grips = isinstance(command, SetEffector) and command.on
        return "paro" if self._latched and (isinstance(command, Motion) or grips) else ""

    def _is_within(self, command: Command) -> bool:
        """True if the goal is within the robot's limits, which do not bind an arm's way up."""
        if not isinstance(command, MoveJoints) or not self._robot.joints:
            return True
        rows = zip(self._robot.joints, command.q, strict=True)
        return all(joint.lower - SLACK <= value <= joint.upper + SLACK for joint, value in rows)

    def compare(
        self, reports: list[Report], published: list[Publication], *, returned: bool, late: bool
    ) -> None:
        """Compare what left in a step with the commands that came in it.

        `returned`: the board is back, so that its latch may be repeated. `late`: the bridge was away before.
        """
        left = [each for each in published if not each.topic.endswith("/latido")]
        refused = [(each.rejected, each.refusal) for each in reports] if self.orders else []
        halts = sum(
            isinstance(each, Stop) and each.mode is StopMode.HALT for each, word in self.orders if not word
        )
        own = sum(map(_halts, left)) > halts
        latched, self._was_latched = self._was_latched, self._latched
        for place, (command, word) in enumerate(self.orders):
            held, latched = latched, _latched_after(command, latched)
            if word:
                self._check_refusal(command, word, refused)
                continue
            if late and (command.id, "no_link") in refused:  # after a time away it distrusts its link
                self._numbers.refused.add((command.id, "no_link"))
                continue
            if own and _halts(left[0]):
                own = False
                self._take_own_halt(left.pop(0), place)
            is_latch = isinstance(command, Stop) and command.mode is StopMode.LATCH
            while returned and held and not is_latch and left and _latches(left[0]):
                self._number("", left.pop(0), place)  # its latch again, before this command
            publication = left.pop(0) if left else None
            is_it = publication is not None and publication.topic.endswith("/" + CHANNELS[type(command)])
            if publication is None or not is_it:
                self._breach(f"{command} should have left; what left is {publication}")
                return
            self._check_body(command, publication, place)
        for publication in left:
            if own and _halts(publication):
                own = False
                self._take_own_halt(publication, len(self.orders))
            elif returned and self._latched and _latches(publication):
                self._number("", publication, len(self.orders))
            else:
                name = self._robot.name
                self._breach(f"{name} is sent {publication.payload!r}, which nobody commanded")

    def _check_refusal(
        self, command: Command, word: str, refused: list[tuple[str | None, str | None]]
    ) -> None:
        """Check that a command is refused, and that people are told which robot refused it, and why."""
        self._numbers.refused.add((command.id, word))
        if (command.id, word) not in refused:
            self._breach(f"{command} had to be refused as {word}, and was not")
        wanted = (command.id, word, self._robot.name, word)
        for each in self.rejections:
            values = each.sentence.values
            if (each.id, each.reason, values["robot"], values["word"]) == wanted:
                if str(values["why"]) in ("", word):
                    self._breach(f"{command.id} was refused without a reason: {each.sentence}")
                return
        self._breach(f"{command.id} was refused as {word}, and people are told {self.rejections}")

    def _check_body(self, command: Command, publication: Publication, place: int) -> None:
        body = json.loads(publication.payload)
        if isinstance(command, SetEffector) and body.get("efector") != int(command.on):
            self._breach(f"{command} left as {body}")
        if isinstance(command, Stop) and body.get("paro") != command.mode.value:
            self._breach(f"{command} left as {body}")
        if self._numbers.are_used and command.heard is not None and body.get("visto") != command.heard:
            self._breach(f"{command} left as {body}, which names other telemetry than the plant did")
        if self._numbers.are_used and body.get("ficha", command.token) != command.token:
            self._breach(f"{command} left as {body}, which carries another token")
        if publication.qos < 1:
            self._breach(f"{command} left with QoS {publication.qos}")
        self._number(command.id, publication, place)
        if isinstance(command, Motion) and place >= self.over:
            self._motion.begin((body["epoca"], self._numbers.last) if self._numbers.are_used else None)
        elif is_stop(command):
            self._motion.halt()
        elif isinstance(command, Stop):
            self._motion.number = None

    def _take_own_halt(self, publication: Publication, place: int) -> None:
        """Take in a halt by the bridge itself, allowed once for each reported foreign command."""
        if not self.may_halt:
            self._breach(f"{self._robot.name} is halted, which nobody commanded")
        self.may_halt = False
        self._motion.halt()
        self._number("", publication, place)

    def _number(self, command_id: str, publication: Publication, place: int) -> None:
        wrong = self._numbers.give(command_id, publication, place)
        if wrong:
            self._breach(wrong)
            self._motion.number = None

    def _breach(self, sentence: str) -> None:
        self._wrong[COMMANDS].append(sentence)


def _latched_after(command: Command, latched: bool) -> bool:
    """True if a stop is latched after a command; `latched`: one was before."""
    if isinstance(command, Stop) and command.mode is not StopMode.HALT:
        return command.mode is StopMode.LATCH
    return latched


def _halts(publication: Publication) -> bool:
    return publication.topic.endswith("/paro") and b'"paro":2' in publication.payload


def _latches(publication: Publication) -> bool:
    return publication.topic.endswith("/paro") and b'"paro":1' in publication.payload
