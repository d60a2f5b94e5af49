"""Runner of one ROS 2 node: builds its part of the plant and runs it until SIGINT or SIGTERM."""

from __future__ import annotations

import logging
import os
import sys
from contextlib import closing
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from arboleda.adapters.broker_login import login
from arboleda.extension import ArboledaError, StartError
from arboleda.model.plant_model import Link as LinkKind
from arboleda.model.plant_model import PlantModel
from arboleda.model.recording import Recording
from arboleda.plant_file.loader import load_recorded
from arboleda.plant_file.versions import Versions
from arboleda.runtime.alarm_options import alarm_options
from arboleda.runtime.build import App, Options, build
from arboleda.runtime.interrupts import raise_at_signals
from arboleda.runtime.log_file import LogFile
from arboleda.runtime.log_queue import log_to
from arboleda.runtime.web_options import WebOptions
from arboleda.web.access.names import LOCAL
from arboleda_ros import missing_libraries
from arboleda_ros.link import Link, connect
from arboleda_ros.ros_log import RosLog

LOG = logging.getLogger("arboleda.ros")
STDERR = 2
Value = str | float | int | bool
EMBEDDED = "embedded"

_PARAMETERS: dict[str, tuple[Value, str]] = {
    "plant": ("", "plant file; empty: the shipped plant"),
    "broker": ("", "MQTT broker as HOST:PORT; empty: 127.0.0.1:1883; virtual_devices: or 'embedded'"),
    "rate": (1.0, "speed of the virtual devices, 1 is real"),
    "virtual": (False, "devices with a driver of their own have virtual boards instead"),
    "state_dir": ("", "where the plant keeps its state; empty: $XDG_STATE_HOME/arboleda/<plant name>"),
}
_DASHBOARD: dict[str, tuple[Value, str]] = {
    "dashboard": (False, "serve the page and the HTTP API on this machine"),
    "dashboard_port": (0, "port where they listen; 0: 8080, or a free one where that is taken"),
    "dashboard_host": (LOCAL, "IP address where they listen; one that other hosts reach wants tokens"),
}
_STORE: dict[str, tuple[Value, str]] = {
    "store": ("", "database that keeps the plant's memory; empty: what the plant file says, else a file"),
    "standby": (False, "wait until nobody leads this plant, and lead it then; needs a store"),
}
_PARTS = {"orchestrator": "orchestrator", "mqtt_bridge": "bridge", "virtual_devices": "devices"}
_KINDS = {float: "a number", int: "a whole number", str: "a text", bool: "true or false"}


def run(name: str) -> int:
    """Run the node `name` until a signal interrupts it; returns 1 if it cannot start."""
    raise_at_signals()
    try:
        return _run(name)
    except ArboledaError as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1


def offered(name: str) -> dict[str, tuple[Value, str]]:
    """The parameters of the node `name`, each with its default and description."""
    return {**_PARAMETERS, **({**_DASHBOARD, **_STORE} if name == "orchestrator" else {})}


def _run(name: str) -> int:
    link = connect(args=sys.argv)
    try:
        # two queues: a console that nobody reads holds up neither /rosout nor the file
        with log_to(partial(_to_console, link.log)), log_to(link.log) as log:
            app = _app(link, name)
            with closing(LogFile(app.log_file, _complain)) as details:
                log.add(details.handle)
                _run_app(app)
                log.flush()
    finally:
        link.close()
    return 0


def _run_app(app: App) -> None:
    try:
        app.start()
        for note in app.notes:
            LOG.info(note)
        app.wait()
    finally:
        app.stop()


def _to_console(log: RosLog, line: logging.LogRecord) -> None:
    """A line in the form of ROS 2's console output."""
    heading = log.heading(line)
    if heading is not None:
        _complain(heading + line.getMessage())


def _complain(sentence: str) -> None:
    """Write to standard error, past Python's buffer: a thread blocked there must not hold up the exit."""
    os.write(STDERR, f"{sentence}\n".encode())


def _app(link: Link, name: str) -> App:
    values = _parameters(link.node(name), name)
    plant_file = Path(values["plant"]) if values["plant"] else None
    if plant_file is not None:
        Versions(plant_file).go_on()

    def read() -> tuple[PlantModel, Recording | None]:
        model, recording = load_recorded(plant_file)
        if not values["virtual"]:
            return model, recording
        return model.on_boards(LinkKind.DRIVER), recording and replace(recording, virtual=True)

    model, recording = read()
    parts = {_PARTS[name]}
    if values["broker"] == EMBEDDED:
        parts.add(_embedded(name))
    if values.get("dashboard") and _has_web():
        parts.add("web")
    options = Options(
        link=link,
        broker=None if "broker" in parts else values["broker"] or None,
        credentials=login(),
        of_parts=(alarm_options(),),
        rate=values["rate"],
        page="web" in parts,
        log_name="arboleda.log" if name == "orchestrator" else f"{name}.log",
        state_dir=Path(values["state_dir"]) if values["state_dir"] else None,
        store=values.get("store", ""),
        web=WebOptions(host=values.get("dashboard_host", LOCAL), port=values.get("dashboard_port") or None),
        recording=recording,
        plant_file=plant_file,
    )
    if values.get("standby"):
        from arboleda.runtime.standing_by import take_over

        return take_over(model, parts, options, LOG.info, read)
    return build(model, parts, options)


def _embedded(name: str) -> str:
    """The plant's own broker as a part; it may run only with simulated boards."""
    if name != "virtual_devices":
        raise StartError(
            "the parameter broker is 'embedded', which only virtual_devices can be; "
            "start that with broker:=embedded and this with broker:=127.0.0.1:1883"
        )
    return "broker"


def _has_web() -> bool:
    """True if the libraries of the page are installed; logs a warning if not."""
    try:
        for name in ("arboleda.dashboard.page", "arboleda.runtime.parts.web"):
            import_module(name)
    except ImportError as error:
        LOG.warning("the dashboard is off: %s", missing_libraries.sentence(error))
        return False
    return True


def _parameters(node: Node, name: str) -> dict[str, Any]:
    """The node's parameters, read-only once it runs; raises StartError for a value of a wrong type."""
    known = offered(name)
    for key, (default, description) in known.items():
        about = ParameterDescriptor(description=description, read_only=True, dynamic_typing=True)
        node.declare_parameter(key, default, about)
    return {key: _typed(key, node.get_parameter(key).value, default) for key, (default, _) in known.items()}


def _typed(key: str, value: Any, default: Value) -> Value:
    wanted = type(default)
    if type(value) is int and wanted is float:
        return float(value)
    if type(value) is not wanted:
        raise StartError(f"the parameter {key} is {value!r}; {_KINDS[wanted]} is needed")
    return value
