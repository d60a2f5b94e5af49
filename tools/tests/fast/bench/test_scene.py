"""The scene of a benchmark: states of its nodes, and what is said of what never becomes ready."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ArboledaError
from arboleda_bench.scene import Scene, wait_for


class StillScene(Scene):
    """A scene that starts nothing and keeps how it would have."""

    def __init__(self) -> None:
        super().__init__(quick=True, say=lambda _said: None)
        self.calls: list[tuple[str, ...]] = []

    def python(self, module: str, *args: str, name: str = "") -> None:  # type: ignore[override]
        self.calls.append(args)


def test_no_node_finds_the_tasks_of_the_one_before():
    with StillScene() as scene:
        scene.node("orchestrator", Path("plant_1.yaml"))
        scene.node("orchestrator", Path("plant_10.yaml"))
        states = {word for words in scene.calls for word in words if word.startswith("state_dir:=")}
    assert len(states) == 2


def test_what_is_missing_is_named_as_it_is_at_the_end():
    missing = ["c1", "c2"]

    def ready() -> bool:
        missing.clear()
        missing.append("c2")
        return False

    with pytest.raises(ArboledaError, match="c2 is not ready after 0 s"):
        wait_for(ready, lambda: ", ".join(missing), limit_s=0.0)
