"""A plant with robots that obey, as benchmarks drive it."""

from __future__ import annotations

from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.testing import plants
from arboleda_bench.obedient import Yard, command_in, is_over


def test_robots_that_obey_bring_a_task_to_its_end():
    yard = Yard(plants.shipped("sis_a"))
    out, commands = yard.ask("sis_a 0B 7"), []
    while not is_over(out):
        command = command_in(out)
        if command is None:
            out = yard.sleep()
            continue
        commands.append(type(command))
        yard.step(yard.accepts(command))
        out = yard.step(yard.finishes(command))
    states = [each.state for each in out if isinstance(each, TaskChanged)]
    assert states == [TaskState.DONE]
    assert commands == [FollowPath, MoveJoints, SetEffector, MoveJoints, SetEffector, MoveJoints]
