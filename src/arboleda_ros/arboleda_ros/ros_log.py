"""The lines of Python's logging on `/rosout` and in ROS 2's log files, each by the logger of its node.

rclpy writes a line to the console while it holds the interpreter's lock: a console that nobody reads any
more, such as a pager, would stop the whole process, heartbeat and stop included. So rclpy is told to be
QUIET, and whoever wants lines on a console writes them in the thread of the log (decision 26).
"""

from __future__ import annotations

import logging
import os
import threading
from collections.abc import Callable
from typing import Any

from rclpy.logging import LoggingSeverity
from rclpy.node import Node

from arboleda.runtime.log_queue import OURS

QUIET = ("--ros-args", "--disable-stdout-logs", "--")
Logger = Any  # rclpy names its type in a private module only

# rclpy remembers the severity of each place in the program that logs, and refuses another one from there
_SAY: dict[int, Callable[[Logger, str], object]] = {
    logging.DEBUG: lambda logger, text: logger.debug(text),
    logging.INFO: lambda logger, text: logger.info(text),
    logging.WARNING: lambda logger, text: logger.warning(text),
    logging.ERROR: lambda logger, text: logger.error(text),
    logging.CRITICAL: lambda logger, text: logger.fatal(text),
}
_WORDS = {logging.WARNING: "WARN", logging.CRITICAL: "FATAL"}  # ROS 2's, where they are others than Python's


class RosLog:
    """An output of the log; `join` its nodes, `close` before they are destroyed.

    `arboleda.tasks` is the logger `orchestrator.tasks` of the first node. What a port logs, as
    `arboleda.ros.mqtt_bridge`, is said by the logger of its own node.
    """

    def __init__(self) -> None:
        self._nodes: dict[str, Node] = {}
        self._loggers: dict[tuple[str, str], Logger] = {}
        self._lock = threading.Lock()
        # Humble publishes on /rosout what a node's own logger says, and nothing of its children
        self._children = os.environ.get("ROS_DISTRO") != "humble"

    def join(self, node: Node) -> None:
        """Let a node write lines; the first one also writes those that belong to no node."""
        with self._lock:
            self._nodes[node.get_name()] = node

    def close(self) -> None:
        """Write nothing more, and release the nodes."""
        with self._lock:
            self._nodes.clear()
            self._loggers.clear()

    def __call__(self, line: logging.LogRecord) -> None:
        """Write a line if its logger's level lets it pass."""
        with self._lock:
            logger = self._logger(line.name)
            if logger is not None:
                _SAY[_level(line)](logger, line.getMessage())

    def heading(self, line: logging.LogRecord) -> str | None:
        """The prefix of a line on a console of ROS 2; None if its logger's level suppresses the line."""
        level = _level(line)
        with self._lock:
            logger = self._logger(line.name)
            if logger is None:
                return None if level < logging.INFO else _heading(level, line.created, line.name)
            if not logger.is_enabled_for(LoggingSeverity(level)):
                return None
            return _heading(level, line.created, logger.name)

    def _logger(self, name: str) -> Logger | None:
        """The logger for the name of a Python logger; None if there is no node yet."""
        if not self._nodes:
            return None
        part = name.removeprefix(f"{OURS}.")
        owner = part.removeprefix("ros.")
        node = self._nodes.get(owner) or next(iter(self._nodes.values()))
        key = (node.get_name(), "ros" if owner in self._nodes else part)
        if key not in self._loggers:
            own = node.get_logger()
            self._loggers[key] = own.get_child(key[1]) if self._children and key[1] else own
        return self._loggers[key]


def _level(line: logging.LogRecord) -> int:
    """Python's level at or below that of a line; DEBUG if lower than all."""
    return max((level for level in _SAY if level <= line.levelno), default=logging.DEBUG)


def _heading(level: int, at: float, name: str) -> str:
    return f"[{_WORDS.get(level, logging.getLevelName(level))}] [{at:.9f}] [{name}]: "
