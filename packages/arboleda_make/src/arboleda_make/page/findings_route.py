"""Route `/findings.json`: gives a page the findings of its draft in its own language."""

from __future__ import annotations

from typing import Annotated

from fastapi import FastAPI, HTTPException, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import Field

from arboleda.dashboard.shell import language_of
from arboleda.extension import PageApi, Role, needs
from arboleda.web.schema.bodies import BodyModel
from arboleda.web.schema.queries import read_body
from arboleda_make.trying.api import MakeApi

PATH = "/findings.json"
OPERATORS = [needs(Role.OPERATOR, "reading what was found in a draft")]
NO_DRAFT = "This plant has no draft."


class FindingLines(BodyModel):
    """Findings in English, as the API gives them, that a page wants in its language."""

    lines: list[Annotated[str, Field(max_length=5000)]] = Field(max_length=1000)


def serve(server: FastAPI, plant: PageApi) -> None:
    """Add the route to the server of a plant."""

    async def findings(request: Request) -> JSONResponse:
        make = plant.ask(MakeApi)
        if make is None:
            raise HTTPException(404, NO_DRAFT)
        asked = read_body(await request.body(), FindingLines)
        return JSONResponse(
            {"lines": await run_in_threadpool(make.translate, language_of(request), asked.lines)}
        )

    server.add_api_route(PATH, findings, methods=["POST"], dependencies=OPERATORS, include_in_schema=False)
