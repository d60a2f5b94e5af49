"""The plant and its boards as processes."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import httpx

from arboleda.runtime.state import find_running

from .deeds import Deed

BROKER = re.compile(r"MQTT broker: (\S+):(\d+)")
UP = "from arboleda.cli.main import main; main()"
PATIENCE_S = 60.0
LOOK_S = 0.02


class Ended(Exception):
    """The plant ended by itself, or did not come up; its last words."""


class Plant:
    """`arboleda up` as people start it, until `kill`; no board is there before `joined_at`.

    `command`: another one that runs the plant of `state`, instead. `shown`: headers of whoever asks it.
    """

    def __init__(
        self,
        state: Path,
        log: Path,
        on_broker: Callable[[str, int], None],
        options: Sequence[str] = (),
        *,
        command: Sequence[str] = (),
        shown: Mapping[str, str] | None = None,
    ) -> None:
        self.started_at = time.time()
        self.joined_at = float("inf")
        self._state, self._log, self._on_broker = state, log, on_broker
        self._shown = dict(shown or {})
        self._port: int | None = None
        up = (sys.executable, "-c", UP, "up", "--no-ros", "--boards", "real", "--state", str(state))
        self._child = subprocess.Popen(
            [*(command or up), *options],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**environment(), "PYTHONUNBUFFERED": "1", "COLUMNS": "200"},
            start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self.http: httpx.Client | None = None

    def kill(self) -> None:
        """kill -9, the whole of it."""
        if self._child.poll() is None:
            os.killpg(self._child.pid, signal.SIGKILL)
        self._child.wait(PATIENCE_S)
        self._reader.join(PATIENCE_S)
        if self.http is not None:
            self.http.close()

    def interrupt(self) -> int:
        """Ctrl-C; the exit status."""
        self._child.send_signal(signal.SIGINT)
        return self._child.wait(PATIENCE_S)

    def await_api(self, until: float) -> bool:
        """True if its API answers by that time; Ended where it has ended instead."""
        while time.time() < until:
            self.check()
            running = find_running(self._state)
            if running is not None and running.port is not None and running.pid == self._child.pid:
                self.http = httpx.Client(
                    base_url=running.url, headers=self._shown, trust_env=False, timeout=10.0
                )
                return self.http.get("/api/plant").status_code == httpx.codes.OK
            time.sleep(LOOK_S)
        return False

    def freeze(self, *, on: bool) -> None:
        """Stop it where it is, or let it go on."""
        self._child.send_signal(signal.SIGSTOP if on else signal.SIGCONT)

    @property
    def pid(self) -> int:
        return self._child.pid

    def ended(self) -> tuple[int, str]:
        """Status and last words, once it has ended by itself."""
        status = self._child.wait(PATIENCE_S)
        self._reader.join(PATIENCE_S)
        return status, self._last_words()

    def check(self) -> None:
        """Ended where it runs no more."""
        if self._child.poll() is not None:
            self._reader.join(PATIENCE_S)
            raise Ended(f"the plant ended with status {self._child.returncode}: {self._last_words()}")

    def ask(self, method: str, path: str, body: dict[str, Any] | None = None) -> tuple[int, Any]:
        """Status and content of an answer."""
        assert self.http is not None
        answer = self.http.request(method, path, json=body)
        return answer.status_code, answer.json()

    def _read(self) -> None:
        assert self._child.stdout is not None
        with self._log.open("a") as log:
            for line in self._child.stdout:
                log.write(line)
                log.flush()
                if found := BROKER.search(line):
                    self.joined_at = time.time()
                    self._on_broker(found[1].strip("[]"), int(found[2]))

    def _last_words(self) -> str:
        lines = self._log.read_text(errors="replace").strip().splitlines()
        return lines[-1] if lines else "it said nothing"


class Teller:
    """A module of ours as a process that says JSON, a line each, which `hear` takes, until `end`.

    `before`: what its command begins with.
    """

    def __init__(
        self, module: str, words: Sequence[str], log: Path, hear: Callable[[Any], None], before: Sequence[str]
    ) -> None:
        self._hear = hear
        with log.open("wb") as errors:
            self._child = subprocess.Popen(
                [*before, sys.executable, "-m", module, *words],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=errors,
                text=True,
                env=environment(),
                start_new_session=True,
            )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def end(self) -> None:
        """Close its input and wait for its end."""
        assert self._child.stdin is not None
        self._child.stdin.close()
        self._child.wait(PATIENCE_S)
        self._reader.join(PATIENCE_S)

    def _read(self) -> None:
        assert self._child.stdout is not None
        for line in self._child.stdout:
            self._hear(json.loads(line))


class Boards(Teller):
    """The process of `boards.py`; `deeds` grows while it runs."""

    def __init__(self, rate: float, log: Path, before: Sequence[str] = ()) -> None:
        self.deeds: list[Deed] = []
        super().__init__("arboleda_kills.boards", [str(rate)], log, self._did, before)

    def _did(self, said: dict[str, Any]) -> None:
        self.deeds.append(Deed.of(said))

    def broker(self, host: str, port: int) -> None:
        """Tell them where the plant's broker is."""
        self.act({"broker": [host, port]})

    def leave(self) -> None:
        """Tell them that it is gone."""
        self.act({"broker": None})

    def act(self, line: dict[str, Any]) -> None:
        """Have something done at the boards."""
        assert self._child.stdin is not None
        if self._child.poll() is not None:
            raise Ended(f"the boards ended with status {self._child.returncode}")
        self._child.stdin.write(json.dumps(line) + "\n")
        self._child.stdin.flush()


def environment() -> dict[str, str]:
    """That of this process, for one that finds the same packages."""
    return {**os.environ, "PYTHONPATH": paths()}


def paths() -> str:
    """Folders in which this interpreter finds its packages, for one that it starts."""
    return os.pathsep.join(path for path in sys.path if path)
