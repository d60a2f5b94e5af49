"""Versions of the plant's files: which is at work, and putting one to work."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import Field
from starlette.exceptions import HTTPException

from arboleda.extension import PlantApi, Role, needs
from arboleda.web.schema.bodies import BodyModel
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import answering, described_body, read_body
from arboleda_make.answers.drafts import AppliedDraft
from arboleda_make.answers.versions import VersionList
from arboleda_make.versions.api import VersionsApi

from .draft import REFUSED, SHIPPED

OPERATORS = [needs(Role.OPERATOR, "putting a version to work")]
Number = Annotated[int, Path(ge=1, le=1_000_000)]


class PutRequest(BodyModel):
    """Body: these keys and no others, of exactly these types."""

    name: str = Field(
        min_length=1, max_length=60, description="Of who does it, for the journal.", examples=["Ana"]
    )


class RestartWish(PutRequest):
    """Body of a wish for a restart, or of its end."""

    wanted: bool = Field(default=True, description="False: the restart is not wanted any more.")


def routes(side: PlantApi) -> APIRouter:
    """Register the routes."""
    api = APIRouter(prefix="/api/versions")

    @api.get("", **answering(VersionList, REFUSED))
    async def versions() -> JSONResponse:
        """The versions that were put to work, which one is, and what each cell works by."""
        return PlainJson(await run_in_threadpool(_versions(side).listed))

    @api.post(
        "/{number}/put",
        dependencies=OPERATORS,
        **answering(AppliedDraft, REFUSED, described_body(PutRequest)),
    )
    async def put(request: Request, number: Number) -> JSONResponse:
        """Put a version to work, as when going back to it: a cell takes it once its task has ended."""
        desk, body = _versions(side), read_body(await request.body(), PutRequest)
        return PlainJson(await run_in_threadpool(lambda: desk.put(number, body.name)))

    @api.post(
        "/restart", dependencies=OPERATORS, **answering(VersionList, REFUSED, described_body(RestartWish))
    )
    async def restart(request: Request) -> JSONResponse:
        """Restart the plant with its files as they are now, once all its cells rest; until then no further
        task begins.
        """
        desk, request_body = _versions(side), read_body(await request.body(), RestartWish)
        return PlainJson(
            await run_in_threadpool(lambda: desk.restart(request_body.name, wanted=request_body.wanted))
        )

    return api


def _versions(side: PlantApi) -> VersionsApi:
    """The plant's versions; 404 if it has none."""
    found = side.ask(VersionsApi)
    if found is None:
        raise HTTPException(404, SHIPPED)
    return found
