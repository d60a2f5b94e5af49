"""Answers of a plant, as its HTTP API describes them (`/api/docs`): the same names, the same types."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, TypeVar

from .errors import LibraryMissing

ENDED = frozenset({"done", "failed", "cancelled"})
Value = bool | int | float | str
Item = TypeVar("Item")


class Rows(list[Item]):
    """Rows of an answer: a list, and a table of pandas where that is installed."""

    def to_pandas(self) -> Any:
        """A DataFrame with a column for each field; times stay Unix times. LibraryMissing without pandas."""
        try:
            import pandas  # type: ignore[import-not-found, import-untyped, unused-ignore]
        except ImportError as error:
            raise LibraryMissing("pandas is not installed; type: pip install pandas") from error
        return pandas.DataFrame([asdict(row) for row in self])  # type: ignore[call-overload, unused-ignore]


@dataclass(frozen=True, kw_only=True)
class Event:
    """Change of the plant: `kind` is snapshot, plant, cell, robot, task or zone, `row` what is so now."""

    id: str
    kind: str
    row: Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class TaskAnswer:
    """Answer that a device or a person gave while a task ran."""

    by: str
    asked: str
    answer: Value


@dataclass(frozen=True, kw_only=True)
class Task:
    """Task of the plant; `state` is queued, running, done, failed, cancelled or refused."""

    id: str
    text: str
    cell: str | None
    state: str
    reason: str | None = None
    sentence: str = ""
    key: str | None = None
    values: dict[str, Any] | None = None
    answers: list[TaskAnswer] = field(default_factory=list)
    choice: str | None = None
    unchecked: list[str] = field(default_factory=list)

    @property
    def has_ended(self) -> bool:
        return self.state in ENDED


@dataclass(frozen=True, kw_only=True)
class KeptTask:
    """Task of the history; times are Unix times, in seconds."""

    number: int
    id: str
    text: str
    cell: str
    recipe: str
    state: str
    reason: str | None = None
    sentence: str = ""
    key: str | None = None
    values: dict[str, Any] | None = None
    accepted_s: float
    started_s: float | None = None
    ended_s: float | None = None
    asked_by: str | None = None
    attempts: int = 0
    answers: list[TaskAnswer] = field(default_factory=list)
    choice: str | None = None
    unchecked: list[str] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """Sentence, for a person and as data."""

    sentence: str
    key: str | None
    values: dict[str, Any] | None


@dataclass(frozen=True, kw_only=True)
class TaskCause(Explanation):
    """Cause of a failure, by the record of the plant; `kind` is a word for programs."""

    kind: str
    robot: str | None


@dataclass(frozen=True, kw_only=True)
class TaskTrouble:
    """Trouble of a device around a failure; times in s since that."""

    at_s: float
    robot: str
    kind: str
    seconds: float | None
    cut: bool


@dataclass(frozen=True, kw_only=True)
class LastCommand:
    """Last command of the robot whose failure it was."""

    at_s: float
    robot: str
    id: str
    accepted_after_s: float | None


@dataclass(frozen=True, kw_only=True)
class Absence:
    """Time in which the plant itself did nothing."""

    at_s: float
    seconds: float


@dataclass(frozen=True, kw_only=True)
class OperatorAct:
    """Act of an operator, in words."""

    at_s: float
    words: str


@dataclass(frozen=True, kw_only=True)
class ForeignCommand:
    """Command of somebody else to a robot."""

    at_s: float
    robot: str


@dataclass(frozen=True, kw_only=True)
class TaskEvidence:
    """Facts from which the cause of a failure follows."""

    troubles: list[TaskTrouble]
    last_command: LastCommand | None
    absences: list[Absence]
    acts: list[OperatorAct]
    foreign: list[ForeignCommand]


@dataclass(frozen=True, kw_only=True)
class TaskReport:
    """Report of a task that failed; `state` is waiting or written."""

    task: str
    state: str
    text: str = ""
    cell: str = ""
    ended_s: float | None = None
    reason: str | None = None
    failure: Explanation | None = None
    cause: TaskCause | None = None
    evidence: TaskEvidence | None = None


@dataclass(frozen=True, kw_only=True)
class Done:
    """Outcome of a verb that is not refused; while `under_way`, its act tells the end."""

    verb: str
    scope: str
    act: int | None = None
    outcome: str | None = None
    why: str | None = None


@dataclass(frozen=True, kw_only=True)
class Act:
    """Act of an operator, with its present outcome."""

    number: int
    at: float
    verb: str
    scope: str
    cell: str | None
    sentence: str
    outcome: str
    why: str | None
    ended_at: float | None
    ended: str | None


@dataclass(frozen=True, kw_only=True)
class Advice:
    """Step that leads a cell out of its state."""

    do: str
    hand: bool
    scope: str
    by_hand: bool
    instead: bool
    said: str
    why: str
    moves: list[str]
    drops: list[str]
    refusal: str | None


@dataclass(frozen=True, kw_only=True)
class Device:
    """Device of a cell, in its role."""

    role: str
    name: str
    kind: str
    position: str | None
    holds: str | None
    asked: bool


@dataclass(frozen=True, kw_only=True)
class Place:
    """Target at which parts lie."""

    name: str
    parts: int
    holds: int
    device: str | None
    by_people: bool
    station: int | None


@dataclass(frozen=True, kw_only=True)
class Teaching:
    """Manual mode of a cell."""

    session: int
    teacher: str
    seconds: float
    robot: str | None
    number: int | None
    trouble: str | None


@dataclass(frozen=True, kw_only=True)
class Cell:
    """Cell of the plant, with its behavior tree depth first."""

    name: str
    state: str
    devices: list[Device]
    task: Task | None
    step: str | None
    queue: list[str]
    paused: bool
    waiting_for: str | None
    not_ready: str | None
    blocked_by: str | None
    held_by: str | None
    advice: list[Advice]
    refused: dict[str, str]
    tree: list[dict[str, Any]]
    places: list[Place]
    teaching: Teaching | None


@dataclass(frozen=True, kw_only=True)
class Asking:
    """Open question to a person."""

    id: str
    text: str
    answers: list[str]
    left_s: float


@dataclass(frozen=True, kw_only=True)
class Robot:
    """Device of any kind, as it is; `q` in rad and m."""

    name: str
    kind: str
    holder: str | None = None
    online: bool
    obstacle: str | None
    state: int | None
    age_s: float | None
    q: list[float] | None
    node: int | None
    facts: dict[str, Value | None]
    answer: Value | None
    question: Asking | None = None
    homed: bool | None
    latched: bool
    refused: dict[str, str]


@dataclass(frozen=True, kw_only=True)
class Snapshot:
    """The whole plant as of its last step."""

    plant: str
    epoch: int
    at: float
    ending: bool
    cells: list[Cell]
    robots: list[Robot]
    tasks: list[Task]
    zones: list[dict[str, Any]]
    acts: list[Act] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """Parameter of a recipe."""

    name: str
    called: str
    type: str
    choices: list[str]
    lower: float | None = None
    upper: float | None = None


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """Recipe that a cell offers."""

    name: str
    about: str
    default: bool
    form: str
    example: str
    parameters: list[Parameter]


@dataclass(frozen=True, kw_only=True)
class Offer:
    """Recipes of one cell."""

    cell: str
    recipes: list[Recipe]


@dataclass(frozen=True, kw_only=True)
class Promise:
    """Promise of a cell for a task that it has not been given."""

    cell: str
    text: str
    seconds: float
    hindrance: str | None
    full: bool


@dataclass(frozen=True, kw_only=True)
class CellOee:
    """OEE of one cell; shares from 0 to 1, None where `missing` says why."""

    cell: str
    since_s: float
    until_s: float
    planned_s: float
    worked_s: float
    done: int
    failed: int
    timed: int
    availability: float | None
    performance: float | None
    quality: float | None
    oee: float | None
    missing: str | None


@dataclass(frozen=True, kw_only=True)
class AssistantLevel:
    """Level of assistants in the plant file, off, read, propose or submit, and the limits of their tasks."""

    level: str
    cells: list[str]
    at_once: int
    hours: str | None


@dataclass(frozen=True, kw_only=True)
class Editing:
    """Editor of the draft, and the time since when."""

    name: str
    since: str


@dataclass(frozen=True, kw_only=True)
class DraftState:
    """State of the draft of the plant's files."""

    file: str
    digest: str
    editor: Editing | None
    changes: list[str]
    waiting: list[str]
    undo: int
    redo: int
    values: dict[str, Any]
    trees: list[str]
    restart: list[str]
    is_ours: bool
    set_aside: list[str]


