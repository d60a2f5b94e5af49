"""docs/how-to/plant-file.md names every key, and its example is a plant."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader, shapes
from arboleda.plant_file.robot_models import Shape

PAGE = (Path(__file__).parents[3] / "docs" / "how-to" / "plant-file.md").read_text("utf-8")
EXAMPLE = PAGE.split("```yaml\n")[1].split("```")[0]
ELSEWHERE = ("RobotShape", "ModelShape", "OffsetShape")  # the latter two are on the page of own arms
SHAPES = [each for name, each in vars(shapes).items() if name.endswith("Shape") and name not in ELSEWHERE]


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.__name__)
def test_every_key_is_on_the_page(shape: type[Shape]) -> None:
    keys = [field.alias or name for name, field in shape.model_fields.items()]
    assert [key for key in keys if not re.search(rf"\b{key}\b", PAGE)] == []


def test_every_default_of_a_time_is_on_the_page() -> None:
    for key, field in shapes.TimingShape.model_fields.items():
        assert re.search(rf"\| `{key}` \| {field.default:g} \|", PAGE)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.__name__)
def test_every_number_that_is_a_default_is_in_the_table_of_its_key(shape: type[Shape]) -> None:
    for name, field in shape.model_fields.items():
        told = _defaults().get(field.alias or name)
        if told and type(field.default) in (int, float) and field.default != 0:  # some keys are told in prose
            assert any(re.search(rf"\b{field.default:g}\b", each) for each in told), name


def test_the_tables_have_the_defaults_of_plant_cell_timing_and_record() -> None:
    assert {"history_days", "queue_limit", "stop_timeout_s", "megabytes", "timeout_s"} <= {*_defaults()}


def _defaults() -> dict[str, list[str]]:
    """What the tables say in their columns of defaults, by key."""
    found: dict[str, list[str]] = {}
    for table in re.findall(r"(?:^\|.*\n)+", PAGE, re.MULTILINE):
        header, _, *rows = ([each.strip() for each in line.split("|")] for line in table.splitlines())
        if "default" in header:
            for row in rows:
                found.setdefault(row[1].strip("`"), []).append(row[header.index("default")])
    return found


def test_the_smallest_plant_of_the_page_is_one(tmp_path: Path) -> None:
    file = tmp_path / "my_plant.yaml"
    file.write_text(EXAMPLE, "utf-8")
    plant = loader.load(file)
    assert [pose.name for pose in plant.cell("sis_a").stations] == ["station 0"]


def test_the_mistakes_of_the_page_are_what_check_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = EXAMPLE.replace("evidence: ids}", "evidence: id}", 1).replace("[45, 10]", "[45, 150]")
    Path("my_plant.yaml").write_text(text, "utf-8")
    with pytest.raises(ConfigError) as refusal:
        loader.load(Path("my_plant.yaml"))
    assert "\n".join(refusal.value.problems) in PAGE
