"""What must hold over all starts of a plant holds, and each of it finds a bug that was planted for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import pytest
from tests.lengths import length, sample

from arboleda.core.intake import Intake
from arboleda.core.task_desk import TaskDesk
from arboleda.core.task_queue import TaskQueue
from arboleda.model.messages import ENDED, KeptTask, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.model.task import Task
from arboleda.resume.walk_back import WalkBack
from arboleda.rig import plant_process
from arboleda.testing import shipped
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.faults import KINDS, OF_CRASHES
from arboleda_proofs.simulator.invariants.part_places import parts_are_taken_and_put_where_they_can_be
from arboleda_proofs.simulator.invariants.starts import STARTS
from arboleda_proofs.simulator.judged import INVARIANTS, judged_by
from arboleda_proofs.simulator.judged_world import BrokenInvariant
from arboleda_proofs.simulator.run import Simulation

from .test_general_invariants import load, shop

Patch = pytest.MonkeyPatch
Bug = Callable[[Patch], None]
WEATHER = {**dict.fromkeys(OF_CRASHES, 8.0), "double_submit": 6.0}


def run(model: PlantModel, seed: int, *, only: str = "", cycles: int = 6) -> BrokenInvariant | None:
    """What breaks; `only`: by this invariant alone."""
    rates = {name: rate for name, rate in WEATHER.items() if KINDS[name].targets(model)}
    climate = Climate.from_file(model, seed, {"rates": rates})
    judges = [each for each in judged_by() if only in ("", each.name)]
    return Simulation(model, seed, climate.faults, invariants=judges).run(cycles=cycles).broken


def forgets(patch: Patch) -> None:
    """What an earlier start accepted is nothing to the next one."""
    patch.setattr(TaskDesk, "take_back", lambda self, kept: None)


def takes_ended_for_others(patch: Patch) -> None:
    """A task that has ended is kept without its text, so that who asks again asks for another one."""
    of = Task.of.__func__  # type: ignore[attr-defined]

    def without_text(cls: type[Task], kept: KeptTask, order: Any = None) -> Task:
        task: Task = of(cls, kept, order)
        if task.state in ENDED:
            task.order = replace(task.order, text="")
        return task

    patch.setattr(Task, "of", classmethod(without_text))


def tells_ends_again(patch: Patch) -> None:
    """A plant that starts tells of all tasks that it knows, also of those that have ended."""
    take_back = TaskDesk.take_back

    def loudly(self: TaskDesk, kept: Iterable[KeptTask]) -> None:
        rows = list(kept)
        take_back(self, rows)
        for each in rows:
            if each.state in ENDED:
                self.tell(self._state.intake.tasks[each.id])

    patch.setattr(TaskDesk, "take_back", loudly)


def begins_anew(patch: Patch) -> None:
    """A task that was at work waits again, and begins from its first step."""
    take_back = Intake.take_back

    def waits(self: Intake, kept: KeptTask, now: float) -> Task:
        if kept.state is TaskState.RUNNING:
            kept = replace(kept, state=TaskState.QUEUED, started_at=None)
        return take_back(self, kept, now)

    patch.setattr(Intake, "take_back", waits)


def gives_again_what_is_proven(patch: Patch) -> None:
    """A task goes on at its step, which is given again although its board proves that it is done."""
    go_on = WalkBack.go_on
    patch.setattr(WalkBack, "go_on", lambda self, finding: go_on(self, replace(finding, fates={})))


def goes_on_by_itself(patch: Patch) -> None:
    """What waited starts without a word, whatever the plant file says."""
    patch.setattr(TaskQueue, "take_back", lambda self, waiting, *, cut_off: self.extend(waiting))


def says_what_it_cannot_keep(patch: Patch) -> None:
    """A plant that can keep nothing more goes on as if it had."""
    patch.setattr(plant_process, "leaves_unkept", lambda message: True)


BITES: list[tuple[str, Bug]] = [
    ("accepted_is_found_again", forgets),
    ("accepted_is_found_again", says_what_it_cannot_keep),
    ("nothing_unkept_leaves", says_what_it_cannot_keep),
    ("asked_again_is_the_same_task", takes_ended_for_others),
    ("ends_once_over_all_starts", tells_ends_again),
    ("no_step_is_done_twice", begins_anew),
    ("no_step_is_done_twice", gives_again_what_is_proven),
    ("parts_are_taken_and_put_where_they_can_be", begins_anew),
    ("nothing_moves_after_a_restart", goes_on_by_itself),
]
LIKELY = {  # seeds that found them, tried first
    ("storage", "accepted_is_found_again", forgets): 3,
    ("storage", "asked_again_is_the_same_task", takes_ended_for_others): 7,
    ("storage", "no_step_is_done_twice", begins_anew): 5,
    ("storage", "no_step_is_done_twice", gives_again_what_is_proven): 10,
    ("storage", "parts_are_taken_and_put_where_they_can_be", begins_anew): 12,
    ("storage", "nothing_moves_after_a_restart", goes_on_by_itself): 7,
    ("devices", "accepted_is_found_again", says_what_it_cannot_keep): 4,
    ("devices", "asked_again_is_the_same_task", takes_ended_for_others): 16,
    ("devices", "no_step_is_done_twice", begins_anew): 2,
    ("devices", "no_step_is_done_twice", gives_again_what_is_proven): 3,
}
HERE = {"storage": shipped(), "devices": shop(load)}
CASES = [
    (kind, name, bug)
    for kind in HERE
    for name, bug in BITES
    if kind == "storage" or name in {each.name for each in STARTS}
]


IDS = [f"{kind}: {name} by {bug.__name__}" for kind, name, bug in CASES]


@pytest.mark.sampled(17)
@pytest.mark.parametrize(("kind", "name", "bug"), CASES, ids=IDS)
def test_it_bites(monkeypatch: Patch, kind: str, name: str, bug: Bug) -> None:
    bug(monkeypatch)
    seeds = sorted(range(1, 25), key=lambda seed: seed != LIKELY.get((kind, name, bug)))
    found = (run(HERE[kind], seed, only=name) for seed in seeds)
    assert any(broken is not None and broken.invariant == name for broken in found)


@pytest.mark.long
@pytest.mark.parametrize("kind", HERE)
@pytest.mark.parametrize("seed", sample([1, 2], every=2))
def test_all_of_them_hold_however_often_the_plant_dies(kind: str, seed: int) -> None:
    assert run(HERE[kind], seed, cycles=length(2, whole=6)) is None


def test_every_one_of_them_has_a_bug_and_judges_where_it_can() -> None:
    rest = {"tasks_go_on_from_what_was_kept"}  # it needs boots, and has its bugs in tools/tests/mutants
    over_all_starts = (*STARTS, parts_are_taken_and_put_where_they_can_be)
    assert {each.name for each in over_all_starts} == rest | {name for name, _ in BITES}
    assert {*over_all_starts} <= {*INVARIANTS}
