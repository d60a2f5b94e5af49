"""Scene of a recipe: what is known at some moment of a way through it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from arboleda.model.facts import Value

HELD, TAKEN, AT, OVER = "=held", "=taken", "=at", "=over"
CHANGE, LEAST, MOST = "=change", "=least", "=most"
"""What is known besides facts: of a hand, whether it holds a part and where it took that; of a robot, at or
over which target it is; and of a place how many parts came and went."""
OF_PLACES = (CHANGE, LEAST, MOST)
Key = tuple[str, str]


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Scene: what is known at some moment of a way through a recipe; what is not in it is not certain."""

    known: Mapping[Key, Value] = field(default_factory=dict)

    def get(self, name: str, what: str) -> Value | None:
        return self.known.get((name, what))

    def put(self, changes: Mapping[Key, Value]) -> Scene:
        return Scene(known={**self.known, **changes})

    def without(self, keys: set[Key]) -> Scene:
        return Scene(known={key: value for key, value in self.known.items() if key not in keys})

    @cached_property
    def mark(self) -> frozenset[tuple[Key, Value]]:
        """The key that tells it from others."""
        return frozenset(self.known.items())


def common(scenes: Sequence[Scene]) -> tuple[Scene, ...]:
    """One scene with all that these have in common; none of none."""
    if len(scenes) < 2:
        return tuple(scenes)
    return (Scene(known=dict(frozenset.intersection(*(scene.mark for scene in scenes)))),)
