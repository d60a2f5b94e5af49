"""What a plant can be put together from."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

import pytest
from tests.added_package import COUNTER, install

from arboleda.runtime.build import TURN_S, Options, build
from arboleda.testing import shipped


@pytest.fixture
def thawed() -> Iterator[None]:
    """Nothing is left out of garbage collection, as where a plant is a process of its own; nothing looks at
    all that other tests have made."""
    gc.unfreeze()
    with mock.patch.object(gc, "collect"):
        yield
    gc.freeze()


def test_what_was_there_before_a_plant_starts_is_left_out_of_garbage_collection(
    thawed: None, tmp_path: Path
) -> None:
    app = build(shipped(), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.start()
    assert gc.get_freeze_count() > 0
    app.stop()
    assert gc.get_freeze_count() == 0


def test_no_thread_keeps_pythons_lock_for_long_while_a_plant_runs(tmp_path: Path) -> None:
    before = sys.getswitchinterval()
    app = build(shipped(), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.start()
    assert sys.getswitchinterval() == pytest.approx(TURN_S)
    app.stop()
    assert sys.getswitchinterval() == pytest.approx(before)


def test_a_part_of_a_package_starts_hears_of_tasks_and_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(tmp_path / "site", "acme_counter", COUNTER)
    monkeypatch.syspath_prepend(tmp_path / "site")
    app = build(shipped(), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    heard = sys.modules["acme_counter"].HEARD
    app.start()
    try:
        asked = app.plant.submit("sis_a 0B 7 #lot").result(30.0)
    finally:
        app.stop()
    assert heard[0] == "start" and heard[-1] == "stop"
    assert asked.task in [each.task for each in heard[1:-1]]


def test_a_plant_halts_its_robots_before_any_part_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    app = build(shipped(), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    done: list[str] = []

    def noted(of: object, name: str) -> None:
        act = getattr(of, name)
        monkeypatch.setattr(of, name, lambda: (done.append(f"{name} {type(of).__name__}"), act()))

    noted(app.plant, "halt")
    for each in app.parts:
        noted(each, "stop")
    app.start()
    app.stop()
    ends = [f"stop {type(each).__name__}" for each in reversed(app.parts)]
    assert done[0] == "halt Orchestrator" and [each for each in done if each.startswith("stop")] == ends
