from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import pytest

from arboleda.dashboard.faces import Face
from arboleda.dashboard.page_state import PageState
from arboleda.testing import Rig, shipped
from arboleda.views import view

LINKS: dict[str, Any] = {
    "broker": {"address": "here:1883", "connected": True},
    "ros": None,
    "refused": {},
    "standbys": [],
}


class Told(Rig):
    """A plant whose story is told where it changes, and when somebody looks at its face."""

    def __init__(self, *, past_acts: Sequence[dict[str, Any]] = (), **changes: Any) -> None:
        self.story: PageState | None = None
        self._told = -1
        super().__init__(shipped(**changes))
        self.story = PageState(view.layout(self.plant.model), list(past_acts))
        self.wait(0.5)

    def _keep(self) -> None:
        super()._keep()
        if self.story is not None and self.plant.version != self._told:
            self._tell(self.story)

    def _tell(self, story: PageState) -> None:
        self._told = self.plant.version
        story.see(view.snapshot(self.plant), 1000.0 + self.plant.now)

    def face(self, language: str = "en", **links: Any) -> Face:
        assert self.story is not None
        self._tell(self.story)
        return self.story.face(language, LINKS | links)

    def statuses(self, cell: str = "sis_a") -> dict[str, str]:
        """What the page shows of each node, by the node's name; of equal names the last."""
        assert self.story is not None
        tree = self.story.trees[cell]
        return {str(row["name"]): tree.statuses[row["path"]] for row in tree.rows}


@pytest.fixture
def told() -> Callable[..., Told]:
    return Told
