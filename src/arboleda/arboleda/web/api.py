"""Routes of the HTTP API, and the answer to requests that no route takes."""

from __future__ import annotations

import asyncio
import json
import logging
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import asdict
from typing import Any, TypeVar
from urllib.parse import quote

from fastapi import APIRouter, FastAPI, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, PlainTextResponse, Response
from pydantic import ValidationError
from starlette.exceptions import HTTPException
from starlette.routing import BaseRoute, Match
from starlette.types import Receive, Scope, Send

from arboleda import __version__
from arboleda.client.answers.plant import Snapshot
from arboleda.client.answers.tasks import Act, Done, KeptTask, Task
from arboleda.client.protocol import COMMAND_LINE
from arboleda.departures.leaving import Unkept
from arboleda.host.packages import left_out
from arboleda.host.pieces import Pieces, short
from arboleda.model.errors import ArboledaError, PayloadError, QueueFull, Refused, TextError
from arboleda.model.messages import Outcome, Verb
from arboleda.model.outside import plain, quoted
from arboleda.model.packages import PackageMissing
from arboleda.model.sentence import explained
from arboleda.model.verbs import Arguments, from_text
from arboleda.store.task_rows import COMMAND, HTTP, TaskRow, answers_of, choice_of, table, unchecked_of

from . import limits, stream
from .access import login
from .access.auth import SUBMIT, Forbidden, require
from .limits import LATER_S
from .missing import missing, package_missing
from .package_routes import ASKED
from .plant_api import PlantApi
from .request import METRICS, is_api
from .routes import installed, packaged
from .routes import routers as looks
from .schema import openapi
from .schema.bodies import AnyVerbArguments, Sentence, TaskFilter, TaskForm, TaskText, VerbArguments
from .schema.plain_json import PlainJson
from .schema.queries import (
    WRONG,
    Answers,
    answering,
    described,
    described_body,
    query_of,
    text_answer,
    wrong_parameter,
)


class NotFound(BaseRoute):
    """The last of the `routes`. Pages are mounted after it, and take every path; without it they would
    answer for a route of ours that was asked with another method."""

    def __init__(self, routes: Sequence[BaseRoute], pieces: Pieces) -> None:
        self._routes = tuple(routes)
        self._packages = installed()
        self._pieces = pieces

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        if scope["type"] != "http":
            return Match.NONE, {}
        methods = self._methods(scope)
        ours = methods or is_api(scope["path"]) or package_missing(scope["path"], self._packages)
        return (Match.FULL if ours else Match.NONE), {"arboleda.methods": methods}

    async def handle(self, scope: Scope, receive: Receive, send: Send) -> None:
        methods = ", ".join(scope["arboleda.methods"])
        if not methods:
            package = package_missing(scope["path"], self._packages)
            if package is not None:
                raise missing(package)
            why = (NOTHING, *left_out(), *self._pieces.without_routes)
            raise HTTPException(404, "; ".join(why) if why[1:] else f"{NOTHING}.")
        raise HTTPException(405, f"Here one can {methods} only.", {"allow": methods})

    def _methods(self, scope: Scope) -> list[str]:
        known = [route for route in self._routes if route.matches(scope)[0] is Match.PARTIAL]
        return sorted({method for route in known for method in getattr(route, "methods", None) or ()})


NOTHING = "There is nothing here; /api/docs lists what there is"
NOTHING_SENT = "No response returned."
log = logging.getLogger(__name__)
Answer = TypeVar("Answer")

