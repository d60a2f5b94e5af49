"""Forked processes: stand in for a new Python where starting and importing would take most of the time."""

from __future__ import annotations

from collections.abc import Sequence
from multiprocessing import get_context
from subprocess import DEVNULL, TimeoutExpired
from typing import Any

__all__ = ["DEVNULL", "Popen", "TimeoutExpired"]  # what `subprocess` has of it

FORKING = get_context("forkserver")
FORKING.set_forkserver_preload(["arboleda.plant_file.loader", "arboleda.plant_file.recipe_check"])
ALONE = """import os, sys
null = os.open(os.devnull, os.O_RDWR)
for stream in range(3):
    os.dup2(null, stream)
sys.argv = {argv!r}
"""


class Popen:
    """`subprocess.Popen` of `python -I -c CODE WORDS...`, as a fork of a Python that knows Arboleda."""

    def __init__(self, command: Sequence[str], **_: Any) -> None:
        code = ALONE.format(argv=["-c", *command[4:]]) + command[3]
        self._command = command
        self._process = FORKING.Process(target=exec, args=(code, {}))
        self._process.start()

    def __enter__(self) -> Popen:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.join()

    def wait(self, timeout: float | None = None) -> int:
        self._process.join(timeout)
        if self._process.exitcode is None:
            raise TimeoutExpired(self._command, timeout or 0.0)
        return self._process.exitcode

    def kill(self) -> None:
        self._process.kill()
