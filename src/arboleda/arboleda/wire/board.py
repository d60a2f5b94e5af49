"""State machine of one board: commands to the board, its telemetry, its stop latch.

- Nothing is sent again after a lost link, as it may be wrong by then. Only a latched stop is: a board that
  comes back may have forgotten it.
- Most telemetry repeats the last, and is known by its bytes without being read (`_again`). `_words` is None
  once the same bytes would mean something else, as after a command or a refusal: then the next message is
  read whole.
- A heartbeat precedes each motion, since a board that hears none stops by itself.
"""

from __future__ import annotations

from functools import lru_cache

from arboleda.model import refusals
from arboleda.model.commands import Command, Stop, StopMode, Work, needs_clear
from arboleda.model.errors import PayloadError
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Evidence, Robot
from arboleda.model.sentence import Phrase, Sentence

from . import rejections
from .board_reports import BoardReports
from .copies import Copies
from .forms import MessageForm, form_of
from .hop import is_stop, shown
from .labels import Labels
from .link import BoardLink, LinkUpdate
from .motion import OpenMotion
from .payloads import Beat, Payload, Presence, Telemetry, decode, encode, read_angles
from .rejections import ForeignCommand, Rejection
from .repeats import SplitTelemetry
from .rivals import News, Rivals
from .topics import Channel, topic
from .transport import Delivery, Publication
from .units import from_wire

Message = Publication | Report | Rejection | ForeignCommand
UNREADABLE = Phrase("message.unreadable", "{topic}: {why}")
ABSENT = Phrase("message.absent", "telemetry of a board whose conexion is 0")
DENIED = Phrase(
    "link.denied",
    "its board talks, but its `conexion` says 0; "
    "the board has to publish 1 there, retained, when it connects",
)
TWINS = Phrase(
    "link.twins",
    "two boards call themselves {board}, as their boot numbers alternate; "
    "give one of them another name, or switch it off",
)
AGAIN_S = 0.1  # least time between two reports in a burst of foreign commands


