"""Walkthrough of a recipe's tree: the scenes after each of its steps, without running them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.engine import Act
from arboleda.model.by_class import nearest
from arboleda.model.facts import Value
from arboleda.recipes.handles import Ask
from arboleda.recipes.of_files import FileNode, Variables
from arboleda.recipes.place_questions import PlaceQuestion

from .foresight import ANSWER, ASKER, Foresight, Scene, SceneKey, common, still_holding

MOST_SCENES = 256  # that are followed at once
MOST_ROUNDS = 25  # of a repeat


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Outcome of a step: the scenes after it, by whether it succeeded, failed, or was skipped."""

    done: tuple[Scene, ...] = ()
    failed: tuple[Scene, ...] = ()
    skipped: tuple[Scene, ...] = ()

    @property
    def passed(self) -> tuple[Scene, ...]:
        """The scenes in which the next step of a sequence begins."""
        return self.done + self.skipped

    def plus(
        self, *, done: Iterable[Scene] = (), failed: Iterable[Scene] = (), skipped: Iterable[Scene] = ()
    ) -> Outcome:
        return Outcome(
            done=(*self.done, *done), failed=(*self.failed, *failed), skipped=(*self.skipped, *skipped)
        )

    def plus_all(self, other: Outcome) -> Outcome:
        return self.plus(done=other.done, failed=other.failed, skipped=other.skipped)

    def joined(self) -> Outcome:
        """The outcome with one scene for each result, which has the values that its scenes share."""
        passed = common(self.passed)
        return Outcome(
            done=passed if self.done else (),
            failed=common(self.failed),
            skipped=passed if self.skipped else (),
        )


Rule = Callable[["Walkthrough", Any, Sequence[Scene]], Outcome]
"""The outcome of a node of some class that begins in these scenes."""


@dataclass(kw_only=True)
class Walkthrough:
    """Walkthrough of one tree, by a rule for each class of nodes.

    `findings` are the objections on some path, each with the place of its node, if there is one. `doubts`
    counts conditions that cannot be decided in advance. Such a condition may decide alike when it is asked
    again, so its branches are joined where they meet: else impossible paths would be followed.
    """

    foresight: Foresight
    rules: Mapping[type[Behaviour], Rule]
    findings: dict[tuple[str | None, str], None] = field(default_factory=dict)
    place: str | None = None
    doubts: int = 0
    touched_by_node: dict[Behaviour, set[SceneKey]] = field(default_factory=dict)

    def follow(self, node: Behaviour, scenes: Sequence[Scene]) -> Outcome:
        """The outcome of a node that begins in one of these scenes."""
        begin = few(scenes)
        rule = nearest(self.rules, type(node))
        if not begin or rule is None:
            return self.unsure(node, begin) if begin else Outcome()
        before = self.doubts
        outcome = rule(self, node, begin)
        thin = Outcome(done=few(outcome.done), failed=few(outcome.failed), skipped=few(outcome.skipped))
        return thin if self.doubts == before else thin.joined()

    def unsure(self, node: Behaviour, scenes: Sequence[Scene]) -> Outcome:
        """The outcome of a node that may tick its children in any order, and break off anywhere."""
        self.doubts += 1
        blurred = self.blurred(node, scenes)
        for child in node.children:
            self.follow(child, blurred)
        return Outcome(done=blurred, failed=blurred, skipped=blurred)

    def check(self, act: Act, scenes: Sequence[Scene]) -> None:
        """Note the objections to a command in these scenes."""
        command = act.make(id="")
        for scene in scenes:
            for sentence in self.foresight.objections(command, scene):
                self.findings[self.place, sentence] = None

    def given_back(self, devices: Collection[str], scenes: Sequence[Scene]) -> Outcome:
        """The outcome of giving back shared devices, which fails where one of them holds a part."""
        empty = []
        for scene in scenes:
            held = still_holding(self.foresight, devices, scene)
            self.findings |= {(self.place, sentence): None for sentence in held}
            empty += [] if held else [scene]
        return Outcome(done=tuple(empty), failed=tuple(scenes))

    def blurred(self, node: Behaviour, scenes: Iterable[Scene]) -> tuple[Scene, ...]:
        """The scenes without all values that a part of a tree may change."""
        keys = self.touched(node)
        return few([scene.without(keys) for scene in scenes])

    def touched(self, node: Behaviour) -> set[SceneKey]:
        """The facts and places that a part of a tree may change."""
        if node not in self.touched_by_node:
            self.touched_by_node[node] = set(self._touched(node))
        return self.touched_by_node[node]

    def _touched(self, node: Behaviour) -> Iterator[SceneKey]:
        for each in node.iterate():
            if isinstance(each, FileNode):
                yield from map(key_of, each.writes)
            elif isinstance(each, PlaceQuestion):
                yield answer_key(each)
            elif isinstance(each, Act):
                yield answer_key(each)
                yield from self.foresight.touched(each.make(id=""))

    @contextmanager
    def at(self, place: str | None) -> Iterator[None]:
        """Context in which findings get this place."""
        before, self.place = self.place, place or self.place
        yield
        self.place = before

    def apart(self) -> Walkthrough:
        """A walkthrough like this one, with findings of its own."""
        return replace(self, findings={})


def answer_key(act: Behaviour) -> SceneKey:
    """The key of the answer to a question."""
    return act.id.hex, ANSWER


def last_answer_key(act: Act) -> SceneKey:
    """The key of the last answer to a question that a device is asked."""
    command = act.make(id="")
    return command.robot, command.word + ANSWER


def asked_by(step: Behaviour) -> dict[SceneKey, Value]:
    """The step that has asked a device last, once this one is done; empty for a step that asks nobody."""
    if not isinstance(step, Ask):
        return {}
    command = step.make(id="")
    return {(command.robot, command.word + ASKER): step.id.hex}


def last_answer(question: Behaviour, answer: Value) -> dict[SceneKey, Value]:
    """The last answer of a device or a person; empty where the plant's own books answer."""
    return {last_answer_key(question): answer} if isinstance(question, Ask) else {}


def key_of(variable: tuple[Variables, str]) -> SceneKey:
    """The key of a variable in scenes."""
    scope, name = variable
    return f"scope {id(scope)}", name


def first_values(tree: Behaviour) -> dict[SceneKey, Value]:
    """The values that variables have when the tree begins: parameters, and constants of subtrees."""
    scopes = {id(node.scope): node.scope for node in tree.iterate() if isinstance(node, FileNode)}
    return {key_of((each, name)): value for each in scopes.values() for name, value in each.values.items()}


def few(scenes: Iterable[Scene]) -> tuple[Scene, ...]:
    """The scenes, each once; where they are too many, one scene with the values that all share."""
    all_of_them = tuple(scenes)
    if len(all_of_them) < 2:
        return all_of_them
    distinct = tuple({scene.mark: scene for scene in all_of_them}.values())
    return distinct if len(distinct) <= MOST_SCENES else common(distinct)


def in_order(node: Behaviour) -> Iterator[Behaviour]:
    """The node and all below it, each before its children."""
    waiting = [node]
    while waiting:
        each = waiting.pop()
        yield each
        waiting += reversed(each.children)
