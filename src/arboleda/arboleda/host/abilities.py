"""Abilities of the operating system, as constants."""

from __future__ import annotations

import os
import sys

ABSTRACT_SOCKETS = sys.platform == "linux"  # names of sockets without a file
PROCESSES = sys.platform != "emscripten"  # a tab of a browser has one process
FORKS = PROCESSES and hasattr(os, "fork")  # in a browser the function exists, and fails
WAITS_FOR_PIPES = sys.platform != "win32"  # Windows can only wait for sockets