class Board:
    """Takes commands and telemetry of one board, and gives publications and reports.

    A command needs a link to the board, and a motion no latched stop.
    """

    def __init__(self, robot: Robot, *, epoch: int, stale_after_s: float, has_lease: bool = False) -> None:
        supervised = robot.evidence is not Evidence.STATE
        self.robot = robot
        self.labels = Labels(epoch)
        self.link = BoardLink(stale_after_s if supervised else None)
        self.rivals = Rivals(has_lease=has_lease)
        self.copies = Copies()
        self.reports = BoardReports(robot, self.labels, self.link)
        self._foreign_reported_at = 0.0
        self._last: Report | None = None
        self._words: SplitTelemetry | None = (
            None  # of the last telemetry, until a command changes what it means
        )
        self._form = form_of(robot)
        self._axes = self._form.joints
        self._motion: OpenMotion | None = None
        self._latched = False
        self._warned: Sentence | None = None  # the last reported reason why the board ignores a command

    @property
    def in_motion(self) -> bool:
        """True while a motion or a process is open."""
        return self._motion is not None

    def connection(self, at: float, up: bool) -> list[Message]:
        self.link.connection(up)
        return [] if up else self.lose(at)

    def lose(self, at: float) -> list[Message]:
        """Lose the link and all open work, of which nothing is sent again."""
        self._motion = None
        self.rivals.lose()
        return [self.reports.no_link(at)] if self.link.lose() else []

    def command(self, at: float, command: Command, sender: str = "") -> list[Message]:
        """Send a command, or report the word that refuses it; a repeated id is ignored."""
        if self.labels.repeated(command.id):
            return []
        if isinstance(command, Stop) and command.mode is not StopMode.HALT:
            self._latched = command.mode is StopMode.LATCH
        word = self._refusal(command)
        if word:
            return self.refuse(at, command, word, sender)
        goes_on = self.in_motion and not isinstance(command, Work | Stop)  # these end the motion
        self.rivals.answer(at, self.labels, in_motion=goes_on)
        return [*self._passed_over(at, command), *self._send(at, command, sender)]

    def _passed_over(self, at: float, command: Command) -> list[Message]:
        """The notice that a board without ids will silently ignore a command; once for each reason."""
        last = self._last
        if last is None or self.robot.evidence is Evidence.IDS or not isinstance(command, Work):
            return []
        form = self._form.form_of_command(type(command))
        if form is None:
            return []
        rests = self._motion is None and last.state is MotionState.STOPPED
        why = form.passed_over(self.robot, command, last) if rests else None
        warned_before, self._warned = self._warned, why
        if why is None or why == warned_before:
            return []
        sentence = rejections.passed_over(self.robot, command, why)
        self.reports.count(sentence)
        name, topic = self.robot.name, shown(command)
        return [
            Rejection(
                at=at, robot=name, command=topic, id=command.id, reason=refusals.LIMIT, sentence=sentence
            )
        ]

    def refuse(self, at: float, command: Command, word: str, sender: str = "") -> list[Message]:
        """Refuse a command with a word, and report it."""
        rejection = self.reports.rejection(at, command, word, sender, by_board=False)
        self.reports.count(rejection.sentence)
        self.labels.refuse(command.id, word)
        self._words = None
        return [rejection, self.reports.word(at)] if command.id else [rejection]

    def report_foreign(self, at: float, sentence: Sentence, *, refused: bool) -> list[Message]:
        """Report a foreign command to the plant that commands the robot."""
        self._words = None
        self.reports.count_foreign(sentence, refused=refused)
        reports = [] if refused else [ForeignCommand(at=at, robot=self.robot.name, sentence=sentence)]
        if at < self._foreign_reported_at + AGAIN_S:
            return [*reports]
        self._foreign_reported_at = at
        return [*reports, self.reports.word(at)]

    def halt(self, at: float) -> list[Message]:
        """End the open motion, unless it is ending already."""
        if self._motion is None or self._motion.stopping or not self.robot.has_stop:
            return []
        return self._send(at, Stop(id="", robot=self.robot.name, mode=StopMode.HALT))

    def hear_plant(self, at: float, epoch: int) -> list[Message]:
        """Take a heartbeat of the plant: answer rivals; a new plant gets the last report of the board."""
        answer = self._answer_rivals(at)
        if epoch == self.reports.plant:
            return answer
        self.reports.plant = epoch
        self._last = self._last.again(at, plant=epoch) if self._last else None
        return [*answer, self._last] if self._last and self.link.up else answer

    def _answer_rivals(self, at: float) -> list[Message]:
        """Halt a motion that a rival began, under a number above the rival's."""
        if self.rivals.noticed_at is None or not self.link.up:
            return []
        if not self.rivals.answer(at, self.labels, in_motion=self.in_motion):
            return []
        halt = Stop(id="", robot=self.robot.name, mode=StopMode.HALT)
        return self._send(at, halt) if self.robot.has_stop else []

    def beat(self) -> Publication:
        """The heartbeat `latido` for the board."""
        return _beat(self.robot.mqtt, self.labels.beat())

    def fence(self) -> list[Message]:
        """A heartbeat for a board that would still take commands of an earlier bridge."""
        numbered = self.robot.evidence is Evidence.IDS and not self.rivals.yielded
        return [self.beat()] if numbered and self.link.up and not self.labels.fenced else []

    def deliver(self, delivery: Delivery, channel: Channel) -> list[Message]:
        """Take a message of the board; one that breaks the contract is counted and has no effect."""
        ending = self._motion is not None and self._motion.ending
        if channel is Channel.TELEMETRY and not ending and (again := self._again(delivery)):
            return [again]
        try:
            message = decode(channel, delivery.payload, axes=self._form.axes)
            _check(message, delivery, self._form)
        except PayloadError as error:
            self.reports.count(UNREADABLE(topic=delivery.topic, why=error.sentence))
            return []
        if isinstance(message, Presence):
            return self._presence(delivery.at, message.online)
        return self._telemetry(delivery, message) if isinstance(message, Telemetry) else []

    def _again(self, delivery: Delivery) -> Report | None:
        """The last report once more, if the message repeats it under a new number; else None."""
        if self._words is None or self._last is None or delivery.retain:
            return None
        number = self._words.number(delivery.payload)
        if number is None:
            return self._turned(delivery, self._words, self._last) if self._words.joints else None
        if not self.link.hear_again(delivery.at, number):
            return None
        news = {} if self._words.after is None else {"number": number}
        self._last = self._last.again(delivery.at, **news)
        return self._last

    def _turned(self, delivery: Delivery, words: SplitTelemetry, last: Report) -> Report | None:
        """The last report with new joints, if nothing else is new in a moving arm's message; else None."""
        read = read_angles(delivery.payload, len(self._axes))
        if read is None:
            return None
        angles, length = read
        words = words.turned(delivery.payload, length)
        number = words.number(delivery.payload)
        if number is None or not self.link.hear_again(delivery.at, number):
            return None
        news: dict[str, object] = {"q": self._in_si(angles)}
        if words.after is not None:
            news["number"] = number
        self._words, self._last = words, last.again(delivery.at, **news)
        return self._last

    def _presence(self, at: float, online: bool) -> list[Message]:
        self.link.presence(at, online)
        if not online:
            return self.lose(at)
        return self._stop_again(at) if self.link.up else []

    def _telemetry(self, delivery: Delivery, message: Telemetry) -> list[Message]:
        at = delivery.at
        update = self.link.hear(at, message)
        if update is LinkUpdate.OLD:
            self.reports.count_old()
        if update in (LinkUpdate.ABSENT, LinkUpdate.DENIED):
            self.reports.count(ABSENT())
        if update is LinkUpdate.DENIED:
            return [self.reports.no_link(at, lost=DENIED())]
        if update is LinkUpdate.TWINS:
            self._motion, self._words = None, None
            self.rivals.lose()
            return [self.reports.no_link(at, lost=TWINS(board=self.robot.mqtt))]
        if update in (LinkUpdate.LATE, LinkUpdate.ABSENT, LinkUpdate.OLD):
            return []
        if update is LinkUpdate.REBOOT:
            self.labels.reboot()
            self._motion = None
        q = None if message.q_deg is None else self._in_si(message.q_deg)
        facts, ended = self._form.facts_in(message.facts), self.labels.hear(message)
        if self._motion and self._motion.ended(at, message, q, ended, facts):
            self._motion = None
        out = [*self._objections(at), *self.reports.earlier_failures(at)]
        self._last = self.reports.of_telemetry(at, message, q, facts)
        self._words = SplitTelemetry.of(delivery.payload, message)
        return [*out, self._last, *([] if update is LinkUpdate.NEWS else self._stop_again(at))]

    def _objections(self, at: float) -> list[Message]:
        """The messages on newly refused commands and on rivals, which telemetry shows."""
        out: list[Message] = []
        if self.labels.objection is not None:
            issued, word = self.labels.objection
            rejection = self.reports.rejection(at, issued.command, word, issued.sender, by_board=True)
            out.append(rejection)
            if not issued.command.id:  # the plant counts refusals of its own commands
                self.reports.count(rejection.sentence)
        if (sentence := _of_rivals(self.rivals.hear(at, self.labels), self.robot, self.labels)) is not None:
            self._words = None
            self.reports.count_foreign(sentence, refused=False)
            out.append(ForeignCommand(at=at, robot=self.robot.name, sentence=sentence))
        return out

    def _refusal(self, command: Command) -> str | None:
        if not self.link.up:
            return refusals.NO_LINK
        if self.rivals.yielded and not is_stop(command):
            return refusals.OTHER_BRIDGE
        return self._form.refusal(self.robot, command) or (
            refusals.STOPPED if self._latched and needs_clear(command) else None
        )

    def _send(self, at: float, command: Command, sender: str = "") -> list[Message]:
        seq = self.labels.issue(command, sender)
        self._words = None
        channel, goal = self._form.goal(self.robot, command, **self._stamp(command, seq))
        try:
            publication = self._publication(channel, goal)
        except PayloadError:
            return self.refuse(at, command, refusals.FORMAT, sender)
        if isinstance(command, Work):
            self._motion = OpenMotion(robot=self.robot, command=command, seq=seq)
            return [self.beat(), publication]
        if isinstance(command, Stop) and command.mode is not StopMode.CLEAR and self._motion:
            self._motion.stopping = True
        return [publication]

    def _stamp(self, command: Command, seq: int) -> dict[str, int | str | None]:
        """The seq, epoch and token of a command, and the number of the telemetry that its sender heard."""
        if self.robot.evidence is not Evidence.IDS:
            return {"seq": None, "epoch": None}
        stamp: dict[str, int | str | None] = {"seq": seq, "epoch": self.labels.epoch}
        if not isinstance(command, Stop):
            stamp["token"] = command.token
            stamp["heard"] = self.link.number if command.heard is None else command.heard
        return stamp

    def _stop_again(self, at: float) -> list[Message]:
        """Send the stop again to a board that comes back, for it may have forgotten its latch."""
        if not self._latched or not self.robot.has_stop:
            return []
        return self._send(at, Stop(id="", robot=self.robot.name, mode=StopMode.LATCH))

    def _in_si(self, angles: tuple[float, ...]) -> tuple[float, ...]:
        rows = zip(self._axes, angles, strict=True)
        return tuple([from_wire(joint, value) for joint, value in rows])

    def _publication(self, channel: Channel, payload: Payload, qos: int = 1) -> Publication:
        return Publication(topic=topic(self.robot.mqtt, channel), payload=encode(payload), qos=qos)


def _check(message: Payload, delivery: Delivery, form: MessageForm) -> None:
    if not isinstance(message, (Presence, Telemetry)):
        raise PayloadError("a command is not for the bridge")
    if delivery.retain and isinstance(message, Telemetry):
        raise PayloadError("telemetry is retained: nobody knows how old it is")
    if isinstance(message, Telemetry) and message.node is not None and message.node >= form.nodes:
        raise PayloadError(f"nodo is {message.node}; allowed: 0 to {form.nodes - 1}")
    if isinstance(message, Telemetry) and message.facts is not None:
        form.facts_in(message.facts)


def _of_rivals(news: News | None, robot: Robot, labels: Labels) -> Sentence | None:
    if news is News.TAKEN and labels.foreign is not None:
        return rejections.taken(robot, *labels.foreign)
    if news is None or labels.beaten_by is None:
        return None
    return rejections.beaten(robot, labels.beaten_by, yielded=news is News.YIELDED)


@lru_cache(maxsize=256)
def _beat(name: str, epoch: int) -> Publication:
    return Publication(topic=topic(name, Channel.BEAT), payload=encode(Beat(epoch=epoch)), qos=0)
