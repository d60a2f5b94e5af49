"""Draft as a plant: its cells and trees, and what is tried and proved of it in processes beside the plant."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import FileResponse, JSONResponse, Response
from pydantic import Field
from starlette.exceptions import HTTPException

from arboleda.extension import PlantApi, Role, needs
from arboleda.web.languages import FIRST
from arboleda.web.schema.bodies import RequestModel
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import answering, described, described_body, query_of, read_body
from arboleda_make.answers.drafts import DraftCells, DraftState, DriverRow, Objection, RunState
from arboleda_make.answers.trees import Drawn, Nodes
from arboleda_make.trying.api import MakeApi

from .draft import MAY, REFUSED, SHIPPED, TREES, RecipeName, Step
from .tree_answers import EditForm, TreeForm, operation_of

What = Literal["try", "prove", "notice", "reach"]
Simulated = Literal["try", "prove", "notice"]
Short = Annotated[str, Field(max_length=200)]
DeviceName = Annotated[str, Field(pattern="^[a-z][a-z0-9_]{0,31}$", examples=["door"])]


class Cell(RequestModel):
    cell: Short
    language: Short = FIRST


class Recipe(RequestModel):
    cell: Short
    recipe: Short


class Carrying(Step):
    cell: Short
    recipe: RecipeName
    robot: Short
    start: Short
    end: Short


class Copying(Recipe, Step):
    name: RecipeName


class Language(RequestModel):
    language: Short = FIRST


class DeviceForm(RequestModel):
    """Device with its driver; none: its board speaks by itself. Settings are texts, nested ones YAML."""

    cell: Short
    role: Short
    kind: Short
    driver: Short = ""
    settings: dict[Short, Annotated[str, Field(max_length=20_000)]] = Field(default={}, max_length=100)
    declared: dict[str, Any] | None = Field(
        default=None, description="Its kind, where that is new or changed."
    )
    keys: dict[Short, Any] = Field(
        default={}, max_length=20, description="Other keys of the device in the plant file, such as `model`."
    )


class NewDevice(DeviceForm):
    role: DeviceName
    kind: DeviceName


class AddedDevice(Step, NewDevice):
    pass


class Removed(Step):
    cell: Short
    role: Short = Field(default="", description="Without one the whole cell.")


class WantedFault(RequestModel):
    kind: Short
    at: float = Field(ge=0, le=1e6)
    seconds: float = Field(ge=0, le=1e6)
    target: Short
    amount: float
    word: Short


class Wanted(RequestModel):
    """Task to be tried, with answers and faults; or recipes to be proved, for so long."""

    task: Short = ""
    answers: dict[Short, str | int | float | bool] = Field(default={})
    faults: list[WantedFault] = Field(default=[], max_length=2)
    recipes: list[Short] = Field(default=[], max_length=50)
    kinds: list[Short] = Field(default=[], max_length=100, description="Of faults; none: all.")
    budget_s: float = Field(default=60, ge=1, le=600)


def routes(side: PlantApi) -> APIRouter:
    """Register the routes."""
    api = APIRouter(prefix="/api/make", dependencies=[needs(Role.OPERATOR, MAY), TREES])
    _look(api, side)
    _draw(api, side)
    _device(api, side)
    _run(api, side)
    return api


def _look(api: APIRouter, side: PlantApi) -> None:
    @api.get("/cells", **answering(DraftCells, REFUSED))
    async def cells(request: Request) -> JSONResponse:
        """The cells of the draft: devices, targets, recipes. It waits for a process that reads the draft."""
        return PlainJson(await run_in_threadpool(_make(side).cells))

    @api.get("/recipe", **answering(None, REFUSED, described(Recipe)))
    async def recipe(request: Request) -> Response:
        """The tree of a recipe, whoever wrote it, as XML that viewers show."""
        make, wanted = _make(side), query_of(request, Recipe)
        text = await run_in_threadpool(make.shown, wanted.cell, wanted.recipe)
        return Response(text, media_type="application/xml")

    @api.post("/carry", **answering(DraftState, REFUSED, described_body(Carrying)))
    async def carry(request: Request) -> JSONResponse:
        """Add a recipe that takes a part from one target to another."""
        make, to = _make(side), read_body(await request.body(), Carrying)
        way = {"cell": to.cell, "robot": to.robot, "start": to.start, "end": to.end}
        return PlainJson(await run_in_threadpool(make.carry, to.editor, to.recipe, way))

    @api.post("/copy", **answering(DraftState, REFUSED, described_body(Copying)))
    async def copy(request: Request) -> JSONResponse:
        """Add a recipe that is a tree and does what one in Python does."""
        make, to = _make(side), read_body(await request.body(), Copying)
        return PlainJson(await run_in_threadpool(make.copy, to.editor, to.cell, to.recipe, to.name))


def _draw(api: APIRouter, side: PlantApi) -> None:
    @api.get("/palette", **answering(list[Nodes], REFUSED, described(Cell)))
    async def palette(request: Request) -> JSONResponse:
        """The nodes that a tree can have in a cell of the draft."""
        make, wanted = _make(side), query_of(request, Cell)
        return PlainJson(await run_in_threadpool(make.palette, wanted.cell, wanted.language))

    @api.post("/drawn/check", **answering(Drawn, REFUSED, described_body(TreeForm)))
    async def check(request: Request) -> JSONResponse:
        """A file of trees, with what `check` says of each node in a cell of the draft."""
        make, form = _make(side), read_body(await request.body(), TreeForm)
        return PlainJson(await run_in_threadpool(make.drawn, form.cell, form.text))

    @api.post("/drawn/edit", **answering(Drawn, REFUSED, described_body(EditForm)))
    async def edit(request: Request) -> JSONResponse:
        """The same file after an operation; the draft stays as it is."""
        make, form = _make(side), read_body(await request.body(), EditForm)
        operation = operation_of(form.operation)
        return PlainJson(await run_in_threadpool(make.drawn, form.cell, form.text, operation))


def _device(api: APIRouter, side: PlantApi) -> None:
    @api.get("/drivers", **answering(list[DriverRow], REFUSED, described(Language)))
    async def drivers(request: Request) -> JSONResponse:
        """The drivers that a device of a declared kind can have, with a form for each of their settings."""
        make, wanted = _make(side), query_of(request, Language)
        return PlainJson(await run_in_threadpool(make.drivers, wanted.language))

    @api.post("/objections", **answering(list[Objection], REFUSED, described_body(DeviceForm)))
    async def objections(request: Request) -> JSONResponse:
        """The problems that `check` finds in such a device, its kind and the name of its cell."""
        make, form = _make(side), read_body(await request.body(), DeviceForm)
        return PlainJson(await run_in_threadpool(make.objections, form.model_dump()))

    @api.post("/device", **answering(DraftState, REFUSED, described_body(AddedDevice)))
    async def device(request: Request) -> JSONResponse:
        """Add a device, or change it, with its driver, and its kind where that is new or changed."""
        make, new = _make(side), read_body(await request.body(), AddedDevice)
        return PlainJson(await run_in_threadpool(make.add_device, new.editor, new.model_dump()))

    @api.post("/remove", **answering(DraftState, REFUSED, described_body(Removed)))
    async def remove(request: Request) -> JSONResponse:
        """Take a device away with all that names it, or a whole cell."""
        make, old = _make(side), read_body(await request.body(), Removed)
        return PlainJson(await run_in_threadpool(make.remove, old.editor, old.cell, old.role))

    @api.post("/runs/reach", **answering(RunState, REFUSED, described_body(NewDevice)))
    async def reach(request: Request) -> JSONResponse:
        """Listen to such a device for some seconds, in a process of its own; no command is sent to it."""
        make, new = _make(side), read_body(await request.body(), NewDevice)
        return PlainJson(await run_in_threadpool(make.reach, new.model_dump()))


def _run(api: APIRouter, side: PlantApi) -> None:
    @api.get("/runs/{what}", **answering(RunState, REFUSED))
    async def run(request: Request, what: What) -> JSONResponse:
        """Progress of the run."""
        return PlainJson(_make(side).run(what))

    @api.post("/runs/{what}", **answering(RunState, REFUSED, described_body(Wanted)))
    async def begin(request: Request, what: Simulated) -> JSONResponse:
        """Begin with the draft as it is now, in a process that everything else of the plant goes before."""
        make, wanted = _make(side), read_body(await request.body(), Wanted)
        return PlainJson(await run_in_threadpool(make.begin, what, wanted.model_dump()))

    @api.post("/runs/{what}/end", **answering(RunState, REFUSED))
    async def end(request: Request, what: What) -> JSONResponse:
        """End it, wherever it is."""
        return PlainJson(await run_in_threadpool(_make(side).end, what))

    @api.get("/runs/{what}/result", **answering(dict[str, Any], REFUSED))
    async def result(request: Request, what: What) -> Response:
        """Result of the last run."""
        file = _make(side).result(what)
        if file is None:
            raise HTTPException(404, "Nothing has come of it yet.")
        return FileResponse(file, media_type="application/json")


def _make(side: PlantApi) -> MakeApi:
    """The bench of the plant's draft; 404 if it has none."""
    make = side.ask(MakeApi)
    if make is None:
        raise HTTPException(404, SHIPPED)
    return make
