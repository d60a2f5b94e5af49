"""The table of the cells' OEE, and the address from which its script fills it."""

from __future__ import annotations

import time
from typing import Annotated

from fastapi import FastAPI, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse

from arboleda.dashboard.shell import language_of
from arboleda.extension import PageApi, Spot, rows, tag
from arboleda.extension import words as words_of
from arboleda.model.packages import FLEET
from arboleda.web.missing import missing

from ..oee.api import OeeApi, OeeQuery
from .oee_rows import face

COLUMNS = ("cell", "oee", "availability", "performance", "quality", "planned", "counted", "missing")
HOURS = (1, 8, 24, 168)
Hours = Annotated[float, Query(gt=0, le=1000)]


def build(spot: Spot) -> None:
    """Draw the table; the script fills it once it is looked at."""
    words = spot.words
    with tag("div", classes="box"):
        with tag("div", classes="box-head"):
            tag("h2", words("oee.title"))
            with tag("label", classes="search"):
                tag("span", words("oee.hours"))
                with tag("select", id="oee-hours"):
                    for hours in HOURS:
                        chosen = {"selected": "true"} if hours == 24 else {}
                        tag("option", words(f"oee.last_{hours}"), value=str(hours), **chosen)
        columns = [words(f"column.{name}") for name in COLUMNS]
        rows("oee", columns, empty=words("oee.none"), classes="oee")
        tag("p", words("oee.about"), classes="hint")


def serve(server: FastAPI, plant: PageApi) -> None:
    """Answer `/oee.json`."""

    async def figures(request: Request, hours: Hours = 24.0) -> JSONResponse:
        query = OeeQuery(since_s=time.time() - hours * 3600)
        desk = plant.ask(OeeApi)
        if desk is None:
            raise missing(FLEET)
        rows_ = await run_in_threadpool(desk.oee, query)
        return JSONResponse(face(rows_, words_of(language_of(request))))

    server.add_api_route("/oee.json", figures, include_in_schema=False)
