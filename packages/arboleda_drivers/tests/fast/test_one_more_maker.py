"""A maker is one folder and one line of entry points: plant file, page and `arboleda virtual` know it."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.plant_file import driver_forms, loader
from arboleda.web.languages import texts
from arboleda_drivers.virtual import command

ADAPTER = """\
from dataclasses import dataclass, field
from arboleda.drivers import driver

@dataclass(frozen=True, kw_only=True)
class Settings:
    "An oven of Acme."
    host: str = field(metadata={"about": "Address of the oven"})

@driver("acme", settings=Settings)
class Acme:
    def __init__(self, settings): ...
    def start(self, devices, hear, clock): ...
    def send(self, command): ...
    def stop(self): ...
"""
COMMAND = """\
def add_to(cli):
    @cli.command("acme", help="Play an oven of Acme.")
    def run(celsius: int = 20) -> None:
        print(f"the oven has {celsius} degrees")
"""
POINTS = "[arboleda.drivers]\nacme = somewhere.acme.adapter:Acme\n"
PLANT = """\
name: lab
uses: [recipes.py]
kinds:
  oven: {verbs: {heat: {effect: process}}}
cells:
  bench: {devices: {oven: {kind: oven, driver: {acme: {host: 10.0.0.7}}}}}
"""
RECIPES = """\
from arboleda.recipes import recipe

@recipe("heat")
def heat(cell):
    return cell.device("oven").heat()
"""


@pytest.fixture
def maker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder of a maker in an installed package, which is forgotten after the test."""
    site, before = tmp_path / "site", set(sys.modules)
    folder, about = site / "somewhere/acme", site / "somewhere-1.0.dist-info"
    (folder / "virtual").mkdir(parents=True)
    about.mkdir()
    for package in (folder.parent, folder, folder / "virtual"):
        (package / "__init__.py").touch()
    (folder / "adapter.py").write_text(ADAPTER, "utf-8")
    (folder / "virtual/command.py").write_text(COMMAND, "utf-8")
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: somewhere\nVersion: 1.0\n", "utf-8")
    (about / "entry_points.txt").write_text(POINTS, "utf-8")
    monkeypatch.syspath_prepend(site)
    monkeypatch.chdir(tmp_path)
    Path("plant.yaml").write_text(PLANT, "utf-8")
    Path("recipes.py").write_text(RECIPES, "utf-8")
    yield folder
    for name in set(sys.modules) - before:
        if name.partition(".")[0] == "somewhere":
            del sys.modules[name]


def virtual(*words: str) -> Any:
    app = typer.Typer(rich_markup_mode=None)
    app.callback()(lambda: None)
    command.add_to(app)
    return CliRunner().invoke(app, ["virtual", *words])


def test_a_plant_file_names_the_driver_and_its_check_finds_nothing_wrong(maker: Path) -> None:
    driver = loader.load(Path("plant.yaml")).robots["oven"].driver
    assert driver is not None and (driver.name, driver.settings.host) == ("acme", "10.0.0.7")
    checked = CliRunner().invoke(cli, ["check", "plant.yaml"])
    assert checked.exit_code == 0, checked.output


def test_a_wrong_key_is_found(maker: Path) -> None:
    Path("plant.yaml").write_text(PLANT.replace("host: 10", "hots: 10"), "utf-8")
    with pytest.raises(ConfigError, match='"hots" is not known; did you mean "host"'):
        loader.load(Path("plant.yaml"))


def test_the_page_has_a_form_for_it(maker: Path) -> None:
    (row,) = (each for each in driver_forms.forms({}, texts("en", "drivers")) if each["name"] == "acme")
    assert (row["about"], row["why_not"]) == ("An oven of Acme.", "")
    assert [(key["name"], key["about"]) for key in row["keys"]] == [("host", "Address of the oven")]


def test_its_virtual_controller_is_listed_and_runs(maker: Path) -> None:
    listed = virtual("--help").output
    assert "acme" in listed and "Play an oven of Acme." in listed and "dobot" in listed
    assert virtual("acme", "--celsius", "80").output == "the oven has 80 degrees\n"


def test_a_driver_without_a_virtual_controller_is_not_listed(maker: Path) -> None:
    (maker / "virtual/command.py").unlink()
    assert "acme" not in virtual("--help").output


def test_a_virtual_controller_that_cannot_be_loaded_is_told_and_the_others_are_there(
    maker: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (maker / "virtual/command.py").write_text("import no_such_library\n", "utf-8")
    assert "dobot" in virtual("--help").output
    told = capsys.readouterr().err
    assert "somewhere.acme.virtual.command cannot be loaded: " in told and "no_such_library" in told
