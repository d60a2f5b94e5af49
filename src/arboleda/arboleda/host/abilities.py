"""Abilities of the operating system: constants by which others choose their way."""

from __future__ import annotations

import os
import sys

ABSTRACT_SOCKETS = sys.platform == "linux"  # names of sockets without a file
PROCESSES = sys.platform != "emscripten"  # in a tab of a browser there is this one alone
FORKS = PROCESSES and hasattr(os, "fork")  # a browser has the name alone
WAITS_FOR_PIPES = sys.platform != "win32"  # there poll and select take sockets only
