"""`arboleda check` warns of what could not stand where a plant file puts it."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.plant_check import layout_check
from arboleda.plant_check.layout_mends import moved_grid
from arboleda.plant_file import loader
from arboleda.testing import shipped

from ...plants import plant_text, rows

ROOT = Path(__file__).parents[3]
EXAMPLES = sorted((ROOT / "examples" / "plants").glob("*.yaml"))
PAGES = ("docs/how-to/plant-file.md", "docs/how-to/test-your-plant.md")
GOOD = plant_text(__file__, "layout_check")
OTHER = """\
  b:
    arm: {name: rb, model: cr10a, link: mqtt, evidence: ids, base: {origin_m: [0.75, -1.2], yaw_deg: 32.71}}
    mobile: {name: mb, link: mqtt, evidence: ids, grid: {origin_m: [0.55, -2.104]}}
    home: {deg: [0, 0, 0, 0, 0, 0]}
    pickup: {deg: [35, 10, 145.5, -65.5, -90, 0]}
    stations: {0: {deg: [0, 0, -132.69, 42.69, 90, 0]}}
"""
Warned = Callable[[str], tuple[str, ...]]


@pytest.fixture
def warned(tmp_path: Path) -> Warned:
    def read(text: str) -> tuple[str, ...]:
        file = tmp_path / "plant.yaml"
        file.write_text(text, "utf-8")
        return layout_check.warnings(loader.load(file))

    return read


WRONG = rows(__file__, "layout_check")


@pytest.mark.sampled(6)
@pytest.mark.parametrize(("old", "new", "said"), WRONG.values(), ids=WRONG)
def test_what_could_not_stand_there_is_a_warning(warned: Warned, old: str, new: str, said: str) -> None:
    good = GOOD + OTHER
    assert old in good and warned(good) == ()
    assert said in warned(good.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "before", "after"),
    [
        ("[0.2, 1.566]", "[0.2, 1.52]", r"origin_m: \[0.2, 1.52\]", r"(origin_m: \[.*?\])"),
        ("[0.2, 1.566]", "[0.2, 2.566]", r"origin_m: \[0.2, 2.566\]", r"(origin_m: \[.*?\])"),
        ("[45, 10], mm: 0", "[45, 10], mm: 80", "mm: 80", r"(mm: \d+)"),
    ],
    ids=["beside", "out of reach", "into the part"],
)
def test_what_a_warning_tells_to_write_is_right(
    warned: Warned, old: str, new: str, before: str, after: str
) -> None:
    wrong = GOOD.replace(old, new)
    (told,) = [each for each in warned(wrong) if "; write " in each]
    to_write = re.search(after, told.partition("; write ")[2])
    assert to_write is not None
    assert warned(re.sub(before, to_write[1], wrong)) == ()


def test_pick_ups_of_a_grid_that_are_off_by_different_lengths_are_to_be_taught() -> None:
    grid = next(robot for robot in shipped().robots.values() if robot.floor_grid)
    assert moved_grid(grid, [(0.0, 0.1), (0.0, -0.1)], 0.01) == "; teach the pick-ups of these paths anew"


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.name)
def test_an_example_could_be_built(file: Path) -> None:
    assert layout_check.warnings(loader.load(file)) == ()


@pytest.mark.parametrize("page", PAGES)
def test_the_plant_of_a_page_could_be_built(warned: Warned, page: str) -> None:
    text = (ROOT / page).read_text("utf-8")
    block = next(part for part in text.split("```yaml\n")[1:] if "pickup:" in part).split("```")[0]
    assert warned(block) == ()


def test_the_shipped_plant_could_be_built() -> None:
    assert layout_check.warnings(shipped()) == ()


def test_check_says_it_and_takes_the_file(tmp_path: Path) -> None:
    file = tmp_path / "plant.yaml"
    file.write_text(GOOD.replace("[45, 10], mm: 0", "[45, 10], mm: 80"))
    said = CliRunner().invoke(cli, ["check", str(file)])
    assert said.exit_code == 0
    assert "warning: a: pick-up is 78 mm below the top of a part on ma" in " ".join(said.stdout.split())


def test_a_model_without_a_drawing_is_said_not_to_have_been_looked_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("arboleda_description.urdf.models", lambda: ("mobile",))
    (said,) = layout_check.warnings(shipped())
    assert said.startswith("nobody has looked where things stand: the model scara of ra1 cannot be drawn")
