"""Forms of a drawn plant: its recipes in Python and as trees in XML, which have to do the same.

PYTHONPATH=tools:tools/drawn .venv/bin/python -m arboleda_drawn.forms COUNT [FIRST]

says where the plants of COUNT seeds from seed FIRST on (1) differ.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import zip_longest

from arboleda.drivers import Command
from arboleda.model.commands import Question
from arboleda.model.errors import ConfigError
from arboleda.model.messages import TaskChanged, TaskState, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import World
from arboleda_proofs.simulator.chance import Dice
from arboleda_proofs.simulator.people import answer_anything, any_text
from frame.words import words

from . import devices
from .devices import DrawnDevices, Form, can_be_xml
from .plants import loaded

TASKS = 2
LONGEST_S = 1500.0
THINKS_S = 1.5  # a person who is asked
ENDED = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED, TaskState.REFUSED)


@dataclass(frozen=True, kw_only=True)
class Conduct:
    """Conduct of a plant: how each task ended, and what each device was told, in order."""

    ends: list[str] = field(default_factory=list)
    commands: dict[str, list[str]] = field(default_factory=dict)


def differences(drawn: DrawnDevices, seed: int) -> list[str]:
    """Differences between what both forms of a plant do, without faults; empty where XML cannot say it."""
    if not all(map(can_be_xml, drawn.recipes)):
        return []
    python, xml = (loaded(replace(drawn, form=form)).model for form in (Form.PYTHON, Form.XML))
    return differences_of(python, xml, seed)


def differences_of(python: PlantModel, xml: PlantModel, seed: int) -> list[str]:
    """Differences between what two plants do, without faults, that only differ in the form of recipes."""
    texts = _texts(python, seed)
    one, other = (_Play(model, seed).play(texts) for model in (python, xml))
    return [*_differing("task", one.ends, other.ends), *_commands(one, other)]


def _texts(model: PlantModel, seed: int) -> list[str]:
    dice = Dice(seed, "tasks of both forms")
    return [any_text(model.cells[0], dice) for _ in range(TASKS)]


def _commands(python: Conduct, xml: Conduct) -> Iterator[str]:
    for robot in sorted(python.commands.keys() | xml.commands.keys()):
        yield from _differing(robot, python.commands.get(robot, []), xml.commands.get(robot, []))


def _differing(what: str, python: list[str], xml: list[str]) -> Iterator[str]:
    """The first difference of two rows."""
    for number, (one, other) in enumerate(zip_longest(python, xml, fillvalue="nothing"), 1):
        if one != other:
            yield f"{what} {number}: Python {one}, XML {other}"
            return


class _Play:
    """Plays the tasks of one form one after the other; devices and persons answer by the seed."""

    def __init__(self, model: PlantModel, seed: int) -> None:
        self._conduct = Conduct()
        self._world = World(model)
        self._people = {each.name: Dice(seed, "says", each.name) for each in model.robots.values()}
        self._questions: set[str] = set()
        self._world.watchers.append(self._look)
        answer_anything(self._world, seed)

    def play(self, texts: list[str]) -> Conduct:
        self._world.advance(2.0)
        for number, text in enumerate(texts, 1):
            self._world.request_task(text)
            self._world.advance(LONGEST_S, lambda ended=number: len(self._conduct.ends) >= ended)  # type: ignore[misc]
            self._world.advance(5.0)
        return self._conduct

    def _look(self) -> None:
        for message in self._world.moment.sent:
            if isinstance(message, TaskChanged) and message.state in ENDED:
                self._conduct.ends.append(f"{message.text}: {message.state.value}")
            elif isinstance(message, Question):
                self._ask(message)
            if isinstance(message, Command):
                self._conduct.commands.setdefault(message.robot, []).append(_words(message))

    def _ask(self, question: Question) -> None:
        answer = self._people[question.robot].pick(question.answers)
        self._world.at(self._world.now + THINKS_S, self._answer, (question.robot, answer))

    def _answer(self, answer: tuple[str, str]) -> None:
        self._world.request_verb(Verb.ANSWER, answer[0], arguments=(("answer", answer[1]),))


def _words(command: Command) -> str:
    given = {name: _number(value) for name, value in command.given.items() if name != "definition"}
    return f"{type(command).__name__}{given}"


def _number(value: object) -> object:
    """A whole number as any other: XML has 30.0 where Python has 30."""
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value


def run(seeds: range) -> int:
    """Compare the plants of these seeds that both forms can say; the number of those that differ."""
    differing = 0
    for seed in seeds:
        try:
            found = differences(devices.draw(seed), seed)
        except ConfigError:  # what `arboleda check` refuses is not simulated either
            continue
        differing += bool(found)
        for each in found:
            print(f"seed {seed}: {each}", flush=True)
    return differing


def main() -> int:
    count, first = words(__doc__, int, 1)
    differing = run(range(first, first + count))
    print(f"{count} seeds: {differing} plants differ")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
