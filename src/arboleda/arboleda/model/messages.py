"""Messages across the core's border beside commands: notices out, events in."""

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
    """Reason of a failure; one each."""

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
    """One reason and one sentence for the operator."""

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
    """Course of a task that was done: the s it took, and after how many each of its steps began last, by
    the step's name and its number among those of that name. While it was held no time passed.
    """

    seconds: float
    begun: Mapping[str, float]

    def left(self, step: str, seconds: float) -> float | None:
        """Time in s that was left so many s after this step had begun, at least what was left when the next
        one began; None where it did not come to this step.
        """
        at = self.begun.get(step)
        if at is None:
            return None
        following = min((each for each in self.begun.values() if each > at), default=self.seconds)
        return self.seconds - min(at + seconds, following)


class Check(str, Enum):
    """A part of a task's work that no device may have confirmed, though the task is done."""

    GRIP = "grip"
    RELEASE = "release"


@dataclass(frozen=True, kw_only=True)
class KeptTask:
    """Task of an earlier start, as it was kept; times in s of this start's clock.

    `recipe` is "" where nobody knows; `choice` says why it is done in its cell, where several were allowed.
    `course` is known of tasks that were done from their beginning in one start of the plant. `is_bound` marks
    a task that may begin only in the start, and by the version of the plant, for which it was allowed.
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
    """One change of a task; `request` is the token of the request that caused it, if one did. `for_now`
    says of a refused one that the same text may be taken later. `choice` says why it is done in this cell,
    where several were allowed; `course` how one went that is done, `unchecked` what nobody confirmed."""

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
    """Answer to an operator's request; `refusal` says why nothing was done, None where it was.

    `act` is the number under which its `outcome`, and why so, is told on where that is still to come.
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
    """Fact that must survive a restart of the plant."""

    LATCH = "latch"  # robot -> "on", or "cleared" until its cell is reset
    EFFECTOR = "effector"  # arm -> "on", "off" or "switching"
    EMPTIED = "emptied"  # device that says that it holds a part -> "true" while a person has taken that out
    QUARANTINE = "quarantine"  # zone -> the robot that may still be in it
    PARTS = "parts"  # cell -> its places with parts, as `trees/part_places.py` writes them
    STORED = (
        "stored"  # by version 0.1: cell -> the numbers of its stations with a part, "0 7"; now in `parts`
    )
    DISPLACED = "displaced"  # robot that cannot say so -> "true" while its position means nothing
    BOOT = "boot"  # such a robot -> the boot in which it was heard last
    MANUAL = "manual"  # cell -> who teaches it, until its end has been told
    STEP = "step"  # running task -> where its tree stands, as `resume/trail.py` writes it


@dataclass(frozen=True, kw_only=True)
class Remember:
    """A fact to keep before anything sent after it leaves; None forgets it."""

    fact: Fact
    name: str
    value: str | None


@dataclass(frozen=True, kw_only=True)
class Journal:
    """One act of an operator, kept for good; `cell` is the one it was for, None where it was for more.

    An act of devices has two of them: `outcome` is in that of its end. A version that is put to work is an
    act without a verb.
    """

    verb: Verb | None
    scope: str
    cell: str | None
    sentence: Sentence
    outcome: Outcome | None = field(default=None, repr=False)
    arguments: Arguments = field(default=(), repr=False)


LETS_GO = Grip.OFF.value


def outlives_power(kept: Remember | Journal | TaskChanged) -> bool:
    """True where not even a power cut may undo it; all that was kept survives a process that dies.

    What is lost may only make the plant more careful than it need be: that an effector has let go, that a
    zone is free again, that a robot was put right, the last steps of a task.
    """
    if not isinstance(kept, Remember):
        return True
    if kept.fact is Fact.STEP:
        return False
    if kept.fact is Fact.EFFECTOR:
        return kept.value != LETS_GO  # what has gripped and counts as switching lets go in a recovery
    return kept.value is not None or kept.fact not in (Fact.QUARANTINE, Fact.DISPLACED, Fact.MANUAL)


@dataclass(frozen=True, kw_only=True)
class InternalError:
    """A defect: something raised what nobody handles. `cell` is held for it, "" where it belongs to none.

    `error` carries its traceback, for the log.
    """

    cell: str
    error: Exception


@dataclass(frozen=True, kw_only=True)
class Absence:
    """The plant did nothing for so many seconds: its process was stopped, or its machine suspended."""

    seconds: float


@dataclass(frozen=True, kw_only=True)
class RevisionName:
    """Name of a version: `digest` of its files, and its `number` among those that are kept."""

    digest: str
    number: int


