"""`arboleda up` and `run` speak ROS 2 where it is there; where it is missing they say so."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.cli import main, session
from arboleda.runtime import build
from arboleda.runtime.build import App

BY_HAND = Path(__file__).parents[3] / "examples" / "plants" / "by_hand.yaml"
Started = Callable[..., "tuple[App | None, str]"]


class Missing:
    """The entry point of the ROS 2 link on a machine without ROS 2, or with one that cannot be loaded."""

    name = "ros"

    def __init__(self, error: ImportError) -> None:
        self._error = error

    def load(self) -> Any:
        raise self._error


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Started:
    """The plant that a command line starts on a machine without ROS 2, and what it complains of."""
    apps: list[App] = []

    class Unrun:
        def __init__(self, app: App, *_: Any, **_options: Any) -> None:
            apps.append(app)

        def run(self) -> int:
            return 0

    monkeypatch.setattr(session, "Session", Unrun)
    monkeypatch.setattr(build, "PARTS", tuple(part for part in build.PARTS if part != "web"))
    monkeypatch.setattr(session, "registered", lambda _: [Missing(ImportError("No module named 'rclpy'"))])

    def start(*words: str) -> tuple[App | None, str]:
        monkeypatch.setattr(sys, "argv", ["arboleda", *words, "--state", str(tmp_path / "state")])
        with pytest.raises(SystemExit):
            main.main()
        return (apps[0] if apps else None), capsys.readouterr().err

    return start


@pytest.mark.parametrize("command", [("up",), ("up", "--once", "sis_a 0B 1")])
def test_a_plant_runs_without_ros_where_it_is_missing_and_says_so(
    started: Started, command: tuple[str, ...]
) -> None:
    app, said = started(*command)
    assert app and not said
    (note,) = (note for note in app.notes if "ROS 2" in note)
    assert note.startswith("Without ROS 2, over MQTT alone: ") and "No module named 'rclpy'" in note


def test_who_has_no_ros_is_told_how_to_get_it_and_nothing_of_modules(
    started: Started, monkeypatch: pytest.MonkeyPatch
) -> None:
    missing = ModuleNotFoundError("No module named 'rclpy'", name="rclpy")
    monkeypatch.setattr(session, "registered", lambda _: [Missing(missing)])
    app, _ = started("up")
    assert app
    (note,) = (note for note in app.notes if "ROS 2" in note)
    assert "`make install ROS=1`" in note and "module" not in note


def test_who_wants_no_ros_is_not_told_that_it_is_missing(started: Started) -> None:
    app, _ = started("up", "--no-ros")
    assert app and not [note for note in app.notes if "ROS 2" in note]


@pytest.mark.parametrize("option", ["--ros", "--ros-lan"])
def test_who_wants_ros_is_told_how_to_get_it(started: Started, option: str) -> None:
    app, said = started("up", option)
    assert app is None
    assert said.startswith("arboleda: ROS 2 for Python is not installed here") and said.count("\n") == 1


def test_a_robot_that_speaks_ros_needs_it(started: Started) -> None:
    app, said = started("up", "--boards", "real", "--plant", str(BY_HAND))
    assert app is None and "ROS 2 for Python is not installed here" in said
