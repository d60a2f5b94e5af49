"""Requests to the API, and the sentence that refuses one; other answers are in `arboleda.client.answers`."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, create_model, model_validator

from arboleda.model.errors import PayloadError
from arboleda.model.messages import Verb
from arboleda.model.text import BETWEEN_CELLS
from arboleda.model.verbs import Arguments
from arboleda.store.task_rows import TaskQuery
from arboleda.views.verb_words import ABOUT

from .answers import ResponseModel

ANYTHING = ".+"  # the form of an argument that has none of its own


class RequestModel(BaseModel):
    """Query or body of a request: these keys and no others."""

    model_config = ConfigDict(extra="forbid")


class BodyModel(RequestModel):
    """Body of a request whose values are of exactly these types."""

    model_config = ConfigDict(strict=True)


class TaskFilter(RequestModel):
    """Filter for tasks of the history; without any key the last `limit` tasks."""

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


class TaskText(BodyModel):
    text: str = Field(examples=["sis_a 0B 7"], description="A task, as on the command line.")
    why: str = Field(
        default="", max_length=500, description="Why it is given to this cell, by who chose between plants."
    )


class TaskForm(BodyModel):
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


class AnyVerbArguments(BodyModel):
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
