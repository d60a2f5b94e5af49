"""Promises of cells for a task that nobody has submitted."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse
from pydantic import Field

from arboleda.client.answers.offers import Promise

from ..plant_api import PlantApi
from ..schema.bodies import RequestModel
from ..schema.plain_json import PlainJson
from ..schema.queries import WRONG, answering, described, query_of


class PromiseFilter(RequestModel):
    """Task for which promises are asked."""

    text: str = Field(max_length=200, examples=["sis_a,sis_b 0B 7"])


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/promises", **answering(list[Promise], WRONG, described(PromiseFilter)))
    async def promises(request: Request) -> JSONResponse:
        """The time at which each cell named by a task text would have done it; queues no task."""
        return PlainJson(side.promises(query_of(request, PromiseFilter).text))

    return api
