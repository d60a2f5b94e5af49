"""The report of a task that failed, as a page of its own that can be kept and sent."""

from __future__ import annotations

from html import escape

from fastapi import FastAPI, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import HTMLResponse, Response

from arboleda.dashboard.sandbox import POLICY
from arboleda.dashboard.shell import language_of
from arboleda.dashboard.tags import of_task
from arboleda.extension import ArboledaError, PageApi, Spot, Words, words
from arboleda.model.packages import PROOFS
from arboleda.web.access import login
from arboleda.web.missing import missing
from arboleda_proofs.running.api import ReportsApi

PATH = "/report"
LOOK_S = 1


def serve(server: FastAPI, plant: PageApi) -> None:
    """Answer `/report?task=ID` with the report, or with a page that waits until it is written."""

    async def report(request: Request, task: str = "") -> Response:
        wording = words(language_of(request))
        try:
            desk = plant.ask(ReportsApi)
            if desk is None:
                raise missing(PROOFS)
            content = await run_in_threadpool(desk.report, task)
        except ArboledaError as error:
            return _note(wording, task, wording.say(error.sentence), status=404)
        if content is None:
            waits = _note(wording, task, wording("report.waits"))
            waits.headers["refresh"] = str(LOOK_S)
            return waits
        name = f'inline; filename="{task}.html"'
        return HTMLResponse(content, headers={"content-security-policy": POLICY, "content-disposition": name})

    server.add_api_route(PATH, report, include_in_schema=False)


def way_from_cell(spot: Spot) -> None:
    """Draw the link to the report on the last task of a cell, while its card says that it failed."""
    _way(spot, f"{spot.cell}.report")


def way_from_task(spot: Spot) -> None:
    """Draw the link to the report on the task whose page this is, if it failed."""
    _way(spot, "task.report")


def _way(spot: Spot, key: str) -> None:
    if spot.layout.get("recorded"):
        of_task(key, PATH, classes="act to-report")


def _note(wording: Words, task: str, text: str, status: int = 200) -> HTMLResponse:
    title = wording("report.title", task=task)
    body = f"<h1>{escape(title)}</h1><p role=status>{escape(text)}</p>"
    return login.page(title, body, language=wording.language, status=status)
