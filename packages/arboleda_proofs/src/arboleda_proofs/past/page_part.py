"""Part of a plant's page: the page on its records."""

from __future__ import annotations

from fastapi import FastAPI, Request, Response

from arboleda.dashboard import shell
from arboleda.dashboard.toolkit import Client
from arboleda.extension import Assets, PageApi, PagePart
from arboleda.recorder.errors import NoRecord
from arboleda.web.access.auth import require

from .desk import NOT_YET, PastDesk
from .page import KEY, SCENE, START, open_page


def show(request: Request, client: Client, plant: PageApi) -> str:
    """The page on the record that the address names, on that of this start where it names none."""
    desk, name = _desk(plant), request.query_params.get(START, "")
    is_other = name in desk.others and shell.is_operator(request)
    shown = desk.other(name) if is_other else desk.own(plant)
    return open_page(client, shown, desk.turns, request, of=name if is_other else "", beside=True)


def serve(server: FastAPI, plant: PageApi) -> None:
    """Answer with the scene of the twin of a record."""

    def scene(request: Request, record: str = "") -> Response:
        desk = _desk(plant)
        if record not in desk.others:
            return desk.own(plant).scene.answer()
        require(request.scope["arboleda.role"], desk.others[record].may)
        return desk.other(record).scene.answer()

    server.add_api_route(SCENE, scene, include_in_schema=False)


def _desk(plant: PageApi) -> PastDesk:
    desk = plant.ask(PastDesk)
    if desk is None:
        raise NoRecord(NOT_YET())
    return desk


PAGE = PagePart(assets=Assets(package=__package__), serve=serve, pages={KEY: show})
