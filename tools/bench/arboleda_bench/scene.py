"""Scene of a benchmark: a folder, a ROS domain and processes of its own, all gone at its end."""

from __future__ import annotations

import os
import shutil
import socket
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.testing.domains import Domain

from .processes import Process

SEARCH_PATH = os.pathsep.join([os.environ.get("PATH", os.defpath), "/usr/sbin"])  # Debian keeps servers there
START_S = 10.0
POLL_S = 0.02
MOSQUITTO = "allow_anonymous true\nset_tcp_nodelay true\n"  # the latter as docs/how-to/real-boards.md asks


class Scene:
    """One run of one benchmark; `quick` is for a short look, `say` shows what it is doing."""

    def __init__(self, *, quick: bool, say: Callable[[str], None]) -> None:
        self.quick = quick
        self.say = say
        self.folder = Path(tempfile.mkdtemp(prefix="arboleda_bench_"))
        self._processes: list[Process] = []
        self._environ = dict(os.environ)
        self._domain = Domain()

    def __enter__(self) -> Scene:
        os.environ["ROS_DOMAIN_ID"] = str(self._domain.id)
        os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        return self

    def __exit__(self, *_: object) -> None:
        self.end()
        self._domain.close()
        os.environ.clear()
        os.environ.update(self._environ)
        shutil.rmtree(self.folder, ignore_errors=True)

    def end(self) -> None:
        """End every process, the last one first."""
        while self._processes:
            self._processes.pop().end()

    def node(self, name: str, plant: Path, **parameters: Any) -> Process:
        """One of the shipped ROS 2 nodes, as a user starts it, with a state of its own.

        A plant that found the tasks of the one before would hold the cells that were at work.
        """
        state = Path(tempfile.mkdtemp(prefix="state_", dir=self.folder))
        values = {"plant": plant, "state_dir": state, **parameters}
        settings = [word for key, value in values.items() for word in ("-p", f"{key}:={value}")]
        return self.python("arboleda_ros.nodes", name, "--ros-args", *settings, name=name)

    def python(self, module: str, *args: str, name: str = "") -> Process:
        """A Python module as a process, ended with the scene."""
        count = len(list(self.folder.glob("*.log")))
        log = self.folder / f"{name or module.rpartition('.')[2]}_{count}.log"
        process = Process.python(module, *args, log=log)
        self._processes.append(process)
        return process

    def program(self, file: Path) -> Process:
        """Another program as a process, ended with the scene."""
        process = Process([str(file)], self.folder / f"{file.name}.log")
        self._processes.append(process)
        return process

    def mosquitto(self) -> str:
        """A mosquitto of the scene's own, as HOST:PORT; raises ArboledaError if it is not installed."""
        program = shutil.which("mosquitto", path=SEARCH_PATH)
        if program is None:
            raise ArboledaError("this benchmark needs the MQTT broker mosquitto: apt install mosquitto")
        port = free_port()
        config = self.folder / f"mosquitto_{port}.conf"
        config.write_text(f"listener {port} 127.0.0.1\n{MOSQUITTO}")
        process = Process([program, "-c", str(config)], config.with_suffix(".log"))
        self._processes.append(process)
        wait_for(lambda: _answers(port), "mosquitto", process.check)
        return f"127.0.0.1:{port}"


def free_port() -> int:
    """A TCP port of this machine that is not in use."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def wait_for(
    ready: Callable[[], object],
    what: str | Callable[[], str],
    check: Callable[[], None] = lambda: None,
    limit_s: float = START_S,
) -> None:
    """Wait until `ready`; raises ArboledaError naming `what` after `limit_s`, or whatever `check` raises.

    `what` may be a function where only the end of the wait shows what is missing.
    """
    until = time.monotonic() + limit_s
    while not ready():
        check()
        if time.monotonic() > until:
            raise ArboledaError(
                f"{what if isinstance(what, str) else what()} is not ready after {limit_s:g} s"
            )
        time.sleep(POLL_S)


def _answers(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0
