"""Requests and answers of the API, for its description; snapshots have more keys than are listed."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, create_model, model_validator

from arboleda.model.cell_states import CellState
from arboleda.model.errors import PayloadError
from arboleda.model.messages import Outcome, Verb
from arboleda.model.text import BETWEEN_CELLS
from arboleda.model.verbs import Arguments
from arboleda.store.task_rows import TaskQuery
from arboleda.views.verb_words import ABOUT

ANYTHING = ".+"  # the form of an argument that has none of its own


class _RequestModel(BaseModel):
    """Body of a request: these keys and no others, of exactly these types."""

    model_config = ConfigDict(extra="forbid", strict=True)


class ResponseModel(BaseModel):
    """Answer of the API; more keys may be added to it."""

    model_config = ConfigDict(extra="allow")


class TaskFilter(BaseModel):
    """Filter for tasks of the history; without any key the last `limit` tasks."""

    model_config = ConfigDict(extra="forbid")

    cell: str = ""
    state: Literal["", "queued", "running", "done", "failed", "cancelled"] = ""
    recipe: str = ""
    words: str = Field(default="", description="In the task's text or id.")
    since: float | None = Field(default=None, description="Accepted since then, Unix time in seconds.")
    until: float | None = Field(default=None, description="Accepted before then.")
    before: int | None = Field(default=None, description="With a lower number, as the next page begins.")
    limit: int = Field(default=100, ge=1, le=1000)

    def query(self) -> TaskQuery:
        """This filter as a query to the plant's memory."""
        return TaskQuery(
            cell=self.cell,
            state=self.state,
            recipe=self.recipe,
            words=self.words,
            since_s=self.since,
            until_s=self.until,
            before=self.before,
            limit=self.limit,
        )


class FindingLines(_RequestModel):
    """Findings in English, as the API gives them, that a page wants in its language."""

    lines: list[Annotated[str, Field(max_length=5000)]] = Field(max_length=1000)


class TaskText(_RequestModel):
    text: str = Field(examples=["sis_a 0B 7"], description="A task, as on the command line.")
    why: str = Field(
        default="", max_length=500, description="Why it is given to this cell, by who chose between plants."
    )


class TaskForm(_RequestModel):
    """A task as a form of `/api/recipes` has it; either for a `cell`, or for `any_of` several."""

    model_config = ConfigDict(json_schema_extra={"oneOf": [{"required": ["cell"]}, {"required": ["any_of"]}]})

    cell: str = Field(default="", examples=["sis_a"])
    any_of: list[str] = Field(
        default=[], examples=[["sis_a", "sis_b"]], description="Cells of which the plant chooses one."
    )
    recipe: str = Field(default="", description="One of the cell's recipes; without it the default one.")
    values: dict[str, bool | int | float | str] = Field(
        default={}, examples=[{"path": "0B", "station": 7}], description="A value for each parameter."
    )
    id: str = Field(default="", description="Of your choice; the same id again asks for the same task.")

    @model_validator(mode="after")
    def _check_cell(self) -> TaskForm:
        if bool(self.cell) is bool(self.any_of):
            raise ValueError("either cell or any_of is needed")
        return self

    def named(self) -> dict[str, Any]:
        """The arguments for `spelled`."""
        named = self.model_dump(exclude={"any_of"})
        return named | {"cell": self.cell or BETWEEN_CELLS.join(self.any_of)}


class AnyVerbArguments(_RequestModel):
    """Arguments of an operator's verb."""

    by_hand: bool = Field(
        default=False,
        description="Nothing moves, you declare what was done by hand: for home, that the robot is at its "
        "reference; for release, that the part was taken out.",
    )

    def of(self, verb: Verb) -> Arguments:
        """The arguments of this verb; raises PayloadError for one that it does not take."""
        given = self.model_dump(exclude={"by_hand"}, exclude_none=True)
        takes = {each.name: each for each in verb.arguments}
        for name in given:
            if name not in takes:
                raise PayloadError(f"{verb.value} takes no {name}.")
            if (beside := takes[name].beside) and beside not in given:
                raise PayloadError(f"A {name} is only allowed beside {beside}.")
        return tuple(given.items())


def _fields() -> dict[str, Any]:
    """A field for each argument of each verb."""
    found: dict[str, Any] = {}
    for verb in Verb:
        for each in verb.arguments:
            limits = {"ge": 0} if each.type is int else {"pattern": f"^(?:{each.pattern or ANYTHING})$"}
            text = f"For `{verb.value}`: {ABOUT[verb].arguments[each.name]}"
            found[each.name] = (each.type | None, Field(default=None, description=text, **limits))
    return found


VerbArguments: type[AnyVerbArguments] = create_model("VerbArguments", __base__=AnyVerbArguments, **_fields())


class Sentence(ResponseModel):
    """Reason of a refusal or failure, as a sentence for a person and as data."""

    sentence: str = Field(examples=["'sis_z' is not a cell of this plant; there are sis_a, sis_b, sis_c"])
    key: str | None = Field(
        default=None, examples=["text.unknown"], description="What it says, whatever its language."
    )
    values: dict[str, Any] | None = Field(default=None, description="What stands in it, by name.")


class TaskAnswer(ResponseModel):
    """Answer that a device or a person gave while a task ran."""

    by: str
    asked: str = Field(description="The question, or the verb and its values.")
    answer: bool | int | float | str


OUTCOME = (
    "sent: a stop; whether robots stand shows in what they report. under_way: devices were told to. done. "
    "unchecked: devices were told, and report nothing of it. failed."
)
KEPT_CHOICE = "Why it was given to its cell, if others were allowed; of an assistant's, who approved it."
CHOICE = "Why it is done in this cell, where several were allowed."
UNCHECKED = "Of one that is done what no device confirmed: grip, release; its sentence says it for people."


