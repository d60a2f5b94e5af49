"""Plant with parts of packages, for tests of these: time is moved by hand, and no thread runs."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from functools import partial
from importlib.metadata import EntryPoint
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from arboleda.engine import Plant as Core
from arboleda.host.packages import package_of, registered
from arboleda.host.pieces import Piece, Pieces, piece_of
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import OperatorAnswer, OperatorRequest, TaskChanged, TaskRequest, Verb
from arboleda.model.plant_model import Link, PlantModel
from arboleda.model.verbs import Arguments
from arboleda.recorder.chapter import Chapter
from arboleda.rig.rig import Rig
from arboleda.runtime.extensions.alarms import PackageAlarms
from arboleda.runtime.extensions.chapters import Chapters
from arboleda.runtime.extensions.part import Part
from arboleda.runtime.extensions.plant import Plant, Uses
from arboleda.runtime.extensions.questions import Questions
from arboleda.runtime.extensions.table import Table, Writes
from arboleda.runtime.extensions.telling import Telling
from arboleda.store.package_table import PackageTable
from arboleda.store.sqlite import IN_MEMORY, Store
from arboleda.store.task_rows import TaskQuery, TaskRow
from arboleda.views import view
from arboleda.web.access.auth import Role
from arboleda.web.api import make_app
from arboleda.web.offers import Offers, Thing
from arboleda.web.part_routes import PartRoute, PartRoutes
from arboleda.web.plant_api import Found, PlantApi, Snapshot

if TYPE_CHECKING:
    import httpx

GROUP = "arboleda.parts"
AT = "http://127.0.0.1:8080"
NO_SETTINGS = "{part} needs settings: give plant_with one {settings}"
Kind = TypeVar("Kind", bound=Part)


class Raised(Pieces):
    """Pieces of packages in a test: what one raises ends the test."""

    def leave_out(self, piece: Piece, error: BaseException) -> None:
        raise error


class Side(PlantApi):
    """Rig as parts of a package, and the HTTP API, see a plant; it answers at once."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.things = Offers()
        self.watchers: list[Callable[[Snapshot], None]] = []
        self.beside: Callable[[], Snapshot] = dict  # what a snapshot has beside the plant's own

    @property
    def model(self) -> PlantModel:
        return self.rig.plant.model

    def read(self, look: Callable[[Core], Found]) -> Found:
        return look(self.rig.plant)

    def snapshot(self) -> Snapshot:
        return {**view.snapshot(self.rig.plant), **self.beside()}

    latest = snapshot

    def ask(self, kind: type[Thing]) -> Thing | None:
        return self.things.ask(kind)

    def find(self, task: str) -> dict[str, Any] | None:
        return view.task_by_id(self.rig.plant, task)

    def history(self, query: TaskQuery) -> list[TaskRow]:
        return []

    def submit(self, text: str, asked_by: str, choice: str = "") -> Future[dict[str, Any]]:
        request = TaskRequest(at=self.rig.now, text=text, request=text, choice=choice)
        return done(view.change(self._answer(request, TaskChanged)))

    def operate(
        self, verb: Verb, scope: str, *, by_hand: bool = False, arguments: Arguments = ()
    ) -> Future[OperatorAnswer]:
        request = OperatorRequest(
            at=self.rig.now, verb=verb, scope=scope, by_hand=by_hand, arguments=arguments
        )
        return done(self._answer(request, OperatorAnswer))

    def watch(self, callback: Callable[[Snapshot], None]) -> Callable[[], None]:
        self.watchers.append(callback)
        return lambda: self.watchers.remove(callback)

    def _answer(self, event: Any, kind: type[Any]) -> Any:
        before = len(self.rig.sent)
        self.rig.tell(event)
        return next(each for each in self.rig.sent[before:] if isinstance(each, kind))


class KeptChapters(list[Chapter]):
    """Chapters that parts have written into reports, as a record keeps them."""

    def add(self, chapter: Chapter) -> None:
        self.append(chapter)


