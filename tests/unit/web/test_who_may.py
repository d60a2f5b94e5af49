"""Who may ask for the routes of packages: an operator, unless a route only reads or says otherwise."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any

import httpx
import nicegui  # noqa: F401  # as it is loaded it starts a process, which no test may
import pytest
from fastapi import FastAPI
from tests.added_package import install
from tests.guarded_plant import guarded
from tests.in_process import ORIGIN
from tests.packages import PACKAGES, leave_out
from tests.web_plant import TOKENS, Plant

from arboleda.dashboard.added import AddedParts
from arboleda.host.packages import registered
from arboleda.web import routes
from arboleda.web.access.auth import Role
from arboleda.web.api import answer_in_sentences, make_app
from arboleda.web.package_routes import leaves

ALL = {**TOKENS, Role.ASSISTANT: "a" * 32}
FILLED = {"{hash}": "0" * 64, "{number}": "1", "{what}": "try", "{cell}": "saw", "{task_id}": "t-1"}
STRANGE = """
from fastapi import APIRouter, Depends, FastAPI
from fastapi.responses import PlainTextResponse
from starlette.websockets import WebSocket
from arboleda.web.access.auth import Role
from arboleda.web.access.needs import needs


async def answer():
    return {"orders": 3}


async def asks(_=needs(Role.OPERATOR)):
    return await answer()


async def nested(_=Depends(asks)):
    return await answer()


async def plain(request):
    return PlainTextResponse("taken")


async def follow(socket: WebSocket):
    await socket.accept()
    await socket.close()


async def hear(socket: WebSocket, _=needs(Role.OPERATOR)):
    await follow(socket)


def add(api, at=""):
    path = f"{at}/orders"
    api.add_api_route(path, answer, methods=["GET", "HEAD"])
    api.add_api_route(path, answer, methods=["POST", "PUT", "PATCH", "DELETE"])
    api.add_api_route(f"{path}/wish", answer, methods=["POST"], dependencies=[needs(Role.ASSISTANT)])
    api.add_api_route(f"{path}/note", answer, methods=["POST"], dependencies=[needs(Role.VIEWER)])
    api.add_api_route(f"{path}/prices", answer, dependencies=[needs(Role.OPERATOR, "reading prices")])
    api.add_api_websocket_route(f"{path}/live", follow)
    api.add_route(f"{path}/plain", plain, methods=["POST"])
    server = FastAPI()
    server.add_api_route("/{path:path}", answer, methods=["GET", "POST"])
    api.mount(f"{path}/mounted", server)
    api.add_api_route(f"{path}/parameter", asks)
    api.add_api_route(f"{path}/nested", nested)
    api.add_api_route(f"{path}/beside", answer, dependencies=[Depends(asks)])
    api.add_api_route(f"{path}/both", asks, dependencies=[needs(Role.VIEWER)])
    api.add_api_websocket_route(f"{path}/heard", hear)
    strict = FastAPI(dependencies=[needs(Role.OPERATOR)])
    strict.add_api_route("/prices", answer)
    api.mount(f"{path}/strict", strict)


def routes(side):
    api, inner, strict = APIRouter(), APIRouter(), APIRouter(dependencies=[needs(Role.OPERATOR)])
    add(api, "/api")
    add(inner)
    strict.add_api_route("/prices", answer)
    strict.add_api_route("/open", answer, methods=["POST"], dependencies=[needs(Role.VIEWER)])
    strict.add_api_route("/both", asks, dependencies=[needs(Role.VIEWER)])
    api.include_router(inner, prefix="/api/inner")
    api.include_router(strict, prefix="/api/strict")
    return api
"""
PAGE = (
    STRANGE
    + """
from arboleda.dashboard.page_part import PagePart


def serve(server, plant):
    add(server)


