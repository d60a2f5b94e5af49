"""Plant with virtual boards behind the real API, its guard and its desk of proposals; time is moved."""

from __future__ import annotations

import asyncio
import json
import threading
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from datetime import datetime
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest import mock

import anyio.to_thread
import httpx
from tests.threads import run_here

from arboleda.core.plant import Plant
from arboleda.model.messages import (
    Event,
    OperatorAnswer,
    OperatorRequest,
    Revision,
    RevisionAnswer,
    TaskChanged,
    TaskRequest,
    TaskState,
    Verb,
)
from arboleda.model.plant_model import PlantModel
from arboleda.model.verbs import Arguments
from arboleda.plant_check import draft_check
from arboleda.plant_file import loader
from arboleda.runtime import at_work
from arboleda.runtime.parts.orchestrator import PutToWork
from arboleda.store.task_rows import TaskQuery
from arboleda.testing import Rig
from arboleda.views import view
from arboleda.web.access.auth import Door, Role
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.api import make_app
from arboleda.web.package_routes import taking
from arboleda.web.plant_api import PlantApi, Snapshot
from arboleda_make.drafts.plant_folder import PlantFolder
from arboleda_make.proposals.api import ProposalsApi
from arboleda_make.proposals.desk import ProposalDesk
from arboleda_make.versions.desk import VersionDesk

AT = "2026-11-26T08:00:00+00:00"
PLANT = """name: lab
uses: [rest.xml, shine.xml]
assistants: submit
assistant_limits: {cells: [cell], at_once: 1}
kinds:
  lamp:
    facts: {lit: bool}
    verbs:
      shine: {effect: switch, sets: {lit: true}}
      dark: {effect: switch, sets: {lit: false}}
cells:
  cell:
    devices:
      loader: {kind: arm, model: scara}
      lamp: {kind: lamp}
    targets:
      home: {loader: {deg: [0, 0], mm: 0}}
      feed: {loader: {deg: [60, 20], mm: 80, approach_mm: 40}}
"""
TREE = '<root BTCPP_format="4"><BehaviorTree ID="{name}">{steps}</BehaviorTree></root>\n'
REST = TREE.format(name="Rest", steps="<loader_home/>")
SHINE = TREE.format(name="Shine", steps="<lamp_shine/>")
TOKENS = {Role.VIEWER: "v" * 32, Role.OPERATOR: "o" * 32, Role.ASSISTANT: "a" * 32}
HOST = "127.0.0.1"


