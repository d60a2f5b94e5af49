"""The client in Python has what the HTTP API has: a method for each route, and the type of each answer."""

from __future__ import annotations

from typing import Any, get_args, get_origin, get_type_hints

import pytest
from fastapi import APIRouter
from fastapi.routing import APIRoute

from arboleda.client import Draft, Plant
from arboleda.client.answers.plant import Event
from arboleda.client.answers.rows import Rows
from arboleda.client.calls import Flow, Following, Route
from arboleda.host.packages import registered
from arboleda.web import api, stream
from arboleda.web.routes import GROUP, routers
from arboleda.web.schema.answers import model_of
from arboleda.web.schema.openapi import described_route

SIDE: Any = None  # nothing is asked of it
PUBLIC: list[APIRouter] = [api.routes(SIDE), *routers(SIDE), stream.routes(SIDE, 1)]
PUBLIC += [point.load()(SIDE) for point in registered(GROUP)]
ROUTES = {
    f"{method} {each.path}": each
    for router in PUBLIC
    for each in map(described_route, router.routes)
    if isinstance(each, APIRoute)
    for method in each.methods
}
METHODS = {
    f"{side.__name__}.{name}": getattr(side, name)
    for side in (Plant, Draft)
    for name in dir(side)
    if isinstance(getattr(side, name), Flow | Following)
}
DECLARED = {name: method for name, method in METHODS.items() if isinstance(method, Route)}
# A button that is held has to be said again every 0.1 s, and an editor asks for what it draws and takes away.
LEFT_TO_THE_PAGE = {
    *(path for path in ROUTES if "/api/teach/" in path),
    "POST /api/make/drawn/check",
    "POST /api/make/drawn/edit",
    "POST /api/make/objections",
    "POST /api/make/remove",
    "POST /api/make/runs/reach",
}


def test_every_route_has_a_method() -> None:
    known = {path for method in METHODS.values() for path in method.routes}
    assert known <= ROUTES.keys()
    assert ROUTES.keys() - known == LEFT_TO_THE_PAGE


@pytest.mark.parametrize("name", DECLARED)
def test_a_method_takes_what_its_route_takes(name: str) -> None:
    method = DECLARED[name]
    route = ROUTES[method.routes[0]]
    described = route.openapi_extra or {}
    body = described.get("requestBody", {}).get("content", {}).get("application/json", {}).get("schema", {})
    taken = {each["name"] for each in described.get("parameters", ())} | body.get("properties", {}).keys()
    taken |= {each.alias for each in (*route.dependant.path_params, *route.dependant.query_params)}
    assert set(method.parameters) == taken - {"editor"}
    assert method.by_editor is ("editor" in taken)


@pytest.mark.parametrize("name", DECLARED)
def test_a_method_returns_what_its_route_answers(name: str) -> None:
    method = DECLARED[name]
    wanted = list[get_args(method.answer)[0]] if get_origin(method.answer) is Rows else method.answer  # type: ignore[misc]
    assert ROUTES[method.routes[0]].response_model == (None if wanted is str else model_of(wanted))


def test_what_is_submitted_or_operated_is_answered_so_too() -> None:
    for name, path in (
        ("submit", "/api/tasks"),
        ("submit_form", "/api/tasks"),
        ("operate", "/api/plant/{verb}"),
    ):
        answer = get_type_hints(METHODS[f"Plant.{name}"].work)["return"]
        assert ROUTES[f"POST {path}"].response_model is model_of(answer)


def test_an_event_is_of_a_kind_that_its_description_names() -> None:
    told = Event.__doc__ or ""
    assert all(kind in told for kind in ("snapshot", "plant", *(kind for kind, *_ in stream.ROWS.values())))
