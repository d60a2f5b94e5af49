"""A device that a tree asks something is in the zone until it has answered."""

from __future__ import annotations

from pathlib import Path

from tests.plants import read
from tests.unit.kinds.test_zones_of_devices import ASKED, RECIPES, in_the_zone_until_it_has_answered

TREE = """
<root BTCPP_format="4"><BehaviorTree ID="Tree"><Sequence>
  <Parallel failure_count="1" success_count="-1">
    <feeder_look answer="{seen}"/>
    <Sequence><Sleep msec="500"/><ram_press/></Sequence>
  </Parallel>
  <Switch2 variable="{seen}" case_1="free" case_2="jammed">
    <ram_lift/><AlwaysFailure/><AlwaysFailure/>
  </Switch2>
</Sequence></BehaviorTree></root>
"""


def test_a_device_that_is_asked_is_in_the_zone_until_it_has_answered(tmp_path: Path) -> None:
    plant = read(tmp_path, ASKED.replace("[rec", "[tree.xml, rec"), RECIPES, {"tree.xml": TREE})
    in_the_zone_until_it_has_answered(plant, "tree")
