"""Stand-ins for `launch` and `launch_ros`: they keep what a launch file says and start nothing."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

LAUNCH_FILE = Path(__file__).parents[1] / "launch/plant.launch.py"
NAMES = {
    "launch": ("LaunchContext", "LaunchDescription"),
    "launch.actions": ("DeclareLaunchArgument", "LogInfo", "OpaqueFunction", "Shutdown"),
    "launch_ros": (),
    "launch_ros.actions": ("Node",),
    "launch_ros.parameter_descriptions": ("ParameterValue",),
}


class Entity(SimpleNamespace):
    """A call that a launch file made: `kind` is the class's name, `words` its positional arguments."""

    def __init__(self, kind: str, *words: Any, **named: Any) -> None:
        super().__init__(kind=kind, words=words, **named)


def stand_in(name: str) -> ModuleType:
    module = ModuleType(name)
    for kind in NAMES[name]:
        setattr(module, kind, lambda *words, _kind=kind, **named: Entity(_kind, *words, **named))
    return module


@pytest.fixture
def description(monkeypatch: pytest.MonkeyPatch) -> list[Entity]:
    """The entities that plant.launch.py describes: its arguments, and the function that makes the rest.

    Its `python3` is the one that runs the tests, with the same path.
    """
    monkeypatch.setenv("PATH", os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(path for path in sys.path if path))
    for name in ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY"):
        monkeypatch.delenv(name, raising=False)
    for name in NAMES:
        monkeypatch.setitem(sys.modules, name, stand_in(name))
    spec = importlib.util.spec_from_file_location("plant_launch", LAUNCH_FILE)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    (entities,) = module.generate_launch_description().words
    return entities


@pytest.fixture
def launched(description: list[Entity]) -> Callable[..., list[Entity]]:
    """`launched(sim="false")`: the actions of a launch with these arguments, the others as declared."""
    *declared, function = description
    defaults = {argument.words[0]: argument.default_value for argument in declared}

    def run(**given: str) -> list[Entity]:
        context = SimpleNamespace(launch_configurations={**defaults, **given}, environment={})
        return function.function(context)

    return run
