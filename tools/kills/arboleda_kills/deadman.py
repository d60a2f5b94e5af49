"""Time that a robot still moves whose teacher is lost: the client gone, the network cut, the plant killed.

`python -m arboleda_kills.deadman --rounds 30`. A real plant, its broker and HTTP; a virtual arm over MQTT, in
this process, which sees when it truly stands. A round holds a button, and then loses something.
"""

from __future__ import annotations

import math
import socket
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from itertools import count
from pathlib import Path
from typing import Any

from arboleda.adapters import clock
from arboleda.adapters.broker_login import Address
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.runtime.loop import Loop
from arboleda.sim.devices import Devices
from frame.words import parser

from .board_clients import BoardClients, forget_unsent
from .processes import PATIENCE_S, Plant

CELL, ROBOT = "sis_a", "ra1"
BEAT_S = 0.05
PRESSED_S = 0.7
WATCHED_S = 1.5  # after the loss; by then every board has stopped by itself
FAR_DEG = 100.0
HELD = 0.3
LOSSES = ("client", "network", "plant")


class Arm:
    """The boards of a plant, and when the body of one of them moved last."""

    def __init__(self, model: PlantModel, robot: str) -> None:
        self.devices = Devices(model, now=clock.seconds(), boot_ids=count(int(time.time())).__next__)
        self._body = self.devices.boards[model.robots[robot].mqtt].body
        self._clients = BoardClients(self.devices, lambda event: self.loop.post(event))
        self._moved = False
        self.moved_at = -math.inf
        self.loop: Loop[Any, Any] = Loop(
            "boards",
            self.devices,
            self._clients.send,
            on_send_error=forget_unsent,
            on_step=lambda now, *_: self._look(now),
        )
        self.loop.start()

    @property
    def moves(self) -> bool:
        return self._moved

    def join(self, broker: Address) -> None:
        self._clients.join(broker)

    def close(self) -> None:
        self._clients.leave()
        self.loop.stop()

    def _look(self, now: float) -> None:
        moves = self._body.next_change_us is not None and self._body.moving
        if moves or self._moved:
            self.moved_at = now
        self._moved = moves


class Cable:
    """A cable between boards and broker: what goes through it is lost while it is cut, and nobody is told."""

    def __init__(self) -> None:
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._server.getsockname()[1]
        self.cut = False
        self._broker: tuple[str, int] | None = None
        threading.Thread(target=self._accept, daemon=True).start()

    def lead_to(self, host: str, port: int) -> None:
        self._broker = (host, port)

    def _accept(self) -> None:
        while True:
            near, _ = self._server.accept()
            if self._broker is None or self.cut:
                near.close()
                continue
            try:
                far = socket.create_connection(self._broker, 5.0)
            except OSError:
                near.close()
                continue
            for one, other in ((near, far), (far, near)):
                one.settimeout(None)
                one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                threading.Thread(target=self._carry, args=(one, other), daemon=True).start()

    def _carry(self, one: socket.socket, other: socket.socket) -> None:
        with suppress(OSError):
            while data := one.recv(65536):
                if self.cut:
                    break
                other.sendall(data)
        for each in (one, other):
            with suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)
            each.close()


class Teacher:
    """Client that holds a button of a plant in a thread, until it is told to be gone."""

    def __init__(self, plant: Plant, session: int) -> None:
        self._plant, self._session = plant, session
        self._number = count(1)
        self.beat_at = -math.inf
        self._held = threading.Event()

    def press(self, goal: float) -> threading.Thread:
        self._held.set()
        body = {"session": self._session, "number": next(self._number), "robot": ROBOT}
        body |= {"goal": [goal, 0.0, 0.0]}
        thread = threading.Thread(target=self._hold, args=(body,), daemon=True)
        thread.start()
        return thread

    def be_gone(self) -> None:
        self._held.clear()

    def _hold(self, body: dict[str, Any]) -> None:
        with suppress(Exception):  # the plant may be dead
            while self._held.is_set():
                beat_at = clock.seconds()
                self._plant.ask("POST", f"/api/teach/{CELL}/jog", body)
                self.beat_at = beat_at
                time.sleep(max(0.0, beat_at + BEAT_S - clock.seconds()))


