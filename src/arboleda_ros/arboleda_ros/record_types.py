"""Types of ROS 2 that a record has, as their packages define them, and the QoS of their topics."""

from __future__ import annotations

from arboleda.recorder.channels import Channel

BETWEEN = "=" * 80 + "\nMSG: "
TIME = f"{BETWEEN}builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
HEADER = f"{BETWEEN}std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n{TIME}"
KEY_VALUE = f"{BETWEEN}diagnostic_msgs/KeyValue\nstring key\nstring value\n"
STATUS = (
    f"{BETWEEN}diagnostic_msgs/DiagnosticStatus\n"
    "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n"
    "byte level\nstring name\nstring message\nstring hardware_id\ndiagnostic_msgs/KeyValue[] values\n"
)
UINT8, STRING = "std_msgs/msg/UInt8", "std_msgs/msg/String"
JOINT_STATE, DIAGNOSTICS = "sensor_msgs/msg/JointState", "diagnostic_msgs/msg/DiagnosticArray"
DEFINITIONS = {
    UINT8: "uint8 data\n",
    STRING: "string data\n",
    JOINT_STATE: (
        "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"
        + HEADER
    ),
    DIAGNOSTICS: (
        "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n" + HEADER + STATUS + KEY_VALUE
    ),
}
FOR_EVER = "sec: 9223372036, nsec: 854775807"  # ROS 2's value for no deadline


def channel(topic: str, type: str, *, depth: int = 10, is_kept: bool = False) -> Channel:
    """The channel of a topic of this type, reliable; `is_kept`: late subscribers get the last messages.

    The numbers are those of rmw, which `ros2 bag` of every version reads.
    """
    qos = (
        f"- history: 1\n  depth: {depth}\n  reliability: 1\n  durability: {1 if is_kept else 2}\n"
        f"  deadline: {{{FOR_EVER}}}\n  lifespan: {{{FOR_EVER}}}\n"
        f"  liveliness: 1\n  liveliness_lease_duration: {{{FOR_EVER}}}\n"
        "  avoid_ros_namespace_conventions: false"
    )
    definition = DEFINITIONS[type].encode()
    return Channel(topic, "cdr", type, "ros2msg", definition, {"offered_qos_profiles": qos})
