"""Teaching of cells: what devices can be told, buttons that are held, targets where robots stand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeVar

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import Field, model_validator
from starlette.exceptions import HTTPException

from arboleda.client import Teaching
from arboleda.extension import PlantApi, Role, needs, takes
from arboleda.model.sentence import explained
from arboleda.web.schema.bodies import BodyModel, Sentence
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import Answers, answering, described_body, read_body
from arboleda_make.teaching import api as teach

MAY = "teaching"
REFUSED: Answers = {
    403: {"model": Sentence, "description": "Only operators may."},
    404: {"model": Sentence, "description": "This plant is not taught from here."},
    409: {"model": Sentence, "description": "Nothing moves, or no target is made, and why."},
    422: {"model": Sentence, "description": "The request is wrong."},
}
Word = Annotated[str, Field(min_length=1, max_length=64)]
Number = Annotated[int, Field(ge=0, lt=2**53)]
Value = bool | int | float | Annotated[str, Field(max_length=200)]


class WayAlong(BodyModel):
    axis: Literal["x", "y", "z"]
    frame: Literal["base", "tool"] = "base"
    sign: Literal[-1, 1] = 1
    mm: float | None = Field(default=None, gt=0, le=100, description="Its length; without, on and on.")


class ButtonState(BodyModel):
    """Button that is held; said again at least every 0.1 s, with the same number, or the robot is halted."""

    session: Number = Field(description="The act that began the teaching, as `teach` has answered it.")
    number: Number = Field(description="Higher with each press; one that has ended never begins again.")
    robot: Word
    held: bool = Field(default=True, description="False: it was let go of.")
    goal: list[float] | int | None = Field(
        default=None, description="Degrees or millimetres of each joint, or a node."
    )
    along: WayAlong | None = None
    verb: str = Field(default="", max_length=64, description="home, grip, let_go, or a verb of the device.")
    values: dict[Word, Value] = Field(default={}, max_length=32)

    @model_validator(mode="after")
    def _check_one(self) -> ButtonState:
        given = [self.goal is not None, self.along is not None, bool(self.verb)]
        if self.held and given.count(True) != 1:
            raise ValueError("exactly one of goal, along and verb is needed")
        return self

    def button(self) -> teach.Button:
        along = None if self.along is None else teach.Along(**self.along.model_dump())
        return teach.Button(**self.model_dump(exclude={"along"}), along=along)


class NewTarget(BodyModel):
    """Target of the draft, made or moved to where the robot stands now."""

    robot: Word
    target: Word
    editor: Annotated[str, Field(min_length=8, max_length=64, description="An id of your own.")]
    name: Annotated[str, Field(min_length=1, max_length=40, description="What others see.")]
    approach_mm: float | None = Field(default=None, ge=0, le=10_000, description="Without it as it was.")
    zone: str = Field(default="", max_length=64, description="A zone of the plant file in which it lies.")


@dataclass(frozen=True, kw_only=True)
class TeachState:
    """Teacher of a cell, its devices and its targets."""

    cell: str
    teaching: Teaching | None
    refusal: Annotated[str | None, "Why nobody can begin to teach it now."]
    devices: Annotated[list[dict[str, Any]], "Where each stands, its joints, nodes and verbs."]
    targets: Annotated[list[dict[str, Any]], "By robot; `draft`: as the draft has it."]
    drafts: Annotated[bool, "Whether there is a plant file in which targets can be kept."]


@dataclass(frozen=True, kw_only=True)
class Pressed:
    """Robot whose button is held, or was let go of."""

    teaching: Teaching | None
    robot: dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class MadeTarget:
    """Target that was made or moved."""

    at: list[float] | int
    place: Annotated[list[str], "Where it stands in the plant file."]


Body = TypeVar("Body", bound=BodyModel)


def routes(side: PlantApi) -> APIRouter:
    """Register the routes."""
    api = APIRouter(prefix="/api/teach", dependencies=[needs(Role.OPERATOR, MAY)])

    @api.get("/{cell}", **answering(TeachState, REFUSED))
    async def state(cell: str, request: Request) -> JSONResponse:
        """Teacher of a cell, the commands that its devices take, and its targets."""
        desk = _desk(side)
        return await _answered(lambda: desk.state(cell))

    @api.post(
        "/{cell}/jog",
        dependencies=[takes(held=True)],
        **answering(Pressed, REFUSED, described_body(ButtonState)),
    )
    async def jog(cell: str, request: Request) -> JSONResponse:
        """Hold a button of a cell that is taught, or let go of it."""
        desk = _desk(side)
        body = read_body(await request.body(), ButtonState)
        return await _answered(lambda: desk.press(cell, body.button()))

    @api.post("/{cell}/here", **answering(MadeTarget, REFUSED, described_body(NewTarget)))
    async def here(cell: str, request: Request) -> JSONResponse:
        """Make a target in the draft where a robot stands now, or move one there."""
        desk = _desk(side)
        body = read_body(await request.body(), NewTarget)
        return await _answered(lambda: desk.here(cell, teach.Target(**body.model_dump())))

    return api


async def _answered(act: Callable[[], teach.State]) -> JSONResponse:
    try:
        return PlainJson(await run_in_threadpool(act))
    except teach.TeachRefused as refused:
        return PlainJson(explained({"sentence": refused.sentence}), status_code=409)


def _desk(side: PlantApi) -> teach.TeachApi:
    desk = side.ask(teach.TeachApi)
    if desk is None:
        raise HTTPException(404, "This plant is not taught from here.")
    return desk
