"""`extensions` of a plant file: settings of packages, checked at their lines, and packages left out."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from tests.added_package import register
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.host.pieces import Pieces
from arboleda.model.errors import ArboledaError, ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.model.revision import obstacle
from arboleda.plant_file import loader
from arboleda.plant_file.extensions import notes, settings_of
from arboleda.runtime.build import Options, build
from arboleda.testing import shipped

from ...plants import rows

PLANT = (Path(__file__).parents[3] / "examples/plants/by_hand.yaml").read_text("utf-8")
CODE = """
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class OrderSettings:
    cell: str
    most: int = 5

    def __post_init__(self):
        if self.most < 1:
            raise ValueError("most must be at least 1")


class Orders:
    settings_type = OrderSettings


class Plain:
    settings_type = None
"""
LINE = len(PLANT.splitlines()) + 1
Load = Callable[[str], PlantModel]


@pytest.fixture(autouse=True)
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Two packages: `orders` with settings, of which `cell` is needed, and `plain` without any."""
    site = tmp_path / "site"
    site.mkdir()
    (site / "shop.py").write_text(CODE, "utf-8")
    (site / "broken.py").write_text("raise RuntimeError('no luck')", "utf-8")
    parts = ["orders.desk = shop:Orders", "plain = shop:Plain", "broken = broken"]
    routes = ["views = shop:Plain"]
    register(site, "shop", {"arboleda.api": ["1 = shop"], "arboleda.parts": parts, "arboleda.routes": routes})
    register(site, "old", {"arboleda.api": ["0 = old"], "arboleda.parts": ["old = old:Parts"]})
    monkeypatch.syspath_prepend(site)
    yield
    for each in ("broken", "shop", "sums"):
        sys.modules.pop(each, None)


@pytest.fixture
def load(tmp_path: Path) -> Load:
    """Reads a plant with this below it."""

    def read(extensions: str) -> PlantModel:
        file = tmp_path / "plant.yaml"
        file.write_text(f"{PLANT}extensions: {extensions}\n", "utf-8")
        return loader.load(file)

    return read


def test_a_package_gets_its_settings_as_the_dataclass_that_it_declares(load: Load) -> None:
    (settings,) = load("{orders: {cell: sis_a}, plain: {}}").extensions.items()
    name, given = settings
    assert (name, type(given).__name__, vars(given)) == (
        "orders",
        "OrderSettings",
        {"cell": "sis_a", "most": 5},
    )


@pytest.mark.parametrize(
    ("extensions", "column", "told"),
    rows(__file__, "extensions"),
)
def test_what_is_wrong_is_told_at_its_place(load: Load, extensions: str, column: int, told: str) -> None:
    with pytest.raises(ConfigError) as refused:
        load(extensions)
    (problem,) = refused.value.problems
    assert f"plant.yaml:{LINE}:{column}: " in problem and told in problem


@pytest.mark.parametrize("off", ["off", "false"])
def test_a_package_that_is_off_is_not_imported_and_has_no_piece_in_this_plant(load: Load, off: str) -> None:
    plant = load(f"{{orders: {off}, broken: {off}}}")
    assert plant.extensions == {} and plant.extensions_off == {"orders", "broken"}
    names = [each.name for each in Pieces(off=plant.extensions_off).registered("arboleda.parts")]
    assert "plain" in names and not {"orders.desk", "broken"} & {*names}
    assert "shop" not in sys.modules


@pytest.mark.parametrize(("extensions", "told"), [("{plain: {}}", ["no luck"]), ("{broken: off}", [])])
def test_a_start_makes_nothing_of_a_package_that_is_off(
    load: Load, tmp_path: Path, extensions: str, told: list[str]
) -> None:
    plant = replace(shipped("sis_a"), extensions_off=load(extensions).extensions_off)
    app = build(plant, {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.stop()
    assert [each.rpartition(": ")[-1] for each in app.notes if "RuntimeError" in each] == told


def test_a_package_that_is_not_named_has_its_defaults_or_is_told_what_to_write(load: Load) -> None:
    plant = load("{plain: {}}")
    from shop import OrderSettings  # type: ignore[import-not-found]

    told = r"the plant file gives orders no cell; write extensions: \{orders: \{cell: \.\.\.\}\}"
    with pytest.raises(ArboledaError, match=told):
        settings_of(plant, "orders", OrderSettings)
    assert settings_of(load("{orders: {cell: lab, most: 2}}"), "orders", OrderSettings).most == 2


def test_what_a_plant_goes_on_without_is_noted(load: Load) -> None:
    why = "the plant file gives orders no cell; write extensions: {orders: {cell: ...}}"
    assert notes(load("{broken: off}")) == [f"Arboleda goes on without the parts of shop 1: {why}"]
    assert (
        notes(load("{orders: {cell: lab}, broken: off}")) == notes(load("{orders: off, broken: off}")) == []
    )


def test_check_says_what_a_plant_goes_on_without(load: Load, tmp_path: Path) -> None:
    load("{broken: off}")
    said = CliRunner().invoke(cli, ["check", str(tmp_path / "plant.yaml")]).output
    assert (
        said.count("Arboleda goes on without the parts of shop 1: the plant file gives orders no cell") == 1
    )


def test_what_is_wrong_on_a_page_is_noted(load: Load, tmp_path: Path) -> None:
    page = "from arboleda.extension import Page, Value\nPAGE = Page(card=[Value('count'), 'sum'])\n"
    installs = "import os\nos.utime(os.path.dirname(__file__), ns=(1, 1))\n"  # all packages are read anew
    (tmp_path / "site/sums.py").write_text(page, "utf-8")
    (tmp_path / "site/broken.py").write_text(installs, "utf-8")
    groups = {"arboleda.api": ["1 = sums"], "arboleda.page": ["sums = sums:PAGE"]}
    register(tmp_path / "site", "sums", groups)
    assert notes(load("{orders: off}")) == [
        "Arboleda goes on without the declaration 'sum' of sums 1: one of card of the page is 'sum'; "
        "it takes Sequence[Item]"
    ]
    assert notes(load("{orders: off, broken: off, sums: off}")) == []


@pytest.mark.parametrize("settings", ["off", "{cell: lab}"])
def test_a_plant_goes_on_without_a_package_that_is_left_out_whole(load: Load, settings: str) -> None:
    assert load(f"{{old: {settings}}}").extensions == {}


def test_settings_of_another_class_are_refused_in_words(load: Load) -> None:
    with pytest.raises(ArboledaError, match="gives orders other settings than Plant"):
        settings_of(load("{orders: {cell: lab}}"), "orders", PlantModel)


@pytest.mark.parametrize("other", ["{orders: {cell: lab, most: 3}}", "{orders: off}"])
def test_a_running_plant_takes_no_other_settings(load: Load, other: str) -> None:
    before = load("{orders: {cell: lab}}")
    assert obstacle(before, before) is None
    assert str(obstacle(before, load(other))) == "the settings of its packages are others"
