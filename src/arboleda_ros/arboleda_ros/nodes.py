"""The ROS 2 nodes: each builds its part of the plant and runs it until SIGINT or SIGTERM."""

from __future__ import annotations

import logging
import signal
import sys
from pathlib import Path
from types import FrameType
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from arboleda.app.build import App, Options, build
from arboleda.app.config import load
from arboleda.core.errors import ArboledaError, StartError

from .link import Link, connect

_PARAMETERS: dict[str, tuple[str | float, str]] = {
    "plant": ("", "plant file; empty: the shipped plant"),
    "broker": ("", "MQTT broker as HOST:PORT; empty: 127.0.0.1:1883"),
    "rate": (1.0, "speed of the virtual devices, 1 is real"),
    "state_dir": ("", "where the plant keeps its state; empty: $XDG_STATE_HOME/arboleda/<plant name>"),
}
_PARTS = {"orchestrator": "orchestrator", "mqtt_bridge": "bridge", "virtual_devices": "devices"}


def orchestrator() -> int:
    """The plant itself: tasks in, commands out."""
    return main("orchestrator")


def mqtt_bridge() -> int:
    """Between ROS 2 and the boards on MQTT."""
    return main("mqtt_bridge")


def virtual_devices() -> int:
    """The boards, simulated."""
    return main("virtual_devices")


def main(name: str) -> int:
    """Run the node `name` until a signal; 0 at a clean end, 1 where it cannot start."""
    logging.basicConfig(level=logging.INFO, format="[%(levelname)s] [%(name)s]: %(message)s")
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)
    try:
        return _run(name)
    except KeyboardInterrupt:
        return 0
    except ArboledaError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1


def _run(name: str) -> int:
    link = connect(args=sys.argv)
    try:
        for note in link.notes:
            logging.info(note)
        app = _part(link, name)
        try:
            app.start()
            app.wait()
        finally:
            app.stop()
    finally:
        link.close()
    return 0


def _part(link: Link, name: str) -> App:
    values = _parameters(link.node(name))
    model = load(Path(values["plant"]) if values["plant"] else None)
    options = Options(
        link=link,
        broker=values["broker"] or None,
        rate=values["rate"],
        state_dir=Path(values["state_dir"]) if values["state_dir"] else None,
    )
    return build(model, {_PARTS[name]}, options)


def _parameters(node: Node) -> dict[str, Any]:
    """The four parameters, read-only once the node runs; StartError for a value of a wrong type."""
    for key, (default, description) in _PARAMETERS.items():
        about = ParameterDescriptor(description=description, read_only=True, dynamic_typing=True)
        node.declare_parameter(key, default, about)
    return {key: _typed(key, node.get_parameter(key).value) for key in _PARAMETERS}


def _typed(key: str, value: Any) -> str | float:
    wanted = type(_PARAMETERS[key][0])
    if isinstance(value, int) and not isinstance(value, bool) and wanted is float:
        return float(value)
    if not isinstance(value, wanted):
        kind = "a number" if wanted is float else "a text"
        raise StartError(f"the parameter {key} is {value!r}; {kind} is needed")
    return value


def _interrupt(number: int, frame: FrameType | None) -> None:
    """Ends the wait; a second signal must not break the clean end."""
    for each in (signal.SIGINT, signal.SIGTERM):
        signal.signal(each, signal.SIG_IGN)
    raise KeyboardInterrupt


def _chosen() -> str:
    if len(sys.argv) > 1 and sys.argv[1] in _PARTS:
        return sys.argv.pop(1)
    sys.exit(f"usage: python -m arboleda_ros.nodes {{{','.join(_PARTS)}}} [--ros-args -p plant:=FILE ...]")


if __name__ == "__main__":
    sys.exit(main(_chosen()))
