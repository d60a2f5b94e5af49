"""Ways of a task to the leader from a host that runs no plant: by a command, by the standby's address."""

from __future__ import annotations

import re
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

import httpx

from ..people import ACCEPTED, OVER
from ..processes import UP, environment
from .cast import BROKER, UNHEARD, Cast, HostPlant
from .network import Network

COMMAND, STATUS, STANDBY = "by a command", "by `arboleda status`", "by the standby's address"
PATIENCE_S = 300.0  # of who waits for a task
ANSWER_S = 5.0
SENT_ON = 307
FOLLOWED = re.compile(r": (asked|followed) there$", re.MULTILINE)


@dataclass(frozen=True, kw_only=True)
class Answer:
    """`state` is "" where nobody said that the task is known; `sentence` is why, or why no more is known."""

    state: str = ""
    sentence: str = ""


Way = Callable[[str], Answer]


class Ways:
    """From the broker's host. `followed`: how often somebody was sent on, asked or went on at a leader;
    `looked`: what `arboleda status` said where it showed no plant; `trouble`: tracebacks."""

    def __init__(self, network: Network, cast: Cast, waits: Callable[[], HostPlant]) -> None:
        self._network, self._cast, self._waits = network, cast, waits
        self.all: dict[str, Way] = {COMMAND: self._by_command, STANDBY: self._by_standby}
        self.followed: Counter[str] = Counter()
        self.looked: Counter[tuple[str, str]] = Counter()
        self.trouble: list[str] = []

    def _by_command(self, task: str) -> Answer:
        """As a person does: submit and wait; then a look at the plant."""
        done = self._typed("submit", "--wait", task)
        states = [line.partition(":")[0] for line in done.stdout.splitlines()]
        state = states[-1] if states else ""
        if state not in OVER:
            return Answer(state=state, sentence=_last(done.stderr) or f"status {done.returncode}")
        looked = self._typed("status")
        if looked.returncode:
            self.looked[STATUS, _last(looked.stderr)] += 1
        return Answer(state=state)

    def _typed(self, *words: str) -> subprocess.CompletedProcess[str]:
        places = ("--store", self._cast.store, "--state", str(self._cast.visitor))
        done = subprocess.run(
            [*self._network.on(BROKER), sys.executable, "-c", UP, *words, *places],
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            env={**environment(), "COLUMNS": "400"},
        )
        self.followed.update(FOLLOWED.findall(done.stderr))
        if "Traceback" in done.stderr:
            self.trouble.append(f"{' '.join(words)}: {done.stderr}")
        return done

    def _by_standby(self, task: str) -> Answer:
        """As a program does that shows its token at the address to which it is sent on."""
        with self._network.inside(BROKER):
            try:
                answer = self._posted(f"{self._waits().url}/api/tasks", task)
                if answer.status_code == SENT_ON:
                    self.followed["sent on"] += 1
                    answer = self._posted(answer.headers["location"], task)
                said = answer.json()
            except (*UNHEARD, ValueError) as error:
                return Answer(sentence=f"no answer: {error}")
        if answer.status_code == ACCEPTED:
            return Answer(state=said["state"])
        return Answer(sentence=f"status {answer.status_code}: {said.get('sentence', '')}")

    def _posted(self, url: str, task: str) -> httpx.Response:
        return httpx.post(
            url, json={"text": task}, headers=self._cast.shown, timeout=ANSWER_S, trust_env=False
        )


def _last(said: str) -> str:
    lines = [line for line in said.splitlines() if line and not FOLLOWED.search(line)]
    return lines[-1] if lines else ""