EXAMPLE = (
    "sis_a 0B 7",
    '{"cell": "sis_a", "values": {"path": "0B", "station": 7}}',
    '["sis_a", "sis_b"]',
)
ANSWER_S = 5.0
ABOUT = """Look at a running plant, give it tasks, and operate it. What is refused says why in one sentence.
Where the plant is open to a network every request carries a token (Authorization: Bearer ...). A process
that stands by for the plant answers 307 with the address of the one that leads it, to which a client shows
its token itself, or 503 with Retry-After. Who names a plant in a header Arboleda-Plant is refused with 421
where another one answers. The stop is a stop in software and no safety function."""
STATUS = {TextError: 422, PayloadError: 422, Forbidden: 403, Refused: 409, PackageMissing: 501}
OTHERS: Answers = {
    "default": {"model": Sentence, "description": "401 without a token, 413 too long, 429 too often, ..."}
}
REFUSED: Answers = {
    403: {"model": Sentence, "description": "The role is not enough, or a page of another site asks."},
    422: {"model": Sentence, "description": "The request is wrong."},
    503: {"model": Sentence, "description": "Not now; with Retry-After where a queue is full."},
}
ACCEPTED: Answers = {
    202: {
        "model": Done,
        "description": "Devices do it now, and its act tells its end; or it is a stop that has left for its "
        "robots, and the plant cannot keep it, or not yet; or a hold that the plant has yet to do.",
    }
}
CONFLICT: Answers = {409: {"model": Sentence, "description": "The plant does not do this now."}}
CSV, PROMETHEUS = "text/csv; charset=utf-8", "text/plain; version=0.0.4; charset=utf-8"
NO_ACT: Answers = {404: {"model": Sentence, "description": "The plant does not know this act (any more)."}}
UNKNOWN: Answers = {404: {"model": Sentence, "description": "There is no such task."}}


def make_app(
    side: PlantApi,
    *,
    streams: int = limits.STREAMS,
    counts: Callable[[], bytes] | None = None,
    pieces: Pieces | None = None,
) -> FastAPI:
    """An application with the routes; pages may be mounted on it afterwards. It wants a Guard before it.

    At most so many `streams` of changes are open at a time; `counts` is what Prometheus gets, in its format.
    `pieces` calls what is of packages.
    """
    app = openapi.DescribedApp(
        OTHERS,
        title="Arboleda",
        version=__version__,
        description=ABOUT,
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        redirect_slashes=False,
    )
    answer_in_sentences(app)
    routers = [routes(side), *looks(side), stream.routes(side, streams)]
    routers += [login.routes(), openapi.routes(app)]
    routers += [_metrics(counts)] if counts is not None else []
    pieces = pieces or Pieces()
    routers += packaged(side, routers, pieces)
    app.serve(routers)
    app.router.routes.append(NotFound([route for router in routers for route in router.routes], pieces))
    return app


def answer_in_sentences(app: FastAPI) -> None:
    """Have an application answer with a sentence where it refuses, and where it fails."""
    app.add_exception_handler(ArboledaError, refuse)
    app.add_exception_handler(HTTPException, refuse)
    app.add_exception_handler(RequestValidationError, refuse_parameter)
    app.add_exception_handler(Exception, own_up)


def _metrics(counts: Callable[[], bytes]) -> APIRouter:
    """Register the route for Prometheus; `counts` may wait for the plant."""
    api = APIRouter()

    @api.get(METRICS, response_class=Response, responses=text_answer(PROMETHEUS, "Counts and states."))
    async def metrics() -> PlainTextResponse:
        """Counts and states in the text format of Prometheus."""
        return PlainTextResponse(await run_in_threadpool(counts), media_type=PROMETHEUS)

    return api


def routes(side: PlantApi) -> APIRouter:
    """Register the routes that look, submit and operate."""
    api = APIRouter(prefix="/api")
    _look(api, side)
    _submit(api, side)
    _operate(api, side)
    _follow(api, side)
    return api


def _look(api: APIRouter, side: PlantApi) -> None:
    @api.get("/plant", **answering(Snapshot))
    async def plant() -> JSONResponse:
        """The whole plant: cells with their trees, robots, tasks, zones."""
        return PlainJson(await run_in_threadpool(side.latest))

    @api.get("/tasks", **answering(list[Task]))
    async def tasks() -> JSONResponse:
        """The open tasks and those that ended last, in the order of their acceptance."""
        latest = await run_in_threadpool(side.latest)
        return PlainJson([explained(task) for task in latest["tasks"]])

    takes = described(TaskFilter)

    @api.get("/history", **answering(list[KeptTask], WRONG, takes))
    async def history(request: Request) -> JSONResponse:
        """Tasks of all starts, the last accepted first; the next page is `before` the last `number`."""
        rows = await run_in_threadpool(side.history, query_of(request, TaskFilter).query())
        return PlainJson([_kept(row) for row in rows])

    table_or_wrong = WRONG | text_answer(CSV, "The table.")

    @api.get("/history.csv", response_class=Response, **answering(None, table_or_wrong, takes))
    async def history_as_table(request: Request) -> PlainTextResponse:
        """Tasks of all starts as a table for other programs, with a line of names."""
        rows = await run_in_threadpool(side.history, query_of(request, TaskFilter).query())
        return PlainTextResponse(table(rows), media_type=CSV)

    @api.get("/tasks/{task_id}", **answering(Task, UNKNOWN))
    async def task(task_id: str) -> JSONResponse:
        """One task by its id."""
        known = await run_in_threadpool(side.find, task_id)
        if known is None:
            raise HTTPException(404, f"The plant knows no task {quoted(task_id, 80)}.")
        return PlainJson(explained(known))


