"""Trees as XML: what they can be made of in a cell, and edits of a text, of which nothing is kept here."""

from __future__ import annotations

import asyncio

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse

from arboleda.extension import PlantApi, Role, needs
from arboleda.web.languages import FIRST, spoken, texts
from arboleda.web.schema.bodies import RequestModel, Sentence
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import (
    WRONG,
    Answers,
    answering,
    described,
    described_body,
    query_of,
    read_body,
)
from arboleda_make.answers.trees import Drawn, Nodes, TreeCopy, TreeFile

from .draft import TREES
from .tree_answers import CopyForm, EditForm, TreeForm, operation_of

ASSISTANTS = [needs(Role.ASSISTANT, "drawing a tree"), TREES]
REFUSED: Answers = {
    403: {"model": Sentence, "description": "The role is not enough."},
    422: {"model": Sentence, "description": "The text cannot be read, or the operation cannot be done."},
}


class PaletteFilter(RequestModel):
    """Cell for which a tree is drawn, and the language of what its nodes are about."""

    cell: str
    language: str = FIRST


def routes(side: PlantApi) -> APIRouter:
    """Register the routes. One edit is worked on at a time: each is work for a processor."""
    api = APIRouter(prefix="/api/trees")
    turn = asyncio.Lock()

    @api.get("", **answering(list[TreeFile]))
    async def trees() -> JSONResponse:
        """The files of trees that are recipes of this plant, as they were read."""
        from arboleda_make.editing import desk  # which loads once somebody draws: a start does without it

        return PlainJson(desk.tree_files(side.model))

    @api.get("/palette", **answering(list[Nodes], WRONG, described(PaletteFilter)))
    async def palette(request: Request) -> JSONResponse:
        """All nodes that a tree can have in a cell: of its devices, in Python, and those of Arboleda."""
        from arboleda_make.editing import desk

        wanted = query_of(request, PaletteFilter)
        words = texts(spoken([wanted.language]), "nodes")
        return PlainJson(await run_in_threadpool(desk.palette, side.model, wanted.cell, words))

    @api.post("/check", dependencies=ASSISTANTS, **answering(Drawn, REFUSED, described_body(TreeForm)))
    async def check(request: Request) -> JSONResponse:
        """A file as an editor shows it, with what `check` says of each node in a cell."""
        from arboleda_make.editing import desk

        form = read_body(await request.body(), TreeForm)
        async with turn:
            return PlainJson(await run_in_threadpool(desk.drawn, side.model, form.cell, form.text))

    @api.post("/copy", dependencies=ASSISTANTS, **answering(TreeCopy, REFUSED, described_body(CopyForm)))
    async def copy(request: Request) -> JSONResponse:
        """A recipe in Python as a tree that does the same; refused where no tree in XML can say it."""
        from arboleda_make.editing import desk

        form = read_body(await request.body(), CopyForm)
        async with turn:
            text = await run_in_threadpool(desk.copied, side.model, form.cell, form.recipe, form.name)
            return PlainJson({"text": text})

    @api.post("/edit", dependencies=ASSISTANTS, **answering(Drawn, REFUSED, described_body(EditForm)))
    async def edit(request: Request) -> JSONResponse:
        """The same file after an operation, which leaves every other byte of it as it was."""
        from arboleda_make.editing import desk

        form = read_body(await request.body(), EditForm)
        operation = operation_of(form.operation)
        async with turn:
            found = await run_in_threadpool(desk.drawn, side.model, form.cell, form.text, operation)
            return PlainJson(found)

    return api
