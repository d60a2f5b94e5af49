"""The pages on devices and recipes of one's own: what they show works, and `check` says what they say."""

from __future__ import annotations

import re
import shutil
from dataclasses import fields
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.kinds.declared import Device
from arboleda.kinds.shipped import SHIPPED
from arboleda.model.errors import ConfigError
from arboleda.model.orders import MOST
from arboleda.plant_file import loader
from arboleda.recipes.authoring import Kit

ROOT = Path(__file__).parents[3]
DEVICE = (ROOT / "docs/how-to/add-a-device.md").read_text("utf-8")
RECIPE = (ROOT / "docs/how-to/write-a-recipe.md").read_text("utf-8")
KINDS, CELLS, SHOP = (part.partition("```")[0] for part in DEVICE.split("```yaml\n")[1:])
SAW = DEVICE.split("```python\n")[1].partition("```")[0]
FUNCTION = RECIPE.split("```python\n")[1].partition("```")[0]
LAB = ROOT / "examples/lab_bench"


def said(page: str, file: str) -> list[str]:
    """The problems that a page shows."""
    lines = [line for block in page.split("```")[1::2] for line in block.splitlines()]
    return [line for line in lines if re.match(rf"\S*{file}:\d", line)]


def problems(file: Path) -> list[str]:
    with pytest.raises(ConfigError) as refusal:
        loader.load(file)
    return list(refusal.value.problems)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The example, in the folder in which the pages' commands are typed."""
    shutil.copytree(LAB, tmp_path / "examples/lab_bench")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_check_says_of_the_example_what_the_page_says(folder: Path) -> None:
    outcome = CliRunner().invoke(cli, ["check", "examples/lab_bench/plant.yaml"])
    assert outcome.exit_code == 0 and outcome.output in DEVICE


def test_the_plant_of_the_page_is_one_and_its_mistakes_are_told(folder: Path) -> None:
    text = f"name: my_lab\n{KINDS}{CELLS}"
    recipes = FUNCTION.replace('devices("pump", "scale")', 'devices("heater", "scale")')
    recipes = re.sub(r"pump\.dispense\(ml=ml\)|scale\.tare\(\)", "pump.close()", recipes)
    Path("recipes.py").write_text(recipes, "utf-8")
    Path("my_lab.yaml").write_text(text, "utf-8")
    assert [cell.name for cell in loader.load(Path("my_lab.yaml")).cells] == ["bench"]
    for old, new in (
        ("clamped: bool", "clamped: boll"),
        ("sets: {lid: closed}", "sets: {lit: closed}"),
        ("{lid: closed, clamped", "{lid: shut, clamped"),
    ):
        text = text.replace(old, new, 1)
    Path("my_lab.yaml").write_text(text, "utf-8")
    assert problems(Path("my_lab.yaml")) == said(DEVICE, "my_lab.yaml")


def test_the_kind_of_the_page_is_one_and_its_mistakes_are_told(folder: Path) -> None:
    Path("kinds").mkdir()
    kind, plant = Path("kinds/saw.py"), Path("my_shop.yaml")
    kind.write_text(SAW, "utf-8")
    Path("recipes.py").write_text(
        "from arboleda.recipes import recipe\n\n"
        '@recipe("cut")\ndef cut(cell):\n    return cell.device("fast").cut(mm=50, blade="bone")\n',
        "utf-8",
    )
    plant.write_text(SHOP, "utf-8")
    fast = loader.load(plant).robots["fast"]
    assert isinstance(fast, Device) and fast.kind.verbs["cut"].takes_s == 3.0
    for old, new in (("mm_s: 10}", "mms: 10}"), ("mm_s: 100", "mm_s: -1")):
        assert old in SHOP
        plant.write_text(plant.read_text("utf-8").replace(old, new, 1), "utf-8")
    found = problems(plant)
    plant.write_text(SHOP, "utf-8")
    kind.write_text(SAW.replace("mm / settings.mm_s", "mm / 0 / settings.mm_s"), "utf-8")
    found += [each for each in problems(plant) if "wood" in each]
    assert found == said(DEVICE, "my_shop.yaml") + said(DEVICE, "saw.py")


def test_the_page_names_every_kind_that_comes_with_it_and_its_settings() -> None:
    for each in SHIPPED:
        (row,) = [line for line in DEVICE.splitlines() if line.startswith(f"| `{each.name}` |")]
        made = each.of(None if each.settings is None else each.settings())
        for verb in made.verbs.values():
            assert f"`{verb.name}({', '.join(name for name, _ in verb.parameters)})`" in row
        for setting in fields(each.settings) if each.settings else ():
            default = setting.default
            listed = f"[{', '.join(default)}]" if isinstance(default, tuple) else f"{default:g}"
            assert f"`{setting.name}: {listed}`" in row


def test_the_recipe_of_the_page_is_that_of_the_example_and_its_mistakes_are_told(folder: Path) -> None:
    assert FUNCTION.partition("\n\n\n")[2].strip() in (LAB / "recipes.py").read_text("utf-8")
    file, found = Path("examples/lab_bench/recipes.py"), []
    good = file.read_text("utf-8")
    short = ', "short": cell.fail("the scale says that too little was dispensed")'
    for old, new in (('"pump", "scale"', '"pmp", "scale"'), ("ml=ml), seen", "ml=7), seen"), (short, "")):
        assert old in good
        file.write_text(good.replace(old, new, 1), "utf-8")
        found += problems(Path("examples/lab_bench/plant.yaml"))
    assert found == said(RECIPE, "recipes.py")


def test_the_page_names_every_step_and_how_many_tasks_are_tried() -> None:
    steps = [name for name in vars(Kit) if not name.startswith("_") and name not in ("device", "devices")]
    assert [name for name in steps if f"cell.{name}(" not in RECIPE] == []
    assert f"build {MOST} of them" in RECIPE