def _follow(api: APIRouter, side: PlantApi) -> None:
    @api.get("/acts/{number}", **answering(Act, NO_ACT))
    async def act(number: int) -> JSONResponse:
        """The present state of an operator's act; the last 20 acts are known."""
        known = side.act(number)
        if known is None:
            raise HTTPException(404, f"The plant knows no act {number} of an operator, or no more.")
        return PlainJson(known)


def _submit(api: APIRouter, side: PlantApi) -> None:
    @api.post("/tasks", status_code=202, **answering(Task, REFUSED, described_body(TaskText, TaskForm)))
    async def add_task(request: Request) -> JSONResponse:
        """Queue a task, written or as a form; 422 where it is refused, 503 where the queue is full."""
        require(request.scope["arboleda.role"], SUBMIT)
        form = task_in(await request.body(), side.offers)
        text = form.text if isinstance(form, TaskText) else side.spelled(**form.named())
        is_ours = request.headers.get("user-agent", "").startswith(COMMAND_LINE)
        why = form.why if isinstance(form, TaskText) else ""
        asked_by = COMMAND if is_ours else HTTP
        # Its id may be looked up in the history, and a stop must not wait for that.
        task = await in_time(await run_in_threadpool(side.submit, text, asked_by, why))
        return PlainJson(explained(task), status_code=422 if task["state"] == "refused" else 202)


def _operate(api: APIRouter, side: PlantApi) -> None:
    takes = described_body(VerbArguments, required=False)
    verb_route = answering(Done, ACCEPTED | REFUSED | CONFLICT, takes)

    @api.post("/plant/{verb}", **verb_route)
    async def operate_plant(verb: str, request: Request) -> JSONResponse:
        """Carry out a verb in each cell where it is possible; refused if there is none."""
        return await operated(verb, "", request)

    @api.post("/cells/{scope}/{verb}", **verb_route)
    async def operate_one(scope: str, verb: str, request: Request) -> JSONResponse:
        """Carry out a verb on one cell, robot, zone or task; the table of verbs names the scope of each."""
        return await operated(verb, scope, request)

    async def operated(word: str, scope: str, request: Request) -> JSONResponse:
        verb, arguments = verb_of(word), verb_arguments(await request.body())
        require(request.scope["arboleda.role"], verb.value)
        of, values = named(verb, scope, arguments.of(verb))
        answer = await in_time(side.operate(verb, of, by_hand=arguments.by_hand, arguments=values))
        if answer.refusal is not None:
            return PlainJson(explained({"sentence": answer.refusal}), status_code=409)
        known = {"act": answer.act, "outcome": answer.outcome, "why": answer.why}
        parts = {name: value for name, value in known.items() if value is not None}
        is_open = isinstance(answer, Unkept) or answer.outcome is Outcome.UNDER_WAY
        return PlainJson({"verb": verb.value, "scope": scope, **parts}, status_code=202 if is_open else 200)


async def in_time(answer: Future[Answer]) -> Answer:
    """The plant's answer; raises ArboledaError if it takes longer than ANSWER_S."""
    try:
        # the plant still sets its future after that, which a cancelled one does not allow
        return await asyncio.wait_for(asyncio.shield(asyncio.wrap_future(answer)), ANSWER_S)
    except asyncio.TimeoutError:
        raise ArboledaError(
            "The plant did not answer in time; see its state before sending this again."
        ) from None


