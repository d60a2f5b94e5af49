"""The whole plant: cells, robots, and what leads a cell out of its state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

from arboleda.model.cell_states import CellState
from arboleda.model.facts import Value

from .tasks import Act, Task


@dataclass(frozen=True, kw_only=True)
class Event:
    """Change of the plant: `kind` is snapshot, plant, cell, robot, task or zone, `row` what is so now."""

    id: str
    kind: str
    row: Mapping[str, Any]


@dataclass(frozen=True, kw_only=True)
class Advice:
    """Step that leads a cell out of its state."""

    do: Annotated[
        str, "A verb; or, where `hand`: bring_back, repair, reference, check, free, take_out, leave_in."
    ]
    hand: Annotated[bool, "Only a person at the machine can do it."]
    scope: Annotated[str, "A cell, a robot or a zone."]
    by_hand: Annotated[
        bool, "For `home`: the robot was put at its reference; for `release`: the part was taken out."
    ]
    arguments: Annotated[Mapping[str, int | str], "What the verb is told beside its scope."]
    instead: Annotated[bool, "It begins another way out than those before it."]
    said: Annotated[str, "In words, as the command line takes a verb."]
    why: str
    moves: Annotated[list[str], "Robots that it may set in motion."]
    drops: Annotated[list[str], "Arms whose part falls."]
    refusal: Annotated[str | None, "Why it would be refused now."]


@dataclass(frozen=True, kw_only=True)
class Device:
    """Device of a cell, in its role."""

    role: str
    name: str
    kind: Annotated[str, "arm, mobile, or a kind of your own."]
    position: Annotated[str | None, "The key of its row under `robots` that has its position."]
    holds: Annotated[str | None, "The fact that says whether it holds a part."]
    asked: Annotated[bool, "Whether it is a person, who answers on the plant's own screens."]


@dataclass(frozen=True, kw_only=True)
class Place:
    """A target at which parts lie."""

    name: str
    parts: Annotated[int, "How many are known to be there."]
    holds: Annotated[int, "How many it holds at most."]
    device: Annotated[str | None, "The device in or under which it is."]
    by_people: Annotated[bool, "Whether people fill or empty it before each task."]
    asked: Annotated[bool, "Whether a failed task has left it full, and a person has to say what is there."]
    station: Annotated[int | None, "Its number in the rack of a cell that stores."]


@dataclass(frozen=True, kw_only=True)
class Teaching:
    """Manual mode of a cell: nothing moves in it but what its teacher holds."""

    session: Annotated[int, "The act by which it began."]
    teacher: str
    seconds: Annotated[float, "Since it began."]
    robot: Annotated[str | None, "The device that moves."]
    number: Annotated[int | None, "The press that is held."]
    trouble: Annotated[str | None, "Why the last press came to nothing, or ended too early."]


@dataclass(frozen=True, kw_only=True)
class Cell:
    """Cells of storage also have the names of their `arm` and `mobile` under these keys."""

    name: str
    state: Annotated[str, CellState, "By PackML's word, as everywhere; an idle one may have `not_ready`."]
    devices: Annotated[list[Device], "Who works in it, by role."]
    task: Task | None
    step: Annotated[str | None, "The step that runs."]
    queue: Annotated[list[str], "Ids of the tasks that wait."]
    paused: bool
    waiting_for: str | None
    not_ready: Annotated[str | None, "Why an idle cell would start no task, and what can be done."]
    blocked_by: Annotated[str | None, "The robot whose obstacle that is."]
    held_by: Annotated[str | None, "Why the cell is held, and what can be done."]
    advice: Annotated[list[Advice], "What leads it out of its state, in the order to do it."]
    refused: Annotated[dict[str, str], "The verbs that would be refused for it now, and why."]
    tree: Annotated[list[dict[str, Any]], "The behavior tree, depth first."]
    places: Annotated[list[Place], "Where parts lie in it."]
    teaching: Annotated[Teaching | None, "Its manual mode, while somebody teaches it."]


@dataclass(frozen=True, kw_only=True)
class Asking:
    """Open question to a person; `POST /api/cells/<person>/answer` with `{"answer": "yes"}` answers it."""

    id: str
    text: str
    answers: list[str]
    left_s: Annotated[float, "Until the question ends unanswered."]


@dataclass(frozen=True, kw_only=True)
class Robot:
    """A device of any kind."""

    name: str
    kind: str
    holder: Annotated[str | None, "Of what cells share: the cell that holds it."] = None
    online: bool
    obstacle: Annotated[str | None, "Why it gets no command now."]
    state: Annotated[int | None, "motion_state: 0 stopped, 1 moving, 2 fault, 3 not homed, 4 latched."]
    age_s: float | None
    q: Annotated[list[float] | None, "Joints of an arm in rad and m, measured."]
    node: Annotated[int | None, "Node of a mobile robot on its grid."]
    facts: Annotated[
        dict[str, Value | None], "What it reports besides, by name; null where it was not said yet."
    ]
    answer: Annotated[Value | None, "To its last command, where that asked."]
    question: Annotated[Asking | None, "What a person is being asked now."] = None
    homed: bool | None
    latched: bool
    refused: Annotated[dict[str, str], "The verbs that would be refused for it now, and why."]


@dataclass(frozen=True, kw_only=True)
class PackageAlarm:
    """Alarm that a package has raised, and has not ended yet."""

    id: int
    package: str
    cell: Annotated[str, "The cell that it is about; empty where it is about none."]
    level: Annotated[str, "warning, or error where somebody is needed."]
    sentence: str


@dataclass(frozen=True, kw_only=True)
class PackageQuestion:
    """Open question of a package; `POST /api/cells/<package>/answer` with `{"answer": "yes"}` answers it."""

    id: str
    package: str
    text: str
    answers: list[str]


@dataclass(frozen=True, kw_only=True)
class Snapshot:
    """The plant as of its last step."""

    plant: str
    epoch: int
    at: Annotated[float, "Monotonic seconds of the plant's clock."]
    ending: bool
    cells: list[Cell]
    robots: list[Robot]
    tasks: list[Task]
    zones: Annotated[
        list[dict[str, Any]],
        "Zones and devices that cells share, each with its state, who holds it and who waits.",
    ]
    acts: Annotated[list[Act], "What operators did last, oldest first."] = field(default_factory=list)
    alarms: Annotated[list[PackageAlarm], "Alarms of packages."] = field(default_factory=list)
    questions: Annotated[list[PackageQuestion], "What packages ask."] = field(default_factory=list)
    chapters: Annotated[list[str], "Tasks that packages wrote about: the last 200 of this start."] = field(
        default_factory=list
    )
