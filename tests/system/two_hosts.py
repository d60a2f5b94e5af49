"""Two processes of the shipped plant, their boards, their broker."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import httpx

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.runtime.state import find_running
from arboleda_kills.deeds import Did
from arboleda_kills.processes import Boards, Plant

from .. import patience
from .patient_plant import patient_plant

TASK = {"text": "sis_a 0B 7 #lot-1"}
PATIENCE_S = max(75.0, patience.PATIENCE_S)


class Hosts:
    """The processes, their boards and their broker; `ask` asks one of them."""

    def __init__(self, folder: Path, database: str, port: int) -> None:
        self._folder = folder
        self._broker = EmbeddedBroker(port=port)
        self._broker.start()
        self._options = (
            "--plant",
            str(patient_plant(folder)),
            "--store",
            database,
            "--broker",
            f"127.0.0.1:{port}",
        )
        self.boards = Boards(1.0, folder / "boards.log")
        self.boards.broker("127.0.0.1", port)
        self.plants: dict[str, Plant] = {}

    def up(self, name: str, *options: str) -> Plant:
        log = self._folder / f"{name}.log"
        made = Plant(self._folder / name, log, lambda *_: None, (*self._options, *options))
        self.plants[name] = made
        return made

    def ask(self, name: str) -> dict[str, Any]:
        """What its API says of the plant; {} where nobody answers."""
        running = find_running(self._folder / name)
        if running is None or running.port is None:
            return {}
        try:
            return httpx.get(f"{running.url}/api/plant", trust_env=False, timeout=PATIENCE_S).json()
        except httpx.HTTPError:
            return {}

    def cell(self, name: str) -> dict[str, Any]:
        return next((row for row in self.ask(name).get("cells", ()) if row["name"] == "sis_a"), {})

    def until(self, true: Callable[[], Any]) -> None:
        """Wait for what another process does; where it never does, the error has what each of them says."""
        ends = time.monotonic() + PATIENCE_S
        while not true():
            assert time.monotonic() < ends, {
                name: (self.cell(name), self._log_of(name)) for name in self.plants
            }
            time.sleep(0.02)

    def led_by_a(self, ports: Sequence[int] = ()) -> None:
        """A leader whose first cell could work, and a standby that waits for it; `ports` of their pages."""
        at_a, at_b = (("--port", str(port)) for port in ports) if ports else ((), ())
        self.up("a", *at_a)
        self.until(lambda: self.cell("a").get("not_ready", "no") is None)
        self.up("b", "--standby", *at_b)
        self.until(lambda: "process" in self.ask("b").get("sentence", ""))

    def at_work(self, ports: Sequence[int] = ()) -> None:
        """The same, and it drives."""
        self.led_by_a(ports)
        self.drives()

    def drives(self) -> None:
        """The leader's first cell begins a task."""
        assert self.plants["a"].await_api(time.time() + PATIENCE_S)
        assert self.plants["a"].ask("POST", "/api/tasks", TASK)[0] == 202
        self.until(lambda: self.cell("a").get("step") == "drive path 0B")

    def parts(self) -> list[tuple[Did, str]]:
        return [(deed.did, deed.what) for deed in self.boards.deeds if deed.did is not Did.WAS_TOLD]

    def finish_with(self, name: str) -> None:
        """The task that was at work comes to its end there, once somebody lets it go on."""
        self.until(
            lambda: self.cell(name).get("state") == "held" and "resume" not in self.cell(name)["refused"]
        )
        assert self.plants[name].await_api(time.time() + PATIENCE_S)
        assert self.plants[name].ask("POST", "/api/cells/sis_a/resume")[0] == 200
        self.done_with(name)

    def done_with(self, name: str) -> None:
        self.until(lambda: self.cell(name).get("state") == "idle")
        assert self.plants[name].await_api(time.time() + PATIENCE_S)
        kept = {row["id"]: row for row in self.plants[name].ask("GET", "/api/history")[1]}
        assert kept["lot-1"]["state"] == "done", (kept, self._log_of(name))
        assert self.parts() == [(Did.PICKED, "pick-up"), (Did.LET_GO, "station 7")]

    def _log_of(self, name: str) -> str:
        return (self._folder / f"{name}.log").read_text(encoding="utf-8", errors="replace")

    def end(self) -> None:
        for each in self.plants.values():
            each.kill()
        self.boards.end()
        self._broker.stop()
