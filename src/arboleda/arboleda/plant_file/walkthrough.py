"""Walkthrough of a recipe's tree: the scenes after each of its steps, without running them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.bt_xml.running.node import Node
from arboleda.engine import Act
from arboleda.model.by_class import nearest
from arboleda.recipes.place_questions import PlaceQuestion

from .foresight import Foresight
from .scene import Key, Scene, common
from .scene_variables import key_of

MOST_SCENES = 256  # that are followed at once
MOST_ROUNDS = 25  # of a repeat
ANSWER = "=answer"


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Outcome of a step: the scenes in which it can have succeeded, failed, or been skipped."""

    done: tuple[Scene, ...] = ()
    failed: tuple[Scene, ...] = ()
    skipped: tuple[Scene, ...] = ()

    @property
    def passed(self) -> tuple[Scene, ...]:
        """The scene in which the next step of a sequence begins."""
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
        """The same without the marks that tell one way from another."""
        passed = common(self.passed)
        return Outcome(
            done=passed if self.done else (),
            failed=common(self.failed),
            skipped=passed if self.skipped else (),
        )


Rule = Callable[["Walkthrough", Any, Sequence[Scene]], Outcome]
"""What becomes of scenes in a node of some class."""


@dataclass(kw_only=True)
class Walkthrough:
    """Walkthrough of one tree, by a rule for each class of nodes.

    `findings` has what is wrong on some way, and the place of its node, if that is known. `doubts` counts the
    conditions that cannot be decided in advance: what follows from one may follow from it again, so the ways
    that it parts are one from where they meet.
    """

    foresight: Foresight
    rules: Mapping[type[Behaviour], Rule]
    findings: dict[tuple[str | None, str], None] = field(default_factory=dict)
    place: str | None = None
    doubts: int = 0
    known_touched: dict[Behaviour, set[Key]] = field(default_factory=dict)

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
        """The outcome of a node whose children are ticked in an order, and so far, as nobody knows."""
        self.doubts += 1
        found = self.blurred(node, scenes)
        for child in node.children:
            self.follow(child, found)
        return Outcome(done=found, failed=found, skipped=found)

    def check(self, act: Act, scenes: Sequence[Scene]) -> None:
        """Note the objections to a command in these scenes."""
        command = act.make(id="")
        for scene in scenes:
            for sentence in self.foresight.objections(command, scene):
                self.findings[self.place, sentence] = None

    def blurred(self, node: Behaviour, scenes: Iterable[Scene]) -> tuple[Scene, ...]:
        """The scenes without what a part of a tree may change, halfway or in any order."""
        keys = self.touched(node)
        return few([scene.without(keys) for scene in scenes])

    def touched(self, node: Behaviour) -> set[Key]:
        """The facts and places that a part of a tree may change."""
        if node not in self.known_touched:
            self.known_touched[node] = set(self._touched(node))
        return self.known_touched[node]

    def _touched(self, node: Behaviour) -> Iterator[Key]:
        for each in node.iterate():
            if isinstance(each, Node):
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
        """The same, whose findings are its own."""
        return replace(self, findings={})


def answer_key(act: Behaviour) -> Key:
    """The key of the answer to a question."""
    return act.id.hex, ANSWER


def few(scenes: Iterable[Scene]) -> tuple[Scene, ...]:
    """The scenes, each once; of too many what they have in common."""
    all_of_them = tuple(scenes)
    if len(all_of_them) < 2:  # as mostly
        return all_of_them
    distinct = tuple({scene.mark: scene for scene in all_of_them}.values())
    return distinct if len(distinct) <= MOST_SCENES else common(distinct)


def in_order(node: Behaviour) -> Iterator[Behaviour]:
    """The node and all below it, each before its children."""
    rest = [node]
    while rest:
        each = rest.pop()
        yield each
        rest += reversed(each.children)
