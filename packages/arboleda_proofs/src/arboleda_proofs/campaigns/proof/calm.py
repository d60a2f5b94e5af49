"""Calm runs: a scenario where nothing goes wrong, from which its instants and its end are read."""

from __future__ import annotations

from collections import deque
from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass, replace

from arboleda.drivers import Command, Query, Value, VerbCommand
from arboleda.engine import Entry
from arboleda.engine.inspection import Question, ledger_of
from arboleda.model.common_places import room_at, same_places
from arboleda.model.messages import OperatorAnswer, TaskChanged
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check.findings import PlantFinding, Source
from arboleda.rig.plant_process import Fuse, Side

from ...simulator.branch_numbers import numbers
from .end_state import EndState
from .instants import Instant, Mark, instants
from .outcome import End, Run
from .scenario import Scenario
from .sights import Sights, Watch
from .stage import ASKED_AT_S, Stage, entry_name

FAR = 10**9  # commits: as many as no run has
MOST_SCENARIOS = 64  # of one recipe, with all answers


@dataclass(frozen=True, kw_only=True)
class Calm:
    """Calm run of a scenario: what came of it, its instants, its commands, what was so when it was done.

    `finding` is what went wrong although nothing had: a command that was refused, a task that failed and was
    not to. `again` is what came of the same task a second time, empty where that was done.
    `questions` are those who were asked something, with the answers that they did not give. `lacks` is the
    place at which the task was to take a part and had none.
    """

    scenario: Scenario
    run: Run
    why: str
    instants: tuple[Instant, ...]
    commands: tuple[str, ...]
    state: EndState
    lasts_s: float
    questions: tuple[tuple[str, tuple[Value, ...]], ...]
    sights: Sights
    finding: str = ""
    again: str = ""
    lacks: str | None = None

    @property
    def is_sound(self) -> bool:
        """True if its task ends as it is written, by an answer even badly, and nothing is broken or found."""
        end = self.run.outcome.end
        as_written = end is End.FAILED and bool(self.scenario.answers)
        return self.run.outcome.broken is None and not self.finding and (end is End.DONE or as_written)


class _Marks:
    """Takes down what happens on a stage, until its task has ended."""

    def __init__(self, stage: Stage) -> None:
        self.rows: list[Mark] = []
        self.questions: dict[str, tuple[Value, ...]] = {}
        self._stage, self._what = stage, "the request"
        self._fuse = Fuse(FAR, Side.AFTER, lambda: None)
        self._counted = FAR
        self._ended = False
        self._numbers = numbers(stage.world.model)
        stage.world.plant_process.fuses.append(self._fuse)
        stage.world.watchers.append(self._look)

    def _look(self) -> None:
        if self._ended:
            return
        moment, truth = self._stage.world.moment, self._stage.watched.truth
        commits, self._counted = self._counted - self._fuse.count, self._fuse.count
        begins = False
        for message in moment.sent:
            begins |= self._begins(message)
        for entry in self._stage.new_questions:
            begins = True
            self._ask(entry)
        ended = [each for each in truth.books.ended if each.entry.cell == self._stage.cell.name]
        reports = any(isinstance(each, TaskChanged | OperatorAnswer) for each in moment.sent)
        if begins or ended or reports or moment.requests or moment.executed or commits:
            what = f"the end of {entry_name(ended[0].entry)}" if ended and not begins else self._what
            at = self._stage.watched.seconds
            self.rows.append(Mark(at=at, what=what, begins=begins, commits=commits))
        self._ended = self._stage.ended

    def _begins(self, message: object) -> bool:
        entry = ledger_of(self._stage.world.plant).entries.get(getattr(message, "id", ""))
        if not isinstance(message, Command) or entry is None:
            return False
        self._ask(entry)
        return True

    def _ask(self, entry: Entry) -> None:
        """Take down a step that begins, and what can be answered where it asks something."""
        self._what, command = entry_name(entry), entry.command
        if isinstance(command, Question):
            self.questions[command.robot] = tuple(command.answers)
        elif isinstance(command, VerbCommand) and isinstance(command, Query):
            listed = command.definition.answers
            self.questions[command.robot] = listed or self._numbers[command.robot, command.verb]


def calm_run(model: PlantModel, scenario: Scenario) -> Calm:
    """Run a scenario where nothing goes wrong."""
    stage = Stage(model, scenario)
    marks, watch = _Marks(stage), Watch(stage)
    run = calm_play(stage)
    finding = next((f"{each.step}: {each.sentence}" for each in stage.watched.findings.found), "")
    rows = [Mark(at=ASKED_AT_S, what="the request", begins=True, commits=0), *marks.rows]
    given = dict(scenario.answers)
    questions = {
        who: tuple(each for each in words if each != given.get(who, words[0]))
        for who, words in marks.questions.items()
    }
    calm = Calm(
        scenario=scenario,
        run=run,
        finding=finding,
        why="" if stage.last_change is None else str(stage.last_change.sentence),
        instants=tuple(instants(rows)),
        commands=tuple(stage.commands),
        state=stage.state,
        lasts_s=rows[-1].at - ASKED_AT_S,
        questions=tuple(questions.items()),
        sights=watch.sights,
        lacks=stage.lacks,
    )
    return replace(calm, again=stage.again(calm.lasts_s)) if run.outcome.end is End.DONE else calm


def calm_play(stage: Stage) -> Run:
    """Run the task of a stage, where nothing goes wrong, to its end."""
    return stage.play(ASKED_AT_S, lambda: None, expected={}, commands=None, lasts_s=0.0)


def calm_runs(model: PlantModel, scenarios: Iterable[Scenario]) -> Iterator[Calm]:
    """The calm runs of scenarios, and of each answer in them after which something else is done.

    A part that a task lacks at a place of several cells, where another may put one, is brought first.
    """
    for first in scenarios:
        known: set[Hashable] = set()
        waiting, tried = deque([first]), {first.answers}
        while waiting and len(known) < MOST_SCENARIOS:
            calm = calm_run(model, waiting.popleft())
            if calm.lacks is not None and _others_may_bring(model, calm.scenario, calm.lacks):
                waiting.appendleft(calm.scenario.with_part(calm.lacks))
                continue
            ending = calm.commands, calm.run.outcome.end
            if ending in known:
                continue
            known.add(ending)
            yield calm
            for who, words in calm.questions:
                others = [calm.scenario.with_answer(who, word) for word in words]
                waiting += [each for each in others if each.answers not in tried]
                tried |= {each.answers for each in others}


def _others_may_bring(model: PlantModel, scenario: Scenario, place: str) -> bool:
    """True for a place that has room beside what is brought, and is one of another cell, too."""
    cell = model.cell(scenario.cell)
    room = room_at(cell, place, model.cells) - scenario.brought.count(place)
    return room > 0 and any(same_places(cell, place, other) for other in model.cells)


def run_findings(calm: Calm) -> Iterator[PlantFinding]:
    """The findings of a run without faults, and of the same task once more."""
    outcome, task = calm.run.outcome, calm.scenario.name
    if not calm.is_sound:
        words = outcome.broken[1] if outcome.broken else calm.finding or outcome.words
        yield PlantFinding(source=Source.RUN, sentence=f"{task}: {words}", task=task)
    elif calm.again:
        yield PlantFinding(source=Source.RUN, sentence=f"{task}, once more: {calm.again}", task=task)
