"""What the API takes and gives, for its description; screens get more keys than are listed."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from arboleda.core.cell_states import CellState
from arboleda.core.messages import Verb


class _Asked(BaseModel):
    """What a client sends: these keys and no others, of exactly these types."""

    model_config = ConfigDict(extra="forbid", strict=True)


class _Told(BaseModel):
    """What a client gets; more keys may come."""

    model_config = ConfigDict(extra="allow")


class TaskText(_Asked):
    text: str = Field(examples=["sis_a 0B 7"], description="A task, as on the command line.")


class TaskForm(_Asked):
    """A task as a form of `/api/recipes` has it."""

    cell: str = Field(examples=["sis_a"])
    recipe: str = Field(default="", description="One of the cell's recipes; without it the default one.")
    values: dict[str, bool | int | float | str] = Field(
        default={}, examples=[{"path": "0B", "station": 7}], description="A value for each parameter."
    )
    id: str = Field(default="", description="Of your choice; the same id again asks for the same task.")


class ByHand(_Asked):
    by_hand: bool = Field(
        default=False, description="For home: nothing moves, you declare that the robot is at its reference."
    )


class Sentence(_Told):
    """What went wrong, for a person and as data."""

    sentence: str = Field(examples=["'sis_z' is not a cell of this plant; there are sis_a, sis_b, sis_c"])
    key: str | None = Field(
        default=None, examples=["text.unknown"], description="What it says, whatever its language."
    )
    values: dict[str, Any] | None = Field(default=None, description="What stands in it, by name.")


class Task(_Told):
    id: str
    text: str
    cell: str | None
    state: str = Field(description="queued, running, done, failed, cancelled or refused.")
    reason: str | None = None
    sentence: str = ""
    key: str | None = Field(default=None, description="What its sentence says, as of a Sentence.")
    values: dict[str, Any] | None = None


class Parameter(_Told):
    """What a recipe wants to know; more types may come."""

    name: str
    called: str = Field(description="Its name for people.")
    type: str = Field(description="`choice`: one of its `choices`; `integer`, `number`: within its limits.")
    choices: list[str]
    lower: float | None = None
    upper: float | None = None


class Recipe(_Told):
    name: str
    about: str = Field(description="What it does, in a line.")
    default: bool = Field(description="A task that names no recipe means this one.")
    form: str = Field(examples=["<cell> <path> <station>"], description="How its task text is written.")
    example: str = Field(examples=["sis_a 0A 8"])
    parameters: list[Parameter]


class Offer(_Told):
    cell: str
    recipes: list[Recipe]


class Done(_Told):
    verb: Verb
    scope: str = Field(description="A cell, robot, zone or task id; empty for the whole plant.")


class Advice(_Told):
    """One thing to do that leads a cell out of its state."""

    do: str = Field(description="A verb; or, where `hand`: bring_back, repair, reference, check or free.")
    hand: bool = Field(description="Only a person at the machine can do it.")
    scope: str = Field(description="A cell, a robot or a zone.")
    by_hand: bool = Field(description="For `home`: the robot was put at its reference.")
    instead: bool = Field(description="It begins another way out than those before it.")
    said: str = Field(description="In words, as the command line takes a verb.")
    why: str
    moves: list[str] = Field(description="Robots that it may set in motion.")
    drops: list[str] = Field(description="Arms whose part falls.")
    refusal: str | None = Field(description="Why it would be refused now.")


class Device(_Told):
    role: str
    name: str
    kind: str = Field(description="arm, mobile, or a kind of your own.")
    position: str | None = Field(description="The key of its row under `robots` that has its position.")
    holds: str | None = Field(description="The fact that says whether it holds a part.")


class Cell(_Told):
    """Cells of storage also have the names of their `arm` and `mobile` under these keys."""

    name: str
    state: CellState = Field(description="By PackML's word, as everywhere; an idle one may have `not_ready`.")
    devices: list[Device] = Field(description="Who works in it, by role.")
    task: Task | None
    step: str | None = Field(description="The step that runs.")
    queue: list[str] = Field(description="Ids of the tasks that wait.")
    paused: bool
    waiting_for: str | None
    not_ready: str | None = Field(description="Why an idle cell would start no task, and what can be done.")
    blocked_by: str | None = Field(description="The robot whose obstacle that is.")
    held_by: str | None = Field(description="Why the cell is held, and what can be done.")
    advice: list[Advice] = Field(description="What leads it out of its state, in the order to do it.")
    refused: dict[str, str] = Field(description="The verbs that would be refused for it now, and why.")
    tree: list[dict[str, Any]] = Field(description="The behavior tree, depth first.")


class Asking(_Told):
    """What a person is being asked; `POST /api/cells/<person> <answer>/answer` answers it."""

    id: str
    text: str
    answers: list[str]
    left_s: float = Field(description="Until the question ends unanswered.")


class Robot(_Told):
    """A device of any kind."""

    name: str
    kind: str
    online: bool
    obstacle: str | None = Field(description="Why it gets no command now.")
    state: int | None = Field(
        description="motion_state: 0 stopped, 1 moving, 2 fault, 3 not homed, 4 latched."
    )
    age_s: float | None
    q: list[float] | None = Field(description="Joints of an arm in rad and m, measured.")
    node: int | None = Field(description="Node of a mobile robot on its grid.")
    facts: dict[str, bool | int | float | str | None] = Field(
        description="What it reports besides, by name; null where it was not said yet."
    )
    answer: bool | int | float | str | None = Field(description="To its last command, where that asked.")
    question: Asking | None = Field(default=None, description="What a person is being asked now.")
    homed: bool | None
    latched: bool
    refused: dict[str, str] = Field(description="The verbs that would be refused for it now, and why.")


class Snapshot(_Told):
    """The plant as of its last step."""

    plant: str
    epoch: int
    at: float = Field(description="Monotonic seconds of the plant's clock.")
    ending: bool
    cells: list[Cell]
    robots: list[Robot]
    tasks: list[Task]
    zones: list[dict[str, Any]]
