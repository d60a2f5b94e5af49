from __future__ import annotations

import pytest
from py_trees.composites import Selector, Sequence

from arboleda.model.tree_nodes import nodes_of
from arboleda.testing import Rig, shipped


def test_nodes_come_in_the_order_of_iterate() -> None:
    rig = Rig(shipped())
    rig.wait(0.5)
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    tree = rig.plant.cells["sis_a"].tree
    assert tree is not None and nodes_of(tree) == list(tree.iterate())


def test_a_tree_without_an_end_is_no_endless_list() -> None:
    outer, inner = Sequence("outer", memory=True), Selector("inner", memory=True)
    outer.add_child(inner)
    inner.children.append(outer)
    with pytest.raises(RecursionError, match="outer has more than"):
        nodes_of(outer)
