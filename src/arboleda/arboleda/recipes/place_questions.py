"""Places of a cell as a recipe asks for the parts there: each call returns a step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from py_trees.common import Status

from arboleda.engine import Await, Context
from arboleda.model.facts import Value
from arboleda.model.messages import Failure, Reason
from arboleda.model.sentence import Phrase, Sentence

from .errors import Offers
from .handles import Question, Step

HAS_PART = Phrase("step.has_part", "look for a part at {place}")
HAS_ROOM = Phrase("step.has_room", "look for room at {place}")
GETS_PART = Phrase("step.gets_part", "wait for a part at {place}")
GETS_ROOM = Phrase("step.gets_room", "wait for room at {place}")
NO_PART_YET = Phrase("recipe.no_part_yet", "no part came to {place} within {seconds:g} s")
NO_ROOM_YET = Phrase("recipe.no_room_yet", "{place} got no room for another part within {seconds:g} s")


class PlaceQuestion(Question):
    """A question about parts at a place; the plant's count of parts answers it with True or False."""

    answers = (True, False)
    told: bool | None = None

    def __init__(self, title: Sentence, is_so: Callable[[], bool]) -> None:
        super().__init__(title)
        self._is_so = is_so

    @property
    def answer(self) -> Value | None:
        return self.told

    def update(self) -> Status:
        self.told = self._is_so()
        return Status.SUCCESS

    def kept(self) -> Mapping[str, Any] | None:
        return None if self.told is None else {"answer": self.told}

    def restore(self, state: Mapping[str, Any]) -> None:
        self.told = state["answer"]


class PlaceHandle(Offers):
    """A place whose parts the plant counts: whether a part is there, and whether there is room."""

    def __init__(self, target: str, context: Context) -> None:
        self._target = target
        self._context = context

    def __str__(self) -> str:
        return self._target

    def has_part(self) -> Step:
        """A question for `choose`: True where a part is there."""
        return PlaceQuestion(HAS_PART(place=self._target), self._is_filled)

    def has_room(self) -> Step:
        """A question for `choose`: True where there is room for another part."""
        return PlaceQuestion(HAS_ROOM(place=self._target), self._is_free)

    def gets_part(self, *, at_most_s: float) -> Step:
        """Wait until a part is there, at most `at_most_s` s."""
        return self._wait(GETS_PART, self._is_filled, at_most_s, NO_PART_YET)

    def gets_room(self, *, at_most_s: float) -> Step:
        """Wait until there is room for another part, at most `at_most_s` s."""
        return self._wait(GETS_ROOM, self._is_free, at_most_s, NO_ROOM_YET)

    def _is_filled(self) -> bool:
        return self._context.places.is_filled(self._target)

    def _is_free(self) -> bool:
        return self._context.places.is_free(self._target)

    def _wait(self, title: Phrase, arrived: Callable[[], bool], at_most_s: float, late: Phrase) -> Step:
        sentence = late(place=self._target, seconds=at_most_s)
        failure = Failure(reason=Reason.DEADLINE, sentence=sentence)
        return Await(title(place=self._target), self._context, arrived, at_most_s, lambda: failure)
