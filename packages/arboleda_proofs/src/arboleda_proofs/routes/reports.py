"""Reports of tasks that failed, as data."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import Any, Literal

from fastapi import APIRouter
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from arboleda.extension import ArboledaError, PlantApi
from arboleda.model.packages import PROOFS
from arboleda.web.missing import missing
from arboleda.web.schema.bodies import Sentence
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import Answers, answering
from arboleda_proofs.answers import TaskReport
from arboleda_proofs.running.api import ReportsApi

DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)
EARLIER = "The report was written by an earlier version; its page is at /report."
NONE: Answers = {404: {"model": Sentence, "description": "There is no report of it, and why."}}


@dataclass(frozen=True, kw_only=True)
class AwaitedReport:
    """Report that is not written yet."""

    task: str
    state: Literal["waiting"]


LATER: Answers = {202: {"model": AwaitedReport, "description": "It is not written yet; ask again."}}


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/tasks/{task_id}/report", **answering(TaskReport, NONE | LATER))
    async def report(task_id: str) -> JSONResponse:
        """The cause of a task's failure, and the evidence. The answer is 202 until it is written."""
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
