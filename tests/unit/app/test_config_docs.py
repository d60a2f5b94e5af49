"""docs/how-to/plant-file.md names every key, and its example is a plant."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from arboleda.app import config
from arboleda.app.plant_file import shapes
from arboleda.model.errors import ConfigError

PAGE = (Path(__file__).parents[3] / "docs" / "how-to" / "plant-file.md").read_text("utf-8")
EXAMPLE = PAGE.split("```yaml\n")[1].split("```")[0]
ELSEWHERE = ("RobotShape", "ModelShape", "OffsetShape")  # the latter two are on the page of own arms
SHAPES = [each for name, each in vars(shapes).items() if name.endswith("Shape") and name not in ELSEWHERE]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.__name__)
def test_every_key_is_on_the_page(shape: type[shapes.Shape]) -> None:
    keys = [field.alias or name for name, field in shape.model_fields.items()]
    assert [key for key in keys if not re.search(rf"\b{key}\b", PAGE)] == []


def test_every_default_of_a_time_is_on_the_page() -> None:
    for key, field in shapes.TimingShape.model_fields.items():
        assert re.search(rf"\| `{key}` \| s? ?\| {field.default:g} \|", PAGE)


def test_the_smallest_plant_of_the_page_is_one(tmp_path: Path) -> None:
    file = tmp_path / "my_plant.yaml"
    file.write_text(EXAMPLE, "utf-8")
    plant = config.load(file)
    assert [pose.name for pose in plant.cell("sis_a").stations] == ["station 0"]


def test_the_mistakes_of_the_page_are_what_check_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = EXAMPLE.replace("evidence: ids}", "evidence: id}", 1).replace("[45, 10]", "[45, 150]")
    Path("my_plant.yaml").write_text(text, "utf-8")
    with pytest.raises(ConfigError) as refusal:
        config.load(Path("my_plant.yaml"))
    assert "\n".join(refusal.value.problems) in PAGE
