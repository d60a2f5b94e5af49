"""Reports of tasks that failed, as data."""

from __future__ import annotations

import json
import re
from typing import Any, Literal

from fastapi import APIRouter
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import Field
from starlette.exceptions import HTTPException

from arboleda.model.errors import ArboledaError
from arboleda.model.packages import PROOFS
from arboleda.web.desks.reports import ReportsApi
from arboleda.web.missing import missing
from arboleda.web.plant_api import PlantApi
from arboleda.web.schema.bodies import ResponseModel, Sentence
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import Answers

DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
EARLIER = "The report was written by an earlier version; its page is at /report."
NONE: Answers = {404: {"model": Sentence, "description": "There is no report of it, and why."}}


class Explanation(ResponseModel):
    """Sentence, for a person and as data."""

    sentence: str
    key: str | None
    values: dict[str, Any] | None


class TaskCause(Explanation):
    """Cause of a failure, by the record of the plant."""

    kind: str = Field(examples=["silence"], description="A word for programs; docs/how-to/failed-at-night.md")
    robot: str | None


class TaskTrouble(ResponseModel):
    """Trouble of a device around the failure."""

    at_s: float = Field(description="Since the failure, as all times here.")
    robot: str
    kind: str = Field(description="silence, boot, alarm or bridge.")
    seconds: float | None = Field(description="Null: to the end.")
    cut: bool = Field(description="Its connection broke.")


class LastCommand(ResponseModel):
    """Last command of the robot whose failure it was."""

    at_s: float
    robot: str
    id: str
    accepted_after_s: float | None = Field(description="Null: it never said so.")


class Absence(ResponseModel):
    """Time in which the plant itself did nothing."""

    at_s: float
    seconds: float


class OperatorAct(ResponseModel):
    """Act of an operator, in words."""

    at_s: float
    words: str


class ForeignCommand(ResponseModel):
    """Command of somebody else to a robot."""

    at_s: float
    robot: str


class TaskEvidence(ResponseModel):
    """Facts from which the cause follows."""

    troubles: list[TaskTrouble]
    last_command: LastCommand | None
    absences: list[Absence]
    acts: list[OperatorAct]
    foreign: list[ForeignCommand]


class TaskReport(ResponseModel):
    """Report of a task that failed; while it is `waiting`, it has nothing but its task."""

    task: str
    state: Literal["waiting", "written"]
    text: str = ""
    cell: str = ""
    ended_s: float | None = Field(default=None, description="Unix time, in seconds.")
    reason: str | None = None
    failure: Explanation | None = Field(default=None, description="As the plant said it then.")
    cause: TaskCause | None = None
    evidence: TaskEvidence | None = None


class AwaitedReport(ResponseModel):
    """Report that is not written yet."""

    task: str
    state: Literal["waiting"]


LATER: Answers = {202: {"model": AwaitedReport, "description": "It is not written yet; ask again."}}


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/tasks/{task_id}/report", response_model=TaskReport, responses=NONE | LATER)
    async def report(task_id: str) -> JSONResponse:
        """Why a task failed: cause and evidence. The first answer may be 202, until it is written."""
        desk = side.ask(ReportsApi)
        if desk is None:
            raise missing(PROOFS)
        try:
            content = await run_in_threadpool(desk.report, task_id)
        except ArboledaError as error:
            raise HTTPException(404, str(error.sentence)) from None
        if content is None:
            return PlainJson({"task": task_id, "state": "waiting"}, status_code=202)
        facts = _facts(content)
        if facts is None:
            raise HTTPException(404, EARLIER)
        return PlainJson({**facts, "state": "written"})

    return api


def _facts(content: str) -> dict[str, Any] | None:
    """The facts in the page of a report."""
    found = DATA.search(content)
    facts: dict[str, Any] | None = json.loads(found[1]).get("facts") if found else None
    return facts
