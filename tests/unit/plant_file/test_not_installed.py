"""What a plant file names of a package that is gone: the sentence says which one, and what to type."""

from __future__ import annotations

import json
import os
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.added_package import register
from tests.unit.plant_file.test_own_drivers import DRIVER, PLANT, RECIPES, USE

from arboleda.host.state_folders import default_state
from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader
from arboleda.plant_file.not_installed import FILE
from arboleda.runtime.build import Options, build

OF_PACKAGE = PLANT.replace("uses: [recipes.py, drivers/my_plc.py]", "uses: [recipes.py]").replace(
    USE, "driver: balance"
)
GONE = "{} came from scales 1, which is not installed: pip install scales"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder with a plant file of that content, and states of plants in another one."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.chdir(tmp_path)
    Path("recipes.py").write_text(RECIPES, "utf-8")
    (tmp_path / "site").mkdir()
    Path("site/scales.py").write_text(DRIVER.replace('"plain"', '"balance"'), "utf-8")
    monkeypatch.syspath_prepend(tmp_path / "site")
    yield tmp_path
    sys.modules.pop("scales", None)


def load(plant: str) -> object:
    Path("plant.yaml").write_text(plant, "utf-8")
    return loader.load(Path("plant.yaml"))


def problems(plant: str) -> str:
    with pytest.raises(ConfigError) as refused:
        load(plant)
    return str(refused.value)


@pytest.mark.parametrize("state", [None, Path("elsewhere")])
def test_a_start_remembers_what_a_package_brought_and_the_next_check_names_it(
    folder: Path, state: Path | None
) -> None:
    assert "must be mqtt, ros" in problems(OF_PACKAGE), "nobody has ever brought it"
    register(folder / "site", "scales", {"arboleda.drivers": ["balance = scales:Plain"]})
    plant = loader.load(Path("plant.yaml"))
    build(plant, {"orchestrator"}, Options(page=False, state_dir=state)).stop()
    assert json.loads((default_state("lab") / FILE).read_text()) == {
        "arboleda.drivers": {"balance": "scales 1"}
    }
    shutil.rmtree(folder / "site/scales-1.dist-info")
    os.utime(folder / "site", ns=(1, 1))
    told = GONE.format("balance")
    assert problems(OF_PACKAGE) == f"plant.yaml:10:34: cells.bench.devices.oven.driver: {told}"


@pytest.mark.parametrize(
    ("group", "name", "plant"),
    [
        ("kinds", "scale", PLANT.replace("kind: oven, " + USE, "kind: scale")),
        ("drivers", "balance", PLANT.replace(USE, "driver: {balance: {port: 1}}")),
        ("stores", "redis", f"{PLANT}store: redis://here/db\n"),
        ("parts", "scales", f"{PLANT}extensions: {{scales: {{}}}}\n"),
    ],
)
def test_all_that_a_package_brought_is_named(group: str, name: str, plant: str) -> None:
    Path("drivers").mkdir()
    Path("drivers/my_plc.py").write_text(DRIVER, "utf-8")
    default_state("lab").mkdir(parents=True)
    (default_state("lab") / FILE).write_text(json.dumps({f"arboleda.{group}": {name: "scales 1"}}))
    assert GONE.format(name) in problems(plant)


@pytest.mark.parametrize(
    "content", ["", "[]", "{", '{"arboleda.drivers": 3}', '{"arboleda.drivers": {"balance": 3}}']
)
def test_a_file_that_cannot_be_read_says_nothing(content: str) -> None:
    default_state("lab").mkdir(parents=True)
    (default_state("lab") / FILE).write_text(content)
    assert "must be mqtt, ros" in problems(OF_PACKAGE)


def test_what_a_package_of_another_api_has_is_told_with_that(folder: Path) -> None:
    groups = {"arboleda.drivers": ["balance = scales:Plain"], "arboleda.api": ["9 = scales"]}
    register(folder / "site", "scales", groups)
    assert "goes on without scales 1: it is written for API 9" in problems(OF_PACKAGE)
