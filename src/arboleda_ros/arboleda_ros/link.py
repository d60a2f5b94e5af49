"""The entry point `arboleda.links: ros`: one rclpy context, one thread, the nodes of the parts."""

from __future__ import annotations

import atexit
import io
import logging
import os
import threading
from collections.abc import Callable, MutableMapping, Sequence
from typing import Any

from rclpy.context import Context
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node

from arboleda.extension import StartError
from arboleda.model.messages import Event
from arboleda.model.plant_model import PlantModel
from arboleda.wire.hop import FromPlant
from arboleda_ros.bridge import BridgePort
from arboleda_ros.orchestrator import OrchestratorPort
from arboleda_ros.port import Port
from arboleda_ros.ros_log import QUIET, RosLog
from arboleda_ros.standby import StandbyVoice
from arboleda_ros.wall_time import keep_wall_time

LOG = logging.getLogger("arboleda.ros")

_SPIN_S = 1.0
_FLUSH_S = 1.0
_HOPS = 4  # three tasks in a chain, and one more for an executor that takes the last one first


def connect(*, args: Sequence[str] = (), lan: bool = False) -> Link:
    """Join ROS 2; `args` may hold `--ros-args`, `lan` admits other machines. Raises StartError on failure."""
    note = limit_discovery(os.environ, lan=lan)
    context = Context()
    try:
        context.init(args=[*QUIET, *args])
    except Exception as error:
        raise StartError(f"ROS 2 does not start: {error}") from error
    return Link(context, notes=(note,) if note else ())


def limit_discovery(environ: MutableMapping[str, str], *, lan: bool) -> str | None:
    """Keep ROS 2 on this machine unless `lan` or the environment decides; returns a line on that."""
    if lan or "ROS_AUTOMATIC_DISCOVERY_RANGE" in environ or "ROS_LOCALHOST_ONLY" in environ:
        return None
    humble = environ.get("ROS_DISTRO") == "humble"
    name, value = ("ROS_LOCALHOST_ONLY", "1") if humble else ("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    environ[name] = value
    return f"ROS 2 stays on this machine ({name}={value}); to open it, set {name} yourself or use --ros-lan"


class Link:
    """Connection of this process to ROS 2. Make the ports, `start`, and `close` at the end."""

    def __init__(self, context: Context, *, notes: tuple[str, ...] = ()) -> None:
        self.notes = notes
        self._context = context
        self._executor = _executor(context)
        self._nodes: dict[str, Node] = {}
        self._ports: list[Port] = []
        self.log = RosLog()
        self._thread = threading.Thread(target=self._spin, name="ros", daemon=True)
        self._closing = False
        atexit.register(self.close)  # a thread still in rclpy aborts the process at its exit

    def node(self, name: str) -> Node:
        """The node of that name, made at the first call; only before `start`."""
        if name not in self._nodes:
            self._nodes[name] = node = Node(name, context=self._context)
            keep_wall_time(node)
            self.log.join(self._nodes[name])
        return self._nodes[name]

    def orchestrator(
        self, model: PlantModel, on_event: Callable[[Event], None], clock: Callable[[], float]
    ) -> OrchestratorPort:
        """The plant's port; nothing arrives before `start`."""
        port = OrchestratorPort(self.node("orchestrator"), model, on_event, clock)
        self._ports.append(port)
        return port

    def bridge(
        self, model: PlantModel, on_event: Callable[[FromPlant], None], clock: Callable[[], float]
    ) -> BridgePort:
        """The bridge's port; nothing arrives before `start`."""
        port = BridgePort(self.node("mqtt_bridge"), model, on_event, clock)
        self._ports.append(port)
        return port

    def standby(self) -> StandbyVoice:
        """A voice in `/diagnostics` for a process that waits to lead a plant; close it at the end."""
        return StandbyVoice(self._context)

    def start(self) -> None:
        """Begin to deliver; a second call does nothing."""
        if self._thread.ident is None:
            for node in self._nodes.values():
                self._executor.add_node(node)
            self._thread.start()

    def close(self) -> None:
        """Stop delivering, join the thread and leave ROS 2; a second call does nothing."""
        if self._closing:
            return
        for port in self._ports:
            port.close()
        self._flush()
        for handler in logging.getLogger().handlers:
            handler.flush()
        self.log.close()
        self._closing = True
        atexit.unregister(self.close)
        if self._thread.is_alive():
            self._executor.create_task(_nothing)  # ends the spin_once that waits; wake() does not
            self._thread.join()
        self._executor.shutdown()
        for port in self._ports:
            port.destroy()
        for node in self._nodes.values():
            node.destroy_node()
        self._context.try_shutdown()

    def _flush(self) -> None:
        """Let the executor finish the tasks given to it, and those that follow from them."""
        for _ in range(_HOPS if self._thread.is_alive() else 0):
            done = threading.Event()
            self._executor.create_task(done.set)
            if not done.wait(_FLUSH_S):
                return

    def _spin(self) -> None:
        # EventsExecutor.spin() of the wheels delivers nothing, spin_once does
        while not self._closing and self._context.ok():
            try:
                self._executor.spin_once(timeout_sec=_SPIN_S)
            except ExternalShutdownException:
                return
            except Exception:  # the guarded handlers do not raise, rclpy's own services may
                LOG.exception("a callback of rclpy failed")


def _nothing() -> None:
    """A task that only wakes the executor."""


def _executor(context: Context) -> Executor | Any:
    """EventsExecutor where there is one: a fifth of the processor time per message."""
    try:
        from rclpy.experimental import EventsExecutor

        return EventsExecutor(context=context)
    except (ImportError, io.UnsupportedOperation, RuntimeError):
        # Humble has none; and it turns faulthandler on, which needs a stderr with a file number
        return SingleThreadedExecutor(context=context)
