"""Packages bring routes of their own; what is not installed is named with the line that installs it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import indent
from typing import Any

import pytest
from fastapi.routing import APIRoute
from tests.added_package import install
from tests.guarded_plant import guarded
from tests.in_process import Caller
from tests.packages import PACKAGES, leave_out
from tests.web_plant import Plant

from arboleda.extension import takes
from arboleda.host.pieces import Pieces
from arboleda.web import missing, routes
from arboleda.web.api import make_app
from arboleda.web.package_routes import TAKEN
from arboleda.web.routes import routers

CODE = '''
from fastapi import APIRouter


def routes(side):
    api = APIRouter(prefix="/api")

    @api.get("/ended")
    async def ended():
        """How many tasks ended."""
        return {{"ended": len(side.latest()["tasks"])}}

    {more}
    return api
'''
TAKES = """
from fastapi import APIRouter, FastAPI


async def mine():
    return "mine"


def routes(side):
    api = APIRouter()
    for path in ("/api/ended", "/api/plant", "/api/events", "/login", "/api/ended", "/", "/task.json"):
        api.add_api_route(path, mine)
    api.add_api_route("/twin/{what}", mine)
    api.mount("/shelf", FastAPI())
    api.mount("", FastAPI())
    return api
"""
STOPS = """
from fastapi import APIRouter


async def act(verb: str = ""):
    return verb


def routes(side):
    api = APIRouter()
    api.add_api_route("PATH", act, methods=["POST"])
    return api
"""
Install = Callable[[str], None]


@pytest.fixture
def put(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Installs a package `acme` with this code."""
    monkeypatch.syspath_prepend(tmp_path / "site")
    yield lambda code: install(tmp_path / "site", "acme", code, group=routes.GROUP, what="routes")
    sys.modules.pop("acme", None)


def paths(each: Any) -> list[str]:
    return [route.path for route in each.routes if isinstance(route, APIRoute)]


def test_a_route_of_a_package_is_asked_and_described(plant: Plant, put: Install) -> None:
    put(CODE.format(more=""))
    app = make_app(plant)
    assert Caller(app).get("/api/ended").json() == {"ended": 1}
    assert "/api/ended" in app.openapi()["paths"]


def test_a_package_takes_no_path_of_the_runner(plant: Plant, put: Install) -> None:
    told: list[str] = []
    put(TAKES)
    app = make_app(plant, pieces=Pieces(tell=told.append))
    assert Caller(app).get("/api/plant").json()["plant"] == "demo"
    assert Caller(app).get("/api/ended").json() == "mine"
    assert Caller(app).get("/anything").status_code == 404
    assert told == [
        f"Arboleda goes on without the route GET {each} of acme 1: {whose} has this address already"
        for each, whose in (
            ("/api/plant", "Arboleda"),
            ("/api/events", "Arboleda"),
            ("/login", "Arboleda"),
            ("/api/ended", "acme"),
            ("/", "Arboleda"),
            ("/task.json", "Arboleda"),
            ("/twin/scene.json", "Arboleda"),
        )
    ]


@pytest.mark.parametrize(
    ("path", "taken"),
    [
        ("/api/plants/stop", "/api/plants/stop"),
        ("/api/plants/{name}/stop", "/api/plants/x/stop"),
        ("/api/plants/north/stop", "/api/plants/north/stop"),
        ("/api/{what}/stop", "/api/plant/stop"),
        ("/api/{rest:path}", "/api/cells/x/stop"),
    ],
)
def test_a_package_takes_no_address_of_a_stop(plant: Plant, put: Install, path: str, taken: str) -> None:
    told: list[str] = []
    put(STOPS.replace("PATH", path))
    make_app(plant, pieces=Pieces(tell=told.append))
    why = TAKEN.format(whose="Arboleda")
    assert told == [f"Arboleda goes on without the route POST {taken} of acme 1: {why}"]


def test_no_route_of_a_package_is_asked_for_a_stop(plant: Plant, put: Install) -> None:
    told: list[str] = []
    put(STOPS.replace("PATH", "/api/plants/north/{verb}"))
    web = guarded(plant, behind=make_app(plant, pieces=Pieces(tell=told.append))).client()
    assert not told and web.post("/api/plants/north/home").json() == "home"
    assert web.post("/api/plants/north/stop").status_code == 404


@pytest.mark.parametrize(
    ("code", "why"),
    [
        (CODE.format(more="raise ValueError('the shelf is full')"), "the shelf is full"),
        ("def routes(side): return 7", "acme:routes makes no APIRouter"),
        ("import no_such_library", "No module named"),
    ],
)
def test_a_package_whose_routes_break_is_left_out_and_named(
    plant: Plant, put: Install, code: str, why: str
) -> None:
    put(code)
    told: list[str] = []
    app = make_app(plant, pieces=Pieces(tell=told.append))
    (said,) = told
    assert said.startswith("Arboleda goes on without the routes of acme 1: ") and why in said
    assert Caller(app).get("/api/plant").status_code == 200