class Site(PlantApi):
    """Site: a plant at rest whose boards count their commands; what is asked over HTTP reaches it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.plant_file = folder / "plant.yaml"
        for name, text in {"plant.yaml": PLANT, "rest.xml": REST, "shine.xml": SHINE}.items():
            (folder / name).write_text(text)
        state = folder / "state"
        state.mkdir()
        model, files = loader.load_with_files(self.plant_file)
        at_work.keep(state, files, AT)
        self.rig = Rig(model)
        self.turns = threading.RLock()
        self.revisions: list[str] = []
        self.given: dict[str, str] = {}  # by the ids of tasks, the way by which they came
        home = PlantFolder(self.plant_file, state)
        port = SimpleNamespace(plant=SimpleNamespace(cells={}), revise=self.revise, loop=self)
        self.versions_desk = VersionDesk(
            home,
            state,
            port,  # type: ignore[arg-type]
            as_it_runs=lambda each: each,
            check=draft_check.check,
        )
        self.desk = ProposalDesk(
            home,
            state,
            self.versions_desk,
            SimpleNamespace(check=draft_check.check, stop=lambda: None),  # type: ignore[arg-type]
            self,
            lambda: datetime(2026, 1, 1),
        )
        self.home()

    def home(self) -> None:
        """Have the arm find its home, as a person does; what is counted begins after that."""
        with self.turns:
            self.rig.wait(5.0)
            self.rig.operate(Verb.HOME, "loader")
            self.rig.wait(60.0, lambda: self.rig.plant.cells["cell"].is_between_tasks)
            self.rig.wait(20.0)
            self._before = len(self.rig.to_boards)

    @property
    def moved(self) -> int:
        """Commands that reached the virtual boards; time passes first, so that what was begun goes on."""
        with self.turns:
            self.rig.wait(1.0)
            return len(self.rig.to_boards) - self._before

    @property
    def model(self) -> PlantModel:
        return self.rig.plant.model

    def ask(self, kind: type[Any]) -> Any:
        return self.desk if kind is ProposalsApi else None

    def read(self, look: Callable[[Plant], Any]) -> Any:
        with self.turns:
            return look(self.rig.plant)

    def revise(self, put: PutToWork) -> Future[RevisionAnswer]:
        with self.turns:
            self.revisions.append(put.by)
            self.rig.plant.versions[put.version.digest] = put.model
            event = Revision(at=self.rig.now, version=put.version, by=put.by, changes=put.changes)
            return _done(self._answer(event, RevisionAnswer))

    def submit(self, text: str, asked_by: str, choice: str = "", version: str = "") -> Future[dict[str, Any]]:
        with self.turns:
            request = TaskRequest(at=self.rig.now, text=text, request=text, choice=choice, version=version)
            change = self._answer(request, TaskChanged)
            self.given[change.task] = asked_by
            return _done(view.change(change))

    def operate(
        self, verb: Verb, scope: str, *, by_hand: bool = False, arguments: Arguments = ()
    ) -> Future[OperatorAnswer]:
        with self.turns:
            request = OperatorRequest(
                at=self.rig.now, verb=verb, scope=scope, by_hand=by_hand, arguments=arguments
            )
            return _done(self._answer(request, OperatorAnswer))

    def history(self, query: TaskQuery) -> list[Any]:
        with self.turns:
            is_open = (TaskState.QUEUED, TaskState.RUNNING)
            tasks = [each for each in self.rig.plant.intake.tasks.values() if each.state in is_open]
            return [SimpleNamespace(asked_by=self.given.get(each.id)) for each in tasks]

    def snapshot(self) -> Snapshot:
        return self.read(view.snapshot)  # type: ignore[no-any-return]

    def latest(self) -> Snapshot:
        return self.snapshot()

    def find(self, task: str) -> dict[str, Any] | None:
        return None

    def watch(self, callback: Callable[[Snapshot], None]) -> Callable[[], None]:
        return lambda: None

    def _answer(self, event: Event, kind: type) -> Any:
        before = len(self.rig.sent)
        self.rig.tell(event)
        return next(each for each in self.rig.sent[before:] if isinstance(each, kind))


def _done(result: Any) -> Future[Any]:
    future: Future[Any] = Future()
    future.set_result(result)
    return future


class Caller:
    """Caller: sends requests to the API of a site as it is on a network, where a token is wanted."""

    def __init__(self, site: Site) -> None:
        door = Door(lambda: TOKENS)
        self._door = door
        app = make_app(site)
        self._app = Guard(app, names_for(HOST, None), door, takes=taking(app))
        self.sent = 0

    async def send(
        self, method: str, path: str, body: Any = None, headers: Mapping[str, str] | None = None
    ) -> httpx.Response:
        """The answer to one request."""
        self.sent += 1
        transport = httpx.ASGITransport(app=self._app)  # type: ignore[arg-type]
        async with httpx.AsyncClient(transport=transport, base_url=f"http://{HOST}:8080") as client:
            content = json.dumps(body)  # also letters that UTF-8 has not
            return await client.request(method, path, content=content, headers=dict(headers or {}))

    def session(self, role: Role) -> str:
        """A cookie of a browser that logged in."""
        return f"arboleda_8080={self._door.log_in(TOKENS[role].encode())}"

    def all(self, requests: Iterator[tuple[Any, ...]]) -> list[httpx.Response]:
        """The answers to many, one after the other."""

        async def work() -> list[httpx.Response]:
            return [await self.send(*each) for each in requests]

        with mock.patch.object(anyio.to_thread, "run_sync", run_here):
            return asyncio.run(work())


def bearer(role: Role) -> dict[str, str]:
    return {"authorization": f"Bearer {TOKENS[role]}"}
