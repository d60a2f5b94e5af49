"""Packages add to the page: what they add stands in its place, and one that breaks is left out and named."""

from __future__ import annotations

import asyncio
import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from fastapi import FastAPI
from nicegui import json
from nicegui.client import HTML_ESCAPE_TABLE
from tests.added_package import install
from tests.packages import PACKAGES, leave_out

from arboleda.dashboard import added, page, shell
from arboleda.dashboard.added import AddedParts
from arboleda.dashboard.desk import Desk
from arboleda.dashboard.feed import Feed
from arboleda.dashboard.page_part import GROUP
from arboleda.dashboard.wording import words
from arboleda.host.pieces import Pieces
from arboleda.model.errors import ArboledaError
from arboleda.testing import shipped
from arboleda.views import view
from arboleda.web.access.auth import Role
from arboleda.web.package_routes import PackageRoute

CODE = """
from arboleda.dashboard.asset_files import Assets
from arboleda.dashboard.page_part import PageAct, PagePart, Place, Section
from arboleda.dashboard.tags import live, tag
from arboleda.web.access.auth import Role

HEARD = []


def card(spot):
    live("p", f"{spot.cell}.ended")


def panel(spot):
    tag("h2", f"Shelf of {spot.layout['plant']}")


async def take(request):
    HEARD.append((request.of, request.more))
    request.say("taken", good=True)


def face(moment):
    return {f"text/{cell['name']}.ended": ["7", ""] for cell in moment.snapshot["cells"]}


def serve(server, plant):
    server.add_api_route("/shelf.json", lambda: plant.layout()["plant"])


PAGE = PagePart(
    sections=(
        Section(place=Place.CARD, build=card),
        Section(place=Place.TAB, name="zones", build=panel, role=Role.OPERATOR),
    ),
    acts={"fetch": PageAct(name="zones.title", take=take)},
    face=face,
    serve=serve,
)
"""
LAYOUT = view.layout(shipped())
IN_ORDER = {"cells": ["cells"], "tasks": ["tasks"], "log": ["events", "links"], "settings": ["settings"]}
Install = Callable[..., None]
Told = list[str]


