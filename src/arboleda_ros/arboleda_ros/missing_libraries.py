"""Install advice for a library that is missing or too old; imports nothing that may be missing itself."""

from __future__ import annotations

ROS = "source a ROS 2 installation, or install its wheels: python3 -m pip install 'arboleda[ros]'"
OURS = "build the workspace with colcon and source its install/setup.bash"
HOW = {
    **dict.fromkeys(("rclpy", "action_msgs", "builtin_interfaces", "rcl_interfaces"), ROS),
    **dict.fromkeys(("diagnostic_msgs", "sensor_msgs", "std_msgs", "std_srvs"), ROS),
    **dict.fromkeys(("arboleda", "arboleda_description", "arboleda_interfaces", "arboleda_ros"), OURS),
}
ON_PYPI = {
    "paho": "paho-mqtt>=2",
    "pydantic": "pydantic>=2",
    "starlette": "fastapi",
    "yaml": "PyYAML",
}


def sentence(error: ImportError) -> str:
    """One sentence on a failed import: the library, the reason, and the remedy."""
    library = (error.name or "").partition(".")[0]
    why = (str(error).splitlines() or ["no reason given"])[0]
    name = ON_PYPI.get(library, library)
    how = HOW.get(library, f"install it: python3 -m pip install '{name}'")
    return f"the Python library {library or '(unnamed)'} cannot be used here ({why}); {how}"