@dataclass(frozen=True, kw_only=True)
class DraftCheck:
    """Findings of `arboleda check` on the draft."""

    problems: list[str]
    warnings: list[str]


@dataclass(frozen=True, kw_only=True)
class DraftChoice:
    """Value that the plant file could have, and what would stand there."""

    text: str
    value: dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class DraftOffer:
    """Offer to state what nobody knows: one of these values at this place of the plant file."""

    sentence: str
    place: list[str]
    choices: list[DraftChoice]


@dataclass(frozen=True, kw_only=True)
class CheckedDraft(DraftCheck):
    """Findings of `arboleda check` on the draft with this digest, and what its plant file could state."""

    digest: str
    offers: list[DraftOffer]


@dataclass(frozen=True, kw_only=True)
class KeptDraft(DraftCheck):
    """The draft, kept as a version; None with its problems where nothing was changed."""

    version: int | None


@dataclass(frozen=True, kw_only=True)
class AppliedDraft(KeptDraft):
    """The version, put to work: when each cell takes it."""

    cells: dict[str, str]
    cancelled: list[str]
    restart: list[str]


@dataclass(frozen=True, kw_only=True)
class TreesText:
    """File of trees of the draft."""

    file: str
    text: str


@dataclass(frozen=True, kw_only=True)
class VersionRow:
    """Version of the plant's files that was put to work."""

    number: int
    at: str
    by: str
    note: str
    changes: list[str]
    is_at_work: bool


