"""All that this package is asked for over HTTP, and who may."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.client_methods import routes_of_package
from tests.in_process import Caller
from tests.unit.web.test_who_may import assert_for, of_package

DRAFT_STEPS = (
    "take",
    "set",
    "remove",
    "undo",
    "redo",
    "discard",
    "check",
    "keep",
    "apply",
    "set_trees",
    "remove_trees",
    "own",
)
MAKE_PATHS = (
    "cells",
    "objections",
    "recipe",
    "carry",
    "copy",
    "remove",
    "palette",
    "drawn/check",
    "drawn/edit",
    "drivers",
    "device",
    "runs/reach",
    "runs/{what}",
    "runs/{what}/end",
    "runs/{what}/result",
)
ASSISTANTS = {  # and operators; none of them moves a robot by itself
    "GET /api/proposals",
    "GET /api/proposals/base",
    "GET /api/proposals/{hash}",
    "POST /api/assistants/tasks",
    "POST /api/proposals",
    "POST /api/proposals/{hash}/prove",
    "POST /api/proposals/{hash}/simulate",
    "POST /api/proposals/{hash}/withdraw",
    "POST /api/trees/check",
    "POST /api/trees/copy",
    "POST /api/trees/edit",
}
READ_BY_OPERATORS = {
    "GET /api/draft",
    "GET /api/draft/trees",
    "GET /api/make/cells",
    "GET /api/make/drivers",
    "GET /api/make/palette",
    "GET /api/make/recipe",
    "GET /api/make/runs/{what}",
    "GET /api/make/runs/{what}/result",
    "GET /api/teach/{cell}",
    "GET /proof",
}


def test_the_description_has_every_route() -> None:
    assert {each.split()[1] for each in routes_of_package("make")} == {
        *(f"/api/trees{path}" for path in ("", "/palette", "/check", "/copy", "/edit")),
        "/api/draft",
        "/api/draft/trees",
        *(f"/api/draft/{step}" for step in DRAFT_STEPS),
        "/api/proposals",
        "/api/proposals/base",
        "/api/proposals/{hash}",
        *(f"/api/proposals/{{hash}}/{act}" for act in ("approve", "prove", "reject", "simulate", "withdraw")),
        "/api/assistants/tasks",
        "/api/versions",
        "/api/versions/{number}/put",
        "/api/versions/restart",
        *(f"/api/teach/{{cell}}{path}" for path in ("", "/jog", "/here")),
        *(f"/api/make/{path}" for path in MAKE_PATHS),
    }


def test_each_route_is_asked_by_whom_it_is_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = of_package("arboleda_make", tmp_path, monkeypatch)
    assert_for(made, assistants=ASSISTANTS, read_by_operators=READ_BY_OPERATORS)


def test_a_path_that_is_not_there_is_no_missing_package(web: Caller) -> None:
    assert web.get("/api/draft/nothing").status_code == 404


def test_a_missing_part_of_an_address_is_named(web: Caller) -> None:
    answer = web.get("/api/draft/trees")
    assert answer.status_code == 422
    assert answer.json() == {"sentence": "'file' is missing; /api/docs says what to give."}
