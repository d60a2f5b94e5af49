"""Moment of a breach: the tree of the cell then, and where its devices truly were."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from arboleda.views import tree_view

from ..from_above import FloorPlan, Scene
from .stage import Stage


@dataclass(frozen=True, kw_only=True)
class Moment(Scene):
    """Moment: the devices as they truly were, and the rows of the tree."""

    tree: Sequence[dict[str, Any]] = ()


class Witness:
    """Witness of a stage: keeps the tree of its cell as it was last, before anything judges the step."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._tree: Sequence[dict[str, Any]] = ()
        stage.world.watchers.insert(0, self._look)

    def _look(self) -> None:
        run = self._stage.run
        if run.tree is not None:
            self._tree = tree_view.rows(run.tree, self._stage.world.now)

    @property
    def moment(self) -> Moment:
        """The moment at which the run stands now."""
        stage = self._stage
        scene = FloorPlan(stage.world.model, stage.cell.name).scene(stage.watched)
        return Moment(tree=self._tree, **vars(scene))
