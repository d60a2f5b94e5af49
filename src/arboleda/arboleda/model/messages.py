"""Messages across the engine's border beside commands: notices out, events in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import Enum
from functools import cached_property
from operator import attrgetter
from typing import NamedTuple

from .commands import Position
from .facts import Facts, Value
from .grips import Grip
from .sentence import NOTHING, Sentence
from .verbs import Arguments
from .verbs import Outcome as Outcome  # of whose requests and answers this module tells
from .verbs import Verb as Verb


class MotionState(int, Enum):
    """The code a robot reports as `motion_state` (ROS 2) and `estado` (MQTT)."""

    STOPPED = 0
    MOVING = 1
    FAULT = 2
    NOT_HOMED = 3
    STOP_LATCHED = 4
    NO_LINK = 255


class Reason(str, Enum):
    """Reason of a failure."""

    LINK_LOST = "link_lost"
    REBOOTED = "rebooted"
    NOT_HOMED = "not_homed"
    REJECTED = "rejected"
    DEADLINE = "deadline"
    STOPPED_SHORT = "stopped_short"
    NOT_REACHED = "not_reached"
    PRECONDITION = "precondition"
    DEVICE_FAULT = "device_fault"
    STOP_UNCONFIRMED = "stop_unconfirmed"
    STOPPED = "stopped"
    CANCELLED = "cancelled"
    NO_PIECE = "no_piece"
    NOT_GRIPPED = "not_gripped"
    PART_LOST = "part_lost"
    ZONE_UNAVAILABLE = "zone_unavailable"
    INTERRUPTED = "interrupted"
    INTERNAL = "internal"


@dataclass(frozen=True, kw_only=True)
class Failure:
    """Failure of a command or a task: a reason, and a sentence for the operator."""

    reason: Reason
    sentence: Sentence


class TaskState(str, Enum):
    """The life of a task as `/task_status` tells it."""

    QUEUED = "queued"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"
    REFUSED = "refused"


ENDED = frozenset({TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED})  # of a task that was accepted


@dataclass(frozen=True, kw_only=True)
class TaskAnswer:
    """Answer of a device or a person to a task; `asked` is the question, or the verb and its values."""

    by: str
    asked: str
    answer: Value


@dataclass(frozen=True, kw_only=True)
class Course:
    """Course of a task that was done: how long it took, and when each step began last, in s without holds.

    The key of a step is its name with its number among the steps of that name.
    """

    seconds: float
    begun: Mapping[str, float]

    def remaining_s(self, step: str, seconds: float) -> float | None:
        """The time (s) that the task needed from `seconds` after a step began; None without that step.

        It is at least the time that it needed from the begin of the next step.
        """
        at = self.begun.get(step)
        if at is None:
            return None
        following = min((each for each in self.begun.values() if each > at), default=self.seconds)
        return self.seconds - min(at + seconds, following)


class Check(str, Enum):
    """Part of a task's work that no device may have confirmed although the task is done."""

    GRIP = "grip"
    RELEASE = "release"


@dataclass(frozen=True, kw_only=True)
class KeptTask:
    """Task of an earlier start, as it was kept; times in s of this start's clock.

    `recipe` is "" where it was not kept. `choice` says why the task is done in its cell, where several were
    allowed. Tasks that were done within one start of the plant have a `course`. `is_bound` marks a task that
    may begin only in the start, and by the version of the plant, for which it was allowed.
    """

    id: str
    text: str
    cell: str
    state: TaskState
    failure: Failure | None = None
    started_at: float | None = None
    ended_at: float | None = None
    attempts: int = 0
    answers: tuple[TaskAnswer, ...] = ()
    recipe: str = ""
    choice: Sentence | None = None
    course: Course | None = None
    unchecked: tuple[Check, ...] = field(default=(), repr=False)
    is_bound: bool = field(default=False, repr=False)


@dataclass(frozen=True, kw_only=True)
class Heartbeat:
    """The plant is alive; `epoch` names this start of it."""

    epoch: int


@dataclass(frozen=True, kw_only=True)
class SystemStart:
    """A cell starts a task."""

    cell: str


