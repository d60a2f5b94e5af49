"""Belief about one robot, merged from its reports; and what troubles keep it from commands."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from operator import attrgetter, methodcaller
from typing import NamedTuple

from arboleda.model.commands import Position
from arboleda.model.facts import HEALTH, WELL, Facts, Value
from arboleda.model.messages import BUILT_IN, Failure, MotionState, Reason, Receipt, Report, Tokens
from arboleda.model.plant_model import Evidence, Link, Robot
from arboleda.model.sentence import OWN, Phrase, Sentence

from .lateness import LATE_S, Pauses
from .stillness import Stillness

RATE_S = 2.0  # the rate of reports is counted over at least this long
GRAVITY = (
    None,
    MotionState.STOPPED,
    MotionState.MOVING,
    MotionState.STOP_LATCHED,
    MotionState.NOT_HOMED,
    MotionState.FAULT,
    MotionState.NO_LINK,
)  # each state asks for more care than those before it
MERGED = ("epoch", "boot_id", "state", "q", "node", "homed", "effector", "piece", "receipt")
_merged = attrgetter(*MERGED)


class ReportRate:
    """Rate of a robot's reports: `hz` is None until it was counted, `since` when it was counted last."""

    def __init__(self) -> None:
        self.hz: float | None = None
        self.since = 0.0
        self._reports = 0

    def count(self, at: float, reports: int, *, online: bool) -> None:
        """Take the number of the last report, where the rate is due to be counted."""
        if reports == 1 or not online:
            self.hz = None
        elif at - self.since < RATE_S:
            return
        else:
            self.hz = (reports - self._reports) / (at - self.since)
        self.since, self._reports = at, reports


@cache
def _position_under(key: str | None) -> Callable[[Report | Belief], Position | None]:
    return attrgetter(key) if key else _nowhere


def _nowhere(source: Report | Belief) -> None:
    """The position of a robot that has none."""


@cache
def _fact_under(name: str | None) -> Callable[[Report | Belief], Value | None]:
    if name is None:
        return _nowhere
    return attrgetter(name) if name in BUILT_IN else methodcaller("fact", name)


