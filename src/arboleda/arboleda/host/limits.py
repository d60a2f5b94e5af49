"""Limits of this process: open files, memory, processor time, and its place behind others."""

from __future__ import annotations

import os
from contextlib import suppress

try:
    import resource
except ImportError:  # Windows, and a tab of a browser: none of these limits is there
    resource = None  # type: ignore[assignment]

# Python that runs the command `arboleda` behind everybody else; its words are those of the command line.
BEHIND = (
    "import sys; from arboleda.host.limits import give_way; give_way(10); "
    "from arboleda.cli.main import main; sys.argv[0] = 'arboleda'; main()"
)


def open_files() -> int | None:
    """The number of files that this process may open; None if nothing limits it."""
    if resource is None:
        return None
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return None if soft == resource.RLIM_INFINITY else soft


def raise_open_files(wanted: int) -> None:
    """Raise the limit of open files to `wanted`, or as near to it as is possible without being root."""
    soft = open_files()
    if soft is None or resource is None:
        return
    _, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = wanted if hard == resource.RLIM_INFINITY else min(hard, wanted)
    if soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))


def limit_memory(size: int) -> None:
    """End this process rather than let it take more than `size` bytes, where the system does that."""
    if resource is not None:
        with suppress(ValueError, OSError):  # macOS has the name, and refuses it
            resource.setrlimit(resource.RLIMIT_AS, (size, size))


def limit_processor(seconds: int) -> None:
    """End this process after so much time of the processor, where the system does that."""
    if resource is not None:
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))


def give_way(steps: int) -> None:
    """Let other processes go first by so many steps of niceness, where the system knows them."""
    if hasattr(os, "nice"):
        os.nice(steps)