@dataclass(frozen=True, kw_only=True)
class TaskChanged:
    """Change of a task; `request` is the id of the request that caused it, if any.

    `for_now`: the text of this refused task may be taken later. `choice` says why the task is done in this
    cell, where several were allowed. A task that is done has a `course`, and the checks that nobody
    confirmed.
    """

    task: str
    text: str
    cell: str | None
    state: TaskState
    reason: Reason | None = None
    sentence: Sentence = NOTHING
    request: str | None = None
    for_now: bool = False
    choice: Sentence | None = field(default=None, repr=False)
    course: Course | None = field(default=None, repr=False)
    unchecked: tuple[Check, ...] = field(default=(), repr=False)


@dataclass(frozen=True, kw_only=True)
class OperatorAnswer:
    """Answer to an operator's request; `refusal` says why nothing was done, None where it was done.

    `act` is the number of the act, under which a later `outcome` is told.
    """

    verb: Verb
    scope: str
    refusal: Sentence | None = None
    request: str | None = None
    act: int | None = field(default=None, repr=False)
    outcome: Outcome | None = field(default=None, repr=False)
    why: Sentence | None = field(default=None, repr=False)
    arguments: Arguments = field(default=(), repr=False)


class Fact(str, Enum):
    """Fact that has to survive a restart of the plant."""

    LATCH = "latch"  # robot -> "on", or "cleared" until its cell is reset
    EFFECTOR = "effector"  # arm -> "on", "off" or "switching"
    EMPTIED = "emptied"  # device that reports a part -> "true" where a person has taken the part out
    QUARANTINE = "quarantine"  # zone -> the robot that may still be in it
    PARTS = "parts"  # cell -> its places with parts, as `trees/part_places.py` writes them
    STORED = "stored"  # of version 0.1: cell -> the numbers of its stations with a part, "0 7"
    DISPLACED = "displaced"  # robot that cannot report it -> "true" while its position means nothing
    BOOT = "boot"  # such a robot -> the boot in which it was heard last
    MANUAL = "manual"  # cell -> the person who teaches it
    STEP = "step"  # running task -> its trail, as `resume/trail.py` writes it


@dataclass(frozen=True, kw_only=True)
class Remember:
    """Fact to keep before any later message leaves; None removes it."""

    fact: Fact
    name: str
    value: str | None


@dataclass(frozen=True, kw_only=True)
class Journal:
    """Entry of the journal about an act of an operator; `cell` is None where the act was for several cells.

    An act that devices carry out has two entries, of which the second has the `outcome`. An entry about
    something else, as a version that is put to work, has no verb.
    """

    verb: Verb | None
    scope: str
    cell: str | None
    sentence: Sentence
    outcome: Outcome | None = field(default=None, repr=False)
    arguments: Arguments = field(default=(), repr=False)


LETS_GO = Grip.OFF.value


def outlives_power(notice: Remember | Journal | TaskChanged) -> bool:
    """True for a notice that not even a power cut may undo; every notice that was kept outlives its process.

    A loss may only make the next start more careful than it need be. So may be lost: that an effector has let
    go, that a zone is free, that a robot was put right, and the last steps of a task.
    """
    if not isinstance(notice, Remember):
        return True
    if notice.fact is Fact.STEP:
        return False
    if notice.fact is Fact.EFFECTOR:
        return notice.value != LETS_GO  # without its grip, a recovery would let go of the part
    return notice.value is not None or notice.fact not in (Fact.QUARANTINE, Fact.DISPLACED, Fact.MANUAL)


@dataclass(frozen=True, kw_only=True)
class InternalError:
    """Defect: an exception that nothing handles. `cell` is held for it; "" where it belongs to no cell.

    `error` has its traceback, for the log.
    """

    cell: str
    error: Exception


@dataclass(frozen=True, kw_only=True)
class Absence:
    """Absence of the plant: it did nothing for so long, as its process or its machine was suspended."""

    seconds: float


@dataclass(frozen=True, kw_only=True)
class RevisionName:
    """Name of a version: `digest` of its files, and its `number` among those that are kept."""

    digest: str
    number: int