BROAD = """
from fastapi import APIRouter


async def any_of(what: str = ""):
    return "any"


async def ended():
    return "ended"


def routes(side):
    api = APIRouter()
    for path in ("/api/{what:path}", "/api/{what}"):
        api.add_api_route(path, any_of)
    api.add_api_route("/api/ended", ended)
    return api
"""


def test_a_whole_address_goes_before_one_that_takes_any(plant: Plant, put: Install) -> None:
    put(BROAD)
    web = Caller(make_app(plant))
    assert [web.get(f"/api/{each}").json() for each in ("ended", "other")] == ["ended", "any"]


BREAKS = """
@api.post("/orders")
async def order(body: dict):
    raise ValueError("the shelf is full")
"""


def test_a_route_that_breaks_is_named_with_its_package(
    plant: Plant, put: Install, caplog: pytest.LogCaptureFixture
) -> None:
    put(CODE.format(more=indent(BREAKS, "    ")))
    answer = guarded(plant, behind=make_app(plant)).client().post("/api/orders", json={})
    whose = "the route POST /api/orders of acme 1"
    assert answer.json() == {"sentence": f"The plant could not answer: internal error in {whose}."}
    assert f"{whose} failed: ValueError: the shelf is full" in caplog.messages


def test_a_body_that_is_no_json_is_refused_in_words(plant: Plant, put: Install) -> None:
    put(CODE.format(more=indent(BREAKS, "    ")))
    head = {"content-type": "application/json"}
    web = guarded(plant, behind=make_app(plant)).client(**head)
    answer = web.post("/api/orders", content=b'{"amount": 3 "of": 7}')
    said = "The body is no JSON: expecting ',' delimiter, at character 13."
    assert (answer.status_code, answer.json()) == (422, {"sentence": said})


LARGE = """
from fastapi import APIRouter, Request
from arboleda.extension import takes


async def size(request: Request):
    return len(await request.body())


def routes(side):
    api = APIRouter(dependencies=[takes(kilobytes=8)])
    api.add_api_route("/api/photos/{name}", size, methods=["POST"])
    api.add_api_route("/api/films", size, methods=["POST"], dependencies=[takes(kilobytes=16)])
    return api
"""


@pytest.mark.parametrize(("path", "most"), [("photos/a", 8), ("films", 16), ("tasks", 4)])
def test_a_body_is_as_large_as_its_route_says(plant: Plant, put: Install, path: str, most: int) -> None:
    put(LARGE)
    web = guarded(plant, behind=make_app(plant)).client()
    fits, too_large = (
        web.post(f"/api/{path}", content=b" " * size) for size in (most * 1024, most * 1024 + 1)
    )
    assert fits.status_code != 413
    assert (too_large.status_code, too_large.json()["sentence"]) == (
        413,
        f"The body may have {most * 1024} bytes.",
    )


def test_a_route_takes_no_more_than_there_is_room_for() -> None:
    with pytest.raises(ValueError, match="it may take 4096"):
        takes(kilobytes=4097)


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> Caller:
    """The routes of the runner alone."""
    with pytest.MonkeyPatch.context() as patch:
        leave_out(patch, tmp_path_factory.mktemp("nothing"), *PACKAGES)
        return Caller(make_app(Plant()))


@pytest.mark.parametrize(
    ("method", "path", "package"),
    [
        ("GET", "/api/oee", "fleet"),
        ("GET", "/api/draft", "make"),
        ("POST", "/api/draft/take", "make"),
        ("GET", "/api/versions", "make"),
        ("POST", "/api/assistants/tasks", "make"),
        ("POST", "/api/faults", "proofs"),
        ("GET", "/api/tasks/t-1/report", "proofs"),
        ("GET", "/oee.json", "fleet"),
        ("GET", "/proof", "make"),
        ("GET", "/report", "proofs"),
    ],
)
def test_what_is_not_installed_is_named_with_the_line_that_installs_it(
    bare: Caller, method: str, path: str, package: str
) -> None:
    answer = bare.request(method, path)
    assert answer.status_code == 501
    said = f"This needs the package {package}, which is not installed here:"
    assert answer.json()["sentence"] == f"{said} type pip install 'arboleda[{package}]'"


def test_a_path_that_nobody_knows_is_no_missing_package(bare: Caller) -> None:
    assert bare.get("/api/draughts").status_code == 404


def test_no_path_of_the_runner_is_a_package_s(bare: Caller) -> None:
    mine = [path for each in routers(None) for path in paths(each)]
    assert not [path for path in mine for known in missing.PATHS.values() if known.fullmatch(path)]