class PlantWith:
    """A plant with parts of packages; `plant_with` makes it. Each device is a virtual board.

    `wait` moves time. What is asked takes effect at once, and parts are told of it before the call returns.
    """

    def __init__(
        self, parts: Iterable[type[Part]], *, settings: Iterable[object], model: PlantModel, folder: Path
    ) -> None:
        self.rig = Rig(model.on_boards(Link.ROS, Link.NONE, Link.DRIVER))
        self._settings = {type(each): each for each in settings}
        self._classes = tuple(parts)
        self._folder = folder
        self._memory = Store(IN_MEMORY)
        self._memory.open()
        self._seen = 0
        self._kept = KeptChapters()
        self._begin()

    def part(self, kind: type[Kind]) -> Kind:
        """The part of this class."""
        found = self._side.ask(kind)
        if found is None:
            raise ArboledaError(f"there is no {kind.__name__} here: name it in `parts`")
        return found

    def shown(self, kind: type[Part]) -> Mapping[str, Any]:
        """The values that the part of this class shows."""
        return self.part(kind).plant.shown

    @property
    def alarms(self) -> list[str]:
        """The alarms of parts that stand."""
        return [str(each.sentence) for each in self._alarms.standing]

    @property
    def questions(self) -> list[str]:
        """The questions of parts to people that wait for an answer."""
        return [each.text for each in self._questions.open]

    @property
    def chapters(self) -> list[Chapter]:
        """The chapters that parts have written into the reports of tasks."""
        return [*self._kept]

    def answer(self, word: str) -> None:
        """Answer the oldest question of a part; raises ArboledaError where this is no answer to one."""
        asked = next((each for each in self._questions.open if word in each.answers), None)
        if asked is None:
            raise ArboledaError(f"no part asks anything to which {word} is an answer")
        asked.answer.set_result(word)
        self._tell()

    def submit(self, text: str) -> str:
        """Ask for a task as a person; its state: queued, or the sentence of a refusal."""
        change = self.rig.submit(text)
        self._tell()
        return str(change.sentence) if change.state.value == "refused" else change.state.value

    def operate(
        self, verb: Verb | str, scope: str = "", *, by_hand: bool = False, **arguments: int | str
    ) -> str | None:
        """Act as an operator; the sentence of a refusal, None where it was done."""
        refusal = self.rig.operate(Verb(verb), scope, by_hand=by_hand, **arguments)
        self._tell()
        return refusal

    def wait(self, seconds: float = 600.0, until: Callable[[], bool] = lambda: False) -> bool:
        """Let at most these seconds pass; True as soon as `until` comes true."""
        end = self.rig.now + seconds
        while self.rig.now < end:
            self.rig.wait(end - self.rig.now, lambda: self._has_news or until())
            self._tell()
            if until():
                return True
        return until()

    def get(self, path: str, role: Role = Role.OPERATOR) -> Any:
        """The answer to `GET path`, as somebody of a role gets it; raises ArboledaError for a refusal."""
        return self.request("GET", path, role=role)

    def post(self, path: str, body: object = None, role: Role = Role.OPERATOR) -> Any:
        """The answer to `POST path` with this body, in the same way."""
        return self.request("POST", path, body, role=role)

    def request(self, method: str, path: str, body: object = None, *, role: Role = Role.OPERATOR) -> Any:
        """The answer to any other request, in the same way."""
        answer = self.response(method, path, body, role=role)
        if answer.is_error:
            raise ArboledaError(answer.json()["sentence"])
        is_json = answer.headers.get("content-type", "").startswith("application/json")
        return answer.json() if is_json else answer.content

    def response(
        self, method: str, path: str, body: object = None, *, role: Role = Role.OPERATOR
    ) -> httpx.Response:
        """The whole answer to a request, also to one that is refused: `status_code`, `headers`, `json()`."""
        answer = asyncio.run(self._asked(method, path, body, role))
        self._tell()
        return answer

    def restart(self) -> None:
        """Kill the plant and start it again, with what it and its parts have kept."""
        self.rig.crash()
        self._begin()

    def stop(self) -> None:
        """End the parts."""
        for part in reversed(self._parts):
            part.stop()

    def _begin(self) -> None:
        self._side = Side(self.rig)
        self._listeners: list[Callable[[TaskChanged], None]] = []
        self._tellings: list[Telling] = []
        self._routes = PartRoutes()
        self._side.things.offer(PartRoutes, self._routes)
        self._writes = Writes(lambda: None, lambda: False)
        self._alarms = PackageAlarms()
        running: Any = None  # `answer` below answers, and no plant
        self._questions = Questions(running, self.rig.plant.epoch)
        self._chapters = Chapters(lambda: self._kept)
        told = (self._alarms, self._questions, self._chapters)
        self._side.beside = lambda: {key: rows for each in told for key, rows in each.rows().items()}
        self._parts = [self._made(each) for each in self._classes]
        for part in self._parts:
            part.start()
        self._app = make_app(self._side, pieces=Raised())
        self._tell()

    def _made(self, kind: type[Part]) -> Part:
        point = _point(kind)
        telling = Telling(point.name, Raised(), partial(piece_of, point))
        uses = Uses(
            package=package_of(point),
            side=self._side,
            telling=telling,
            alarms=self._alarms,
            questions=self._questions,
            chapters=self._chapters,
            tell_tasks=self._listeners.append,
            tell_views=self._side.watchers.append,
            table=self._table,
            folder=partial(_folder, self._folder / point.name),
        )
        plant = Plant(point.name, uses)
        part = kind(plant, self._settings_of(kind))
        self._side.things.offer(kind, part)
        self._tellings.append(telling)
        self._routes.append(PartRoute(point, piece_of(point, f"the part {kind.__name__}"), part.routes))
        return part

    def _settings_of(self, kind: type[Part]) -> object:
        if kind.settings_type is None:
            return None
        if kind.settings_type not in self._settings:
            with suppress(TypeError):  # it has no value that must be given
                return kind.settings_type()
            raise ArboledaError(NO_SETTINGS.format(part=kind.__name__, settings=kind.settings_type.__name__))
        return self._settings[kind.settings_type]

    def _table(self, name: str) -> Table:
        return Table(PackageTable(self._memory, name), self._writes)

    @property
    def _has_news(self) -> bool:
        return len(self.rig.changes) > self._seen

    def _tell(self) -> None:
        """Tell the parts of what happened, and of what they do about it."""
        while self._has_news or any(each.turn() for each in self._tellings):
            news, self._seen = self.rig.changes[self._seen :], len(self.rig.changes)
            for change in news:
                for listener in self._listeners:
                    listener(change)
            if news and self._side.watchers:
                snapshot = self._side.snapshot()
                for watcher in self._side.watchers:
                    watcher(snapshot)

    async def _asked(self, method: str, path: str, body: object, role: Role) -> httpx.Response:
        import httpx

        async def asked(scope: Any, receive: Any, send: Any) -> None:
            await self._app({**scope, "arboleda.role": role}, receive, send)

        async with httpx.AsyncClient(transport=httpx.ASGITransport(asked), base_url=AT) as http:
            return await http.request(method, path, json=body)


def done(result: Any) -> Future[Any]:
    """A future that has its result."""
    future: Future[Any] = Future()
    future.set_result(result)
    return future


def _point(kind: type[Part]) -> EntryPoint:
    """The entry point by which a package registers a part; one of the class's own name where none does."""
    value = f"{kind.__module__}:{kind.__qualname__}"
    registers = (each for each in registered(GROUP) if each.value == value)
    return next(registers, EntryPoint(kind.__name__.lower(), value, GROUP))


def _folder(path: Path) -> Path:
    path.mkdir(parents=True, exist_ok=True)
    return path
