"""Answers of the API: faults by hand, and reports of tasks that failed with the evidence in them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Any, Literal


@dataclass(frozen=True, kw_only=True)
class FaultKind:
    """Fault that can be provoked at a virtual device."""

    robot: str
    kind: str
    about: str
    lasts: Annotated[bool, "False: it is over at once."]


@dataclass(frozen=True, kw_only=True)
class ProvokedFault:
    """Fault that was provoked, and goes on for so long."""

    number: int
    robot: str
    kind: str
    about: str
    left_s: Annotated[float, "For how long it goes on; 0.0: it was an instant."]


@dataclass(frozen=True, kw_only=True)
class FaultList:
    """Faults that go on, and those that can be provoked."""

    begun: Annotated[list[ProvokedFault], "Those that go on, the first one first."]
    offers: Annotated[list[FaultKind], "What can be provoked; empty where no device is virtual."]


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """Sentence, for a person and as data."""

    sentence: str
    key: str | None
    values: dict[str, Any] | None


@dataclass(frozen=True, kw_only=True)
class TaskCause(Explanation):
    """Cause of a failure, by the record of the plant."""

    kind: Annotated[str, "A word for programs; docs/how-to/failed-at-night.md"] = field(
        metadata={"examples": ["silence"]}
    )
    robot: str | None


@dataclass(frozen=True, kw_only=True)
class TaskTrouble:
    """Trouble of a device around the failure."""

    at_s: Annotated[float, "Since the failure, as all times here."]
    robot: str
    kind: Annotated[str, "silence, boot, alarm or bridge."]
    seconds: Annotated[float | None, "Null: to the end."]
    cut: Annotated[bool, "Its connection broke."]


@dataclass(frozen=True, kw_only=True)
class LastCommand:
    """Last command of the robot whose failure it was."""

    at_s: float
    robot: str
    id: str
    accepted_after_s: Annotated[float | None, "Null: it never said so."]


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
    """Facts from which the cause follows."""

    troubles: list[TaskTrouble]
    last_command: LastCommand | None
    absences: list[Absence]
    acts: list[OperatorAct]
    foreign: list[ForeignCommand]


@dataclass(frozen=True, kw_only=True)
class ReportChapter:
    """Chapter that a package has written; its picture is in the page of the report."""

    package: str
    title: str
    text: str
    rows: list[list[str]]
    picture: Annotated[str, "The media type of its picture; empty where it has none."]


@dataclass(frozen=True, kw_only=True)
class TaskReport:
    """Report of a task; while it is `waiting`, it has nothing but its task. Of one that has not failed there
    is one where a package has written a chapter."""

    task: str
    state: Literal["waiting", "written"]
    text: str = ""
    cell: str = ""
    ended_s: Annotated[float | None, "Unix time, in seconds."] = None
    reason: str | None = None
    failure: Annotated[Explanation | None, "As the plant said it then."] = None
    cause: TaskCause | None = None
    evidence: TaskEvidence | None = None
    chapters: Annotated[list[ReportChapter], "What packages wrote."] = field(default_factory=list)
