"""Promises of cells for a task that nobody has submitted."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field

from ..plant_api import PlantApi
from ..schema.bodies import ResponseModel
from ..schema.plain_json import PlainJson
from ..schema.queries import WRONG, described, query_of


class PromiseFilter(BaseModel):
    """Task for which promises are asked."""

    model_config = ConfigDict(extra="forbid")

    text: str = Field(max_length=200, examples=["sis_a,sis_b 0B 7"])


class Promise(ResponseModel):
    """Promise of a cell for a task that it has not been given."""

    cell: str
    text: str = Field(description="The task for this cell.")
    seconds: float = Field(description="Until it would have done it, as far as past tasks tell.")
    hindrance: str | None = Field(description="Why it could not begin it now.")
    full: bool = Field(description="Whether its queue has no room.")


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get(
        "/promises", response_model=list[Promise], responses=WRONG, openapi_extra=described(PromiseFilter)
    )
    async def promises(request: Request) -> JSONResponse:
        """The time at which each cell named by a task text would have done it; queues no task."""
        return PlainJson(side.promises(query_of(request, PromiseFilter).text))

    return api
