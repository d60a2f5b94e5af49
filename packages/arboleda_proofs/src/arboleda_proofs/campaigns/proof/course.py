"""Course of a calm run: how its world was every now and then, to know the runs that come back to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from arboleda.extension import ArboledaError
from arboleda.model.plant_model import PlantModel

from .calm import Calm, calm_play
from .likeness import Likeness, first_difference, likeness
from .outcome import Run
from .stage import Rejoined, Stage

EVERY_S = 0.5  # between two points
MOST_POINTS = 48  # of a course: a point takes as long as some seconds of a run
WORDS = 400  # of a likeness, which take as long to find as the run to the next point


@dataclass(frozen=True, kw_only=True)
class Course:
    """Course of a calm run: its likeness by the time of the world, and what had been done by then."""

    run: Run
    points: Mapping[float, tuple[Likeness, object]]


def course_of(model: PlantModel, calm: Calm) -> Course:
    """The course of a calm run, which is run again for it."""
    stage = Stage(model, calm.scenario)
    points: dict[float, tuple[Likeness, object]] = {}
    every_s, due = max(EVERY_S, calm.lasts_s / MOST_POINTS), 0.0

    def look() -> None:
        nonlocal due
        if stage.world.now >= due:
            due = stage.world.now + every_s
            points[stage.world.now] = (likeness(stage.world), _done(stage))

    stage.on_its_way = look
    run = calm_play(stage)
    if run != calm.run:
        raise ArboledaError(f"{calm.scenario.name} went otherwise as it was run again: {run.outcome.words}")
    return Course(run=run, points=points)


def rejoin(stage: Stage, course: Course) -> None:
    """Have a run end as the calm one as soon as nothing is left of its fault.

    Its world is then as it was there at that time, and the same was done: so what follows is the same. Who
    judges excuses more after a fault, not less.
    """

    passed_over = 0  # points to come at which nothing is compared: that took too long for what it told

    def look() -> None:
        nonlocal passed_over
        point = course.points.get(stage.world.now)
        if point is None or not _is_over(stage) or _done(stage) != point[1]:
            return
        if passed_over:
            passed_over -= 1
            return
        number = first_difference(stage.world, point[0])
        if number is None:
            raise Rejoined(course.run)
        passed_over = number // WORDS

    stage.on_its_way = look


def _is_over(stage: Stage) -> bool:
    """True if the fault has ended, and nobody lies or is held any more."""
    world = stage.world
    kept_up = world.faults_active or any(world.deceptions.values()) or any(world.holds.values())
    return stage.began and not kept_up


def _done(stage: Stage) -> object:
    """Deeds so far: a quick look before the other."""
    return stage.done, stage.world.plant_process.starts
