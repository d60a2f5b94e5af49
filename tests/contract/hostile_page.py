"""A page in a process of its own, before a plant whose every text is the argument; prints its address."""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from fastapi import FastAPI

from arboleda.dashboard import page
from arboleda.model.errors import StartError
from arboleda.model.messages import OperatorAnswer, Verb
from arboleda.model.sentence import OWN, Sentence
from arboleda.oee.figures import Oee, PastTimes, oee
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda.testing import Rig, shipped
from arboleda.views import view
from arboleda.web.access.auth import Door
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.server import Server

EVIL = sys.argv[1]
SAID = {
    "text",
    "sentence",
    "feedback",
    "failure",
    "what",
    "held_by",
    "not_ready",
    "said",
    "why",
    *(verb.value for verb in Verb),
    "refusal",
    "waiting_for",
    "last",
    "obstacle",
    "id",
    "step",
}


def poisoned(data: Any, key: str = "") -> Any:
    """The same data with every text that a person or a device may have written made an attack."""
    if isinstance(data, dict):
        return {name: poisoned(value, name) for name, value in data.items()}
    if isinstance(data, list):
        return [poisoned(value, key) for value in data]
    if isinstance(data, Sentence) and key in SAID:
        return OWN(text=f"{data} {EVIL}")
    return f"{data} {EVIL}" if isinstance(data, str) and key in SAID else data


class Side:
    """A plant in the middle of its work, told in such words."""

    def __init__(self) -> None:
        rig = Rig(shipped())
        rig.wait(0.5)
        rig.submit("sis_a 0B 7")
        rig.submit("sis_a 0B 7")
        rig.submit("sis_b 0B 7")
        rig.wait_for("sis_a", "move to pick-up")
        rig.operate(Verb.STOP, "sis_b")
        self._layout = view.layout(rig.plant.model) | {"plant": EVIL}
        self._snapshot = poisoned(rig.snapshot())

    def snapshot(self, within_s: float = 0.0) -> dict[str, Any]:
        return self._snapshot

    def layout(self) -> dict[str, Any]:
        return self._layout

    def links(self) -> dict[str, Any]:
        broker = {"address": EVIL, "connected": True}
        return {"broker": broker, "ros": None, "refused": {"": {"count": 1, "last": EVIL}}, "standbys": []}

    def past_acts(self) -> list[dict[str, Any]]:
        return [{"at": 0.0, "cell": EVIL, "scope": EVIL, "sentence": EVIL}]

    def history(self, query: TaskQuery) -> list[TaskRow]:
        said = {"id": EVIL, "text": EVIL, "cell": EVIL, "recipe": EVIL, "sentence": EVIL, "said": EVIL}
        times = {"accepted_s": 0.0, "started_s": None, "ended_s": None}
        return [TaskRow(number=1, state="failed", reason="deadline", **said, **times)]

    def ask(self, kind: type) -> Any:
        return self if kind.__name__ == "OeeApi" else None  # of arboleda_fleet, where it is installed

    def oee(self, query: Any) -> list[Oee]:
        return [oee(EVIL, PastTimes(works=[], runs=[], downs=[], shortest={}), 0.0, 1.0)]

    def submit(self, text: str, _asked_by: str) -> Future[dict[str, Any]]:
        answer: Future[dict[str, Any]] = Future()
        answer.set_result({"state": "refused", "sentence": f"{text} {EVIL}"})
        return answer

    def operate(self, verb: Verb, scope: str, **_: Any) -> Future[OperatorAnswer]:
        answer: Future[OperatorAnswer] = Future()
        answer.set_result(OperatorAnswer(verb=verb, scope=scope, refusal=EVIL))
        return answer

    def act(self, number: int) -> dict[str, Any] | None:
        return None

    def watch(self, callback: Callable[[dict[str, Any]], None]) -> Callable[[], None]:
        return lambda: None


def main() -> None:
    app = FastAPI()
    page.mount(app, Side())
    try:
        page.mount(FastAPI(), Side())
    except StartError as error:
        print(f"second page: {error}")
    server = Server(Guard(app, names_for("127.0.0.1", None), Door(None)), port=0)
    print(f"http://127.0.0.1:{server.start()}", flush=True)
    sys.stdin.read()
    server.stop()


if __name__ == "__main__":
    main()
