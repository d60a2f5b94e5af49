"""examples/extension: a package from outside adds a command, a part, a route, a card and a table."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from importlib import import_module
from inspect import isfunction
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests.added_package import register
from tests.in_process import Caller, without_threads
from typer.testing import CliRunner

from arboleda.cli.commands import commands
from arboleda.cli.main import cli
from arboleda.dashboard import page
from arboleda.dashboard.added import AddedParts
from arboleda.dashboard.wording import words
from arboleda.extension import Part
from arboleda.host.pieces import Pieces
from arboleda.model.messages import Verb
from arboleda.runtime.build import App, Options, build
from arboleda.runtime.extensions.telling import Telling
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.testing import shipped
from arboleda.testing.plugin import MakePlantWith
from arboleda.views import view
from arboleda.web.api import make_app
from arboleda.web.languages import contents, texts

ROOT = Path(__file__).parents[3]
EXAMPLE = ROOT / "examples/extension"
FILES = [each for each in sorted(EXAMPLE.rglob("*.*")) if each.suffix in (".py", ".js", ".yaml", ".toml")]
MOST_LINES = 130
CACHES = (commands, contents, texts, words)


def entry_points() -> dict[str, list[str]]:
    """What its setup.py registers."""
    keywords = ast.walk(ast.parse((EXAMPLE / "setup.py").read_text("utf-8")))
    (found,) = (each for each in keywords if isinstance(each, ast.keyword) and each.arg == "entry_points")
    registered: dict[str, list[str]] = ast.literal_eval(found.value)
    return registered


@pytest.fixture(autouse=True)
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The example is installed: from its folder, as `pip install -e` does it."""
    register(tmp_path / "site", "arboleda_ended", entry_points())
    for folder in (tmp_path / "site", EXAMPLE):
        monkeypatch.syspath_prepend(folder)
    without_threads(monkeypatch)
    for each in CACHES:
        each.cache_clear()
    yield
    for each in CACHES:
        each.cache_clear()


@pytest.fixture
def app(tmp_path: Path) -> Iterator[App]:
    """A plant that nobody has started: its steps are taken by hand."""
    made = built(tmp_path)
    yield made
    made.stop()


def built(tmp_path: Path) -> App:
    app = build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    for each in app.parts:
        if isinstance(each, Part):
            each.start()
    return app


def end_a_task(app: App, id: str = "lot") -> None:
    """Have a task end that nothing has begun; then its part is told."""
    app.plant.submit(f"sis_a 0B 7 #{id}")
    app.plant.loop.turn()
    app.plant.operate(Verb.CANCEL, id)
    app.plant.loop.turn()
    (telling,) = (each for each in app.parts if isinstance(each, Telling))
    while telling.turn():
        pass


def asked(app: App) -> Any:
    """What the route answers."""
    return Caller(make_app(app.offers.need(LocalPlant))).get("/api/ended").json()


def left_out(app: App) -> list[str]:
    return [note for note in app.notes if "goes on without" in note]


def test_it_is_short() -> None:
    assert sum(len(each.read_text("utf-8").splitlines()) for each in FILES) <= MOST_LINES


def test_its_page_shows_all_of_its_code() -> None:
    text = (ROOT / "docs/how-to/write-an-extension.md").read_text("utf-8")
    assert [each for each in FILES if f"\n{each.read_text('utf-8')}```\n" not in text] == []


def test_it_imports_one_module_of_arboleda() -> None:
    trees = [ast.parse(file.read_text("utf-8")) for file in FILES if file.suffix == ".py"]
    nodes = [each for tree in trees for each in ast.walk(tree) if isinstance(each, ast.ImportFrom)]
    imported = {str(each.module) for each in nodes if not each.level}
    assert imported == {"arboleda.extension", "arboleda_ended.part", "setuptools"}


def test_its_test_passes(plant_with: MakePlantWith) -> None:
    tests = [each for each in vars(import_module("test_ended")).values() if isfunction(each)]
    assert len(tests) == 1
    tests[0](plant_with)


def test_its_part_counts_and_its_route_tells(app: App) -> None:
    assert asked(app) == {"sis_a": 0} and left_out(app) == []
    end_a_task(app)
    assert asked(app) == {"sis_a": 1}
    assert "/api/ended" in make_app(app.offers.need(LocalPlant)).openapi()["paths"]


def test_its_table_is_there_after_a_restart(app: App, tmp_path: Path) -> None:
    end_a_task(app)
    app.stop()
    again = built(tmp_path)
    try:
        assert asked(again) == {"sis_a": 1}
        end_a_task(again, "next")
        assert asked(again) == {"sis_a": 2}
    finally:
        again.stop()


@pytest.mark.parametrize(
    ("language", "said"), [("en", "tasks that ended here"), ("es", "tareas que terminaron aquí")]
)
def test_its_card_is_on_the_page(app: App, language: str, said: str) -> None:
    end_a_task(app)
    plant: Any = app.offers.need(LocalPlant)
    layout, told = view.layout(shipped("sis_a")), list[Any]()
    parts = AddedParts(Pieces(tell=told.append))
    drawn = page.drawn(parts, plant, layout, words(language), None)
    snapshot = {"cells": [{"name": "sis_a", "teaching": None, "state": "idle", "not_ready": None}]}
    now: Any = SimpleNamespace(snapshot=snapshot, links=app.links(), words=words(language))
    assert said in drawn and 'data-live="ended:counts:sis_a"' in drawn
    assert parts.face(now)["text/ended:counts:sis_a"] == ["1", ""] and told == []


@pytest.mark.parametrize(
    ("language", "said", "brief"),
    [
        ("en", "sis_a: 1 tasks that ended here", "Show how many tasks ended in each cell."),
        ("es", "sis_a: 1 tareas que terminaron aquí", "Muestra cuántas tareas terminaron en cada celda."),
    ],
)
def test_its_command_asks_the_plant(
    app: App, monkeypatch: pytest.MonkeyPatch, language: str, said: str, brief: str
) -> None:
    end_a_task(app)
    monkeypatch.setenv("ARBOLEDA_LANG", language)
    monkeypatch.setattr(
        "arboleda_ended.command.client", lambda *_: SimpleNamespace(get=lambda path: asked(app))
    )
    assert CliRunner().invoke(cli, ["ended"]).output == f"{said}\n"
    assert brief in CliRunner().invoke(cli, ["help", "history"]).output


def test_where_its_part_breaks_the_plant_goes_on(app: App, monkeypatch: pytest.MonkeyPatch) -> None:
    """As where the disk does not take its table."""

    def full(*_: object) -> None:
        raise OSError("the disk is full")

    monkeypatch.setattr("arboleda.store.package_table.PackageTable.put", full)
    for id in ("lot", "next"):
        end_a_task(app, id)
    assert left_out(app) == [
        "Arboleda goes on without the listener EndedTasks.count of arboleda_ended 1: "
        "OSError: the disk is full"
    ]