PAGE = PagePart(serve=serve)
"""
)


def statuses(app: Any, requests: set[str], role: Role | None) -> dict[str, int]:
    """The status of each answer to somebody of this role, who is never too fast."""

    async def patient(*asked: Any) -> None:
        await guarded(Plant(), dict(ALL), behind=app).app(*asked)

    async def ask() -> dict[str, int]:
        bearer = {} if role is None else {"authorization": f"Bearer {ALL[role]}"}
        transport = httpx.ASGITransport(patient, raise_app_exceptions=False)
        async with httpx.AsyncClient(transport=transport, base_url=ORIGIN, headers=bearer) as client:
            return {each: (await client.request(*filled(each).split())).status_code for each in requests}

    return asyncio.run(ask())


def filled(request: str) -> str:
    for name, value in FILLED.items():
        request = request.replace(name, value)
    return request


def refused(app: Any, requests: set[str], role: Role | None) -> set[str]:
    return {each for each, status in statuses(app, requests, role).items() if status in (401, 403)}


def requests_of(routes_: Any) -> set[str]:
    return {f"{method} {each.path}" for each in leaves(routes_) for method in each.methods or ()}


Made = tuple[FastAPI, set[str]]


def of_package(name: str, folder: Path, patch: pytest.MonkeyPatch) -> Made:
    """The application with the routes of a package, and of its page; what they can be asked for."""
    leave_out(patch, folder, *(each for each in PACKAGES if each != name))
    plant = Plant()
    app, page = make_app(plant), FastAPI(openapi_url=None)
    requests = {each for point in registered(routes.GROUP) for each in requests_of(point.load()(None).routes)}
    AddedParts().serve(page, plant)  # type: ignore[arg-type]
    requests |= requests_of([each.behind for each in page.router.routes])
    app.router.routes += page.router.routes
    return app, requests


def assert_for(
    made: Made, *, assistants: Collection[str] = (), read_by_operators: Collection[str] = ()
) -> None:
    """All requests are refused to strangers, and each is answered to those who may."""
    app, requests = made
    others = {each for each in requests if not each.startswith("GET ")} | {*read_by_operators}
    assert requests > {*assistants, *read_by_operators}
    assert refused(app, requests, None) == requests
    assert refused(app, requests, Role.VIEWER) == others | {*assistants}
    assert refused(app, requests, Role.ASSISTANT) == others - {*assistants}
    assert refused(app, requests, Role.OPERATOR) == set()


@pytest.fixture
def strange(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], FastAPI]]:
    """An application with what a package of somebody else adds: routes, or addresses of its page."""
    monkeypatch.syspath_prepend(tmp_path / "site")

    def made(where: str) -> FastAPI:
        if where != "page":
            install(tmp_path / "site", "acme", STRANGE, group=routes.GROUP, what="routes")
            return make_app(Plant())
        install(tmp_path / "site", "acme", PAGE, group="arboleda.page", what="PAGE")
        app = FastAPI(openapi_url=None)
        answer_in_sentences(app)
        AddedParts().serve(app, Plant())  # type: ignore[arg-type]
        return app

    yield made
    sys.modules.pop("acme", None)


@pytest.mark.parametrize("where", ["/api", "/api/inner", "page"])
def test_without_a_word_only_operators_may_do_more_than_read(
    strange: Callable[[str], FastAPI], where: str
) -> None:
    app, at = strange(where), where.removeprefix("page")
    reads = {f"{method} {at}/orders" for method in ("GET", "HEAD")} | {f"GET {at}/orders/mounted/x"}
    acts = {f"{method} {at}/orders" for method in ("POST", "PUT", "PATCH", "DELETE")}
    acts |= {f"POST {at}/orders/plain", f"POST {at}/orders/mounted/x", f"GET {at}/orders/prices"}
    wish, note = f"POST {at}/orders/wish", f"POST {at}/orders/note"
    asked = {*reads, *acts, wish, note}
    assert refused(app, asked, Role.VIEWER) == {*acts, wish}
    assert refused(app, asked, Role.ASSISTANT) == acts
    assert {*statuses(app, asked, Role.OPERATOR).values()} == {200}


def test_what_a_route_declares_counts_before_what_its_router_does(strange: Callable[[str], FastAPI]) -> None:
    app = strange("/api")
    asked = {"GET /api/strict/prices", "POST /api/strict/open"}
    assert refused(app, asked, Role.VIEWER) == {"GET /api/strict/prices"}


@pytest.mark.parametrize("where", ["/api", "/api/inner", "page"])
def test_what_is_declared_anywhere_else_counts_too(strange: Callable[[str], FastAPI], where: str) -> None:
    app, at = strange(where), where.removeprefix("page")
    names = ("parameter", "nested", "beside", "both", "strict/prices")
    asked = {f"GET {at}/orders/{each}" for each in names}
    assert {*statuses(app, asked, Role.VIEWER).values()} == {403}
    assert {*statuses(app, asked, Role.OPERATOR).values()} == {200}


def test_a_parameter_counts_beside_what_its_router_declares(strange: Callable[[str], FastAPI]) -> None:
    assert statuses(strange("/api"), {"GET /api/strict/both"}, Role.VIEWER) == {"GET /api/strict/both": 403}


def test_the_refusal_names_what_is_refused(strange: Callable[[str], FastAPI]) -> None:
    web = guarded(Plant(), dict(ALL), behind=strange("/api"))
    said = [
        web.client(token=Role.VIEWER).request(*each).json()
        for each in (("DELETE", "/api/orders"), ("GET", "/api/orders/prices"), ("GET", "/api/orders/both"))
    ]
    assert [each["sentence"] for each in said] == [
        "A viewer may look and stop; DELETE /api/orders needs the operator's token.",
        "A viewer may look and stop; reading prices needs the operator's token.",
        "A viewer may look and stop; GET /api/orders/both needs the operator's token.",
    ]


@pytest.mark.parametrize("where", ["/api", "/api/inner", "page"])
@pytest.mark.parametrize("role", [*Role])
@pytest.mark.parametrize("name", ["live", "heard"])
def test_a_websocket_is_no_reading(
    strange: Callable[[str], FastAPI], where: str, role: Role, name: str
) -> None:
    app, sent = strange(where), list[dict[str, Any]]()
    path = f"{where.removeprefix('page')}/orders/{name}"
    scope = {"type": "websocket", "path": path, "query_string": b"", "headers": [], "arboleda.role": role}

    async def receive() -> dict[str, Any]:
        return {"type": "websocket.connect"}

    async def send(message: dict[str, Any]) -> None:
        sent.append(message)

    asyncio.run(app({**scope, "extensions": {"websocket.http.response": {}}}, receive, send))
    accepted = sent[0]["type"] == "websocket.accept"
    assert accepted is (role is Role.OPERATOR)
    assert accepted or sent[0]["status"] == 403
