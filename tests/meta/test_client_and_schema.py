"""The client in Python has what the HTTP API has: a method for each route, and the type of each answer."""

from __future__ import annotations

from typing import get_type_hints

import pytest

from arboleda.client import Plant, Routes, Task, route
from arboleda.client.added import OF_PACKAGES, added
from arboleda.client.answers.plant import Event
from arboleda.web import api, stream
from arboleda.web.routes import routers
from arboleda.web.schema.answers import model_of

from ..client_methods import SIDE, differences, left, methods_of, routes_of

ROUTES = routes_of([api.routes(SIDE), *routers(SIDE), stream.routes(SIDE, 1)])
METHODS = methods_of(Plant)


def test_every_route_of_the_runner_has_a_method() -> None:
    assert left(ROUTES, METHODS) == set()


def test_a_method_takes_and_returns_what_its_route_does() -> None:
    assert differences(ROUTES, METHODS) == []


def test_a_method_that_is_otherwise_than_its_route_is_found() -> None:
    class Wrong(Routes):
        tasks = route("GET", "/api/tasks", Task)(lambda self: None)
        task = route("GET", "/api/tasks/{task_id}", Task)(lambda self, task_id, cell: None)
        orders = route("GET", "/api/orders", Task)(lambda self: None)

    found = differences(ROUTES, methods_of(Wrong))
    assert [each.partition(" ")[0] for each in found] == ["Wrong.orders:", "Wrong.task:", "Wrong.tasks:"]


@pytest.mark.parametrize(
    ("name", "path"),
    [("submit", "/api/tasks"), ("submit_form", "/api/tasks"), ("operate", "/api/plant/{verb}")],
)
def test_what_is_submitted_or_operated_is_answered_so_too(name: str, path: str) -> None:
    answer = get_type_hints(METHODS[f"Plant.{name}"].work)["return"]
    assert ROUTES[f"POST {path}"].response_model is model_of(answer)


def test_an_event_is_of_a_kind_that_its_description_names() -> None:
    told = Event.__doc__ or ""
    assert all(kind in told for kind in ("snapshot", "plant", *(kind for kind, *_ in stream.ROWS.values())))


def test_what_a_client_without_a_package_names_is_a_method_of_that_package() -> None:
    for kind in added():
        package = kind.__module__.partition(".")[0].removeprefix("arboleda_")
        assert {name for name in OF_PACKAGES[package] if not hasattr(kind, name)} == set()
