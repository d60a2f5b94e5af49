"""Scenes of steps at the same time: what the others of them may change, and what is sure after all."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from py_trees.behaviour import Behaviour

from .scene import CHANGE, LEAST, MOST, OF_PLACES, Key, Scene
from .walkthrough import Walkthrough


class Branches:
    """Branches of a parallel that begins in one scene."""

    def __init__(self, walk: Walkthrough, branches: Sequence[Behaviour], begin: Scene) -> None:
        self.begin = begin
        self.alone = [walk.apart().follow(branch, [begin]).passed for branch in branches]
        self.keys = [
            self._changed(walk, branch, ends) for branch, ends in zip(branches, self.alone, strict=True)
        ]

    def begin_of(self, number: int) -> Scene:
        """The scene in which a branch begins, without what others may change meanwhile."""
        others = [keys for each, keys in enumerate(self.keys) if each != number]
        return self.begin.without(set().union(*others))

    def merged(self, ends: Sequence[Scene]) -> Scene:
        """The scene after all branches, each of which has ended in its own."""
        everything = set().union(*self.keys)
        found = dict(self.begin.without(everything).known)
        for number, end in enumerate(ends):
            others = set().union(*(keys for each, keys in enumerate(self.keys) if each != number))
            found |= {key: value for key, value in end.known.items() if key not in others}
        return Scene(known=found).put(self._sums())

    def _changed(self, walk: Walkthrough, branch: Behaviour, ends: Sequence[Scene]) -> set[Key]:
        """The facts and places that a branch may change; of places only those at which some end differs."""
        keys, places = walk.touched(branch), walk.foresight.places if ends else ()
        same = {
            target
            for target in places
            if all(
                end.get(target, what) == self.begin.get(target, what) for end in ends for what in OF_PLACES
            )
        }
        return {(name, what) for name, what in keys if not (what in OF_PLACES and name in same)}

    def _sums(self) -> Mapping[Key, int]:
        """The parts that came and went at places where several branches have worked."""
        found: dict[Key, int] = {}
        for target, what in set().union(*self.keys):
            by = [ends for ends, keys in zip(self.alone, self.keys, strict=True) if (target, what) in keys]
            before = self.begin.get(target, what)
            if what != CHANGE or len(by) < 2 or before is None:
                continue
            changes = [{end.get(target, CHANGE) for end in ends} for ends in by]
            if all(len(each) == 1 and None not in each for each in changes):
                total = int(before) + sum(int(next(iter(each)) or 0) - int(before) for each in changes)
                least, most = int(self.begin.get(target, LEAST) or 0), int(self.begin.get(target, MOST) or 0)
                found |= {(target, CHANGE): total, (target, LEAST): min(least, total)}
                found[target, MOST] = max(most, total)
        return found
