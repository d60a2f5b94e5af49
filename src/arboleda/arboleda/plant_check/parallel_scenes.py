"""Scenes of steps at the same time: the changes that each may make, and the scene after all of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from py_trees.behaviour import Behaviour

from .foresight import CHANGE, LEAST, MOST, OF_PLACES, Scene, SceneKey
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
        """The scene in which a branch begins, without all that other branches may change meanwhile."""
        others = [keys for each, keys in enumerate(self.keys) if each != number]
        return self.begin.without(set().union(*others))

    def merged(self, ends: Sequence[Scene]) -> Scene:
        """The scene after all branches; `ends` has the scene in which each branch ended."""
        everything = set().union(*self.keys)
        values = dict(self.begin.without(everything).values)
        for number, end in enumerate(ends):
            others = set().union(*(keys for each, keys in enumerate(self.keys) if each != number))
            values |= {key: value for key, value in end.values.items() if key not in others}
        return Scene(values=values).put(self._sums())

    def _changed(self, walk: Walkthrough, branch: Behaviour, ends: Sequence[Scene]) -> set[SceneKey]:
        """The facts that a branch may change, and the places at which some end of it differs."""
        keys, places = walk.touched(branch), walk.foresight.places if ends else ()
        same = {
            target
            for target in places
            if all(
                end.get(target, what) == self.begin.get(target, what) for end in ends for what in OF_PLACES
            )
        }
        return {(name, what) for name, what in keys if not (what in OF_PLACES and name in same)}

    def _sums(self) -> Mapping[SceneKey, int]:
        """The changes of the number of parts at places where several branches have worked."""
        sums: dict[SceneKey, int] = {}
        for target, what in set().union(*self.keys):
            by = [ends for ends, keys in zip(self.alone, self.keys, strict=True) if (target, what) in keys]
            before = self.begin.get(target, what)
            if what != CHANGE or len(by) < 2 or before is None:
                continue
            changes = [{end.get(target, CHANGE) for end in ends} for ends in by]
            if all(len(each) == 1 and None not in each for each in changes):
                total = int(before) + sum(int(next(iter(each)) or 0) - int(before) for each in changes)
                least, most = int(self.begin.get(target, LEAST) or 0), int(self.begin.get(target, MOST) or 0)
                sums |= {(target, CHANGE): total, (target, LEAST): min(least, total)}
                sums[target, MOST] = max(most, total)
        return sums
