"""`arboleda extension new`: the folder that it writes is a package that counts the tasks of a plant."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from configparser import ConfigParser
from dataclasses import replace
from importlib import import_module
from inspect import isfunction
from pathlib import Path
from typing import Any

import pytest
from tests.added_package import register
from tests.in_process import Caller, without_threads
from typer.testing import CliRunner, Result

from arboleda.cli.main import cli
from arboleda.model.verbs import Verb
from arboleda.runtime.build import App, Options, build
from arboleda.runtime.extensions.telling import Telling
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.testing import shipped
from arboleda.testing.plugin import MakePlantWith
from arboleda.web.api import make_app

NAME = "my_counts"


def new(folder: Path) -> Result:
    return CliRunner().invoke(cli, ["extension", "new", str(folder)])


def entry_points(pyproject: Path) -> dict[str, list[str]]:
    """The entry points that it registers, each as `setup.py` writes it."""
    read = ConfigParser(delimiters=("=",))
    read.optionxform = str  # type: ignore[assignment]
    read.read(pyproject, "utf-8")
    named = "project.entry-points."
    groups = {each.removeprefix(named).strip('"'): read[each] for each in read.sections() if named in each}
    return {
        group: [f"{key} = {ast.literal_eval(value)}" for key, value in rows.items()]
        for group, rows in groups.items()
    }


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder of a new package, which is installed from there, as `pip install -e` does it."""
    folder = tmp_path / NAME
    assert new(folder).exit_code == 0
    without_threads(monkeypatch)
    register(tmp_path / "site", NAME, entry_points(folder / "pyproject.toml"))
    for each in (tmp_path / "site", folder):
        monkeypatch.syspath_prepend(each)
    yield folder
    for name in (NAME, f"test_{NAME}"):
        sys.modules.pop(name, None)


def counted(tmp_path: Path, **settings: str) -> tuple[App, Any]:
    """What a plant counts after a task was cancelled, by the route."""
    package = import_module(NAME)
    model = replace(shipped("sis_a"), extensions={NAME: package.Settings(**settings)})
    app = build(model, {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.offers.need(package.Counter).start()
    app.plant.submit("sis_a 0B 7 #lot")
    app.plant.loop.turn()
    app.plant.operate(Verb.CANCEL, "lot")
    app.plant.loop.turn()
    (telling,) = (each for each in app.parts if isinstance(each, Telling))
    while telling.turn():
        pass
    app.stop()
    return app, Caller(make_app(app.offers.need(LocalPlant))).get(f"/api/{NAME}").json()


def test_it_says_what_it_wrote_and_what_to_do(tmp_path: Path) -> None:
    folder = tmp_path / NAME
    said = new(folder).output
    assert f"wrote {folder / 'pyproject.toml'}" in said and f"wrote {folder / NAME}.py" in said
    assert f" -e {folder}\n" in said and f"extensions: {{{NAME}: {{counts: failed}}}}" in said
    assert len((folder / f"{NAME}.py").read_text("utf-8").splitlines()) <= 40


def test_what_it_writes_counts_the_tasks_that_its_settings_name(site: Path, tmp_path: Path) -> None:
    app, found = counted(tmp_path, counts="cancelled")
    assert found == {"sis_a": 1} and app.links()[NAME] == {"sis_a": 1}
    assert [note for note in app.notes if "goes on without" in note] == []
    assert counted(tmp_path)[1] == {"sis_a": 1}, (
        "the counts are kept, and a task that was cancelled is not done"
    )


def test_its_test_passes(site: Path, plant_with: MakePlantWith) -> None:
    tests = [each for each in vars(import_module(f"test_{NAME}")).values() if isfunction(each)]
    assert len(tests) == 1
    tests[0](plant_with)


def test_it_is_for_this_api(site: Path) -> None:
    assert f"{NAME} 1 (API 1): parts\n" in CliRunner().invoke(cli, ["extension", "list"]).output


@pytest.mark.parametrize("name", ["queue", "arboleda", "My-Counts", "1st"])
def test_a_name_that_no_package_can_have_is_refused(tmp_path: Path, name: str) -> None:
    ran = new(tmp_path / name)
    assert "cannot be the name of a package" in str(ran.exception) and not (tmp_path / name).exists()


def test_its_comments_are_in_the_language_of_the_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", "es")
    new(tmp_path / NAME)
    text = (tmp_path / NAME / f"{NAME}.py").read_text("utf-8")
    assert text.startswith(f'"""{NAME}: cuenta las tareas') and "Sigue con lo que contaron" in text
