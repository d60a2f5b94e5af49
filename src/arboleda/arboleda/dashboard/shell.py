"""The shell of every page: its head, a header, its parts, and the address of its files."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from functools import cache
from importlib import resources

from fastapi import FastAPI, Request

from arboleda.model.errors import StartError
from arboleda.web.access.auth import Role
from arboleda.web.api import refuse
from arboleda.web.languages import spoken

from .body import Parts, parts_of, script_data
from .page_api import Layout
from .page_budget import PageBudget
from .toolkit import Client, app, ui
from .wording import Words

RECONNECT_S = 30.0
STYLES = ("page", "twin", "record", "draw", "teach", "make")
LANGUAGE_COOKIE = "arboleda_language"
_here: list[FastAPI] = []


def serve(server: FastAPI, layout: Layout, build: Callable[[Request, Client], None]) -> None:
    """Put the page that `build` makes at `/` of this app, after all else that it serves; StartError where
    this process shows a page already."""
    if _here:
        raise StartError(
            "This process shows the page of another plant already; NiceGUI has one page a process."
        )
    _here.append(server)
    unopened = PageBudget()
    app.add_static_files(assets(), str(resources.files(__package__).joinpath("assets")), max_cache_age=3600)

    @ui.page("/", title=f"{layout['plant']} · Arboleda")
    def page(request: Request, client: Client) -> None:
        unopened.add(client)
        build(request, client)

    app.add_exception_handler(404, refuse)  # NiceGUI makes a page for each address that is not there
    app.add_exception_handler(405, refuse)
    ui.run_with(
        server,
        title="Arboleda",
        dark=None,
        tailwind=False,
        binding_refresh_interval=None,
        reconnect_timeout=RECONNECT_S,
        show_welcome_message=False,
        favicon=str(resources.files(__package__) / "assets" / "tree.svg"),
    )


def language_of(request: Request) -> str:
    """The language of the address, else the one chosen before, else the browser's first that is known."""
    browser = request.headers.get("accept-language", "").split(",")
    return spoken([request.query_params.get("lang"), request.cookies.get(LANGUAGE_COOKIE), *browser])


def role_shown(request: Request) -> str | None:
    """The role of the person who logged in; None if nobody needs to log in."""
    door = request.scope.get("arboleda.door")
    return None if door is None or door.open else request.scope["arboleda.role"].value


def is_operator(request: Request) -> bool:
    """True if whoever asks may do what operators may."""
    return bool(request.scope["arboleda.role"] is Role.OPERATOR)


def fill(layout: Layout, wording: Words, parts: Parts, *, script: str, made: str) -> None:
    """Fill the page of one browser with what was `made` of its parts; `script` is its entry."""
    shown = parts_of(parts, layout)
    ui.add_head_html(head(wording, script, *(["twin.js"] if "twin" in shown else [])))
    ui.html(made, sanitize=False).classes("app")


def head(wording: Words, *scripts: str) -> str:
    """The page's head: its styles, its scripts, and the few words that these use themselves."""
    data = json.dumps(script_data(wording)).replace("<", "\\u003c")
    styles = "".join(f'<link rel="stylesheet" href="{assets()}/{name}.css">' for name in STYLES)
    modules = "".join(f'<script type="module" src="{assets()}/{name}"></script>' for name in scripts)
    return f"{styles}<script>window.arboledaPage = {data};</script>{modules}"


@cache
def assets() -> str:
    """The address of the page's files: another one whenever one has changed, as browsers keep them."""
    files = sorted(resources.files(__package__).joinpath("assets").iterdir(), key=lambda file: file.name)
    return f"/arboleda/{hashlib.sha256(b''.join(file.read_bytes() for file in files)).hexdigest()[:12]}"
