"""Methods of clients beside the routes that they ask, which take and answer the same."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, get_args, get_origin

from fastapi import APIRouter
from fastapi.routing import APIRoute

from arboleda.client import Routes
from arboleda.client.answers.rows import Rows
from arboleda.client.calls import Flow, Following, Route
from arboleda.host.packages import package_of, registered
from arboleda.web.routes import GROUP
from arboleda.web.schema.answers import model_of
from arboleda.web.schema.openapi import described_route

SIDE: Any = None  # nothing is asked of it


def routes_of(routers: Iterable[APIRouter]) -> dict[str, APIRoute]:
    """Routes by method and path, as `GET /api/plant`."""
    found = (described_route(each) for router in routers for each in router.routes)
    return {
        f"{way} {each.path}": each for each in found if isinstance(each, APIRoute) for way in each.methods
    }


def routes_of_package(package: str) -> dict[str, APIRoute]:
    return routes_of(each.load()(SIDE) for each in registered(GROUP) if package_of(each) == package)


def methods_of(*kinds: type[Routes]) -> dict[str, Any]:
    """Methods of these classes that ask a plant, by name."""
    named = {f"{kind.__name__}.{name}": getattr(kind, name) for kind in kinds for name in dir(kind)}
    return {name: each for name, each in named.items() if isinstance(each, Flow | Following)}


def left(routes: dict[str, APIRoute], methods: dict[str, Any]) -> set[str]:
    """The routes that no method asks."""
    return routes.keys() - {path for method in methods.values() for path in method.routes}


def differences(
    routes: dict[str, APIRoute], methods: dict[str, Any], *, by_editor: type[Route] | None = None
) -> list[str]:
    """What of the methods is otherwise than their routes, a line each. Those of the kind `by_editor` send the
    editor of a draft along."""
    return [
        f"{name}: {word}"
        for name, method in methods.items()
        for word in _differences(routes, method, by_editor is not None and isinstance(method, by_editor))
    ]


def _differences(routes: dict[str, APIRoute], method: Any, is_by_editor: bool) -> Iterator[str]:
    for path in method.routes:
        if path not in routes:
            yield f"there is no {path}"
        elif isinstance(method, Route):
            taken = _taken(routes[path])
            if {*method.parameters, *(["editor"] if is_by_editor else [])} != taken:
                yield f"{path} takes {sorted(taken)}"
            if routes[path].response_model != _model(method.answer):
                yield f"{path} answers {routes[path].response_model}"


def _taken(route: APIRoute) -> set[str]:
    """The names of what a route takes, in its path, query or body."""
    described = route.openapi_extra or {}
    body = described.get("requestBody", {}).get("content", {}).get("application/json", {}).get("schema", {})
    taken = {each["name"] for each in described.get("parameters", ())} | body.get("properties", {}).keys()
    return taken | {each.alias for each in (*route.dependant.path_params, *route.dependant.query_params)}


def _model(answer: Any) -> Any:
    wanted = list[get_args(answer)[0]] if get_origin(answer) is Rows else answer  # type: ignore[misc]
    return None if wanted is str else model_of(wanted)