class Belief:
    """The last values that a robot reported; None for what it never reported.

    `supervised`: silence means a lost link; a robot at `state` only reports when it moves, so its does not.
    `stale_at` is when it will have been silent for too long; None for a robot that cannot fall silent.
    `barred`: it refused a command for a stop that it does not report, and has not restarted its bridge since.
    `is_hearsay`: its state may be the word of a stranger, who spoke beside it; `own_word` is its own then.
    """

    def __init__(self, robot: Robot, stale_after_s: float, plant_epoch: int) -> None:
        self.robot = robot
        self.stale_after_s = stale_after_s
        self.plant_epoch = plant_epoch
        self.supervised = robot.evidence is not Evidence.STATE and robot.link is not Link.SCREEN
        self.position_in = _position_under(robot.position_key)  # of a report, or of a belief
        self.held_in = _fact_under(robot.held_fact)  # of the same: True where it holds something
        self.drawn = robot.link is Link.NONE
        # rules that can never apply to this robot are not asked at each report
        self.may_be_displaced = not robot.says_homed
        self.tells_boots_only = self.may_be_displaced and robot.evidence is Evidence.IDS
        tells = robot.goes or robot.fact_names
        self._comes_apart = bool(tells) and robot.evidence is Evidence.JOINTS  # its place and its state
        self.heard_at: float | None = None
        self.pauses = Pauses()  # in which nothing was heard of it
        self.stale = False
        self.stale_at: float | None = None
        self.online = not self.supervised and not self.drawn
        self.epoch: int | None = None
        self.plant: int | None = None
        self.boot_id: int | None = None
        self.number: int | None = None  # of its board's last telemetry
        self.state: MotionState | None = None
        self.moves_since = 0.0  # as far as it was heard; it may have stood while its link was lost
        self.q: tuple[float, ...] | None = None
        self.node: int | None = None
        self.position: Position | None = None
        self.reports = 0
        self.repeats = 0  # reports since the last that said something else
        self.rate = ReportRate()
        self.stillness = Stillness(robot, supervised=self.supervised)
        self.piece_at = 0.0
        self.piece_since = 0.0
        self.displaced = False
        self.is_unplaced = False  # its link was lost, and it has not told its place since
        self.came_back_at_zero = False  # for this it counts as displaced
        self.barred = False
        self.homed: bool | None = None
        self.effector: bool | None = None
        self.held_boot: int | None = None  # the boot in which it last said if it holds something
        self.piece: bool | None = None
        self.piece_boot: int | None = None  # the boot in which it last said if a piece is there
        self.receipt: Receipt | None = None
        self.tokens: Tokens | None = None  # of the commands in `receipt`
        self.facts: dict[str, Value] = {}
        self.lost: Sentence | None = None  # why there is no link
        self.said_before_loss: MotionState | None = None  # its state, as it was when its link was lost
        self.is_hearsay = False
        self.own_word: MotionState | None = None
        self.facts_no = 0  # the number of the last report that changed a fact
        self._last: Report | None = None

    @property
    def numbers_commands(self) -> bool:
        """True where its board numbers the commands that it takes, and has reported its boot.

        A board on MQTT always numbers them. Any other device has to have reported such numbers.
        """
        if self.robot.evidence is not Evidence.IDS or self.boot_id is None:
            return False
        return self.robot.link is Link.MQTT or self.receipt is not None

    @property
    def senses_pieces(self) -> bool:
        """True where it has a piece sensor, by its plant file or by its reports since it booted."""
        reported = self.piece is not None and self.piece_boot == self.boot_id
        return reported or self.robot.piece_on_change

    def fact(self, name: str) -> Value | None:
        """The last value of a fact; None where it was never reported."""
        value: Value | None = getattr(self, name) if name in BUILT_IN else self.facts.get(name)
        return value

    def hear_again(self, report: Report) -> bool:
        """Take over a report that repeats the last one of an online robot; False where it is to be merged."""
        last = self._last
        if last is None or not self.online or report.at < self.stillness.position_at:
            return False
        if report.done != last.done or report.words != last.words:  # of most ends no words are made
            return False
        self.repeats += 1
        self.reports += 1
        if report.number is not None:
            self.number = report.number
        if self.heard_at is not None and report.at - self.heard_at > LATE_S:
            self.pauses.note(report.at, report.at - self.heard_at)
        self.heard_at = report.at
        if self.supervised:
            self.stale_at = report.at + self.stale_after_s
        self.stillness.hear(report, self.reports, self.position_in(report), self.position)
        if report.piece is not None:
            self.piece_at = report.at
        if report.at - self.rate.since >= RATE_S:
            self.rate.count(report.at, self.reports, online=True)
        return True

    def merge(self, report: Report) -> None:
        """Take over the values of a report; a value that it leaves out stays."""
        self.repeats = 0
        self._hear(report)
        if report.epoch is not None and report.epoch != self.epoch:
            self.barred = False  # a bridge that restarted has forgotten the stop
        is_told_why = self.lost is None and report.lost is not None
        if report.state is MotionState.NO_LINK and (self.state is not MotionState.NO_LINK or is_told_why):
            self.said_before_loss, self.is_unplaced = self.state, True
        was_seen_moving = self.online and self.state is MotionState.MOVING
        if report.state is MotionState.MOVING and not was_seen_moving:
            self.moves_since = report.at
        for name, value in zip(MERGED, _merged(report), strict=True):
            if value is not None:
                setattr(self, name, value)
        if report.state is not None and report.state is not MotionState.NO_LINK:
            self.is_hearsay = False
        if report.receipt is not None:
            self.tokens = report.tokens  # None too: tokens belong to the numbers of one report
        if report.facts:
            self._merge_facts(report.facts)
        for name in report.unknown:
            if self.facts.pop(name, None) is not None:
                self.facts_no = self.reports
        self.position = self.position_in(self)
        if self.held_in(report) is not None:
            self.held_boot = self.boot_id
        if report.piece is not None:
            self.piece_boot = self.boot_id
        if report.epoch is not None:
            self.plant = report.plant  # a bridge that restarted has to hear the plant anew
        self._last, self.lost = report, report.lost
        if self.reports == 1 or not self.online or report.at - self.rate.since >= RATE_S:
            self.rate.count(report.at, self.reports, online=self.online)
        self.online = (
            not (self.stale or self.drawn)
            and self.state is not MotionState.NO_LINK
            and (self.heard_at is not None or not self.supervised)
        )

    def _merge_facts(self, facts: Facts) -> None:
        if any(self.facts.get(name) != value for name, value in facts):
            self.facts.update(facts)
            self.facts_no = self.reports

    def fall_silent(self) -> None:
        """Note that it has been silent for too long."""
        self.stale = self.is_unplaced = True
        self.stale_at = None
        self.online = False

    def find_again(self, said: Sequence[MotionState]) -> bool:
        """Take it for linked again although it says nothing; returns True where it may have moved.

        Of what it said before and what was `said` for it since then counts what asks for most care. If it was
        moving, it may have come to a stop meanwhile. One that can fall silent has to be heard first. One that
        said itself that it has no link has none.
        """
        before = self.said_before_loss
        gravest = max((before, *said), key=GRAVITY.index)
        if not self.is_hearsay:
            self.own_word = before
        self.is_hearsay = gravest is not self.own_word
        self.state = None if gravest is MotionState.MOVING else gravest
        self.stillness.find_again(self.own_word)
        self._last = self.lost = None
        is_lost = before is MotionState.NO_LINK
        self.online = not is_lost and (self.online or not (self.supervised or self.drawn))
        return MotionState.MOVING in (before, *said)

    def end_hearsay(self) -> None:
        """Go by what it said itself, on the word of a person who has seen to it."""
        if self.is_hearsay and self.state is not MotionState.NO_LINK:
            self.state = None if self.own_word is MotionState.MOVING else self.own_word
            self.is_hearsay = False

    def _hear(self, report: Report) -> None:
        """Take over when and where it was heard; reports are numbered, as two may come at one time."""
        self.reports += 1
        if report.number is not None:
            self.number = report.number
        stands = self._comes_apart and report.state not in (None, MotionState.MOVING)
        if stands and (self.state is MotionState.MOVING or (self.heard_at is not None and not self.online)):
            self.stillness.come_to_a_stop(report.at)
        if report.state is not MotionState.NO_LINK:
            if self.heard_at is not None and report.at - self.heard_at > LATE_S:
                self.pauses.note(report.at, report.at - self.heard_at)
            self.heard_at = report.at
            self.stale = False
            self.stale_at = report.at + self.stale_after_s if self.supervised else None
        self.stillness.hear(report, self.reports, self.position_in(report), self.position)
        if report.piece is not None:
            self.piece_at = report.at
            self.piece_since = report.at if report.piece is not self.piece else self.piece_since

    @property
    def moves(self) -> bool:
        """True while only its motion keeps it from a command."""
        return self.trouble is MOVING

    @property
    def answered(self) -> bool:
        """True where its bridge reports that it hears this plant, or where it has no bridge of ours."""
        return self.plant == self.plant_epoch or self.epoch is None or self.robot.link is Link.ROS

    @property
    def is_located(self) -> bool:
        """True where its position can be believed."""
        return self.online and not self.unhomed

    @property
    def known_position(self) -> Position | None:
        """The position, where it can be believed."""
        return self.position if self.is_located else None

    @property
    def known_q(self) -> tuple[float, ...] | None:
        """The joints, where they can be believed."""
        return self.q if self.is_located else None

    @property
    def unhomed(self) -> bool:
        """True where its position means nothing: it reports so, or it must have rebooted."""
        return self.displaced or self.homed is False or self.state is MotionState.NOT_HOMED

    @property
    def says_unhomed(self) -> bool:
        """True where the board itself reports that it is not homed."""
        own_word = self.own_word if self.is_hearsay else self.state
        return self.homed is False or own_word is MotionState.NOT_HOMED

    def obstacle(self, *, was: bool) -> Failure | None:
        """The reason why this robot takes no command, if there is one; `was`: in words that stay true."""
        trouble = self.trouble
        return None if trouble is None else trouble.failure(self.robot.name, was=was)

    def unreachable(self, *, was: bool = False) -> Failure | None:
        """The reason why the robot cannot even be asked something, be it stopped or not homed."""
        trouble = self.trouble
        if trouble is None or trouble.reason is not Reason.LINK_LOST:
            return None
        return trouble.failure(self.robot.name, was=was)

    def obstacle_besides_stop(self, *, was: bool = False) -> Failure | None:
        """The reason why it takes no command that a stop allows: not homed, where a stop hides that."""
        trouble = self.trouble
        if trouble is STOPPED:
            trouble = _unhomed(self) if self.unhomed else None
        return None if trouble is None else trouble.failure(self.robot.name, was=was)

    def _unanswered(self) -> RobotTrouble:
        """The trouble of a bridge that obeys another start of the plant.

        A bridge obeys the latest start that it has heard, so that an old plant which comes back moves
        nothing.
        """
        if self.plant is None or self.plant < self.plant_epoch:
            return UNANSWERED
        return FENCED._replace(more={"obeyed": self.plant, "ours": self.plant_epoch})

    @property
    def is_cleared_by_homing(self) -> bool:
        """True where it is in a fault that its driver's homing leads out of."""
        trouble, driver = self.trouble, self.robot.driver
        in_fault = trouble is not None and trouble.reason is Reason.DEVICE_FAULT
        return in_fault and driver is not None and driver.recovers

    @property
    def is_led_out_by_homing(self) -> bool:
        """True where homing ends all that keeps it from other commands."""
        trouble = self.trouble
        unhomed = trouble is not None and trouble.reason is Reason.NOT_HOMED
        return unhomed or self.is_cleared_by_homing

    @property
    def trouble(self) -> RobotTrouble | None:
        """The first trouble that keeps it from a command; None where it is ready."""
        if self.drawn:
            return DRAWN
        if not self.online:
            return _unreached(self)
        if self.plant != self.plant_epoch and not self.answered:
            return self._unanswered()
        trouble = TROUBLES.get(self.state)
        if trouble is FAULTY and self.is_hearsay:
            return SAID_FAULTY
        if trouble is FAULTY and (word := self.fact(HEALTH)) not in (None, WELL):
            return FAULTY_BECAUSE._replace(more={"why": OWN(text=str(word))})
        if self.barred and trouble is None:
            return STOPPED
        return _unhomed(self) if self.unhomed and (trouble is None or trouble is MOVING) else trouble


