"""Every driver that takes part in the contract, by its name in a plant file: one row and one module each."""

from __future__ import annotations

from importlib.util import find_spec

from arboleda.testing.drivers import Bench

from ..dobot import bench as dobot
from ..gcode import bench as gcode
from ..gripper_command import bench as gripper_command
from ..joint_trajectory import bench as joint_trajectory
from ..modbus import bench as modbus
from ..mqtt_mapping import bench as mqtt_mapping
from ..nav2 import bench as nav2
from ..opcua import bench as opcua
from ..pylabrobot import bench as pylabrobot
from ..ros_mapping import bench as ros_mapping
from ..s7 import bench as s7
from ..serial_arm import bench as serial_arm
from ..ur import bench as ur
from ..vda5050 import bench as vda5050
from . import line_tcp, mqtt, ros

BENCHES: dict[str, Bench] = {
    "mqtt": mqtt.BENCH,
    "ros": ros.BENCH,
    "line_tcp": line_tcp.BENCH,
    "modbus": modbus.BENCH,
    "mqtt_mapping": mqtt_mapping.BENCH,
    "opcua": opcua.BENCH,
    "pylabrobot": pylabrobot.BENCH,
    "pylabrobot_side_by_side": pylabrobot.SIDE_BY_SIDE,
    "s7": s7.BENCH,
    "serial_arm": serial_arm.BENCH,
    "dobot": dobot.BENCH,
    "gcode": gcode.BENCH,
    "gcode_marlin": gcode.MARLIN_BENCH,
    "gcode_moonraker": gcode.MOONRAKER_BENCH,
    "ur": ur.BENCH,
    "vda5050": vda5050.BENCH,
}
if find_spec("control_msgs"):  # no wheels have it: `make ros-test` builds it, and runs these benches
    BENCHES["follow_joint_trajectory"] = joint_trajectory.BENCH
    BENCHES["gripper_command"] = gripper_command.BENCH
    BENCHES["gripper_command_parallel"] = gripper_command.PARALLEL_BENCH
    BENCHES["ros_mapping"] = ros_mapping.BENCH
if find_spec("nav2_msgs"):
    BENCHES["navigate_to_pose"] = nav2.BENCH
    BENCHES["follow_waypoints"] = nav2.WAYPOINTS_BENCH

SAME_LINK = frozenset(  # these reach their device by the threads and the library of another one
    {
        "dobot",  # of ur
        "follow_waypoints",
        "gcode_marlin",
        "gcode_moonraker",  # of gcode, over a web socket
        "gripper_command",  # of follow_joint_trajectory
        "gripper_command_parallel",
        "navigate_to_pose",  # of follow_joint_trajectory
        "pylabrobot_side_by_side",
        "serial_arm",  # of gcode
    }
)
