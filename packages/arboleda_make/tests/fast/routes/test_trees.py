"""The routes of trees: palette, marks and edits of a text, of which the server keeps nothing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import httpx
import pytest
from tests.in_process import Caller
from tests.web_plant import Plant

from arboleda.plant_file import loader
from arboleda.web import limits
from arboleda.web.access.auth import Role
from arboleda_make.editing import desk
from arboleda_make.editing.errors import EditError

OWN_TREE = Path(__file__).parents[5] / "examples/own_tree/plant.yaml"


class TreePlant(Plant):
    """Plant with a tree, which answers about trees as every plant does."""

    model = loader.load(OWN_TREE)


@pytest.fixture
def plant() -> Plant:
    return TreePlant()


@pytest.fixture
def text() -> str:
    return OWN_TREE.with_name("tend.xml").read_text()


def post(web: Caller, path: str, **body: Any) -> httpx.Response:
    return web.post(f"/api/trees/{path}", json=body)


def test_the_trees_of_the_plant_are_given_as_they_were_read(web: Caller, text: str) -> None:
    (found,) = web.get("/api/trees").json()
    assert found == {
        "recipe": "tend",
        "file": "tend.xml",
        "cells": ["cell"],
        "text": text,
    }


@pytest.mark.parametrize(
    ("language", "about"), [("en", "goes to a target"), ("es", "Va a un destino"), ("../es", "goes to")]
)
def test_the_palette_has_the_devices_with_what_their_values_can_be(
    web: Caller, language: str, about: str
) -> None:
    groups = web.get("/api/trees/palette", params={"cell": "cell", "language": language}).json()
    assert [(each["sort"], each["name"]) for each in groups][:2] == [("device", "loader"), ("device", "jaw")]
    kinds = {kind["name"]: kind for group in groups for kind in group["kinds"]}
    assert about in kinds["loader_visit"]["about"] and kinds["loader_visit"]["most"] == 1
    assert "slot_1" in kinds["loader_visit"]["ports"][0]["words"]
    assert (kinds["jaw_close"]["ports"][1]["lower"], kinds["jaw_close"]["ports"][1]["upper"]) == (0, 60)
    assert all(kind["about"] for group in groups if not group["name"] for kind in group["kinds"])
    assert "ManualSelector" not in kinds  # is not run


def test_an_edit_gives_the_text_and_marks_on_its_nodes(web: Caller, text: str) -> None:
    shown = post(web, "check", cell="cell", text=text).json()
    assert [tree["name"] for tree in shown["trees"]] == ["Tend", "Carry", "TakeOut"] and shown["marks"] == []
    node = {"kind": "jaw_close", "attributes": {"width_mm": "900"}}
    edit = {"do": "insert", "tree": "Carry", "parent": "root", "index": 0, "node": node}
    after = post(web, "edit", cell="cell", text=text, operation=edit).json()
    assert after["text"] == text.replace(
        '"Carry">\n    <Sequence>\n', '"Carry">\n    <Sequence>\n      <jaw_close width_mm="900"/>\n'
    )
    marks = {(mark["path"], mark["attribute"]): mark["sentence"] for mark in after["marks"]}
    assert marks[("0", "width_mm")] == "width_mm of jaw_close must be from 0 to 85, is '900'"
    assert "needs force_n" in marks[("0", None)]


@pytest.mark.parametrize(
    ("operation", "words"),
    [
        ({"do": "remove", "tree": "Tend", "path": "99"}, "has no node"),
        ({"do": "remove", "tree": "Tend"}, "operation.remove.path"),
        ({"do": "run", "code": "1"}, "does not match any of the expected tags"),
        ({"do": "remove", "tree": "Tend", "path": "0", "more": 1}, "more"),
        ({"do": "insert", "tree": "Tend", "parent": "root", "index": "0", "node": {"kind": "A"}}, "index"),
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_told(web: Caller, text: str, operation: Any, words: str) -> None:
    answer = post(web, "edit", cell="cell", text=text, operation=operation)
    assert answer.status_code == 422 and words in answer.json()["sentence"], answer.text


def test_text_that_is_no_tree_and_a_cell_that_is_not_there_are_told(web: Caller, text: str) -> None:
    assert "line 1, column 1" in post(web, "check", cell="cell", text="tend").json()["sentence"]
    assert "there are cell" in post(web, "check", cell="sell", text=text).json()["sentence"]
    answer = web.get("/api/trees/palette", params={"cell": "sell"})
    assert answer.status_code == 422 and "there are cell" in answer.json()["sentence"]


def test_a_recipe_in_python_is_given_as_a_tree(web: Caller, monkeypatch: pytest.MonkeyPatch) -> None:
    def copied(_model: object, cell: str, recipe: str, name: str) -> str:
        if name == recipe:
            raise EditError(f"there is a recipe '{name}' already")
        return f"{name} does in {cell} what {recipe} does"

    monkeypatch.setattr(desk, "copied", copied)
    copy = {"cell": "hall", "recipe": "fetch"}
    made = post(web, "copy", **copy, name="by_tree").json()
    assert made == {"text": "by_tree does in hall what fetch does"}
    refused = post(web, "copy", **copy, name="fetch")
    assert refused.status_code == 422 and "already" in refused.json()["sentence"]
    assert post(web, "copy", **copy, name="a/b").status_code == 422


def test_no_file_of_this_machine_is_looked_into(web: Caller, tmp_path: Path) -> None:
    secret = tmp_path / "secret.xml"
    secret.write_text('<root><BehaviorTree ID="Secret"><AlwaysSuccess/></BehaviorTree></root>')
    body = f'<include path="{secret}"/><BehaviorTree ID="M"><SubTree ID="Secret"/></BehaviorTree>'
    shown = post(web, "check", cell="cell", text=f'<root BTCPP_format="4">{body}</root>').json()
    assert [tree["name"] for tree in shown["trees"]] == ["M"]
    (mark,) = [each for each in shown["marks"] if "was not looked into" in each["sentence"]]
    assert not mark["mistake"]


def test_a_viewer_looks_and_only_an_operator_draws(open_to_all: Any, text: str) -> None:
    viewer = open_to_all.client(token=Role.VIEWER)
    assert viewer.get("/api/trees/palette", params={"cell": "cell"}).status_code == 200
    refused = post(viewer, "check", cell="cell", text=text)
    assert refused.status_code == 403 and "needs the operator's token" in refused.json()["sentence"]
    assert post(open_to_all.client(token=Role.OPERATOR), "check", cell="cell", text=text).status_code == 200


def test_a_file_may_be_large_and_has_a_limit(web: Caller, text: str) -> None:
    large = f"{text}<!-- {'x' * limits.API_BODY_BYTES} -->"
    assert post(web, "check", cell="cell", text=large).status_code == 200
    assert post(web, "check", cell="cell", text=" " * 512 * 1024).status_code == 413