class Bench:
    """Rounds of one loss after the other."""

    def __init__(self, folder: Path, tell: Callable[[str], None]) -> None:
        self._folder, self._tell = folder, tell
        self._cable, self._arm = Cable(), Arm(loader.load(None), ROBOT)
        self._plant: Plant | None = None
        self._teacher: Teacher | None = None
        self._goal = FAR_DEG
        self._broker = ("", 0)

    def run(self, rounds: int) -> dict[str, list[float]]:
        found: dict[str, list[float]] = {loss: [] for loss in LOSSES}
        try:
            for loss in LOSSES:
                while len(found[loss]) < rounds:
                    seconds = self._round(loss)
                    if seconds is not None:
                        found[loss].append(seconds)
                        self._tell(f"{loss}: {seconds * 1000:.0f} ms")
        finally:
            self._arm.close()
            if self._plant is not None:
                self._plant.kill()
        return found

    def _round(self, loss: str) -> float | None:
        """Time that the arm moved on; None where it stood already when something was to be lost."""
        teacher = self._taught()
        holds = teacher.press(self._goal)
        time.sleep(PRESSED_S)
        if not self._moves_lately:
            teacher.be_gone()
            holds.join(PATIENCE_S)
            self._goal = -self._goal
            return None
        lost_at = self._lose(loss, teacher)
        time.sleep(WATCHED_S)
        seconds = max(0.0, self._arm.moved_at - lost_at)
        teacher.be_gone()
        holds.join(PATIENCE_S)
        self._mend(loss)
        return seconds

    @property
    def _moves_lately(self) -> bool:
        return self._arm.moves or clock.seconds() - self._arm.moved_at < HELD

    def _lose(self, loss: str, teacher: Teacher) -> float:
        assert self._plant is not None
        if loss == "client":
            teacher.be_gone()
            return teacher.beat_at  # the last time that it spoke
        at = clock.seconds()
        if loss == "network":
            self._cable.cut = True
        else:
            self._plant.kill()
        return at

    def _mend(self, loss: str) -> None:
        self._cable.cut = False
        if loss == "network":
            self._arm.join(Address(host="127.0.0.1", port=self._cable.port))
        if loss == "plant":
            self._plant = self._teacher = None

    def _taught(self) -> Teacher:
        """The teacher of the cell, in a plant that runs."""
        if self._plant is None:
            self._plant = Plant(self._folder / "state", self._folder / "log", self._on_broker)
            assert self._plant.await_api(time.time() + PATIENCE_S)
        until = time.time() + PATIENCE_S
        while not self._is_ready() and time.time() < until:
            time.sleep(0.1)
        if self._teacher is None:
            status = 0
            said: dict[str, Any] = {}
            while status != 200 and time.time() < until:
                status, said = self._plant.ask("POST", f"/api/cells/{CELL}/teach", {"teacher": "bench"})
                time.sleep(0.1)
            self._teacher = Teacher(self._plant, said["act"])
        return self._teacher

    def _is_ready(self) -> bool:
        assert self._plant is not None
        _, said = self._plant.ask("GET", f"/api/teach/{CELL}")
        arm = next(each for each in said["devices"] if each["name"] == ROBOT)
        return arm["at"] is not None and arm["obstacle"] is None and not arm["moves"]

    def _on_broker(self, host: str, port: int) -> None:
        self._cable.lead_to(host, port)
        self._arm.join(Address(host="127.0.0.1", port=self._cable.port))


def share(values: Sequence[float], part: float) -> float:
    """The value that this part of them does not exceed."""
    in_order = sorted(values)
    return in_order[max(0, math.ceil(part * len(in_order)) - 1)]


def main(arguments: Sequence[str] | None = None) -> int:
    options = parser(__doc__)
    options.add_argument("--rounds", type=int, default=30, help="of each loss")
    rounds = options.parse_args(arguments).rounds
    with tempfile.TemporaryDirectory() as folder:
        found = Bench(Path(folder), lambda line: print(line, file=sys.stderr, flush=True)).run(rounds)
    for loss, values in found.items():
        told = ", ".join(f"p{round(part * 100)} {share(values, part) * 1000:.0f} ms" for part in (0.5, 0.99))
        print(f"{loss} lost, {len(values)} times: {told}, most {max(values) * 1000:.0f} ms")
    return 0


if __name__ == "__main__":
    sys.exit(main())
