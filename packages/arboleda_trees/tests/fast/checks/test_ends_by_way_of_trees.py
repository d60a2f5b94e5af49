"""`check` compares the ends that a tree states, one for each way, with those that it comes to."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.plant_check.test_ends_by_way import BY_ANSWER, EITHER, PARTS_SWAPPED, SWAPPED, sorting, warned

TREE = """
<root BTCPP_format="4" main_tree_to_execute="Sort">
<BehaviorTree ID="Sort"><Sequence>
  <camera_look answer="{seen}"/>
  <arm_visit target="in"><jaw_close width_mm="30" force_n="20"/></arm_visit>
  <Switch2 variable="{seen}" case_1="good" case_2="bad">
    <arm_visit target="GOOD"><jaw_open/></arm_visit>
    <arm_visit target="BAD"><jaw_open/></arm_visit>
    <AlwaysFailure/>
  </Switch2>
  <arm_home/>
</Sequence></BehaviorTree>
<TreeNodesModel><SubTree ID="Sort"><MetadataFields>
  <Metadata ends_with="ENDS"/>
</MetadataFields></SubTree></TreeNodesModel>
</root>
"""


def as_xml(ends: str) -> str:
    """The ends as the metadata of a tree: by an answer, or one of them."""
    return {
        BY_ANSWER: "camera.look: good; press: 1 | camera.look: bad; reject: 1",
        EITHER: "press: 1 | reject: 1",
    }[ends]


@pytest.mark.parametrize("ends", [BY_ANSWER, EITHER], ids=["by answer", "either"])
def test_nothing_is_said_against_a_tree_that_ends_as_it_says_on_each_way(tmp_path: Path, ends: str) -> None:
    assert warned(sorting(tmp_path, as_xml(ends), recipe=TREE, name="sort.xml")) == []


def test_check_finds_the_parts_of_two_answers_swapped(tmp_path: Path) -> None:
    plant = sorting(tmp_path, as_xml(BY_ANSWER), SWAPPED, recipe=TREE, name="sort.xml")
    assert warned(plant) == PARTS_SWAPPED
