"""The versions of the plant's files: which is at work, who put which to work, and a way back."""

from __future__ import annotations

from fastapi import FastAPI, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse, Response

from arboleda.dashboard.shell import language_of
from arboleda.extension import PageApi, Spot, tag
from arboleda.extension import words as words_of
from arboleda_make.versions.api import VersionsApi

from .version_rows import face


def build(spot: Spot) -> None:
    """Draw the box; the script fills and shows it where the plant has files of its own."""
    words = spot.words
    texts = {"data_by": words("versions.from_page"), "data_sure": words("versions.sure")}
    lost = words("js.not_sent")
    with tag("div", id="versions-box", classes="box", hidden="true", data_lost=lost, **texts):
        tag("h2", words("versions.title"))
        tag("p", id="versions-now", classes="fact")
        tag("ul", id="versions-cells")
        with tag("p", id="versions-restart", hidden="true"):
            tag("span", classes="hint")
            tag("button", type="button", classes="act")
        tag("ul", id="versions", aria_label=words("versions.list"))
        tag("p", id="versions-said", role="status", classes="hint")


def serve(server: FastAPI, plant: PageApi) -> None:
    """Answer `/versions.json`."""

    async def versions(request: Request) -> Response:
        desk = plant.ask(VersionsApi)
        listed = None if desk is None else await run_in_threadpool(desk.listed)
        if listed is None:
            return Response(status_code=404)
        return JSONResponse(face(listed, words_of(language_of(request))))

    server.add_api_route("/versions.json", versions, include_in_schema=False)
