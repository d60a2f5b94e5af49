"""Faults by hand at virtual devices: what can be provoked, what goes on, beginning and ending one."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated

from fastapi import APIRouter, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import Field

from arboleda.extension import PlantApi, Role, needs
from arboleda.web.schema.bodies import BodyModel, Sentence
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import Answers, answering, described_body, read_body
from arboleda_proofs.answers import FaultList, ProvokedFault
from arboleda_proofs.running.api import FaultRefused, FaultsApi

OPERATORS = [needs(Role.OPERATOR, "provoking a fault")]
NOT_HERE = "This process has no devices, so no faults can be provoked at them."
REFUSED: Answers = {
    403: {"model": Sentence, "description": "Only operators may."},
    409: {"model": Sentence, "description": "Nothing is provoked, and why: a real device, an unknown kind."},
    422: {"model": Sentence, "description": "The request is wrong."},
}
Word = Annotated[str, Field(min_length=1, max_length=64)]


class NewFault(BodyModel):
    kind: Word = Field(examples=["cut_link"])
    robot: Word = Field(description="A virtual device.", examples=["ra1"])
    seconds: float | None = Field(
        default=None, allow_inf_nan=False, description="For how long; without it 5 s, where the kind lasts."
    )


class EndOfFaults(BodyModel):
    """Body that names the faults to end: one by its number, all of a device, or all without either."""

    robot: str = Field(default="", max_length=64)
    number: int | None = None


def routes(side: PlantApi) -> APIRouter:
    """Register the routes."""
    api = APIRouter(prefix="/api/faults")

    @api.get("", **answering(FaultList))
    async def faults() -> JSONResponse:
        """The faults that were provoked at virtual devices and go on, and those that can be."""
        desk = side.ask(FaultsApi)
        begun = [] if desk is None else await run_in_threadpool(desk.begun)
        offers = [] if desk is None else desk.offers()
        return PlainJson(
            {"begun": [asdict(each) for each in begun], "offers": [asdict(each) for each in offers]}
        )

    @api.post("", dependencies=OPERATORS, **answering(ProvokedFault, REFUSED, described_body(NewFault)))
    async def provoke(request: Request) -> JSONResponse:
        """Have a fault of the simulator happen to a virtual device; it ends by itself, or by `end`."""
        desk, wanted = _faults(side), read_body(await request.body(), NewFault)
        begun = await run_in_threadpool(lambda: desk.begin(wanted.kind, wanted.robot, wanted.seconds))
        return PlainJson(asdict(begun))

    @api.post(
        "/end", dependencies=OPERATORS, **answering(list[ProvokedFault], REFUSED, described_body(EndOfFaults))
    )
    async def end(request: Request) -> JSONResponse:
        """End faults before their time; the answer has those that went on."""
        desk, wanted = _faults(side), read_body(await request.body(), EndOfFaults)
        ended = await run_in_threadpool(lambda: desk.end(wanted.robot, wanted.number))
        return PlainJson([asdict(each) for each in ended])

    return api


def _faults(side: PlantApi) -> FaultsApi:
    found = side.ask(FaultsApi)
    if found is None:
        raise FaultRefused(NOT_HERE)
    return found
