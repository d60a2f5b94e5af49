"""The page on the last proof of the draft, as one file of its own."""

from __future__ import annotations

from fastapi import FastAPI, HTTPException, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response

from arboleda.dashboard.sandbox import POLICY
from arboleda.extension import PageApi, Role, needs
from arboleda_make.trying.api import MakeApi

PATH = "/proof"
OPERATORS = [needs(Role.OPERATOR, "looking at what was proved of a draft")]
NONE = "Nothing of the draft has been proved yet."


def serve(server: FastAPI, plant: PageApi) -> None:
    """Answer `/proof`."""

    async def proof(request: Request) -> Response:
        make = plant.ask(MakeApi)
        file = None if make is None else await run_in_threadpool(make.proof_page)
        if file is None:
            raise HTTPException(404, NONE)
        content = await run_in_threadpool(file.read_text, "utf-8")
        return HTMLResponse(content, headers={"content-security-policy": POLICY})

    server.add_api_route(PATH, proof, dependencies=OPERATORS, include_in_schema=False)
