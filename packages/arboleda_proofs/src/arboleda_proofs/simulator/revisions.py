"""People who change the plant's files while it runs: targets moved, times changed, a recipe exchanged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from arboleda.model.plant_model import Cell, PlantModel, Pose, Retry, Workspace
from arboleda.rig.world import World

from .chance import Dice

EVERY_S = (5.0, 60.0)  # between two changes
SMALL_RAD = 0.01  # by which a joint of a target moves
FACTORS = (0.9, 1.0, 1.25, 2.0)  # of a time
TIMES = ("dwell_s", "effector_timeout_s", "deadline_factor", "piece_wait_s")
Change = Callable[[Dice, PlantModel, PlantModel], PlantModel]
"""Makes another version of a plant; the second one is as it began."""


class Revisions:
    """People who put a version to work now and then, until `go`, each one changed from the last one."""

    def __init__(self, world: World, seed: int) -> None:
        self._world = world
        self._dice = Dice(seed, "revisions")
        self._first = world.model
        self._goes = False
        self._plan()

    def go(self) -> None:
        """Change nothing more."""
        self._goes = True

    def _plan(self) -> None:
        self._world.at(self._world.now + self._dice.between(*EVERY_S), self._change, None)

    def _change(self, _: None) -> None:
        if not self._goes:
            change = self._dice.pick(CHANGES)
            self._world.plant_process.take_version(change(self._dice, self._world.offers, self._first))
            self._plan()


def _moved(dice: Dice, plant: PlantModel, first: PlantModel) -> PlantModel:
    """A station of a cell is somewhere else."""
    cell = dice.pick(plant.cells)
    if not cell.stations:
        return plant
    name, by = dice.pick(cell.stations).name, dice.pick((-SMALL_RAD, SMALL_RAD))

    def moved(pose: Pose) -> Pose:
        if pose.name != name or not isinstance(pose.q, tuple):
            return pose
        above = (pose.above[0] + by, *pose.above[1:]) if isinstance(pose.above, tuple) else pose.above
        return replace(pose, q=(pose.q[0] + by, *pose.q[1:]), above=above)

    def in_space(space: Workspace) -> Workspace:
        return replace(space, poses=tuple(map(moved, space.poses)))

    return _with(plant, replace(cell, spaces=tuple(map(in_space, cell.spaces))))


def _timed(dice: Dice, plant: PlantModel, first: PlantModel) -> PlantModel:
    """A time of the plant is another one."""
    name, factor = dice.pick(TIMES), dice.pick(FACTORS)
    value = getattr(first.timing, name) * factor
    return replace(plant, timing=replace(plant.timing, **{name: value}))


def _tried(dice: Dice, plant: PlantModel, first: PlantModel) -> PlantModel:
    """A cell tries a step more often, or less."""
    cell = dice.pick(plant.cells)
    return _with(plant, replace(cell, retry=Retry(times=dice.below(3), backoff_s=dice.between(0.1, 2.0))))


def _offered(dice: Dice, plant: PlantModel, first: PlantModel) -> PlantModel:
    """A cell does without one of its recipes, or offers all of the first again."""
    cell = dice.pick(plant.cells)
    others = [each for each in first.cell(cell.name).recipes if not each.is_default]
    gone = dice.pick(others) if others and dice.chance(0.5) else None
    known = first.cell(cell.name).recipes
    return _with(plant, replace(cell, recipes=tuple(each for each in known if each is not gone)))


def _with(plant: PlantModel, cell: Cell) -> PlantModel:
    cells = tuple(cell if each.name == cell.name else each for each in plant.cells)
    return replace(plant, cells=cells)


CHANGES: tuple[Change, ...] = (_moved, _timed, _tried, _offered)
