"""Nodes go by the clock of their machine: `use_sim_time` is refused, at the start and while they run."""

from __future__ import annotations

from collections.abc import Sequence

from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from arboleda.extension import StartError

SIM_TIME = "use_sim_time"
REFUSAL = (
    "a plant goes by the clock of its machine, so use_sim_time stays false;"
    " the parameter rate makes virtual boards faster"
)


def keep_wall_time(node: Node) -> None:
    """Have a node refuse simulated time; StartError where it was started with that."""
    if node.get_parameter(SIM_TIME).value:
        raise StartError(REFUSAL)
    node.add_on_set_parameters_callback(judged)


def judged(parameters: Sequence[Parameter]) -> SetParametersResult:
    """The answer to a request to set parameters of a node that runs."""
    wanted = any(each.name == SIM_TIME and each.value for each in parameters)
    return SetParametersResult(successful=not wanted, reason=REFUSAL if wanted else "")
