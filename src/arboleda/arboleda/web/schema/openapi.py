"""Description of the API: `/api/openapi.json` for tools, `/api/docs` for people; no file from elsewhere."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from copy import copy
from html import escape
from typing import Any

from fastapi import APIRouter, FastAPI
from fastapi.responses import HTMLResponse, JSONResponse
from starlette.routing import BaseRoute

from arboleda.model.messages import Verb
from arboleda.views.verb_words import ABOUT, argument_names, scope_words

from ..access.login import page

Schema = dict[str, Any]
VERB = Verb.__name__
SHAPES = "#/components/schemas/"  # before the name of a shape in a reference


LATER = "arboleda.later"  # in `openapi_extra` of a route: what makes its description


def described_later(made: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """The arguments for the decorator of a route whose description is made once somebody reads it."""
    return {"openapi_extra": {LATER: made}}


def described_route(route: BaseRoute) -> BaseRoute:
    """A route with its description, if that was to be made later; any other as it is."""
    route = getattr(route, "behind", route)  # of a package
    made = (getattr(route, "openapi_extra", None) or {}).get(LATER)
    if made is None:
        return route
    described = copy(route)
    vars(described).update(made())
    return described


class DescribedApp(FastAPI):
    """Application that makes its description once somebody reads it: models of all answers take as long as
    all the rest of a start.

    `others` are answers of every route. Shapes within bodies stand beside all others, where references lead
    to.
    """

    def __init__(self, others: dict[int | str, dict[str, Any]], **about: Any) -> None:
        super().__init__(**about)
        self._others = others
        self._routers: list[APIRouter] = []

    def serve(self, routers: Sequence[APIRouter]) -> None:
        """Serve the routes of these routers, as they are: FastAPI would make each that it includes anew."""
        for router in routers:
            self.router.routes += router.routes
        self._routers += routers

    def openapi(self) -> Schema:
        """The description as OpenAPI."""
        if self.openapi_schema is None:
            self.openapi_schema = self._described()
        return self.openapi_schema

    def _described(self) -> Schema:
        described = FastAPI(title=self.title, version=self.version, description=self.description)
        for router in self._routers:
            beside = APIRouter()
            beside.routes += map(described_route, router.routes)
            described.include_router(beside, responses=self._others)
        api = described.openapi()
        for route in (route for methods in api["paths"].values() for route in methods.values()):
            for body in route.get("requestBody", {}).get("content", {}).values():
                for shape in body["schema"].get("anyOf", [body["schema"]]):
                    api["components"]["schemas"] |= shape.pop("$defs", {})
        return api


def routes(app: FastAPI) -> APIRouter:
    """Register the two pages with `app`."""
    pages = APIRouter(prefix="/api", include_in_schema=False)

    @pages.get("/openapi.json")
    def openapi() -> JSONResponse:
        return JSONResponse(app.openapi())

    @pages.get("/docs")
    def docs() -> HTMLResponse:
        return page("Arboleda HTTP API", render(app.openapi()))

    return pages


def render(api: Schema) -> str:
    """The description as HTML: every route with its parameters and answers, then the shapes."""
    info = api["info"]
    parts = [f"<h1>{escape(info['title'])} {escape(info['version'])}: HTTP API</h1>"]
    parts += [f"<p>{escape(info['description'])}</p>"]
    parts += ['<p>For tools: <a href="/api/openapi.json">/api/openapi.json</a></p>']
    for path, methods in api["paths"].items():
        parts += [_route(method, path, route) for method, route in methods.items()]
    shapes = {name: _shape(shape) for name, shape in api["components"]["schemas"].items()}
    shapes |= {VERB: _verbs()} if VERB in shapes else {}
    parts += [
        f'<section id="{escape(name)}"><h2>{escape(name)}</h2>{shape}</section>'
        for name, shape in shapes.items()
    ]
    return "".join(parts)


def _verbs() -> str:
    """The table of operators' verbs as HTML: scope, arguments, role, effect, and when each is refused."""
    names = ("verb", "scope", "arguments", "who may", "what it does", "refused")
    head = f"<tr>{''.join(f'<th>{name}</th>' for name in names)}</tr>"
    rows = (
        (
            verb.value,
            ", ".join(scope_words(verb)),
            ", ".join(argument_names(verb)),
            verb.row.role.value,
            _marked(words.does),
            _marked(words.refused),
        )
        for verb, words in ABOUT.items()
    )
    return f"<table>{head}{''.join(map(_verb_row, rows))}</table>"


def _verb_row(row: tuple[str, ...]) -> str:
    verb, *cells = row
    return f"<tr><th>{verb}</th>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def _marked(text: str) -> str:
    """Markdown of one sentence as HTML."""
    code = re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))
    return re.sub(r"\*\*([^*]+)\*\*", r"<b>\1</b>", code)


def _route(method: str, path: str, route: Schema) -> str:
    answers = "".join(_answer(status, answer) for status, answer in route["responses"].items())
    body = route.get("requestBody")
    taken = f"<h3>Body</h3>{_shape(_json(body))}" if body else ""
    taken += f'<p>See <a href="#{VERB}">{VERB}</a>.</p>' if "{verb}" in path else ""
    title = f"<h2>{method.upper()} {escape(path)}</h2><p>{escape(route.get('description', ''))}</p>"
    return f"<section>{title}{taken}<h3>Answers</h3><table>{answers}</table></section>"


def _answer(status: str, answer: Schema) -> str:
    shape = _json(answer)
    name = shape.get("items", shape).get("$ref", "").rpartition("/")[2]
    link = f'<a href="#{escape(name)}">{escape(name)}</a>' if name else ""
    return f"<tr><th>{escape(status)}</th><td>{escape(answer['description'])}</td><td>{link}</td></tr>"


def _json(content: Schema) -> Schema:
    return dict(content.get("content", {}).get("application/json", {}).get("schema", {}))


def _shape(shape: Schema) -> str:
    if "anyOf" in shape and "type" not in shape:
        return "<p>or</p>".join(map(_shape, shape["anyOf"]))
    about = f"<p>{escape(shape['description'])}</p>" if "description" in shape else ""
    about += f"<p>One of: {escape(', '.join(shape['enum']))}.</p>" if "enum" in shape else ""
    rows = "".join(_field(name, field) for name, field in shape.get("properties", {}).items())
    return f"{about}<table>{rows}</table>"


def _field(name: str, field: Schema) -> str:
    about = field.get("description", "")
    kind = {key: value for key, value in field.items() if key not in ("title", "description", "examples")}
    cells = (name, json.dumps(kind).replace(SHAPES, ""), about)
    return f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in cells)}</tr>"
