"""A mobile robot that somebody carries to the start of its path: nobody expects it to be driven there."""

from __future__ import annotations

from arboleda.kinds.mobile import FollowPath
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.testing import shipped
from arboleda_proofs.simulator.judged_world import JudgedWorld


def test_the_way_to_the_start_is_left_out_where_the_robot_is_there_by_then() -> None:
    world = JudgedWorld(shipped("sis_a")).world
    driven: list[tuple[int, ...]] = []

    def look() -> None:
        for said in world.moment.sent:
            if isinstance(said, TaskChanged) and said.state is TaskState.RUNNING and driven:  # it is away
                world.at(world.now + 0.02, world.manual.put_at_reference, "rm_sis_a")
            if isinstance(said, FollowPath):
                driven.append(said.nodes)

    world.watchers.append(look)
    for number in (1, 2):
        world.request_task(f"sis_a 0B 7 #lot{number}")
        world.advance(60.0)
    path = world.model.cell("sis_a").paths["0B"].nodes
    assert driven == [path, path]