def _unreached(belief: Belief) -> RobotTrouble:
    """The trouble of a robot that is not heard, with the reason where one was reported."""
    if belief.lost is not None:
        return LOST._replace(more={"why": belief.lost})
    return OFFLINE if belief.heard_at is not None else UNHEARD


def _unhomed(belief: Belief) -> RobotTrouble:
    return BACK_AT_ZERO if belief.came_back_at_zero else UNHOMED


class RobotTrouble(NamedTuple):
    """Trouble of a robot: `phrase` while it lasts, and `was`, which stays true afterwards."""

    reason: Reason
    phrase: Phrase
    was: Phrase
    more: Mapping[str, int | Sentence] = {}

    def failure(self, robot: str, *, was: bool) -> Failure:
        """The trouble as the failure of a command; `was`: in words that stay true."""
        sentence = self.was if was else self.phrase
        return Failure(reason=self.reason, sentence=sentence(robot=robot, **self.more))


FENCED = RobotTrouble(
    Reason.LINK_LOST,
    Phrase(
        "robot.fenced",
        "{robot} is fenced off: its bridge obeys plant {obeyed}, which started after this one ({ours}); "
        "end that plant, then start the bridge anew, or this plant where it brings the bridge",
    ),
    Phrase(
        "robot.was_fenced",
        "{robot} was fenced off: its bridge obeyed plant {obeyed}, which started after this one ({ours})",
    ),
)
ONLY_DRAWN = Phrase("robot.only_drawn", "{robot} is only drawn (link: none)")
DRAWN = RobotTrouble(Reason.LINK_LOST, ONLY_DRAWN, ONLY_DRAWN)
OFFLINE = RobotTrouble(
    Reason.LINK_LOST,
    Phrase("robot.offline", "{robot} is offline"),
    Phrase("robot.was_lost", "{robot} was lost"),
)
LOST = RobotTrouble(
    Reason.LINK_LOST,
    Phrase("robot.lost", "{robot} is offline: {why}"),
    Phrase("robot.was_lost_because", "{robot} was offline: {why}"),
)
UNHEARD = RobotTrouble(
    Reason.LINK_LOST,
    Phrase("robot.unheard", "{robot} was not heard yet"),
    Phrase("robot.was_unheard", "{robot} had not been heard yet"),
)
UNANSWERED = RobotTrouble(
    Reason.LINK_LOST,
    Phrase("robot.unanswered", "{robot} has a bridge that does not hear this plant yet"),
    Phrase("robot.was_unanswered", "{robot} had a bridge that did not hear this plant yet"),
)
UNHOMED = RobotTrouble(
    Reason.NOT_HOMED,
    Phrase("robot.not_homed", "{robot} is not homed"),
    Phrase("robot.was_not_homed", "{robot} was not homed"),
)
BACK_AT_ZERO = RobotTrouble(
    Reason.NOT_HOMED,
    Phrase(
        "robot.back_at_zero",
        "{robot} came back at its reference after its link was lost, as a board does that has booted "
        "elsewhere",
    ),
    Phrase(
        "robot.was_back_at_zero",
        "{robot} had come back at its reference after its link was lost, as a board does that has booted "
        "elsewhere",
    ),
)
MOVING = RobotTrouble(
    Reason.REJECTED,
    Phrase("robot.moving", "{robot} is still moving"),
    Phrase("robot.was_moving", "{robot} was still moving"),
)
STOPPED = RobotTrouble(
    Reason.STOPPED,
    Phrase("robot.stopped", "{robot} is stopped (latched)"),
    Phrase("robot.was_stopped", "{robot} was stopped (latched)"),
)
FAULTY = RobotTrouble(
    Reason.DEVICE_FAULT,
    Phrase("robot.in_fault", "{robot} is in fault"),
    Phrase("robot.was_in_fault", "{robot} was in fault"),
)
FAULTY_BECAUSE = RobotTrouble(
    Reason.DEVICE_FAULT,
    Phrase("robot.in_fault_because", "{robot} is in fault: {why}"),
    Phrase("robot.was_in_fault_because", "{robot} was in fault: {why}"),
)
SAID_FAULTY = RobotTrouble(
    Reason.DEVICE_FAULT,
    Phrase("robot.said_in_fault", "{robot} may be in fault: more than one node published when that was said"),
    Phrase(
        "robot.was_said_in_fault",
        "{robot} might have been in fault: more than one node published when that was said",
    ),
)
TROUBLES: dict[MotionState | None, RobotTrouble] = {
    MotionState.MOVING: MOVING,
    MotionState.FAULT: FAULTY,
    MotionState.STOP_LATCHED: STOPPED,
}


def stands_while_cleared(belief: Belief) -> bool:
    """True where homing leads a robot out of its fault, and it keeps its place."""
    driver = belief.robot.driver
    keeps = driver is not None and not (driver.home_moves or driver.home_is_claim)
    return keeps and belief.is_cleared_by_homing
