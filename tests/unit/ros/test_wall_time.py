"""Simulated time is refused, at the start of a node and while it runs."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from rclpy.parameter import Parameter

from arboleda.model.errors import StartError
from arboleda_ros.wall_time import REFUSAL, SIM_TIME, keep_wall_time


class Node:
    """What a node is asked for."""

    def __init__(self, *, sim_time: bool) -> None:
        self.sim_time = sim_time
        self.judges: list[Any] = []

    def get_parameter(self, name: str) -> Any:
        assert name == SIM_TIME
        return SimpleNamespace(value=self.sim_time)

    def add_on_set_parameters_callback(self, judge: Any) -> None:
        self.judges.append(judge)


@pytest.mark.parametrize(
    ("name", "value", "taken"), [(SIM_TIME, True, False), (SIM_TIME, False, True), ("x", True, True)]
)
def test_a_node_that_runs_refuses_simulated_time_alone(name: str, value: bool, taken: bool) -> None:
    node = Node(sim_time=False)
    keep_wall_time(node)  # type: ignore[arg-type]
    (judge,) = node.judges
    answer = judge([Parameter("other", value=1), Parameter(name, value=value)])
    assert answer.successful is taken
    assert answer.reason == ("" if taken else REFUSAL)


def test_a_node_does_not_start_with_it() -> None:
    with pytest.raises(StartError, match="goes by the clock of its machine"):
        keep_wall_time(Node(sim_time=True))  # type: ignore[arg-type]
