"""Methods that this package adds to the client of a plant, against its routes and a plant in this process."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
from tests.client_methods import differences, left, methods_of, routes_of_package
from tests.guarded_plant import guarded
from tests.in_process import ORIGIN, Machine
from tests.in_process import machine as machine
from tests.web_plant import Plant
from tests.web_plant import plant as plant

from arboleda.client import AsyncPlant, WrongRequest
from arboleda.client import Plant as Client
from arboleda_make.client import AsyncDraft, AsyncMake, Draft, Make
from arboleda_make.client.draft import Edit
from arboleda_make.drafts.api import DraftApi

ROUTES = routes_of_package("make")
METHODS = methods_of(Make, Draft)
# A button that is held has to be said again every 0.1 s, and an editor asks for what it draws and takes away.
LEFT_TO_THE_PAGE = {
    *(path for path in ROUTES if "/api/teach/" in path),
    "POST /api/make/drawn/check",
    "POST /api/make/drawn/edit",
    "POST /api/make/objections",
    "POST /api/make/remove",
    "POST /api/make/runs/reach",
}


@pytest.fixture
def client(machine: Machine, plant: Plant) -> Client:
    machine.listen(8080, guarded(plant).app)
    return Client(ORIGIN, patience_s=0.0)


def test_every_route_has_a_method_that_takes_and_returns_the_same() -> None:
    assert left(ROUTES, METHODS) == LEFT_TO_THE_PAGE
    assert differences(ROUTES, METHODS, by_editor=Edit) == []


def test_a_plant_of_either_kind_has_them() -> None:
    plant, awaited = Client(ORIGIN), AsyncPlant(ORIGIN)
    assert isinstance(plant.draft(), Draft) and isinstance(awaited.draft(), AsyncDraft)
    assert isinstance(Make(plant).draft(), Draft) and isinstance(AsyncMake(awaited).draft(), AsyncDraft)
    assert {name for name in dir(Make) if not name.startswith("_")} <= {*dir(plant)}
    asyncio.run(awaited.close())


def test_the_draft_is_edited_under_one_id(client: Client, plant: Any) -> None:
    steps: list[tuple[Any, ...]] = []
    state = {"file": "plant.yaml", "editor": None, "changes": [], "waiting": [], "undo": 0, "redo": 0}
    state |= {"values": {}, "trees": [], "restart": [], "is_ours": True, "set_aside": [], "digest": "4f"}
    choice = {"text": "zones.nest.free_while: {oven: {door: open}}", "value": {"oven": {"door": "open"}}}
    offer = {"sentence": "nobody knows", "place": ["zones", "nest", "free_while"], "choices": [choice]}
    applied = {"problems": [], "warnings": [], "version": 3, "cells": {"lab": "now"}, "cancelled": []}
    applied |= {"offers": [offer]}

    class Desk:
        def __getattr__(self, name: str) -> Any:
            return lambda *told: steps.append((name, *told)) or applied | state

    plant.offered[DraftApi] = Desk()
    draft = client.draft("ana-12345")
    assert draft.state().file == "plant.yaml" and draft.take("Ana").is_ours
    draft.set(["cells", "lab", "targets", 0], [1, {"b": None}])
    assert draft.apply("why").cells == {"lab": "now"}
    found = draft.check()
    (offered,) = found.offers
    draft.set(offered.place, offered.choices[0].value, of=found.digest)
    assert steps == [
        ("state",),
        ("take", "ana-12345", "Ana"),
        ("set", "ana-12345", ("cells", "lab", "targets", 0), [1, {"b": None}], None),
        ("apply", "ana-12345", "why"),
        ("check",),
        ("set", "ana-12345", ("zones", "nest", "free_while"), {"oven": {"door": "open"}}, "4f"),
    ]
    with pytest.raises(WrongRequest, match="place"):
        client.draft().remove([])
