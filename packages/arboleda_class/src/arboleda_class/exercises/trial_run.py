"""Trials of a student's plant: tasks on a simulated plant, and what is not as it is to be."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

from arboleda.drivers import Value, shown
from arboleda.engine import Entry, Plant
from arboleda.engine.inspection import ledger_of
from arboleda.model.counting import counted
from arboleda.model.messages import ENDED, TaskChanged, TaskState
from arboleda.model.plant_model import Link, PlantModel
from arboleda.sim.machine import MachineBody
from arboleda_proofs.campaigns.plants import ELSEWHERE
from arboleda_proofs.campaigns.proof.stage import ASKED_AT_S, HEARD_S, STUCK, entry_name
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld
from arboleda_proofs.simulator.people import FixedAnswers, answer_in_turn
from arboleda_proofs.simulator.run import NO_EXCEPTION

from . import wording
from .exercise import TimedFault, Trial

HELD, OPEN = "held", "not ended"
AT = 0.05  # rad in all axes but the last, which lifts: an arm as near to a target is at it, or over it
OVER = ENDED | {TaskState.REFUSED}
MakePlant = Callable[..., Plant]


@dataclass(kw_only=True)
class Course:
    """Course of a trial: how each task ended and why, what was done, and the `objections` to that."""

    ends: list[str] = field(default_factory=list)
    reasons: list[str] = field(default_factory=list)
    sentences: list[str] = field(default_factory=list)
    acts: list[str] = field(default_factory=list)
    objections: list[str] = field(default_factory=list)
    story: list[str] = field(default_factory=list)


def run_trial(
    model: PlantModel, trial: Trial, faults: Sequence[TimedFault], *, make_plant: MakePlant | None = None
) -> Course:
    """Run the tasks of a trial while these faults befall the plant, and judge what came of it."""
    return _Run(model.on_boards(*ELSEWHERE), trial, faults, make_plant).course()


class _Run:
    """One simulated plant with the tasks of a trial."""

    def __init__(
        self,
        model: PlantModel,
        trial: Trial,
        faults: Sequence[TimedFault],
        make_plant: MakePlant | None,
    ) -> None:
        self._model, self._trial = model, trial
        self._watched = JudgedWorld(model, make_plant=make_plant)
        self._world = self._watched.world
        self._waiting = [each for each in faults if each.act]
        self._timed = [each.fault for each in faults if not each.act]
        self._last_changes: dict[str, TaskChanged] = {}  # by request, the last word
        self._tasks = {f"test-{number}": text for number, text in enumerate(trial.tasks)}
        self._acts: list[str] = []
        self._story: list[str] = []
        self._ended_at = 0.0
        self._questions: set[str] = set()
        self._met = ""  # what was so on the way that is not to be
        self._people = [each.name for each in model.robots.values() if each.link is Link.SCREEN]
        if not trial.silent:
            FixedAnswers(self._world, trial.answers)
        for who, replies in trial.replies.items():
            device, _, verb = who.partition(".")
            body = self._world.boards[model.robots[device].mqtt].body
            assert isinstance(body, MachineBody)
            answer_in_turn(body, verb, replies)
        self._world.watchers.append(self._look)

    def course(self) -> Course:
        """Run to the end of all tasks, and judge."""
        broken = ""
        try:
            self._work()
        except BrokenInvariant as error:
            broken = str(error)
        except Exception as error:  # noqa: BLE001 - that none escapes is one of the invariants
            broken = f"{NO_EXCEPTION}: {type(error).__name__}: {error}"
        changes = [*map(self._last_changes.get, self._tasks)]
        course = Course(
            ends=[self._end(each) for each in changes],
            reasons=[each.reason.value if each and each.reason else "" for each in changes],
            sentences=[str(each.sentence) if each else "" for each in changes],
            acts=self._acts,
            story=self._story,
        )
        course.objections += [broken] if broken else self._objections(course)
        return course

    def _work(self) -> None:
        self._world.advance(ASKED_AT_S)
        for request, text in self._tasks.items():
            self._world.request_task(text, request)
        for fault in self._timed:
            self._world.at(self._world.now + fault.at, self._begin, fault)
        self._world.settle()
        self._world.advance(self._trial.at_most_s, self._is_over)
        self._ended_at = self._watched.seconds
        self._world.advance(HEARD_S)

    def _is_over(self) -> bool:
        changes = [*map(self._last_changes.get, self._tasks)]
        return all(each is not None and (each.state in OVER or self._is_stuck(each)) for each in changes)

    def _is_stuck(self, change: TaskChanged) -> bool:
        run = self._world.plant.cells.get(change.cell or "")
        return run is not None and run.state in STUCK and not run.absence.hold

    def _end(self, change: TaskChanged | None) -> str:
        if change is None:
            return OPEN
        if change.state in OVER:
            return change.state.value
        return HELD if self._is_stuck(change) else OPEN

    def _look(self) -> None:
        entries = ledger_of(self._world.plant).entries
        for message in self._world.moment.sent:
            if isinstance(message, TaskChanged):
                self._follow(message)
            elif entry := entries.get(getattr(message, "id", "")):
                self._act(entry_name(entry))
        for name in self._people:
            entry = ledger_of(self._world.plant).question(name)
            if entry is not None and entry.command.id not in self._questions:
                self._questions.add(entry.command.id)
                self._act(entry_name(entry))
        for entry in entries.values() if self._trial.during else ():
            if entry.open and not self._met:
                self._met = next(self._amiss(entry), "")
        if self._trial.apart and not self._met and all(map(self._is_at, self._trial.apart)):
            (one, here), (other, there) = self._trial.apart
            at_s = self._watched.seconds - ASKED_AT_S
            self._met = f"at {at_s:.1f} s {one} is at {here} while {other} is at {there}"

    def _follow(self, change: TaskChanged) -> None:
        known = {each.task: request for request, each in self._last_changes.items() if each.task}
        request = change.request or known.get(change.task)
        before = self._last_changes.get(request or "")
        if request is not None and (before is None or before.state not in OVER):
            self._last_changes[request] = change
            said = str(change.sentence)
            self._tell(_joined(wording.task_is(self._tasks[request], change.state.value), said))

    def _begin(self, fault: Fault) -> None:
        self._tell(wording.befell(fault))
        self._watched.begin(fault)

    def _tell(self, what: str) -> None:
        """Take down what happens, for people."""
        self._story.append(f"{self._watched.seconds - ASKED_AT_S:8.1f} s  {what}")

    def _act(self, name: str) -> None:
        act = _plain(name)
        self._acts.append(act)
        self._tell(act)
        for each in [each for each in self._waiting if _means(each.act, act)]:
            self._waiting.remove(each)
            self._world.at(self._world.now + each.fault.at, self._begin, each.fault)

    def _amiss(self, entry: Entry) -> Iterator[str]:
        """The sentences on facts that are not so while something is done."""
        act = _plain(entry_name(entry))
        for during, facts in self._trial.during.items():
            for what, wanted in facts.items() if _means(during, act) else ():
                found = self._fact(what)
                if found != wanted:
                    yield f"{what} is to be {shown(wanted)} while '{act}' is done; it is {shown(found)}"

    def _fact(self, what: str) -> Value:
        """The true value of a fact, by its device."""
        robot, _, fact = what.partition(".")
        value: Value = self._watched.truth.robots[robot].body.true_facts[fact]
        return value

    def _is_at(self, where: tuple[str, str]) -> bool:
        robot, target = where
        place = self._watched.truth.robots[robot].body.true_place
        spaces = [cell.workspaces[robot] for cell in self._model.cells if robot in cell.workspaces]
        if not isinstance(place, tuple):
            return False
        poses = [pose for space in spaces for pose in space.poses if pose.name == target]
        return any(math.dist(place[:-1], pose.joints[:-1]) < AT for pose in poses)

    def _objections(self, course: Course) -> list[str]:
        return [
            *self._of_ends(course),
            *self._of_facts(),
            *self._of_acts(course.acts),
            *([self._met] if self._met else []),
            *self._of_time(),
        ]

    def _of_ends(self, course: Course) -> Iterator[str]:
        trial = self._trial
        rows = zip(trial.tasks, trial.ends, course.ends, course.reasons, course.sentences, strict=False)
        for task, allowed, end, reason, sentence in rows:
            if end not in allowed:
                yield f"{wording.task_is_to(task, allowed)}; {_joined(wording.task_is('it', end), sentence)}"
            elif trial.reason is not None and end != "done" and reason != trial.reason:
                yield f"the reason is to be {trial.reason}; it is {reason}: {sentence}"

    def _of_facts(self) -> Iterator[str]:
        for what, wanted in self._trial.facts.items():
            found = self._fact(what)
            if found != wanted:
                yield f"{what} is to be {shown(wanted)} at the end; it is {shown(found)}"
        for place, parts in self._trial.parts.items():
            cells = self._watched.truth.places.cells.values()
            count = next((each.parts[place] for each in cells if place in each.parts), None)
            if count is None:
                yield f"{place} is to have {counted(parts, 'part')} at the end; it is no place"
            elif count != parts:
                to_have, has = counted(parts, "part"), counted(count, "part")
                yield f"{place} is to have {to_have} at the end; it has {has}"

    def _of_acts(self, acts: Sequence[str]) -> Iterator[str]:
        for act, (least, most) in self._trial.acts.items():
            times = sum(_means(act, each) for each in acts)
            if not least <= times <= most:
                yield wording.often(act, times, least, most)
        rest = iter(acts)
        for act in self._trial.order:
            if not any(_means(act, each) for each in rest):
                order, was = ", ".join(self._trial.order), ", ".join(acts)
                yield f"the order of what is done is to be '{order}'; it is '{was}'"
                return

    def _of_time(self) -> Iterator[str]:
        most, took = self._trial.in_s, self._ended_at - ASKED_AT_S
        if most is not None and took > most:
            yield f"it is to take at most {most:g} s; it takes {took:.1f} s"


def _plain(name: str) -> str:
    """The name of an act, as exercises write it: `mill run 1001`."""
    return name.replace(": doing ", " ", 1).replace(": ", " ", 1)


def _joined(*words: str) -> str:
    return ": ".join(each for each in words if each)


def _means(act: str, done: str) -> bool:
    """True if what is done is an act of this name, whatever its values."""
    return done == act or done.startswith(f"{act} ")
