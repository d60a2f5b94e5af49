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

from ...plants import plant_text

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


WRONG = {  # text in the file, put in its place, what is said
    "beside its node": (
        "[0.2, 1.566]",
        "[0.2, 1.52]",
        "a: pick-up is 46 mm beside a part on ma at node 7, where path 0B ends"
        "; write origin_m: [0.199, 1.566] of its grid",
    ),
    "above the part": (
        "[35, 10, 145.5, -65.5, -90, 0]",
        "[35, 4.2, 144.33, -58.53, -90, 0]",
        "b: pick-up is 41 mm above the top of a part on mb at node 7, where path 0B ends"
        "; teach it 41 mm lower",
    ),
    "into the part": (
        "pickup: {deg: [45, 10], mm: 0}",
        "pickup: {deg: [45, 10], mm: 80}",
        "a: pick-up is 78 mm below the top of a part on ma at node 7, where path 0B ends; write mm: 2",
    ),
    "out of reach": (
        "[0.2, 1.566]",
        "[0.2, 2.566]",
        "a: node 7 is out of reach, 2.17 m away; ra reaches 1.17 m (path 0B)"
        "; write origin_m: [0.199, 1.566] of its grid",
    ),
    "stations in each other": (
        "1: {deg: [5, 10]",
        "1: {deg: [1, 10]",
        "a: station 0 and 1 are 20 mm apart; a part is 24 mm wide and 40 mm high; put them 24 mm apart",
    ),
    "below the floor": (
        "0, -132.69, 42.69",
        "-60, -90, 60",
        "b: at station 0, the part in the tool is 160 mm below the floor; teach it 160 mm higher",
    ),
    "bases": (
        "base: {origin_m: [0.75, -1.2], yaw_deg: 32.71}",
        "base: {origin_m: [0.2, 0], yaw_deg: 32.71}",
        "the base of ra and the base of rb overlap; move one of them by 45 mm",
    ),
    "a base on a grid": (
        "grid: {origin_m: [0.55, -2.104]}",
        "grid: {origin_m: [0.55, -1.4]}",
        "the base of rb and the grid of mb overlap; move one of them by 345 mm",
    ),
    "grids": (
        "grid: {origin_m: [0.55, -2.104]}",
        "grid: {origin_m: [0.1, 1.4]}",
        "the grid of ma and the grid of mb overlap; move one of them by 200 mm",
    ),
    "a station on a grid": (
        "grid: {origin_m: [0.55, -2.104]}",
        "grid: {origin_m: [0.75, 0.6]}",
        "a: station 0 stands on the grid of mb; move one of them by 136 mm",
    ),
}


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
