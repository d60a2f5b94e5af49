"""Why a task failed: rules over what the record has of it, the surest first. Pure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from arboleda.core.advice import DO
from arboleda.core.operator import PLANT
from arboleda.model.messages import Reason, Verb
from arboleda.model.sentence import Phrase, Sentence, Value

from .troubles import ALARM, BOOT, BRIDGE, SILENCE, Trouble

BEFORE_S = 0.5  # what had ended so long before the failure was not what it failed of
SOON_S = 0.3  # what shows so soon after it: who ramps down says why once it stands
TOGETHER_S = 0.3  # connections that break within so long broke for one reason
GONE = frozenset({"part.lost", "part.gone"})
MOVES_OFF_S = 0.2  # from the command to the first reports away from where the part lies
AWAY_S = 2.0  # so long after the plant was away, what fails may fail of that


@dataclass(frozen=True, kw_only=True)
class TaskCommand:
    """A command of a task, and what its robot made of it; `switch`: it sets what the robot holds with.

    `moved`: it was seen to move for it; `stands`: after that it was seen to stand, and not to have done it.
    """

    id: str
    robot: str
    at: float
    switch: bool = False
    accepted_at: float | None = None
    moved: bool = False
    stands: bool = False


@dataclass(frozen=True, kw_only=True)
class Evidence:
    """What the record has of a failed task: the reason and the key that the plant gave, whose failure it was,
    when, and what happened before; `acts` are operators' words with their times, `absences` those of the
    plant itself, `foreign` what others commanded, by robot."""

    reason: Reason
    key: str
    failed_at: float
    robot: str | None = None
    doing: Sentence | str = ""
    word: str = ""
    inner: str = ""
    sent: Sequence[TaskCommand] = ()
    troubles: Sequence[Trouble] = ()
    acts: Sequence[tuple[float, str]] = ()
    absences: Sequence[tuple[float, float]] = ()
    foreign: Sequence[tuple[float, str]] = ()
    said: Sentence | str = ""

    @property
    def trouble(self) -> Trouble | None:
        """The last that befell the robot and had not ended long before."""
        mine = [
            each
            for each in self.troubles
            if each.robot == self.robot
            and each.at <= self.failed_at + SOON_S
            and each.ends >= self.failed_at - BEFORE_S
        ]
        return max(mine, key=lambda each: (each.kind != SILENCE, each.at), default=None)

    @property
    def boot(self) -> Trouble | None:
        """One after which nobody knows where the robot is, however long ago, where that was the failure."""
        boots = [each for each in self.troubles if each.robot == self.robot and each.kind == BOOT]
        before = [each for each in boots if each.at <= self.failed_at]
        return before[-1] if before and self.reason is Reason.NOT_HOMED else None

    @property
    def mine(self) -> list[TaskCommand]:
        """The commands of the robot before the failure, in their order."""
        return sorted((each for each in self.sent if each.robot == self.robot), key=_at)

    @property
    def last(self) -> TaskCommand | None:
        """The last of them."""
        return self.mine[-1] if self.mine else None


def _at(sent: TaskCommand) -> float:
    return sent.at


@dataclass(frozen=True, kw_only=True)
class Cause:
    """What a task failed of: a word of `PHRASES` for programs, whose, and a sentence for people."""

    kind: str
    robot: str | None
    sentence: Sentence = field(compare=False)


PHRASES = {
    "silence": Phrase(
        "cause.silence", "{robot} said nothing for {seconds:.1f} s: its board or its connection did nothing"
    ),
    "silent": Phrase("cause.silent", "{robot} fell silent, and was not heard again before the task ended"),
    "connection": Phrase(
        "cause.connection", "the connection of {robot} broke, which the broker told at once"
    ),
    "broker": Phrase("cause.broker", "the connections of several devices broke at once: broker or network"),
    "bridge": Phrase("cause.bridge", "the bridge started anew while {robot} was at work"),
    "boot": Phrase("cause.boot", "the board of {robot} booted: it was without power, or was reset"),
    "alarm": Phrase("cause.alarm", "{robot} reported a fault of its own, as of a motor driver"),
    "unheard": Phrase("cause.unheard", "{robot} never took its command: it was lost on the way there"),
    "unended": Phrase("cause.unended", "{robot} took its command and did not end it in time"),
    "gave_up": Phrase("cause.gave_up", "{robot} itself gave up what it was told ({word})"),
    "refused": Phrase("cause.refused", "{robot} refused what it was told ({word})"),
    "opened": Phrase("cause.opened", "{robot} let go of what it held, and nobody had told it to"),
    "no_part": Phrase("cause.no_part", "no part lay where {robot} was to pick it up"),
    "not_gripped": Phrase("cause.not_gripped", "{robot} closed, and held no part"),
    "part_lost": Phrase("cause.part_lost", "{robot} lost its part on the way"),
    "switch": Phrase(
        "cause.switch", "The gripper, suction cup or clamp of {robot} did not do what it was told"
    ),
    "off_target": Phrase("cause.off_target", "{robot} said that it was done, and what it reported denies it"),
    "short": Phrase(
        "cause.short",
        "{robot} stopped by itself before it was there: nothing of the plant reached it for a second, or "
        "something else stopped it",
    ),
    "not_homed": Phrase("cause.not_homed", "the position of {robot} was unknown"),
    "operator": Phrase("cause.operator", "an operator ended it: {word}"),
    "plant_away": Phrase("cause.plant_away", "the plant's own process did nothing for {seconds:.1f} s"),
    "plant_restart": Phrase("cause.plant_restart", "the plant was ended or killed in the middle of it"),
    "foreign": Phrase("cause.foreign", "somebody else than this plant commanded {robot}"),
    "fenced": Phrase("cause.fenced", "another plant has taken over the bridge of {robot}"),
    "busy": Phrase("cause.busy", "a zone or a device that it shares was not free in time"),
    "defect": Phrase("cause.defect", "a step of it broke on an error of its own"),
    "other": Phrase("cause.other", "{said}"),
}

BY_KEY = {
    "part.none": "no_part",
    "part.not_gripped": "not_gripped",
    "part.gone": "part_lost",
    "part.lost": "part_lost",
    "effector.opened": "opened",
    "device.let_go": "opened",
    "command.gave_up": "gave_up",
    "command.refused": "refused",
    "command.off_target": "off_target",
    "command.fact_unsaid": "off_target",
    "command.fact_other": "off_target",
    "command.short_of_target": "short",
    "command.board_fault": "alarm",
    "command.board_rebooted": "boot",
    "command.joints_jumped": "boot",
    "command.bridge_restarted": "bridge",
    "command.position_unknown": "not_homed",
    "plant.away": "plant_away",
    "robot.was_fenced": "fenced",
    "robot.fenced": "fenced",
    "zone.not_free": "busy",
    "device.not_free": "busy",
    "device.still_held": "busy",
}
"""What the plant's own sentence says by itself, where nothing surer was found."""
BY_REASON = {
    Reason.LINK_LOST: "connection",
    Reason.REBOOTED: "boot",
    Reason.NOT_HOMED: "not_homed",
    Reason.REJECTED: "refused",
    Reason.STOPPED_SHORT: "short",
    Reason.NOT_REACHED: "off_target",
    Reason.DEVICE_FAULT: "alarm",
    Reason.NO_PIECE: "no_part",
    Reason.NOT_GRIPPED: "not_gripped",
    Reason.PART_LOST: "part_lost",
    Reason.ZONE_UNAVAILABLE: "busy",
    Reason.INTERRUPTED: "plant_restart",
    Reason.INTERNAL: "defect",
}
BEFALLEN = frozenset(
    {
        Reason.LINK_LOST,
        Reason.REBOOTED,
        Reason.NOT_HOMED,
        Reason.DEADLINE,
        Reason.DEVICE_FAULT,
        Reason.STOPPED_SHORT,
        Reason.STOP_UNCONFIRMED,
        Reason.NOT_REACHED,
        Reason.PART_LOST,
        Reason.REJECTED,
        Reason.PRECONDITION,
    }
)
"""Reasons that what befalls a device may lead to."""