def verb_of(word: str) -> Verb:
    """The operator's verb of that name; raises PayloadError if there is none."""
    try:
        return Verb(word)
    except ValueError:
        names = ", ".join(verb.value for verb in Verb)
        raise PayloadError(f"{quoted(word, 80)} is not an operator's verb; there are {names}.") from None


def named(verb: Verb, scope: str, arguments: Arguments) -> tuple[str, Arguments]:
    """Scope and arguments; an address that has the arguments in its scope, as `ana yes`, is deprecated."""
    return (scope, arguments) if arguments else from_text(verb, scope)


def verb_arguments(body: bytes) -> AnyVerbArguments:
    """The arguments in a body, none where it is empty; raises PayloadError for anything else."""
    try:
        return VerbArguments.model_validate_json(body or b"{}")
    except ValidationError:
        raise PayloadError(
            'The body may be empty or JSON like {"by_hand": true}, for answer {"answer": "yes"}, '
            'for unload {"station": 7}, and nothing else.'
        ) from None


def task_in(body: bytes, offers: Callable[[], Sequence[dict[str, Any]]] = tuple) -> TaskText | TaskForm:
    """The task in a body, `{"text": "..."}` or cell, recipe and values; PayloadError for anything else.

    Its example is the first of `offers`, which takes long to make where there are many recipes.
    """
    for form in (TaskText, TaskForm):
        with suppress(ValidationError):
            return form.model_validate_json(body)
    text, named, cells = next(map(_example, (each for each in offers() if each["recipes"])), EXAMPLE)
    raise PayloadError(
        f'The body must be JSON like {{"text": "{text}"}} or {named}, for several cells '
        f'{{"any_of": {cells}, "values": {{...}}}}, and nothing else.'
    )


def _example(offer: dict[str, Any]) -> tuple[str, str, str]:
    """A task of the first recipe of a cell as a text and by names, and how several cells are named."""
    recipe = offer["recipes"][0]
    values = {
        each["name"]: each["choices"][0] if each["choices"] else each["lower"]
        for each in recipe["parameters"]
    }
    named = {"cell": offer["cell"], "recipe": recipe["name"], "values": values}
    return recipe["example"], json.dumps(named, ensure_ascii=False), f'["{offer["cell"]}", ...]'


async def refuse(_request: Request, error: Exception) -> JSONResponse:
    """The answer to a refusal: status, sentence, and headers that belong to it, such as Allow."""
    if isinstance(error, HTTPException):
        return JSONResponse({"sentence": error.detail}, status_code=error.status_code, headers=error.headers)
    headers = {"retry-after": LATER_S} if isinstance(error, QueueFull) else None
    status = next((STATUS[each] for each in type(error).__mro__ if each in STATUS), 503)
    body = {"sentence": error.sentence if isinstance(error, ArboledaError) else str(error)}
    return PlainJson(explained(body), status_code=status, headers=headers)


async def refuse_parameter(request: Request, error: Exception) -> JSONResponse:
    """The answer to a request of which a part of its address is wrong."""
    assert isinstance(error, RequestValidationError)
    return await refuse(request, wrong_parameter(error.errors()[0]))


async def own_up(request: Request, error: Exception) -> JSONResponse:
    """The answer to an internal error: its details go to the log, a sentence to the caller.

    Starlette raises one, too, where the caller has gone before anything was sent; it is not logged.
    """
    asked = str(request.scope.get(ASKED, f"{request.method} {quote(request.url.path)}"))
    if str(error) != NOTHING_SENT or not await request.is_disconnected():
        log.error("%s failed: %s", plain(asked), plain(short(error)))
        log.debug("the error of %s, whole", plain(asked), exc_info=error)
    whose = f" in {asked}" if ASKED in request.scope else ""
    sentence = f"The plant could not answer: internal error{whose}."
    return JSONResponse({"sentence": sentence}, status_code=500)


def _kept(row: TaskRow) -> dict[str, Any]:
    answers, choice = [vars(each) for each in answers_of(row)], choice_of(row)
    data = asdict(row) | {
        "sentence": row.sentence or "",
        "answers": answers,
        "choice": None if choice is None else str(choice),
    }
    data["unchecked"] = unchecked_of(row)
    sentence = json.loads(data.pop("said") or "{}")
    del data["course"]  # the plant estimates the duration of the next one from it
    return {**data, **sentence} if row.sentence else data
