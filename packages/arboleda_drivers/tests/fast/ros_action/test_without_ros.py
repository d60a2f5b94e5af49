"""A virtual controller over ROS 2 where there is no ROS 2."""

from __future__ import annotations

import sys

import pytest

from arboleda.model.errors import StartError
from arboleda_drivers.joint_trajectory.virtual.machine import FAULTS
from arboleda_drivers.joint_trajectory.virtual.server import controller
from arboleda_drivers.virtual.faults import Faults


def test_what_it_needs_is_one_sentence_with_the_line_that_installs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "arboleda_ros.link", None)
    arm = controller(Faults(FAULTS, ()), action="move", joint_states="j", joints=("a",), rate=50.0, lan=False)
    with pytest.raises(StartError, match=r"the virtual arm needs ROS 2, .*pip install 'arboleda\[ros\]'"):
        arm.start()
