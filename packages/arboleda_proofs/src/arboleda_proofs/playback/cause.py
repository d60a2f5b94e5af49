"""Rules that find why a task failed, over the facts of its record; the surest rule comes first. Pure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from arboleda.extension import Phrase, Sentence
from arboleda.model.advice import DO
from arboleda.model.messages import Reason, Verb
from arboleda.model.sentence import Value
from arboleda.model.verb_scopes import PLANT

from .troubles import ALARM, BOOT, BRIDGE, SILENCE, Trouble

BEFORE_S = 0.5  # a trouble that ended earlier was not the cause
SOON_S = 0.3  # a robot that ramps down reports its reason only at rest
TOGETHER_S = 0.3  # connections that break within so long broke for one reason
GONE = frozenset({"part.lost", "part.gone"})
MOVES_OFF_S = 0.2  # time from the command to the first reports away from the part's place
PROVOKED_S = 120.0  # a fault by hand lasts for so long, or shows so late
AWAY_S = 2.0  # an absence of the plant may cause failures for so long


@dataclass(frozen=True, kw_only=True)
class TaskCommand:
    """Command of a task, and its course on the robot; `switch`: it sets the effector that holds the part.

    `moved`: the robot was seen to move for it. `stands`: it was seen at rest afterwards, with the command not
    done.
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
    """Facts of a failed task from the record, from which rules tell its cause.

    `reason` and `key` are the plant's; `robot` is the one whose failure it was. `sent` and `troubles` are
    commands and mishaps before it. `acts` are operators' words, each with its time; `absences` the spans in
    which the plant was away; `foreign` the commands of others to the robot; `provoked` the faults that people
    had happen to virtual devices.
    """

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
    provoked: Sequence[tuple[float, str, Sentence]] = ()
    sentence: Sentence | str = ""

    @property
    def trouble(self) -> Trouble | None:
        """The robot's last trouble that had not ended long before the failure; None if there is none."""
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
        """The boot since which the robot's place is unknown, if that was the failure; else None."""
        boots = [each for each in self.troubles if each.robot == self.robot and each.kind == BOOT]
        before = [each for each in boots if each.at <= self.failed_at]
        return before[-1] if before and self.reason is Reason.NOT_HOMED else None

    @property
    def mine(self) -> list[TaskCommand]:
        """The robot's commands before the failure, in order."""
        return sorted((each for each in self.sent if each.robot == self.robot), key=_at)

    @property
    def last(self) -> TaskCommand | None:
        """The robot's last command before the failure; None if there is none."""
        return self.mine[-1] if self.mine else None


def _at(sent: TaskCommand) -> float:
    return sent.at


@dataclass(frozen=True, kw_only=True)
class Cause:
    """Cause of a failure: a word of `PHRASES` for programs, the robot, and a sentence for people."""

    kind: str
    robot: str | None
    sentence: Sentence = field(compare=False)


PROVOKED = Phrase("cause.provoked", "{cause}. Shortly before: {what}")
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
    "command.refused_late": "refused",
    "command.off_target": "off_target",
    "command.fact_unsaid": "off_target",
    "command.fact_other": "off_target",
    "command.short_of_target": "short",
    "command.short_because": "short",
    "command.board_fault": "alarm",
    "command.board_rebooted": "boot",
    "command.joints_jumped": "boot",
    "command.bridge_restarted": "bridge",
    "command.position_unknown": "not_homed",
    "plant.away": "plant_away",
    "robot.was_fenced": "fenced",
    "robot.fenced": "fenced",
    "zone.not_free": "busy",
    "zone.kept_by_machine": "busy",
    "device.not_free": "busy",
    "device.still_held": "busy",
}
"""The cause for each key of the plant's sentence, if no surer one was found."""
BY_REASON = {
    Reason.LINK_LOST: "connection",
    Reason.REBOOTED: "boot",
    Reason.NOT_HOMED: "not_homed",
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
"""Reasons of a failure that a trouble of a device may lead to."""


def cause_of(evidence: Evidence) -> Cause:
    """The cause of a failure, by the first rule that finds one."""
    kind, more = next(found for rule in RULES if (found := rule(evidence)) is not None)
    values = {"robot": evidence.robot or "", "word": evidence.word, "said": evidence.sentence, **more}
    sentence = PHRASES[kind](**values)
    if (what := _provoked(evidence)) is not None:
        sentence = PROVOKED(cause=sentence, what=what)
    return Cause(kind=kind, robot=evidence.robot, sentence=sentence)


def _provoked(evidence: Evidence) -> Sentence | None:
    """The last fault that a person had happen to the robot, if it was not long before the failure."""
    since, until = evidence.failed_at - PROVOKED_S, evidence.failed_at
    mine = [what for at, robot, what in evidence.provoked if robot == evidence.robot and since <= at <= until]
    return mine[-1] if mine else None


Found = tuple[str, dict[str, Value]]


def _operator(evidence: Evidence) -> Found | None:
    """Rule: stopped, held or cancelled by the operator's last act; without one, by somebody else."""
    if evidence.reason not in (Reason.STOPPED, Reason.CANCELLED):
        return None
    acts = [word for at, word in evidence.acts if at <= evidence.failed_at]
    if acts:
        verb, _, scope = acts[-1].partition(" ")
        return "operator", {"word": DO[Verb(verb)](scope=scope or PLANT())}
    return ("foreign", {}) if evidence.robot is not None else None


def _away(evidence: Evidence) -> Found | None:
    """Rule: the plant was away, so boards stopped by themselves, and their reports were lost."""
    if evidence.reason is Reason.REJECTED and evidence.robot is None:
        return None  # the recipe's own words
    since = evidence.last.at if evidence.last is not None else evidence.failed_at - AWAY_S
    away = [seconds for at, seconds in evidence.absences if since <= at <= evidence.failed_at]
    return ("plant_away", {"seconds": max(away)}) if away and evidence.reason in BEFALLEN else None


def _befallen(evidence: Evidence) -> Found | None:
    """Rule: a trouble of the robot, a closer cause than the reason that the plant reported."""
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
    times = [at for at, robot in evidence.foreign if robot == evidence.robot and since <= at]
    return ("foreign", {}) if any(at <= evidence.failed_at for at in times) else None


def _of_boot(evidence: Evidence) -> Found | None:
    return ("boot", {}) if evidence.inner == "effector.as_rebooted" else None


def _left_behind(evidence: Evidence) -> Found | None:
    """Rule: a part that is gone as soon as the arm moves off was never held; the sensor saw it lie."""
    *_, before, sent = (None, None, *evidence.mine)
    if evidence.key not in GONE or sent is None or sent.switch or before is None or not before.switch:
        return None
    return ("not_gripped", {}) if evidence.failed_at - sent.at <= MOVES_OFF_S else None


def _deadline(evidence: Evidence) -> Found | None:
    """Rule: too late; names the command, and whether it was accepted at all."""
    sent = evidence.last
    if evidence.reason is not Reason.DEADLINE or sent is None:
        return None
    if sent.accepted_at is None:
        return "unheard", {}
    if sent.stands:
        return "short", {}
    return ("switch", {}) if sent.switch else ("unended", {})


def _of_failure(evidence: Evidence) -> Found | None:
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
    _of_failure,
    _other,
)
