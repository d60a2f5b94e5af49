"""The client in Python has what the HTTP API has: a method for each route, and the fields of each answer."""

from __future__ import annotations

from dataclasses import MISSING, fields, is_dataclass
from enum import Enum
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import pytest
from fastapi import APIRouter
from fastapi.routing import APIRoute
from pydantic import BaseModel

from arboleda.client import Draft, Plant
from arboleda.client.answers import Event
from arboleda.client.calls import Flow, Following, Route
from arboleda.web import api, stream
from arboleda.web.routes import routers

SIDE: Any = None  # nothing is asked of it
PUBLIC: list[APIRouter] = [api.routes(SIDE), *routers(SIDE), stream.routes(SIDE, 1)]
ROUTES = {
    f"{method} {each.path}": each
    for router in PUBLIC
    for each in router.routes
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
# A button that is held has to be said again every 0.1 s, and an editor of trees asks for what it draws.
LEFT_TO_THE_PAGE = {
    *(path for path in ROUTES if "/api/teach/" in path),
    "POST /api/make/drawn/check",
    "POST /api/make/drawn/edit",
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
def test_an_answer_has_the_fields_of_its_schema(name: str) -> None:
    method = DECLARED[name]
    model = ROUTES[method.routes[0]].response_model
    assert shape(method.answer) == (shape(str) if model is None else shape(model))


def test_what_is_submitted_or_operated_answers_by_its_schema_too() -> None:
    for name, path in (
        ("submit", "/api/tasks"),
        ("submit_form", "/api/tasks"),
        ("operate", "/api/plant/{verb}"),
    ):
        answer = get_type_hints(METHODS[f"Plant.{name}"].work)["return"]
        assert shape(answer) == shape(ROUTES[f"POST {path}"].response_model)


def test_an_event_is_of_a_kind_that_its_description_names() -> None:
    told = Event.__doc__ or ""
    assert all(kind in told for kind in ("snapshot", "plant", *(kind for kind, *_ in stream.ROWS.values())))


def shape(wanted: Any) -> Any:
    """A type without who declares it: fields with their shapes, and whether they may be missing."""
    of = get_origin(wanted)
    if of is Annotated:
        return shape(get_args(wanted)[0])
    if of is Literal or (isinstance(wanted, type) and issubclass(wanted, Enum)):
        return "str"
    if of in (Union, UnionType):
        return frozenset(shape(each) for each in get_args(wanted))
    if of is not None:
        kind = "list" if issubclass(of, list) else of.__name__
        return (kind, *(shape(each) for each in get_args(wanted)))
    if is_dataclass(wanted):
        hints = get_type_hints(wanted)
        return frozenset(
            (each.name, shape(hints[each.name]), each.default is MISSING and each.default_factory is MISSING)
            for each in fields(wanted)
        )
    if isinstance(wanted, type) and issubclass(wanted, BaseModel):
        hints = get_type_hints(wanted, include_extras=True)
        return frozenset(
            (name, shape(hints[name]), each.is_required()) for name, each in wanted.model_fields.items()
        )
    return getattr(wanted, "__name__", str(wanted))
