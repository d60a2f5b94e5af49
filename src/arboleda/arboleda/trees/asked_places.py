"""Places in question: a failed task has left them full, and nobody has said since what is there."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from arboleda.model.plant_model import Place
from arboleda.model.sentence import Sentence


class AskedPlaces:
    """Places of a cell of which a person has to say whether a part is still there.

    A task that fails may leave a place full that the next task fills. People may have taken that part out
    without a word, or a hand may have found none there, so whether it is still there is a question, which
    keeps the next task from beginning.
    `parts` are the books, which go on changing; `changed` has them kept. `trouble` names the full or empty
    place for which the last task failed.
    """

    def __init__(
        self, places: Mapping[str, Place], parts: Mapping[str, int], changed: Callable[[], None]
    ) -> None:
        self._places = places
        self._parts = parts
        self._changed = changed
        self._known: dict[str, int] = {}  # as the last task began, or as a person has said since
        self._failed = False  # the last task
        self.trouble: Sentence | None = None

    @property
    def targets(self) -> tuple[str, ...]:
        """The places in question now."""
        return tuple(filter(self._is_filled_since, self._places)) if self._failed else ()

    @property
    def known(self) -> dict[str, int]:
        """The numbers of parts known at places, for `take_over`; without those that go without saying."""
        known = ((target, n) for target, n in self._known.items() if target in self._places)
        return {target: n for target, n in known if n != self._unused(target)}

    def take_over(self, asked: Collection[str], known: Mapping[str, int]) -> None:
        """Take the questions of an earlier start, and the numbers it knew, which older books lack."""
        self._failed = bool(asked)
        self._known = {target: n for target, n in self._parts.items() if asked and target not in asked}
        self._known |= known

    def begin(self) -> None:
        """Begin a task: the books are as people have left the places."""
        self._known, self._failed, self.trouble = dict(self._parts), False, None

    def fail(self) -> None:
        """End a task that is not done: nobody knows whether people take out what it has left."""
        self._failed = True
        if self.targets:
            self._changed()

    def note(self, trouble: Sentence | None) -> None:
        """Note the place for which a task has failed; None where it ended otherwise."""
        self.trouble = trouble

    def answer(self, parts: Mapping[str, int]) -> None:
        """Take a person's word on how many parts are at places; an output in question has to be emptied."""
        self._known |= {target: n for target, n in parts.items() if not self.is_output(target)}
        if self.trouble is not None and self.trouble.values["place"] in parts:
            self.trouble = None

    def doubt(self, target: str) -> None:
        """Take in that a hand that was to take a part from a place has none: there may be none either."""
        place = self._places.get(target)
        if place is not None and not place.supply:
            self._known[target] = min(self._known_at(target), place.holds - 1)

    def moved_by_others(self, target: str, parts: int) -> None:
        """Count what another cell put at a place of both, or took there: the last task has no part in it."""
        self._known[target] = max(self._known_at(target) + parts, 0)

    def is_output(self, target: str) -> bool:
        """True for a place that people empty before each task."""
        return target in self._places and self._places[target].output

    def _is_filled_since(self, target: str) -> bool:
        parts = self._parts[target]
        return parts >= self._places[target].holds and parts > self._known_at(target)

    def _known_at(self, target: str) -> int:
        return self._known.get(target, self._unused(target))

    def _unused(self, target: str) -> int:
        place = self._places[target]
        return place.holds if place.supply else 0
