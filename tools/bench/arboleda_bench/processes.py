"""Processes of a benchmark: their cost, and an end of all of them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO

from arboleda.extension import ArboledaError

PATIENCE_S = 15.0
PAGE = os.sysconf("SC_PAGE_SIZE")


class Process:
    """A program beside the benchmark; its output goes to `log`, except the lines that `read` takes."""

    def __init__(self, command: Sequence[str], log: Path, environ: Mapping[str, str] | None = None) -> None:
        self.name = log.stem
        self._log = log
        with log.open("wb") as errors:
            self._popen = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                env={**os.environ, **(environ or {})},
                text=True,
                start_new_session=True,  # Ctrl-C is for the benchmark, which ends them in order
            )

    @classmethod
    def python(cls, module: str, *args: str, log: Path) -> Process:
        """A Python module run as a program, by this interpreter."""
        return cls([sys.executable, "-m", module, *args], log)

    @property
    def pid(self) -> int:
        return self._popen.pid

    @property
    def cpu_s(self) -> float:
        """The processor time that it has had so far, with all its threads, s."""
        return time.clock_gettime((~self.pid << 3) | 2)  # as clock_getcpuclockid(3) makes it; to the ns

    @property
    def memory(self) -> int:
        """The memory of its own, in bytes: resident, not shared with a file."""
        return own_memory(self.pid)

    def read(self) -> str:
        """The next line that it prints; raises ArboledaError if it has ended instead."""
        line = _pipe(self._popen.stdout).readline()
        if not line:
            self._popen.wait(PATIENCE_S)
            raise ArboledaError(f"{self.name} ended early: {self._last_words()}")
        return line.rstrip("\n")

    def write(self, line: str) -> None:
        """Hand a line to its input."""
        pipe = _pipe(self._popen.stdin)
        pipe.write(line + "\n")
        pipe.flush()

    def check(self) -> None:
        """Raise ArboledaError if it has ended."""
        if self._popen.poll() is not None:
            raise ArboledaError(f"{self.name} ended early: {self._last_words()}")

    def wait(self, patience_s: float) -> None:
        """Wait for its own end; raises ArboledaError if that does not come, or is a failure."""
        try:
            failed = self._popen.wait(patience_s) != 0
        except subprocess.TimeoutExpired:
            failed = True
        if failed:
            raise ArboledaError(f"{self.name} did not end well: {self._last_words()}")

    def end(self) -> None:
        """Interrupt it and wait for its end."""
        self._popen.send_signal(signal.SIGINT)
        try:
            self._popen.communicate(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired:
            self._popen.kill()
            self._popen.communicate()

    def _last_words(self) -> str:
        lines = self._log.read_text(errors="replace").strip().splitlines()
        return lines[-1] if lines else f"exit status {self._popen.returncode}"


def own_memory(pid: int | str = "self") -> int:
    """The memory of a process's own, in bytes: resident, not shared with a file."""
    _, resident, shared, *_ = Path(f"/proc/{pid}/statm").read_text().split()
    return (int(resident) - int(shared)) * PAGE


def _pipe(pipe: IO[str] | None) -> IO[str]:
    assert pipe is not None
    return pipe