@pytest.fixture
def put(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Installs a package with this code, `acme` where no other is named."""
    monkeypatch.syspath_prepend(tmp_path / "site")

    def put(code: str = CODE, name: str = "acme") -> None:
        install(tmp_path / "site", name, code, group=GROUP, what="PAGE")

    yield put
    for name in ("acme", "bolt"):
        sys.modules.pop(name, None)


def html(parts: AddedParts, role: str | None = None, plant: Any = None) -> str:
    return page.drawn(parts, plant or Plant(), LAYOUT, words("en"), role)


class Plant:
    """A plant of which no part offers anything."""

    def ask(self, kind: type) -> Any:
        return None

    def layout(self) -> dict[str, Any]:
        return LAYOUT


def served(server: FastAPI) -> list[str]:
    return [each.behind.path for each in server.routes if isinstance(each, PackageRoute)]  # type: ignore[attr-defined]


def now() -> Any:
    cell = {"name": "lab", "teaching": None, "state": "idle", "not_ready": None}
    return SimpleNamespace(snapshot={"cells": [cell]}, links={}, words=words("en"))


def loaded(told: Told | None = None) -> AddedParts:
    return AddedParts(Pieces(tell=([] if told is None else told).append), page.OWN)


def tabs(shown: str) -> list[tuple[str, list[str]]]:
    """The tabs of a page in their order, each with its parts; places of several come first."""
    found = re.findall(r'data-tab="(\w+)" data-parts="([\w ]+)"', shown.partition("<section")[0])
    return [(tab, parts.split()) for tab, parts in found]


def test_the_page_has_its_places_with_their_parts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    leave_out(monkeypatch, tmp_path / "site", *PACKAGES)
    places = tabs(html(loaded()))
    assert dict(places[: len(IN_ORDER)]) == IN_ORDER
    assert sorted(tab for tab, _ in places[len(IN_ORDER) :]) == ["events", "links"]


def test_a_viewer_sees_no_part_that_is_for_operators(put: Install) -> None:
    put()
    assert "part-zones" in html(loaded()) and "part-zones" not in html(loaded(), Role.VIEWER.value)


def test_what_a_package_adds_is_drawn_in_its_place(put: Install) -> None:
    put()
    told: Told = []
    shown = html(loaded(told))
    assert told == []
    assert shown.index("part-zones") < shown.index("part-events")
    assert f"<h2>Shelf of {LAYOUT['plant']}</h2>" in shown
    assert all(f'data-live="{cell["name"]}.ended"' in shown for cell in LAYOUT["cells"])
    assert "part-zones" not in html(loaded(), Role.VIEWER.value)


def test_what_changes_in_it_comes_with_the_frames(put: Install) -> None:
    put()
    assert loaded().face(now())["text/lab.ended"] == ["7", ""]


def test_its_script_asks_its_own_code(put: Install) -> None:
    put()
    parts, said = loaded(), list[Any]()
    client: Any = SimpleNamespace(
        environ={"asgi.scope": {"arboleda.role": Role.OPERATOR}}, run_javascript=said.append
    )
    plant: Any = Plant()
    desk = Desk(client, plant, Feed(plant), words("en"), parts.acts)
    asyncio.run(desk.take("fetch", "lab", {"count": 2}))
    assert sys.modules["acme"].HEARD == [("lab", {"count": 2})] and "taken" in said[0]
    client.environ = {"asgi.scope": {"arboleda.role": Role.VIEWER}}
    asyncio.run(desk.take("fetch", "lab", None))
    assert len(sys.modules["acme"].HEARD) == 1 and "Shared zones" in said[1]


@pytest.mark.parametrize(
    ("code", "piece", "why"),
    [
        ("import no_such_library", "the part of the page", "No module named"),
        ("PAGE = 7", "the part of the page", "acme:PAGE is no Page and no PagePart"),
        (
            CODE.replace("PagePart(\n", 'PagePart(assets=Assets(package="acme"),\n'),
            "the part of the page",
            "acme",
        ),
        (CODE.replace("Shelf of {", "{1 / 0}{"), "the section zones", "division by zero"),
        (CODE.replace('["7", ""]', "1 / 0"), "the face of the page", "division by zero"),
        (
            CODE.replace('server.add_api_route("/shelf.json", ', "print(1 / 0, "),
            "the addresses of the page",
            "division by zero",
        ),
    ],
)
def test_a_piece_of_a_package_that_breaks_is_left_out_and_named(
    put: Install, code: str, piece: str, why: str
) -> None:
    put(code)
    told: Told = []
    parts = loaded(told)
    parts.serve(FastAPI(), Plant())  # type: ignore[arg-type]
    parts.face(now())
    shown = html(parts)
    (said,) = told
    assert said.startswith(f"Arboleda goes on without {piece} of acme 1: ") and why in said
    whole = piece.startswith("the part of")
    assert ("fetch" in parts.acts) is not whole
    assert ("part-zones" in shown) is not (whole or "section" in piece)
    assert (".ended" in shown) is not whole and "part-events" in shown


@pytest.mark.parametrize("act", ["home", "download"])
def test_a_package_takes_no_part_of_the_runner(put: Install, act: str) -> None:
    told: Told = []
    put(CODE.replace('name="zones"', 'name="links"').replace('"fetch"', f'"{act}"'))
    parts = loaded(told)
    assert "Shelf of" not in html(parts) and act not in parts.acts
    assert told == [
        f"Arboleda goes on without {each} of acme 1: Arboleda has this name already"
        for each in ("the section links", f"the act {act}")
    ]


@pytest.mark.parametrize("address", ["/", "/task.json", "/{path:path}"])
def test_a_package_takes_no_address_of_the_page(put: Install, address: str) -> None:
    told: Told = []
    put(CODE.replace("/shelf.json", address))
    server = FastAPI(openapi_url=None)
    loaded(told).serve(server, Plant())  # type: ignore[arg-type]
    assert address not in served(server)
    taken = address.replace("{path:path}", "")
    assert told == [
        f"Arboleda goes on without the route GET {taken} of acme 1: Arboleda has this address already"
    ]


def test_of_two_packages_that_serve_one_address_the_first_does(put: Install) -> None:
    told: Told = []
    put()
    put("from acme import serve, PagePart\n\nPAGE = PagePart(serve=serve)\n", "bolt")
    server = FastAPI(openapi_url=None)
    loaded(told).serve(server, Plant())  # type: ignore[arg-type]
    assert served(server).count("/shelf.json") == 1
    assert told == [
        "Arboleda goes on without the route GET /shelf.json of bolt 1: acme has this address already"
    ]


def test_of_two_sections_in_one_place_only_the_one_that_breaks_is_left_out(put: Install) -> None:
    told: Told = []
    broken = "Section(place=Place.CARD, build=lambda spot: 1 / 0),"
    put(CODE.replace("sections=(", f"sections=({broken}"))
    shown = html(loaded(told))
    assert ".ended" in shown
    assert told == [
        "Arboleda goes on without the section card of acme 1: ZeroDivisionError: division by zero"
    ]


PAGES = """
from arboleda.dashboard.page_part import PagePart
from arboleda.model.errors import ArboledaError


def refuse(request, client, plant):
    raise ArboledaError("nothing is kept")


PAGE = PagePart(pages={"shelf": lambda *of: "<p>shelf</p>", "none": refuse, "bad": lambda *of: 1 / 0})
"""


def asked(key: str) -> Any:
    return SimpleNamespace(query_params={key: ""})


def test_a_page_of_a_package_stands_in_place_of_the_plants_at_its_key(
    put: Install,
) -> None:
    told: Told = []
    put(PAGES)
    parts, client, plant = loaded(told), cast(Any, None), cast(Any, Plant())
    assert parts.page(asked("shelf"), client, plant) == "<p>shelf</p>"
    assert parts.page(asked("tab"), client, plant) is None
    with pytest.raises(ArboledaError, match="nothing is kept"):
        parts.page(asked("none"), client, plant)
    assert told == [] and parts.page(asked("bad"), client, plant) is None and "bad" not in parts.pages
    assert "without the page bad of acme 1" in told[0]


def test_without_proofs_whoever_asks_for_a_record_is_told_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    leave_out(monkeypatch, tmp_path / "site", *PACKAGES)
    with pytest.raises(ArboledaError, match=r"pip install 'arboleda\[proofs\]'"):
        loaded().page(asked("at"), cast(Any, None), cast(Any, Plant()))


def test_a_package_is_loaded_only_when_a_page_is_made(put: Install) -> None:
    put()
    assert "acme" in added.installed() and "acme" not in sys.modules


def test_parts_are_written_into_the_page_as_nicegui_would_write_them() -> None:
    parts = html(loaded()) + '<p>`${1}` & \\ "2" ñ \n</p>'
    assert shell.in_page(parts) == json.dumps(parts)[1:-1].translate(HTML_ESCAPE_TABLE).encode()


def test_without_packages_the_page_names_what_installs_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(added, "registered", lambda *_: [])
    monkeypatch.setattr("arboleda.host.pieces.registered", lambda *_: [])
    shown = html(loaded())
    gone = (
        "part-make",
        "part-draw",
        "part-teach",
        "to-teach",
        "to-report",
        "rows-oee",
        "versions-box",
        "fault-drawer",
    )
    assert [each for each in gone if each in shown] == []
    for package in ("fleet", "make", "proofs"):
        assert f"pip install 'arboleda[{package}]'" in shown.replace("&#x27;", "'")
