"""A Python that has no more than that of another operating system, as far as Linux can be made to look so.

    import lesser_host; lesser_host.pretend("win32"); from arboleda.cli.entry import main; main()

What Arboleda itself imports and calls is taken away. Modules are missing for its own imports only, the name
of the system is another one for `arboleda.host` only: libraries and Python chose their way before. Paths,
permissions, sockets and processes stay those of Linux: what another system does in its own way is not shown.
"""

from __future__ import annotations

import asyncio  # before names are taken away: it chooses by them
import builtins
import faulthandler
import fcntl
import multiprocessing.util  # noqa: F401
import os
import pkgutil
import signal
import socket  # noqa: F401
import subprocess  # noqa: F401
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from importlib import import_module
from types import ModuleType, SimpleNamespace
from typing import Any

OF_UNIX = ("fcntl", "grp", "posix", "pty", "pwd", "resource", "syslog", "termios", "tty")
MODULES = {"win32": OF_UNIX, "darwin": ()}
NOWHERE = {  # names of modules of Python that there are not on the system (docs.python.org says which)
    "win32": {
        os: "O_CLOEXEC O_DIRECTORY O_NOCTTY O_NONBLOCK chown fdatasync fork getpgid getuid killpg mkfifo "
        "nice openpty pread pwrite setsid",
        signal: "SIGHUP SIGKILL SIGPROF SIGUSR1 SIGUSR2 setitimer ITIMER_PROF",
        faulthandler: "register unregister",
        time: "CLOCK_BOOTTIME CLOCK_MONOTONIC clock_gettime",
    },
    "darwin": {os: "fdatasync", time: "CLOCK_BOOTTIME"},
}
LIBRARIES = (
    "asyncua fastapi mcap.writer mcp.client mcp.client.stdio mcp.server.stdio nicegui paho.mqtt.client "
    "psycopg pymodbus.client pymodbus.server rich.console serial typer uvicorn zmq"
)


def load_libraries() -> None:
    """Import what Arboleda uses of others, for which nothing is taken away."""
    for library in LIBRARIES.split():
        with suppress(ImportError):  # an optional one that is not installed
            __import__(library)


def pretend(platform: str) -> None:
    """Take away what `platform` (win32, darwin) has not, for all of Arboleda that is imported from now on."""
    load_libraries()
    asyncio.new_event_loop().close()
    _import_without(MODULES[platform], {"msvcrt": _msvcrt()} if platform == "win32" else {})
    for module, names in NOWHERE[platform].items():
        for name in names.split():
            vars(module).pop(name, None)
    real, sys.platform = sys.platform, platform
    for module in pkgutil.iter_modules(import_module("arboleda.host").__path__):
        import_module(f"arboleda.host.{module.name}")
    sys.platform = real


def _import_without(missing: Sequence[str], instead: Mapping[str, Any]) -> None:
    find = builtins.__import__

    def lesser(name: str, globals: Any = None, *rest: Any, **more: Any) -> ModuleType:
        if str((globals or {}).get("__name__", "")).startswith("arboleda"):
            if name in missing:
                raise ModuleNotFoundError(f"No module named {name!r}", name=name)
            if name in instead:
                return instead[name]  # type: ignore[no-any-return]
        return find(name, globals, *rest, **more)

    builtins.__import__ = lesser


def _msvcrt() -> Any:
    """Stand-in for the module of that name, by the locks of Linux."""

    def locking(file: int, mode: int, size: int) -> None:
        assert (mode, size, os.lseek(file, 0, os.SEEK_CUR)) == (2, 1, 1 << 30)
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)

    return SimpleNamespace(LK_NBLCK=2, locking=locking)
