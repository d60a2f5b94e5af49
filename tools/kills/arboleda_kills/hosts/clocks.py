"""Wall clocks of hosts that can be stepped, each by itself; see `wall_clock.c`."""

from __future__ import annotations

import mmap
import shutil
import struct
import subprocess
from collections.abc import Iterable
from pathlib import Path

SOURCE = Path(__file__).with_name("wall_clock.c")
AHEAD = struct.Struct("=q")  # ns


class NoCompiler(Exception):
    """There is no C compiler here."""


class Clocks:
    """In `folder`; right until `step`. Processes of users who may not read that folder are not stepped: the
    loader of programs leaves out what it cannot read."""

    def __init__(self, folder: Path, hosts: Iterable[str]) -> None:
        self._library = compiled(folder)
        self._folder = folder
        self._ahead = {host: _page(self._file(host)) for host in hosts}

    def before(self, host: str) -> tuple[str, ...]:
        """The beginning of a command whose processes go by the clock of that host."""
        return "env", f"LD_PRELOAD={self._library}", f"ARBOLEDA_WALL_CLOCK={self._file(host)}"

    def step(self, host: str, ahead_s: float) -> None:
        """Set it so far ahead of the true time, or behind it; 0 sets it right."""
        AHEAD.pack_into(self._ahead[host], 0, round(ahead_s * 1e9))

    def close(self) -> None:
        for page in self._ahead.values():
            page.close()

    def _file(self, host: str) -> Path:
        return self._folder / f"{host}.clock"


def compiled(folder: Path) -> Path:
    """The library that is preloaded; NoCompiler."""
    if shutil.which("cc") is None:
        raise NoCompiler("there is no C compiler, which clocks of hosts need: apt-get install gcc libc6-dev")
    library = folder / "wall_clock.so"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", str(library), str(SOURCE)], check=True)
    return library


def _page(file: Path) -> mmap.mmap:
    file.write_bytes(bytes(AHEAD.size))
    file.chmod(0o644)
    with file.open("r+b") as opened:
        return mmap.mmap(opened.fileno(), AHEAD.size)
