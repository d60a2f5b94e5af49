"""Cast on the hosts: database, broker, boards, bridge, whoever watches, and plants that lead or wait."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import httpx

from arboleda.runtime import tokens
from arboleda.runtime.state import find_running
from arboleda.web.access.auth import Role

from ..database import DATABASE, PASSWORD, USER, Server
from ..processes import PATIENCE_S, Boards, Plant, Teller, environment
from .network import Network

LEFT, RIGHT, DATA, BROKER, BRIDGE, FLOOR = "left", "right", "data", "broker", "bridge", "floor"
HOSTS = (LEFT, RIGHT, DATA, BROKER, BRIDGE, FLOOR)
PLANTS = (LEFT, RIGHT)
NETWORK = "10.77.0.0/24"
DATABASE_PORT, MQTT_PORT = 5432, 1883
MOSQUITTO = "listener {port} 0.0.0.0\nallow_anonymous true\nset_tcp_nodelay true\n"
NODES = ("-m", "arboleda_ros.nodes")


class HostPlant(Plant):
    """A plant on a host of its own: whoever asks it does so from there."""

    def __init__(
        self, network: Network, host: str, folder: Path, command: Sequence[str], shown: Mapping[str, str]
    ) -> None:
        self.host = host
        self._network, self._folder = network, folder
        super().__init__(folder, folder.with_suffix(".log"), _nobody, command=command, shown=shown)

    def await_api(self, until: float) -> bool:
        with self._network.inside(self.host):
            return super().await_api(until)

    def ask(self, method: str, path: str, body: dict[str, Any] | None = None) -> tuple[int, Any]:
        with self._network.inside(self.host):
            return super().ask(method, path, body)

    @property
    def url(self) -> str:
        """The address at which other hosts reach it; OSError where it listens nowhere."""
        running = find_running(self._folder)
        if running is None or running.port is None:
            raise ConnectionRefusedError(f"nothing listens on {self.host}")
        return f"http://{self._network.address(self.host)}:{running.port}"

    @property
    def runs(self) -> bool:
        """True if the process is there."""
        return self._child.poll() is None


class Watch(Teller):
    """The process of `watch.py`; `executed` grows while it runs: time, robot, id."""

    def __init__(self, before: Sequence[str], robots: Sequence[str], log: Path) -> None:
        self.executed: list[tuple[float, str, str]] = []
        super().__init__("arboleda_kills.hosts.watch", robots, log, self._saw, before)

    def _saw(self, said: dict[str, Any]) -> None:
        self.executed.append((said["at"], said["robot"], said["id"]))


class Cast:
    """All processes on their hosts; whoever makes it calls `close`."""

    def __init__(self, network: Network, folder: Path, rate: float, robots: Sequence[str]) -> None:
        os.environ["PGPASSWORD"] = PASSWORD
        # memory that processes share would be a way past the cable
        os.environ["FASTDDS_BUILTIN_TRANSPORTS"] = "UDPv4"
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "SUBNET"
        self._network, self._folder = network, folder
        self.visitor = folder / "visitor"  # the state directory of who types commands on another host
        token = tokens.read(self.visitor)[Role.OPERATOR]
        self.shown = {"authorization": f"Bearer {token}"}
        self._starts = 0
        with network.inside(DATA):
            self.database = Server(DATABASE_PORT, before=network.on(DATA), others=NETWORK)
        self.store = f"postgresql://{USER}@{network.address(DATA)}:{DATABASE_PORT}/{DATABASE}"
        settings = folder / "mosquitto.conf"
        settings.write_text(MOSQUITTO.format(port=MQTT_PORT))
        self._mosquitto = ("mosquitto", "-c", str(settings))
        self._broker = self._started(BROKER, *self._mosquitto)
        self.boards = Boards(rate, folder / "boards.log", network.on(FLOOR))
        self.boards.broker(network.address(BROKER), MQTT_PORT)
        self._bridge = self._start_bridge()
        self.watch = Watch(network.on(BRIDGE), robots, folder / "watch.log")

    def plant(self, host: str, *, standby: bool) -> HostPlant:
        """One more start of the plant on a host."""
        self._starts += 1
        state = self._folder / f"{host}-{self._starts}"
        state.mkdir(mode=0o700)
        shutil.copy(self.visitor / tokens.TOKENS, state)
        words = {
            "store": self.store,
            "state_dir": state,
            "standby": str(standby).lower(),
            "dashboard": "true",
            "dashboard_host": "0.0.0.0",
        }
        parameters = [word for key, value in words.items() for word in ("-p", f"{key}:={value}")]
        node = (*self._network.on(host), sys.executable, *NODES, "orchestrator", "--ros-args", *parameters)
        return HostPlant(self._network, host, state, node, self.shown)

    def restart_bridge(self) -> None:
        """kill -9, and another one at once."""
        _end(self._bridge)
        self._bridge = self._start_bridge()

    def restart_broker(self) -> None:
        """kill -9, and another one at once; what it retained is gone."""
        _end(self._broker)
        self._broker = self._started(BROKER, *self._mosquitto)

    def restart_database(self, how: signal.Signals, away_s: float) -> None:
        """It ends in this way, and is away for some time."""
        self.database.stop(how)
        time.sleep(away_s)
        with self._network.inside(DATA):
            self.database.start()

    def close(self) -> None:
        self.watch.end()
        self.boards.end()
        _end(self._bridge)
        _end(self._broker)
        self.database.remove()

    def _start_bridge(self) -> subprocess.Popen[bytes]:
        broker = f"broker:={self._network.address(BROKER)}:{MQTT_PORT}"
        state = f"state_dir:={self._folder / BRIDGE}"
        words = (*NODES, "mqtt_bridge", "--ros-args", "-p", broker, "-p", state)
        return self._started(BRIDGE, sys.executable, *words)

    def _started(self, host: str, *command: str) -> subprocess.Popen[bytes]:
        with (self._folder / f"{host}.log").open("ab") as log:
            return subprocess.Popen(
                [*self._network.on(host), *command],
                stdout=log,
                stderr=log,
                env=environment(),
            )


def _end(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait(PATIENCE_S)


def _nobody(host: str, port: int) -> None:
    """The broker is no plant's own."""


UNHEARD = (httpx.HTTPError, OSError)
