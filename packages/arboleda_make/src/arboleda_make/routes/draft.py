"""Draft of the plant's files: who edits it, its steps, its check, and keeping it as a version."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, TypeVar

from fastapi import APIRouter, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import Field
from starlette.exceptions import HTTPException

from arboleda.extension import PlantApi, Role, needs, takes
from arboleda.web.schema.bodies import BodyModel, Sentence
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import Answers, answering, described_body, read_body
from arboleda_make.answers.drafts import AppliedDraft, CheckedDraft, DraftState, KeptDraft, TreesText
from arboleda_make.drafts.api import DraftApi, State
from arboleda_trees.bt_xml.markup import LARGEST

MAY = "editing a draft"
TREES = takes(kilobytes=512)  # a file of trees, of a recipe with its 2,000 nodes, as JSON
SHIPPED = "This plant has no file that could be changed; `arboleda new` writes one of your own."
REFUSED: Answers = {
    403: {"model": Sentence, "description": "Only operators may."},
    404: {"model": Sentence, "description": "The plant has no file of its own."},
    409: {"model": Sentence, "description": "Somebody else edits, or it cannot be done."},
    422: {"model": Sentence, "description": "The request is wrong."},
}
Key = Annotated[str, Field(max_length=200)] | Annotated[int, Field(ge=0, le=100_000)]


class _Request(BodyModel):
    editor: str = Field(
        pattern="^[A-Za-z0-9_-]{8,64}$", description="An id that a page or tool makes for itself."
    )


class Step(_Request):
    """A step of its editor that needs nothing else."""


class Taking(_Request):
    name: str = Field(min_length=1, max_length=60, description="Shown to others.", examples=["Ana"])


class Removal(_Request):
    place: list[Key] = Field(min_length=1, max_length=20, examples=[["cells", "lab", "targets", "nest"]])


class Setting(Removal):
    value: Any = Field(description="A plain value of the plant file.")
    of: str | None = Field(
        default=None,
        max_length=64,
        description="Digest of the only draft in which to set it; refused if the draft has changed since.",
    )


RecipeName = Annotated[
    str, Field(pattern="^[a-z][a-z0-9_]{0,39}$", description="Of a recipe.", examples=["to_tray"])
]


class Trees(_Request):
    file: str = Field(min_length=5, max_length=200, examples=["tend.xml"])


class TreesSetting(Trees):
    text: str = Field(max_length=LARGEST, description="The file as text, BehaviorTree.CPP XML.")


class Keeping(_Request):
    note: str = Field(default="", max_length=200)


Body = TypeVar("Body", bound=_Request)


def routes(side: PlantApi) -> APIRouter:
    """Register the routes."""
    api = APIRouter(prefix="/api/draft", dependencies=[needs(Role.OPERATOR, MAY)])
    _look(api, side)
    _edit(api, side)
    _keep(api, side)
    return api


def _look(api: APIRouter, side: PlantApi) -> None:
    @api.get("", **answering(DraftState, REFUSED))
    async def draft(request: Request) -> JSONResponse:
        """The editor of the draft of the plant's files, and its changes."""
        return await _answered(_draft(side).state)

    @api.get("/trees", **answering(TreesText, REFUSED))
    async def trees(request: Request, file: Annotated[str, Query(max_length=200)]) -> JSONResponse:
        """A file of trees as the draft has it."""
        draft = _draft(side)
        return await _answered(lambda: draft.trees(file))

    @api.post("/check", **answering(CheckedDraft, REFUSED))
    async def check(request: Request) -> JSONResponse:
        """The findings of `arboleda check` on the draft; from a process of its own, within seconds."""
        return await _answered(_draft(side).check)


def _edit(api: APIRouter, side: PlantApi) -> None:
    def route(
        path: str, model: type[Body], about: str, act: Callable[[DraftApi, Body], State], *needed: Any
    ) -> None:
        async def step(request: Request) -> JSONResponse:
            draft = _draft(side)
            body = read_body(await request.body(), model)
            return await _answered(lambda: act(draft, body))

        step.__doc__ = about
        taken = answering(DraftState, REFUSED, described_body(model))
        api.post(path, name=path.strip("/"), dependencies=needed, **taken)(step)

    route("/take", Taking, "Begin to edit, or take over.", lambda each, to: each.take(to.editor, to.name))
    route(
        "/set",
        Setting,
        "Set a value.",
        lambda each, to: each.set(to.editor, tuple(to.place), to.value, to.of),
    )
    route("/remove", Removal, "Remove a key.", lambda each, to: each.remove(to.editor, tuple(to.place)))
    route(
        "/set_trees",
        TreesSetting,
        "Give a file of trees another text.",
        lambda each, to: each.set_trees(to.editor, to.file, to.text),
        TREES,
    )
    route(
        "/remove_trees",
        Trees,
        "Take a file of trees out of it.",
        lambda each, to: each.remove_trees(to.editor, to.file),
    )
    route("/own", Step, "Copy its files to a folder of one's own.", lambda each, to: each.own(to.editor))
    route("/undo", Step, "Take the last step back.", lambda each, to: each.undo(to.editor))
    route("/redo", Step, "Do it again.", lambda each, to: each.redo(to.editor))
    route("/discard", Step, "Forget all of the draft.", lambda each, to: each.discard(to.editor))


def _keep(api: APIRouter, side: PlantApi) -> None:
    @api.post("/keep", **answering(KeptDraft, REFUSED, described_body(Keeping)))
    async def keep(request: Request) -> JSONResponse:
        """Check the draft, write it into the plant's files and keep a version, which the next start takes."""
        draft = _draft(side)
        body = read_body(await request.body(), Keeping)
        return await _answered(lambda: draft.keep(body.editor, body.note))

    @api.post("/apply", **answering(AppliedDraft, REFUSED, described_body(Keeping)))
    async def apply(request: Request) -> JSONResponse:
        """The same, and put the version to work: a cell takes it once its task has ended."""
        draft = _draft(side)
        body = read_body(await request.body(), Keeping)
        return await _answered(lambda: draft.apply(body.editor, body.note))


async def _answered(act: Callable[[], State]) -> JSONResponse:
    return PlainJson(await run_in_threadpool(act))


def _draft(side: PlantApi) -> DraftApi:
    """The plant's draft; 404 if it has none."""
    draft = side.ask(DraftApi)
    if draft is None:
        raise HTTPException(404, SHIPPED)
    return draft