def cause_of(evidence: Evidence) -> Cause:
    """What a task failed of, by the first rule that knows."""
    kind, more = next(found for rule in RULES if (found := rule(evidence)) is not None)
    values = {"robot": evidence.robot or "", "word": evidence.word, "said": evidence.said, **more}
    return Cause(kind=kind, robot=evidence.robot, sentence=PHRASES[kind](**values))


Found = tuple[str, dict[str, Value]]


def _operator(evidence: Evidence) -> Found | None:
    """Stopped, held and cancelled: what an operator did last before; else somebody else stopped the robot."""
    if evidence.reason not in (Reason.STOPPED, Reason.CANCELLED):
        return None
    acts = [word for at, word in evidence.acts if at <= evidence.failed_at]
    if acts:
        verb, _, scope = acts[-1].partition(" ")
        return "operator", {"word": DO[Verb(verb)](scope=scope or PLANT())}
    return ("foreign", {}) if evidence.robot is not None else None


def _away(evidence: Evidence) -> Found | None:
    """While the plant did nothing, boards stopped by themselves, and nobody heard what they said."""
    since = evidence.last.at if evidence.last is not None else evidence.failed_at - AWAY_S
    away = [seconds for at, seconds in evidence.absences if since <= at <= evidence.failed_at]
    return ("plant_away", {"seconds": max(away)}) if away and evidence.reason in BEFALLEN else None


