"""Command line of this process: as a person would type it again, and started again in its place."""

from __future__ import annotations

import os
import shutil
import sys
from importlib.util import find_spec
from typing import NoReturn

RESTARTED = "ARBOLEDA_RESTARTED"  # the port of the page before, in the environment of a restarted process


def command() -> str:
    """`arboleda` if a shell finds it, else the path of the one that runs."""
    return "arboleda" if shutil.which("arboleda") else sys.argv[0]


def python() -> str:
    """The Python that Arboleda is installed in."""
    return "python" if shutil.which("arboleda") else sys.executable


def pip_install() -> str:
    """The command that installs beside Arboleda; an environment that uv has made is without pip."""
    if find_spec("pip") is None and shutil.which("uv"):
        return f"uv pip install --python {sys.executable}"
    return f"{python()} -m pip install"


def restart(port: int) -> NoReturn:
    """Start this process again in its own place, with the same command line and process number.

    `port`: that of its page, which a page that is open comes back to.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os.environ[RESTARTED] = str(port)
    os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])


def port_before() -> int | None:
    """The port of a process that `restart` has started, None for any other; asked once, as its children have
    none.
    """
    port = os.environ.pop(RESTARTED, "")
    return int(port) if port.isdecimal() else None
