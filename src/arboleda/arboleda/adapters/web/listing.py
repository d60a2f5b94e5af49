"""The API described: `/api/openapi.json` for tools, `/api/docs` for people, all of it from here."""

from __future__ import annotations

import json
from html import escape
from typing import Any

from fastapi import APIRouter, FastAPI
from fastapi.responses import HTMLResponse, JSONResponse

from .plain_page import page

Schema = dict[str, Any]


def routes(app: FastAPI) -> APIRouter:
    """The two pages on the routes of `app`."""
    pages = APIRouter(prefix="/api", include_in_schema=False)

    @pages.get("/openapi.json")
    async def openapi() -> JSONResponse:
        return JSONResponse(app.openapi())

    @pages.get("/docs")
    async def docs() -> HTMLResponse:
        return page("Arboleda HTTP API", render(app.openapi()))

    return pages


def render(api: Schema) -> str:
    """The description as HTML: every route, what it takes, what it gives, then the shapes."""
    info = api["info"]
    parts = [f"<h1>{escape(info['title'])} {escape(info['version'])}: HTTP API</h1>"]
    parts += [f"<p>{escape(info['description'])}</p>"]
    parts += ['<p>For tools: <a href="/api/openapi.json">/api/openapi.json</a></p>']
    for path, methods in api["paths"].items():
        parts += [_route(method, path, route) for method, route in methods.items()]
    shapes = api["components"]["schemas"].items()
    parts += [
        f'<section id="{escape(name)}"><h2>{escape(name)}</h2>{_shape(shape)}</section>'
        for name, shape in shapes
    ]
    return "".join(parts)


def _route(method: str, path: str, route: Schema) -> str:
    answers = "".join(_answer(status, answer) for status, answer in route["responses"].items())
    body = route.get("requestBody")
    taken = f"<h3>Body</h3>{_shape(_json(body))}" if body else ""
    title = f"<h2>{method.upper()} {escape(path)}</h2><p>{escape(route.get('description', ''))}</p>"
    return f"<section>{title}{taken}<h3>Answers</h3><table>{answers}</table></section>"


def _answer(status: str, answer: Schema) -> str:
    name = _json(answer).get("$ref", "").rpartition("/")[2]
    link = f'<a href="#{escape(name)}">{escape(name)}</a>' if name else ""
    return f"<tr><th>{escape(status)}</th><td>{escape(answer['description'])}</td><td>{link}</td></tr>"


def _json(content: Schema) -> Schema:
    return dict(content.get("content", {}).get("application/json", {}).get("schema", {}))


def _shape(shape: Schema) -> str:
    about = f"<p>{escape(shape['description'])}</p>" if "description" in shape else ""
    about += f"<p>One of: {escape(', '.join(shape['enum']))}.</p>" if "enum" in shape else ""
    rows = "".join(_field(name, field) for name, field in shape.get("properties", {}).items())
    return f"{about}<table>{rows}</table>"


def _field(name: str, field: Schema) -> str:
    about = field.get("description", "")
    kind = {key: value for key, value in field.items() if key not in ("title", "description", "examples")}
    cells = (name, json.dumps(kind).replace("#/components/schemas/", ""), about)
    return f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in cells)}</tr>"
