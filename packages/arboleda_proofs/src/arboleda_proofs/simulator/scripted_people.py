"""Script of people: tasks and operators' verbs that a file gives, each at its time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from arboleda.model import text as task_text
from arboleda.model.messages import ENDED, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.verbs import Arguments, as_text, from_text
from arboleda.recipes import TextError
from arboleda.rig.hands import BEFOREHAND
from arboleda.rig.manual_work import BY_HAND_S
from arboleda.rig.world import World

from .checks import BadFaults, is_number, only, within
from .cycles import has_told

KEYS = ("at", "task", "do")
HAND = "--by-hand"
EXAMPLE = '[{"at": 2, "task": "..."}, {"at": 9.5, "do": "stop ..."}]'


@dataclass(frozen=True, kw_only=True)
class Act:
    """One act of a script: a `task`, or a `verb` on a scope, `at` s after the run began."""

    at: float
    task: str | None = None
    verb: Verb | None = None
    scope: str = ""
    by_hand: bool = False
    arguments: Arguments = ()

    @property
    def words(self) -> str:
        """The verb as an operator types it."""
        if self.verb is None:
            return ""
        of = as_text(self.verb, self.scope, self.arguments)
        return " ".join(word for word in (self.verb.value, of, HAND if self.by_hand else "") if word)


@dataclass(frozen=True, kw_only=True)
class Script:
    """All acts of people, in order. For `seconds` nobody does anything else; None: until the last act."""

    acts: tuple[Act, ...]
    seconds: float | None = None

    @property
    def ends(self) -> float:
        """The time from which an attendant sees to the cells, in s since the run began."""
        last = self.acts[-1].at if self.acts else 0.0
        return last if self.seconds is None else self.seconds


def script_from(model: PlantModel, data: Any) -> Script | None:
    """The script in a file, or None if it has none; raises BadFaults with the place of the first bad act."""
    if not isinstance(data, dict) or "people" not in data:
        return None
    seconds = data.get("seconds")
    if seconds is not None and (not is_number(seconds) or seconds <= 0):
        raise BadFaults("seconds is how long people only do what is told, more than 0", "seconds")
    with within("people"):
        return Script(acts=_acts(model, data["people"]), seconds=seconds)


def _acts(model: PlantModel, data: Any) -> tuple[Act, ...]:
    if not isinstance(data, list):
        raise BadFaults(f"people is not a list, e.g. {EXAMPLE}")
    acts: list[Act] = []
    for number, each in enumerate(data):
        with within(number):
            acts.append(_act(model, each))
    ids = {act.task.rpartition("#")[2] for act in acts if act.task and "#" in act.task}
    for number, act in enumerate(acts):
        with within(number, "do"):
            _check_scope(model, act, ids)
    return tuple(sorted(acts, key=lambda act: act.at))


def _act(model: PlantModel, data: Any) -> Act:
    entry = only(data, KEYS, "what somebody does")
    if not is_number(entry.get("at")) or entry["at"] < 0:
        raise BadFaults("at is in s since the run began, 0 or more", "at")
    if ("task" in entry) == ("do" in entry):
        raise BadFaults("either a task or what an operator does is needed: task or do")
    what = "task" if "task" in entry else "do"
    if not isinstance(entry[what], str):
        raise BadFaults(f"{what} is {entry[what]!r}; a text is needed", what)
    with within(what):
        return _task(model, entry["at"], entry["task"]) if what == "task" else _verb(entry["at"], entry["do"])


def _task(model: PlantModel, at: float, text: str) -> Act:
    try:
        task_text.alternatives(text, model)
    except TextError as error:
        raise BadFaults(str(error)) from None
    return Act(at=at, task=text)


def _verb(at: float, text: str) -> Act:
    verb, *words = text.split() or [""]
    if verb not in [each.value for each in Verb]:
        raise BadFaults(f"{verb!r} is nothing that operators do; there are {', '.join(Verb)}")
    scope, arguments = from_text(Verb(verb), " ".join(word for word in words if word != HAND))
    return Act(at=at, verb=Verb(verb), scope=scope, by_hand=HAND in words, arguments=arguments)


def scopes(model: PlantModel) -> tuple[str, ...]:
    """The scopes that an operator's verb may name, besides the whole plant and tasks."""
    return (*(cell.name for cell in model.cells), *model.robots, *model.zones)


def _check_scope(model: PlantModel, act: Act, ids: set[str]) -> None:
    word = act.scope.partition(" ")[0]
    if word and word not in ids and word not in scopes(model):
        allowed = ", ".join(scopes(model))
        raise BadFaults(f"{word!r} is nothing of this plant, and no task of the file; there are {allowed}")


class ScriptedPeople:
    """Performs a script, as `Customers` brings drawn tasks: `cycles` and `outcomes` are of tasks that ended.

    `attend` is called once, when the script is over or at `go`.
    """

    def __init__(self, world: World, script: Script, attend: Callable[[], object]) -> None:
        self.cycles = 0
        self.outcomes: dict[str, int] = {}
        self._world = world
        self._attend = attend
        self._gone = False
        self._left = len(script.acts)
        self._open: set[str] = set()
        self._started: dict[str, float] = {}
        world.watchers.append(self._look)
        for act in script.acts:
            if act.by_hand and act.verb in BEFOREHAND:
                by_hand = partial(BEFOREHAND[act.verb], world.manual)
                world.at(world.now + max(0.0, act.at - BY_HAND_S), by_hand, act.scope)
            world.at(world.now + act.at, self._do, act)
        world.at(world.now + script.ends, lambda _: self.go())

    @property
    def over(self) -> bool:
        """True once every act is done and each task has ended."""
        return not self._left and not self._open

    def go(self) -> None:
        """Do nothing more, and leave the plant to its attendant."""
        if not self._gone:
            self._gone = True
            self._attend()

    def _do(self, act: Act) -> None:
        if self._gone:
            return
        self._left -= 1
        if act.task is not None:
            self._world.request_task(act.task)
        elif act.verb is not None:
            self._world.request_verb(act.verb, act.scope, by_hand=act.by_hand, arguments=act.arguments)

    def _look(self) -> None:
        moment = self._world.moment
        for message in (*moment.last_words, *moment.sent):
            if isinstance(message, TaskChanged) and message.task:
                self._follow(message)

    def _follow(self, change: TaskChanged) -> None:
        if change.state not in ENDED:
            self._open.add(change.task)
            if change.state is TaskState.RUNNING:
                self._started.setdefault(change.task, self._world.now)
            return
        self._open.discard(change.task)
        if change.task in self._started:
            self.cycles += has_told(self._world, change.cell, self._started.pop(change.task))
            outcome = change.reason.value if change.reason else change.state.value
            self.outcomes[outcome] = self.outcomes.get(outcome, 0) + 1
