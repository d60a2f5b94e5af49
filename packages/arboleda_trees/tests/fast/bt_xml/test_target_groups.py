"""A parameter of a tree may be one of a group of targets, as the model of the tree says."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file.loader import load

from .findings import mistakes, tree, warnings
from .test_ends import BRING, PLANT

MODEL = """<TreeNodesModel><SubTree ID="Main"><input_port name="source"/>
<MetadataFields><Metadata {}/></MetadataFields></SubTree></TreeNodesModel>"""


def test_a_list_of_values_leaves_no_others(tmp_path: Path) -> None:
    assert words(tmp_path, 'source: racks" /><Metadata values="source: rack_2, nest, moon') == ["rack_2"]


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ("source: ,", "'source: ,' is not read; write a parameter with its values, `ml: 5, 10, 20`"),
        ("goal: a", "values of Main names 'goal'; there are source"),
    ],
)
def test_a_list_that_cannot_be_read_is_a_mistake(values: str, sentence: str) -> None:
    (found,) = mistakes(tree("<A/>", MODEL.format(f'values="{values}"')))
    assert sentence in found


def words(folder: Path, targets: str) -> list[str]:
    """The values of `source`."""
    code = BRING.replace('ends_with="END"', f'targets="{targets}"')
    (folder / "bring.xml").write_text(code, "utf-8")
    (folder / "plant.yaml").write_text(PLANT.replace("recipes.py", "bring.xml"), "utf-8")
    (cell,) = load(folder / "plant.yaml").cells
    return list(cell.recipe("bring").parameters[0].words(cell))


def test_it_is_one_of_the_group_in_its_order(tmp_path: Path) -> None:
    assert words(tmp_path, "source: racks") == ["rack_1", "rack_2"]


def test_one_target_by_its_name_is_enough(tmp_path: Path) -> None:
    assert words(tmp_path, "source: nest") == ["nest"]


def test_a_group_that_no_cell_has_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"has no value to choose; .* has no targets "):
        words(tmp_path, "source: shelf")


@pytest.mark.parametrize(
    ("targets", "sentence"),
    [
        ("source", "'source' is not read; write a parameter with a group of targets, `blank: pallet`"),
        ("goal: racks", "targets of Main names 'goal'; there are source"),
    ],
)
def test_what_is_no_parameter_or_cannot_be_read_is_a_mistake(targets: str, sentence: str) -> None:
    (found,) = mistakes(tree("<A/>", MODEL.format(f'targets="{targets}"')))
    assert sentence in found


def test_a_word_that_is_nearly_this_is_warned_of() -> None:
    found = warnings(tree("<A/>", MODEL.format('target="source: racks"')))
    assert any("nobody here knows 'target' of Main; did you mean targets?" in each for each in found)