@dataclass(frozen=True, kw_only=True)
class AtWork:
    """Version at work."""

    number: int | None
    at: str


@dataclass(frozen=True, kw_only=True)
class CellVersion:
    """Version by which a cell works, and which it takes next."""

    cell: str
    version: int | None
    following: int | None
    when: str


@dataclass(frozen=True, kw_only=True)
class Restart:
    """Wish for a restart once all cells rest."""

    by: str
    can: bool


@dataclass(frozen=True, kw_only=True)
class VersionList:
    """Versions of the plant's files, oldest first."""

    at_work: AtWork
    versions: list[VersionRow]
    cells: list[CellVersion]
    restart: Restart


@dataclass(frozen=True, kw_only=True)
class FaultKind:
    """Fault that can be provoked at a virtual device."""

    robot: str
    kind: str
    about: str
    lasts: bool


@dataclass(frozen=True, kw_only=True)
class ProvokedFault:
    """Fault that was provoked, and goes on for so long."""

    number: int
    robot: str
    kind: str
    about: str
    left_s: float


@dataclass(frozen=True, kw_only=True)
class FaultList:
    """Faults that go on, and those that can be provoked."""

    begun: list[ProvokedFault]
    offers: list[FaultKind]


@dataclass(frozen=True, kw_only=True)
class TreeFile:
    """File of trees that is a recipe of the plant."""

    recipe: str
    file: str
    cells: list[str]
    text: str


@dataclass(frozen=True, kw_only=True)
class TreeMark:
    """Finding of `check` on a node; a warning where `mistake` is False."""

    sentence: str
    mistake: bool
    line: int
    column: int
    tree: str | None
    path: str | None
    attribute: str | None


@dataclass(frozen=True, kw_only=True)
class DrawnTree:
    """Tree of a file, node by node."""

    name: str
    main: bool
    parameters: list[dict[str, str]]
    nodes: list[dict[str, Any]]


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """File of trees, with what `check` says of its nodes."""

    text: str
    trees: list[DrawnTree]
    marks: list[TreeMark]


@dataclass(frozen=True, kw_only=True)
class TreeCopy:
    """Recipe in Python as the text of a tree."""

    text: str


@dataclass(frozen=True, kw_only=True)
class Nodes:
    """Nodes of one sort that a tree can have."""

    sort: str
    name: str
    kinds: list[dict[str, Any]]


@dataclass(frozen=True, kw_only=True)
class DraftCells:
    """Cells of the draft, and the faults that can befall them."""

    cells: list[dict[str, Any]]
    faults: list[dict[str, str]]
    problems: list[str]


@dataclass(frozen=True, kw_only=True)
class RunState:
    """State of what is tried or proved; `state` is idle, running, done, failed or stopped."""

    state: str
    sentence: str | None = None
    doing: str | None = None
    done: int | None = None
    total: int | None = None


@dataclass(frozen=True, kw_only=True)
class DriverRow:
    """Driver that a device of a declared kind can have."""

    name: str
    about: str
    why_not: str
    keys: list[dict[str, Any]]


@dataclass(frozen=True, kw_only=True)
class ProposalBase:
    """Parts of the plant's files that a proposal can build on, and the digest of the version at work."""

    version: str
    cells: dict[str, dict[str, Any]]
    kinds: dict[str, Any]
    trees: dict[str, str]


@dataclass(frozen=True, kw_only=True)
class ProposalRow:
    """Proposal of an assistant; `stage` is open, replaced, withdrawn, rejected or approved."""

    hash: str
    name: str
    by: str
    words: str
    at: str
    recipes: list[str]
    changes: list[str]
    warnings: list[str]
    made_for: str
    fits: bool
    stage: str
    decided_by: str
    decided_at: str
    reason: str
    version: int | None


@dataclass(frozen=True, kw_only=True)
class ProposalAnswer:
    """Proposal that was kept; with `problems` it was not, and `hash` is None."""

    hash: str | None
    problems: list[str]
    warnings: list[str]
    stage: str = ""
    reason: str = ""
    changes: list[str] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True)
class WholeProposal(ProposalRow):
    """Proposal with its trees as text and as pictures (SVG), and what was proved and simulated of it."""

    trees: dict[str, str]
    differing: list[str]
    differences: dict[str, str]
    pictures: dict[str, str]
    proof: dict[str, Any] | None
    proof_state: RunState
    simulation: dict[str, Any] | None
    simulation_state: RunState


@dataclass(frozen=True, kw_only=True)
class DecidedProposal(ProposalRow, AppliedDraft):
    """Proposal that was approved and put to work; with `problems` neither was done."""