@dataclass(frozen=True, kw_only=True)
class RevisionAnswer:
    """Answer to a request to put a version to work; `refusal` says why it was not, None where it was.

    `waits` has the cells that take it later, each with the task that has to end first, "" for no task. All
    other cells have taken it. `cancelled` are tasks that waited, and that this version does not take.
    """

    version: RevisionName
    refusal: Sentence | None = None
    waits: tuple[tuple[str, str], ...] = ()
    cancelled: tuple[str, ...] = ()
    request: str | None = None


@dataclass(frozen=True, kw_only=True)
class CellRevised:
    """A cell has taken a version, by which its tasks begin from now on."""

    cell: str
    version: RevisionName


Notice = (
    Heartbeat
    | SystemStart
    | TaskChanged
    | OperatorAnswer
    | Remember
    | Journal
    | InternalError
    | Absence
    | RevisionAnswer
    | CellRevised
)


class Receipt(NamedTuple):
    """The numbers of the last commands, by anybody, that a board accepted and did in one epoch."""

    epoch: int
    accepted: int
    done: int | None = None


class Tokens(NamedTuple):
    """The tokens of the last commands that a board accepted and did."""

    accepted: str | None = None
    done: str | None = None


@dataclass(frozen=True, kw_only=True)
class Report:
    """Report of a robot, in SI units; None stands for what it does not report.

    `epoch` names the bridge's start, `plant` the start of the plant whose heartbeat the bridge hears,
    `boot_id` the board's; `accepted`, `done` and `rejected` are command ids, the last of each; `refusal` is
    the word that came with `rejected`. `failed` is the last command that the robot itself gave up, `failure`
    its word for why; `answered` is the last query that it answered, with `answer`. `receipt` is what its
    board says of numbers, which outlive the start of plant and bridge, and `tokens` what it echoes of those
    very commands. `facts` are what it reports beside the fields here, `unknown` the names of those of which
    it does not know any more what they are. `lost` says why there is no link, where whoever reports that
    knows it. `foreign_refused` and `foreign_obeyed` count commands of others since the bridge's start,
    `foreign` tells of the last one. `number` is that of the telemetry behind it, which its board counts from
    its boot on.
    """

    at: float
    robot: str
    epoch: int | None = None
    plant: int | None = None
    boot_id: int | None = None
    accepted: str | None = None
    done: str | None = None
    rejected: str | None = None
    refusal: str | None = None
    failed: str | None = None
    failure: str | None = None
    answered: str | None = None
    answer: Value | None = None
    state: MotionState | None = None
    q: tuple[float, ...] | None = None
    node: int | None = None
    homed: bool | None = None
    effector: bool | None = None
    piece: bool | None = None
    facts: Facts | None = None
    unknown: tuple[str, ...] = ()
    receipt: Receipt | None = None
    tokens: Tokens | None = None
    lost: Sentence | None = None
    foreign_refused: int | None = None
    foreign_obeyed: int | None = None
    foreign: Sentence | None = None
    number: int | None = None

    def fact(self, name: str) -> Value | None:
        """The reported value of a fact; None where there is none."""
        if name in BUILT_IN:
            value: Value | None = getattr(self, name)
            return value
        return next((value for fact, value in self.facts or () if fact == name), None)

    @cached_property
    def words(self) -> tuple[object, ...]:
        """All values of it but the time and the number."""
        return _words(self)

    def again(self, at: float, **news: object) -> Report:
        """The same report at another time, with the values of `news`."""
        fields = vars(self).copy()  # several times as fast as `replace`, and most reports are repeats
        fields["at"] = at
        if news:
            fields.update(news)
            if news.keys() - WORDLESS:
                fields.pop("words", None)
        report = object.__new__(Report)
        object.__setattr__(report, "__dict__", fields)
        return report


BUILT_IN = frozenset({"homed", "effector", "piece"})  # facts that have a field of their own
WORDLESS = frozenset({"at", "number"})  # fields that are no value of the robot
_words = attrgetter(*(each.name for each in fields(Report) if each.name not in WORDLESS))


