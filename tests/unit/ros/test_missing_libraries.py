"""What a node says of a library that is missing."""

from __future__ import annotations

import sys

import pytest

from arboleda_ros import nodes
from arboleda_ros.missing_libraries import sentence


@pytest.mark.parametrize(
    ("library", "cure"),
    [
        ("paho", "pip install 'paho-mqtt>=2'"),
        ("paho.mqtt.enums", "pip install 'paho-mqtt>=2'"),
        ("yaml", "pip install 'PyYAML'"),
        ("pydantic", "pip install 'pydantic>=2'"),
        ("py_trees", "pip install 'py_trees'"),
        ("diagnostic_msgs.msg", "source a ROS 2 installation"),
        ("arboleda.model", "build the workspace with colcon"),
    ],
)
def test_it_is_named_with_what_to_do(library: str, cure: str) -> None:
    said = sentence(ImportError(f"No module named {library!r}\nmore", name=library))
    assert said.startswith(f"the Python library {library.partition('.')[0]} cannot be used here")
    assert cure in said and "\n" not in said


def test_one_without_a_name_is_told_with_its_reason() -> None:
    assert "(unnamed) cannot be used here (no reason given)" in sentence(ImportError())


def test_a_node_that_cannot_be_imported_ends_with_that_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "arboleda_ros.running", None)
    assert nodes.main("mqtt_bridge") == 1
    said = capsys.readouterr().err
    assert said.startswith("mqtt_bridge: the Python library arboleda_ros cannot be used here")
    assert said.count("\n") == 1