@dataclass(frozen=True, kw_only=True)
class RevisionAnswer:
    """Answer to a request to put a version to work; `refusal` says why nothing was, None where it was.

    `waits` has the cells that take it later, each with the task that has to end before, "" where something
    else has to; all others have it. `cancelled` are tasks that waited and that it does not offer any more.
    """

    version: RevisionName
    refusal: Sentence | None = None
    waits: tuple[tuple[str, str], ...] = ()
    cancelled: tuple[str, ...] = ()
    request: str | None = None


@dataclass(frozen=True, kw_only=True)
class CellRevised:
    """A cell has taken a version: from now on its tasks begin by that."""

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
    """The numbers of the last commands that a board accepted and did, whoever gave them, of one epoch."""

    epoch: int
    accepted: int
    done: int | None = None


class Tokens(NamedTuple):
    """The tokens of the last commands that a board accepted and did, as its commands carried them."""

    accepted: str | None = None
    done: str | None = None


@dataclass(frozen=True, kw_only=True)
class Report:
    """Report of a robot, in SI units; None stands for what it does not report.

    `epoch` names the bridge's start, `plant` the start of the plant whose heartbeat the bridge hears,
    `boot_id` the board's; `accepted`, `done` and `rejected` are
    command ids, the last of each; `refusal` is the word that came with `rejected`. `failed` is the last
    command that the robot itself gave up, `failure` its word for why; `answered` is the last query that it
    answered, with `answer`. `receipt` is what its board says of numbers, which outlive the start of plant and
    bridge, and `tokens` what it echoes of those very commands. `facts` are what it reports beside the fields
    here. `lost` says why there is no link, where whoever reports that knows it. `foreign_refused` and
    `foreign_obeyed` count commands of others since the bridge's start, `foreign` tells of the last one.
    `number` is that of the telemetry behind it, which its board counts from its boot on.
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
        """All that it says, when apart."""
        return _words(self)

    def again(self, at: float, **news: object) -> Report:
        """The same words, said once more, but for the news."""
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
WORDLESS = frozenset({"at", "number"})  # when and as which message it was said
_words = attrgetter(*(each.name for each in fields(Report) if each.name not in WORDLESS))


@dataclass(frozen=True, kw_only=True)
class TaskRequest:
    """Somebody asks for a task; `request` comes back in the TaskChanged that answers it.

    `trigger` marks a machine's start signal, which may be refused during the arm's own cycle. `kept` is the
    task of this id, where an earlier start has accepted it: no part of what is asked. `choice` is why it was
    given to its cell, in the words of who chose between plants. `version` is the digest of the only version
    of the plant for which it was allowed, "" where any will do.
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
    """A command left this process so many seconds after the step that gave it: a commit came between."""

    at: float
    id: str
    late_s: float


@dataclass(frozen=True, kw_only=True)
class Interference:
    """Somebody else commanded a robot that its link lets everybody command."""

    at: float
    robot: str
    sentence: Sentence


@dataclass(frozen=True, kw_only=True)
class Shutdown:
    """The plant is asked to end: no new task, whatever moves is halted.

    What waits is left for the next start, unless `drops_waiting`: then what this start accepted is cancelled.
    """

    at: float
    drops_waiting: bool = False


@dataclass(frozen=True, kw_only=True)
class OperatorRequest:
    """An operator's act; `scope` is "" for the plant, a cell, a robot, a zone (override), a task (cancel) or
    a person (answer), `arguments` are those of its verb.

    `by_hand` declares what a person has done: a robot stands at its reference (home), the part that a device
    held was taken out (release). `client` (cancel): who asks is no
    operator but the client of the task itself.
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
        return next((value for known, value in self.arguments if known == name), None)


@dataclass(frozen=True, kw_only=True)
class Jog:
    """Press of a button by the person who teaches a cell, or its release: `session` is the number of the act
    that began the teaching, `number` counts the presses in it.

    Its robot goes towards `goal`, or carries out the verb `word` with its values. A goal may be another one
    while the button is held. What is held has to be said again and again: see `HOLD_S` in `core/teaching.py`.
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
    """Somebody puts another version of the plant to work, which the plant knows by its digest.

    `by` is who does, `changes` what it changes in words, a line each: they are for people who read of it.
    """

    at: float
    version: RevisionName
    by: str = ""
    changes: tuple[str, ...] = ()
    request: str | None = None


@dataclass(frozen=True, kw_only=True)
class RestartRequest:
    """Somebody wants the plant to start anew once its cells rest, or does not want that any more.

    Until then no further task begins. `by` is who asks, for people who read of it.
    """

    at: float
    by: str
    wanted: bool = True


@dataclass(frozen=True, kw_only=True)
class FaultByHand:
    """A person had something go wrong with a virtual device, or that is over: for people who look back."""

    at: float
    robot: str
    sentence: Sentence
    is_over: bool = False


Event = (
    Jog
    | Report
    | TaskRequest
    | OperatorRequest
    | Undelivered
    | LateDeparture
    | Interference
    | Shutdown
    | Revision
    | RestartRequest
    | FaultByHand
)