@dataclass(frozen=True, kw_only=True)
class TaskRequest:
    """Request for a task; `request` comes back in the TaskChanged that answers it.

    `trigger` marks a machine's start signal, which may be refused during the arm's own cycle. `kept` is the
    task of this id in the store, where an earlier start has accepted one. `choice` says why the task was
    given to this plant, where somebody chose between plants. `version` is the digest of the only version of
    the plant for which it was allowed, "" for any.
    """

    at: float
    text: str
    request: str | None = None
    trigger: bool = False
    kept: KeptTask | None = field(default=None, repr=False)
    choice: str = field(default="", repr=False)
    version: str = field(default="", repr=False)


@dataclass(frozen=True, kw_only=True)
class Undelivered:
    """A command could not leave this process; `sentence` says why."""

    at: float
    id: str
    robot: str
    sentence: Sentence


@dataclass(frozen=True, kw_only=True)
class LateDeparture:
    """A command left this process `late_s` after the step that gave it, as a commit came between."""

    at: float
    id: str
    late_s: float


@dataclass(frozen=True, kw_only=True)
class Interference:
    """Somebody else commanded a robot, whose link lets anybody command it."""

    at: float
    robot: str
    sentence: Sentence


@dataclass(frozen=True, kw_only=True)
class Uncontested:
    """The reports of a robot count again, after more than one node has published them.

    `said` are the states that were published meanwhile: each may be the robot's word, or a stranger's.
    """

    at: float
    robot: str
    said: tuple[MotionState, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Shutdown:
    """The plant is asked to end: it takes no new task, and halts what moves.

    Tasks that wait are kept for the next start; `drops_waiting`: those that this start accepted are
    cancelled.
    """

    at: float
    drops_waiting: bool = False


@dataclass(frozen=True, kw_only=True)
class OperatorRequest:
    """Request of an operator; `arguments` are those of its verb.

    `scope` is "" for the plant, else a cell, a robot, a zone (override), a task (cancel) or a person
    (answer). `by_hand`: a person has done it: put a robot at its reference (home), or taken a part out
    (release). `client` (cancel): the client of the task asks, and no operator.
    """

    at: float
    verb: Verb
    scope: str = ""
    by_hand: bool = False
    client: bool = False
    request: str | None = None
    arguments: Arguments = field(default=(), repr=False)

    def argument(self, name: str) -> int | str | None:
        """The argument of this name; None where there is none."""
        return next((value for each, value in self.arguments if each == name), None)


@dataclass(frozen=True, kw_only=True)
class Jog:
    """Press of a button by the person who teaches a cell, or its release.

    `session` is the number of the act that began the teaching, `number` counts the presses in it. The robot
    goes towards `goal`, or carries out the verb `word` with its values. The goal may change while the button
    is held. A press has to be sent again and again while it lasts: see `HOLD_S` in `core/teaching.py`.
    """

    at: float
    cell: str
    session: int
    number: int
    robot: str
    goal: Position | None = None
    word: str = ""
    values: Facts = ()
    held: bool = True


@dataclass(frozen=True, kw_only=True)
class Revision:
    """Request to put another version of the plant to work, which the plant knows by its digest.

    `by` is the person who asks, `changes` has what the version changes, a line each; both are for readers.
    """

    at: float
    version: RevisionName
    by: str = ""
    changes: tuple[str, ...] = ()
    request: str | None = None


@dataclass(frozen=True, kw_only=True)
class RestartRequest:
    """Request to restart the plant once its cells rest, or to drop such a request (`wanted` False).

    Until the restart no further task begins. `by` is the person who asks.
    """

    at: float
    by: str
    wanted: bool = True


@dataclass(frozen=True, kw_only=True)
class FaultByHand:
    """A fault that a person provoked at a virtual device began, or is over: for people who look back."""

    at: float
    robot: str
    sentence: Sentence
    is_over: bool = False


@dataclass(frozen=True, kw_only=True)
class ClockSet:
    """The wall clock of the plant's machine was set by so many `seconds`: for people who look back."""

    at: float
    seconds: float


Event = (
    Jog
    | Report
    | TaskRequest
    | OperatorRequest
    | Undelivered
    | LateDeparture
    | Interference
    | Uncontested
    | Shutdown
    | Revision
    | RestartRequest
    | FaultByHand
    | ClockSet
)
