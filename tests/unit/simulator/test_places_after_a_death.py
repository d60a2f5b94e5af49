"""Tasks that were done in the step in which their plant died: they are judged by what they were told."""

from __future__ import annotations

import pytest

from arboleda.model.messages import TaskChanged, TaskState
from arboleda.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda.simulator.world import PLANT, Fuse, Side, World

from .test_general_invariants import storing


class FuseOfADoneTask(Fuse):
    """Fuse that burns down once the plant has told that a task is done."""

    def __init__(self, world: World) -> None:
        super().__init__(1, Side.AFTER, world.stop_plant)
        self._world = world

    def burns(self, side: Side) -> bool:
        said = (each for each in self._world.moment.sent if isinstance(each, TaskChanged))
        return side is self.side and any(each.state is TaskState.DONE for each in said)


def test_what_a_recipe_says_of_its_end_is_judged_though_its_plant_dies_as_it_tells_of_that() -> None:
    world = JudgedWorld(storing()).world
    world.fuses.append(FuseOfADoneTask(world))
    world.request_task("tending bring")
    with pytest.raises(BrokenInvariant, match="recipes_end_as_they_say"):
        world.advance(60.0)
    assert not world.is_on(PLANT)
