"""The end of a tree is checked with its place, and judged in every run."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.kinds.test_places import PLANT

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda_trees.bt_xml import ends

from .findings import looked_at, mistakes, tree, warnings

EXAMPLE = Path(__file__).parents[5] / "examples" / "own_tree"
BRING = """
<root BTCPP_format="4" main_tree_to_execute="Bring">
<BehaviorTree ID="Bring"><Sequence>
  <mover_visit target="{source}"><hand_close/></mover_visit>
  <mover_visit target="nest"><hand_open/></mover_visit>
  <mover_home/>
</Sequence></BehaviorTree>
<TreeNodesModel><SubTree ID="Bring">
  <input_port name="source"/>
  <MetadataFields><Metadata ends_with="END"/></MetadataFields>
</SubTree></TreeNodesModel>
</root>
"""


def model(end: str, *more: str) -> str:
    """A file whose tree Main ends so; its model stands in line 5."""
    fields = "".join(f"<Metadata {each}/>" for each in (f'ends_with="{end}"', *more))
    return tree(
        "<A/>",
        f'<TreeNodesModel><SubTree ID="Main"><MetadataFields>{fields}</MetadataFields></SubTree>'
        "</TreeNodesModel>",
    )


def plant(folder: Path, end: str) -> PlantModel:
    """The laboratory of the tests of places, with a tree instead of a recipe."""
    (folder / "bring.xml").write_text(BRING.replace("END", end), "utf-8")
    (folder / "plant.yaml").write_text(PLANT.replace("recipes.py", "bring.xml"), "utf-8")
    return load(folder / "plant.yaml")


def refusal(folder: Path, end: str) -> tuple[str, ...]:
    with pytest.raises(ConfigError) as refused:
        plant(folder, end)
    return refused.value.problems


def test_values_are_numbers_words_and_yes_or_no() -> None:
    forest, findings, _ = looked_at(model("nest: 1; lid: open; on: true; dose: 0.5; code: '7';"))
    (stated,) = ends.of_tree(forest, "Main")
    found = {end.what: end.value for end in stated}
    assert found == {"nest": 1, "lid": "open", "on": True, "dose": 0.5, "code": "7"}
    assert type(found["nest"]) is int
    assert (findings.mistakes, findings.warnings) == ((), ())
    assert ends.of_tree(forest, "Other") == ()


@pytest.mark.parametrize("end", ["nest 1", "nest: ", ": 1", "nest: 1, bin: 2", "nest: 'a"])
def test_what_cannot_be_read_is_a_mistake_with_its_place(end: str) -> None:
    (line,) = mistakes(model(f"lid: open; {end}"))
    assert line.startswith("t.xml:5:") and f"ends_with of Main: {end.strip()!r} is not read" in line


def test_what_is_said_twice_is_a_mistake() -> None:
    (line,) = mistakes(model("nest: 1", 'ends_with="nest: 0"'))
    assert "ends_with of Main has 'nest' twice" in line


def test_the_ends_of_several_ways_have_a_line_between_them() -> None:
    forest, findings, _ = looked_at(model("lid: open; nest: 1 | lid: closed; nest: 0"))
    ways = [{end.what: end.value for end in way} for way in ends.of_tree(forest, "Main")]
    assert ways == [{"lid": "open", "nest": 1}, {"lid": "closed", "nest": 0}]
    assert findings.mistakes == ()


def test_other_metadata_mean_nothing_but_what_is_nearly_this() -> None:
    assert warnings(model("nest: 1", 'author="me"', 'color="red"')) == ()
    (line,) = warnings(model("nest: 1", 'end_with="nest: 1"'))
    assert "nobody here knows 'end_with' of Main; did you mean ends_with?" in line


def test_a_recipe_of_a_tree_ends_as_its_model_says(tmp_path: Path) -> None:
    (cell,) = plant(tmp_path, "nest: 1; oven.clamped: false").cells
    end = cell.recipe("bring").end_of({"source": "rack_2"})
    assert end == {"nest": 1, "oven.clamped": False}


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("end", "sentence"),
    [
        ("nst: 1", "oven.clamped; did you mean nest?"),
        ("nest: 2", "bring ends with 2 at nest, which holds 0 to 1"),
        ("nest: open", "bring ends with 'open' at nest, which holds 0 to 1"),
        ("ovn.clamped: true", "bring ends with 'ovn.clamped'; there are rack_1, "),
        ("source: 2", "bring ends with 2 at rack_1, which holds 0 to 1"),
        ("oven.clamped: 1.5", "clamped is never 1.5"),
    ],
)
def test_what_no_cell_says_is_refused_with_its_place(tmp_path: Path, end: str, sentence: str) -> None:
    lines = refusal(tmp_path, end)
    assert all(line.startswith(f"{tmp_path / 'bring.xml'}:10:29: ") for line in lines)
    assert sentence in lines[0]


def test_a_parameter_of_which_the_end_says_how_many_parts_are_there_is_a_place(tmp_path: Path) -> None:
    (cell,) = plant(tmp_path, "nest: 1; source: 0").cells
    recipe = cell.recipe("bring")
    (source,) = recipe.parameters
    assert list(source.words(cell)) == ["rack_1", "rack_2", "nest", "inside", "bin"]
    assert recipe.end_of({"source": "rack_2"}) == {"nest": 1, "rack_2": 0}


def test_the_example_says_how_it_ends() -> None:
    (cell,) = load(EXAMPLE / "plant.yaml").cells
    assert cell.recipe("tend").end_of({}) == {"mill.door": "open", "mill.clamped": False}
