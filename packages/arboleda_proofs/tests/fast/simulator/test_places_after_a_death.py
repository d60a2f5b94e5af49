"""Tasks that were done in the step in which their plant died: they are judged by what they were told."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.model.messages import Fact, Remember, TaskChanged, TaskState, Verb
from arboleda.rig.plant_process import Fuse, Side
from arboleda.rig.world import PLANT, World
from arboleda_proofs.simulator.invariants.part_places import books_of_parts_are_true
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld

from .test_general_invariants import looks, storing


class FuseOfBooks(Fuse):
    """Fuse that burns down once the plant has booked parts."""

    def __init__(self, world: World) -> None:
        super().__init__(1, Side.AFTER, world.plant_process.stop)
        self._world = world

    def burns(self, side: Side) -> bool:
        return side is self.side and any(map(_books, self._world.moment.sent))


class FuseOfADoneTask(Fuse):
    """Fuse that burns down once the plant has told that a task is done, `booked`: and books parts."""

    def __init__(self, world: World, *, booked: bool = False) -> None:
        super().__init__(1, Side.AFTER, world.plant_process.stop)
        self._world = world
        self._booked = booked

    def burns(self, side: Side) -> bool:
        sent = self._world.moment.sent
        done = [n for n, each in enumerate(sent) if isinstance(each, TaskChanged) and _is_done(each)]
        return side is self.side and bool(done) and (not self._booked or any(map(_books, sent[done[0] :])))


def _is_done(change: TaskChanged) -> bool:
    return change.state is TaskState.DONE


def _books(message: object) -> bool:
    return isinstance(message, Remember) and message.fact is Fact.PARTS


def test_the_books_may_be_those_of_the_next_task_already_where_people_fill_a_place() -> None:
    world = JudgedWorld(storing(), invariants=[books_of_parts_are_true]).world
    world.plant_process.fuses.append(FuseOfADoneTask(world, booked=True))
    world.request_task("tending forgets")
    world.request_task("tending forgets")
    world.advance(60.0)
    assert not world.is_on(PLANT)


def test_what_a_recipe_says_of_its_end_is_judged_though_its_plant_dies_as_it_tells_of_that() -> None:
    world = JudgedWorld(storing()).world
    world.plant_process.fuses.append(FuseOfADoneTask(world))
    world.request_task("tending bring")
    with pytest.raises(BrokenInvariant, match="recipes_end_as_they_say"):
        world.advance(60.0)
    assert not world.is_on(PLANT)


def test_parts_that_a_person_brought_count_though_the_plant_died_before_it_answered() -> None:
    model = storing()
    (cell,) = model.cells
    model = replace(model, cells=(replace(cell, recipes=(looks,)),))
    world = JudgedWorld(model, invariants=[books_of_parts_are_true]).world
    world.plant_process.fuses.append(FuseOfBooks(world))
    world.request_verb(Verb.LOAD, "tending", arguments=(("place", "vise"),))
    assert world.advance(5.0, lambda: not world.is_on(PLANT))
    world.plant_process.start()
    assert world.plant.cells["tending"].context.places.counts["vise"] == 1
    world.request_task("tending looks")
    world.advance(30.0)
    assert [task.state for task in world.plant.intake.tasks.values()] == [TaskState.DONE]
