"""A plant in ROS 2: its nodes, its robots in TF and in RViz2; `--show-args` lists the arguments."""

from __future__ import annotations

from pathlib import Path

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo, OpaqueFunction, Shutdown
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from arboleda_bringup.arguments import ARGUMENTS, Argument
from arboleda_bringup.plan_query import plan_of
from arboleda_bringup.row import Row

SHARE = Path(__file__).parents[1]


def generate_launch_description() -> LaunchDescription:
    """The arguments, then the nodes that they ask for."""
    declared = [_declared(argument) for argument in ARGUMENTS]
    return LaunchDescription([*declared, OpaqueFunction(function=_actions)])


def _declared(argument: Argument) -> DeclareLaunchArgument:
    return DeclareLaunchArgument(
        argument.name,
        default_value=argument.default,
        description=argument.description,
        choices=argument.choices,
    )


def _actions(context: LaunchContext) -> list[LogInfo | Node]:
    plan = plan_of(context.launch_configurations, SHARE)
    context.environment.update(plan.environment)
    return [*[LogInfo(msg=note) for note in plan.notes], *map(_node, plan.rows)]


def _node(row: Row) -> Node:
    """The launch action of a Row; every value is typed, else launch would read texts as YAML."""
    parameters = {key: ParameterValue(value, value_type=type(value)) for key, value in row.parameters.items()}
    ended = [Shutdown(reason=f"{row.executable} has ended")] if row.required else None
    return Node(
        package=row.package,
        executable=row.executable,
        name=row.executable,
        namespace=row.namespace,
        parameters=[parameters] if parameters else [],
        arguments=row.arguments,
        output="screen",
        on_exit=ended,
    )