class Task(ResponseModel):
    id: str
    text: str
    cell: str | None
    state: str = Field(description="queued, running, done, failed, cancelled or refused.")
    reason: str | None = None
    sentence: str = ""
    key: str | None = Field(default=None, description="What its sentence says, as of a Sentence.")
    values: dict[str, Any] | None = None
    answers: list[TaskAnswer] = Field(default=[], description="Of this task, in the order they came.")
    choice: str | None = Field(default=None, description=CHOICE)
    unchecked: list[str] = Field(default=[], description=UNCHECKED)


class KeptTask(ResponseModel):
    """A task of this start or of an earlier one; times are Unix times, in seconds."""

    number: int = Field(description="Grows by one with each task that the plant accepts.")
    id: str
    text: str
    cell: str
    recipe: str
    state: str = Field(description="queued, running, done, failed or cancelled.")
    reason: str | None = None
    sentence: str = ""
    key: str | None = Field(default=None, description="What its sentence says, as of a Sentence.")
    values: dict[str, Any] | None = None
    accepted_s: float
    started_s: float | None = None
    ended_s: float | None = None
    asked_by: str | None = Field(
        default=None,
        description="The way by which it came: command, page, http, ros2, demo, assistant; null: not known.",
    )
    attempts: int = Field(default=0, description="How often it was begun, or tried again by `retry`.")
    answers: list[TaskAnswer] = Field(default=[], description="Of one that has ended, in their order.")
    choice: str | None = Field(default=None, description=KEPT_CHOICE)
    unchecked: list[str] = Field(default=[], description=UNCHECKED)


class Done(ResponseModel):
    """Outcome of a verb that is not refused; while `under_way`, `GET /api/acts/<act>` tells its end."""

    verb: Verb
    scope: str = Field(description="A cell, robot, zone or task id; empty for the whole plant.")
    act: int | None = Field(default=None, description="Its number, in this start of the plant.")
    outcome: Outcome | None = Field(default=None, description=OUTCOME)
    why: str | None = Field(default=None, description="Why it failed, cannot be checked, or is not kept.")


class Act(ResponseModel):
    """Act of an operator, with its present outcome."""

    number: int = Field(description="Grows by one with each act; of this start of the plant.")
    at: float = Field(description="On the plant's clock.")
    verb: Verb
    scope: str
    cell: str | None = Field(description="Null where it is of several.")
    sentence: str
    outcome: Outcome = Field(description=OUTCOME)
    why: str | None = Field(description="Why it failed, or cannot be checked.")
    ended_at: float | None = Field(description="When that was known, where it was not with the act.")
    ended: str | None = Field(description="Its end in words, then.")


class Advice(ResponseModel):
    """Step that leads a cell out of its state."""

    do: str = Field(description="A verb; or, where `hand`: bring_back, repair, reference, check or free.")
    hand: bool = Field(description="Only a person at the machine can do it.")
    scope: str = Field(description="A cell, a robot or a zone.")
    by_hand: bool = Field(
        description="For `home`: the robot was put at its reference; for `release`: the part was taken out."
    )
    instead: bool = Field(description="It begins another way out than those before it.")
    said: str = Field(description="In words, as the command line takes a verb.")
    why: str
    moves: list[str] = Field(description="Robots that it may set in motion.")
    drops: list[str] = Field(description="Arms whose part falls.")
    refusal: str | None = Field(description="Why it would be refused now.")


class Device(ResponseModel):
    role: str
    name: str
    kind: str = Field(description="arm, mobile, or a kind of your own.")
    position: str | None = Field(description="The key of its row under `robots` that has its position.")
    holds: str | None = Field(description="The fact that says whether it holds a part.")
    asked: bool = Field(description="Whether it is a person, who answers on the plant's own screens.")


class Place(ResponseModel):
    """A target at which parts lie."""

    name: str
    parts: int = Field(description="How many are known to be there.")
    holds: int = Field(description="How many it holds at most.")
    device: str | None = Field(description="The device in or under which it is.")
    by_people: bool = Field(description="Whether people fill or empty it before each task.")
    station: int | None = Field(description="Its number in the rack of a cell that stores.")


class Teaching(ResponseModel):
    """Manual mode of a cell: nothing moves in it but what its teacher holds."""

    session: int = Field(description="The act by which it began.")
    teacher: str
    seconds: float = Field(description="Since it began.")
    robot: str | None = Field(description="The device that moves.")
    number: int | None = Field(description="The press that is held.")
    trouble: str | None = Field(description="Why the last press came to nothing, or ended too early.")


class Cell(ResponseModel):
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
    places: list[Place] = Field(description="Where parts lie in it.")
    teaching: Teaching | None = Field(description="Its manual mode, while somebody teaches it.")


class Asking(ResponseModel):
    """Open question to a person; `POST /api/cells/<person>/answer` with `{"answer": "yes"}` answers it."""

    id: str
    text: str
    answers: list[str]
    left_s: float = Field(description="Until the question ends unanswered.")


class Robot(ResponseModel):
    """A device of any kind."""

    name: str
    kind: str
    holder: str | None = Field(default=None, description="Of what cells share: the cell that holds it.")
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


class Snapshot(ResponseModel):
    """The plant as of its last step."""

    plant: str
    epoch: int
    at: float = Field(description="Monotonic seconds of the plant's clock.")
    ending: bool
    cells: list[Cell]
    robots: list[Robot]
    tasks: list[Task]
    zones: list[dict[str, Any]] = Field(
        description="Zones and devices that cells share, each with its state, who holds it and who waits."
    )
    acts: list[Act] = Field(default=[], description="What operators did last, oldest first.")
