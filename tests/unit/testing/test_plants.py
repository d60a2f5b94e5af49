"""The shipped plant as tests take it: whole or in part, its robots as declared."""

from __future__ import annotations

import pytest

from arboleda.model.plant_model import Evidence, Link
from arboleda.plant_file.loader import load
from arboleda.testing import shipped


def test_without_a_word_it_is_the_shipped_plant() -> None:
    assert shipped() == load()


def test_only_the_named_cells_are_in_it() -> None:
    assert list(shipped("sis_c", "sis_a").robots) == ["ra3", "rm_sis_c", "ra1", "rm_sis_a"]


def test_every_robot_declares_it_and_the_next_plant_does_not() -> None:
    plant = shipped(evidence=Evidence.STATE, link=Link.ROS)
    assert {(robot.evidence, robot.link) for robot in plant.robots.values()} == {(Evidence.STATE, Link.ROS)}
    assert shipped() == load()


def test_a_cell_that_is_not_there_is_named() -> None:
    with pytest.raises(KeyError, match="sis_d"):
        shipped("sis_d")