def _befallen(evidence: Evidence) -> Found | None:
    """A trouble of the robot says more than what the plant saw of it."""
    trouble = evidence.trouble or evidence.boot
    if trouble is None or evidence.reason not in BEFALLEN:
        return None
    if trouble.kind == BOOT:
        return "boot", {}
    if trouble.kind == ALARM:
        return "alarm", {}
    if trouble.kind == BRIDGE:
        return "bridge", {}
    return _silent(evidence, trouble)


def _silent(evidence: Evidence, trouble: Trouble) -> Found:
    together = {
        each.robot
        for each in evidence.troubles
        if each.cut and trouble.cut and abs((each.lost_at or 0.0) - (trouble.lost_at or 0.0)) < TOGETHER_S
    }
    if len(together) > 1:
        return "broker", {}
    if trouble.cut:
        return "connection", {}
    if trouble.ends == float("inf"):
        return "silent", {}
    return "silence", {"seconds": trouble.seconds}


def _foreign(evidence: Evidence) -> Found | None:
    sent = evidence.last
    since = sent.at if sent is not None else evidence.failed_at
    heard = [at for at, robot in evidence.foreign if robot == evidence.robot and since <= at]
    return ("foreign", {}) if any(at <= evidence.failed_at for at in heard) else None


def _of_boot(evidence: Evidence) -> Found | None:
    return ("boot", {}) if evidence.inner == "effector.as_rebooted" else None


def _left_behind(evidence: Evidence) -> Found | None:
    """A part that is gone as soon as the arm moves off was never held: until then, the sensor saw it lie."""
    *_, before, sent = (None, None, *evidence.mine)
    if evidence.key not in GONE or sent is None or sent.switch or before is None or not before.switch:
        return None
    return ("not_gripped", {}) if evidence.failed_at - sent.at <= MOVES_OFF_S else None


def _deadline(evidence: Evidence) -> Found | None:
    """Not in time: whether it was taken at all, and what it was."""
    sent = evidence.last
    if evidence.reason is not Reason.DEADLINE or sent is None:
        return None
    if sent.accepted_at is None:
        return "unheard", {}
    if sent.stands:
        return "short", {}
    return ("switch", {}) if sent.switch else ("unended", {})


def _said(evidence: Evidence) -> Found | None:
    kind = BY_KEY.get(evidence.key) or BY_REASON.get(evidence.reason)
    return (kind, {"seconds": 0.0}) if kind is not None else None


def _other(evidence: Evidence) -> Found:
    return "other", {}


RULES: tuple[Callable[[Evidence], Found | None], ...] = (
    _operator,
    _away,
    _of_boot,
    _befallen,
    _foreign,
    _left_behind,
    _deadline,
    _said,
    _other,
)
