"""OEE of the cells."""

from __future__ import annotations

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import Field, FiniteFloat

from arboleda.extension import PlantApi
from arboleda.model.packages import FLEET
from arboleda.web.missing import missing
from arboleda.web.schema.bodies import RequestModel
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import WRONG, answering, described, query_of

from .answers import CellOee
from .api import OeeApi, OeeQuery


class OeeFilter(RequestModel):
    """Filter for OEE: a cell and a span; by default the last 24 hours of all cells."""

    cell: str = ""
    since: FiniteFloat | None = Field(default=None, description="Unix time in seconds.")
    until: FiniteFloat | None = Field(default=None, description="Not later than now.")

    def query(self) -> OeeQuery:
        """This request as a query to the plant's memory."""
        return OeeQuery(cell=self.cell, since_s=self.since, until_s=self.until)


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/oee", **answering(list[CellOee], WRONG, described(OeeFilter)))
    async def oee(request: Request) -> JSONResponse:
        """The OEE of the cells, of the last 24 hours where no time is asked for; docs/how-to/oee.md."""
        desk, query = side.ask(OeeApi), query_of(request, OeeFilter).query()
        if desk is None:
            raise missing(FLEET)
        rows = await run_in_threadpool(desk.oee, query)
        return PlainJson([row.data() for row in rows])

    return api
