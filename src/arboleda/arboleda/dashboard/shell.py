"""The shell of every page: its head, a header, and its parts."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache

from fastapi import FastAPI, Request
from fastapi.responses import PlainTextResponse, Response

from arboleda.model.errors import ArboledaError, StartError
from arboleda.web.access.auth import Role
from arboleda.web.api import refuse
from arboleda.web.languages import spoken
from arboleda.web.request import PAGE

from .asset_files import Assets, own, own_address, own_folder
from .body import script_data
from .page_api import Layout
from .toolkit import HTML_ESCAPE_TABLE, Client, app, ui
from .wording import Words, words

RECONNECT_S = 30.0
PARTS_HERE = "arboleda-parts-here"  # where the HTML of the parts is put into what NiceGUI makes
STYLES = ("page", "twin")
LANGUAGE_COOKIE = "arboleda_language"
_here: list[FastAPI] = []
MOST_UNOPENED = 40  # a browser opens its page within a second or two


def serve(
    server: FastAPI,
    layout: Layout,
    build: Callable[[Request, Client], str],
    added: Sequence[Assets] = (),
) -> None:
    """Put the page that `build` fills at `/` of this app, after all else that it serves, with the files that
    are `added` to the page's own; StartError where this process shows a page already. `build` returns the
    HTML of the page's parts."""
    if _here:
        raise StartError(
            "This process shows the page of another plant already; NiceGUI has one page a process."
        )
    _here.append(server)
    unopened = PageBudget()
    for address, folder in [*((each.address, each.folder) for each in added), (own_address(), own_folder())]:
        app.add_static_files(address, folder, max_cache_age=3600)

    @ui.page(PAGE, title=f"{layout['plant']} · Arboleda")
    def page(request: Request, client: Client) -> Response:
        unopened.add(client)
        try:
            parts = build(request, client)
        except ArboledaError as error:  # what the address names is not there
            return PlainTextResponse(words(language_of(request)).say(error.sentence), 404)
        return _with_parts(client.build_response(request), parts)

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
        favicon=str(own_folder() / "tree.svg"),
    )


class PageBudget:
    """PageBudget: forgets the oldest page that no browser has opened yet if too many wait: each costs a
    megabyte, and NiceGUI would keep it for a minute."""

    def __init__(self, most: int = MOST_UNOPENED) -> None:
        self._most = most
        self._waiting: dict[str, Client] = {}

    def add(self, client: Client) -> None:
        """Add a page that was just built; its browser reports that it has opened it."""
        self._waiting[client.id] = client
        client.on_connect(lambda: self._forget(client.id))
        client.on_delete(lambda: self._forget(client.id))
        if len(self._waiting) > self._most:
            next(iter(self._waiting.values())).delete()

    def _forget(self, id: str) -> None:
        self._waiting.pop(id, None)


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


def fill(
    layout: Layout,
    wording: Words,
    *,
    script: str,
    added: Sequence[Assets] = (),
    asks: Mapping[str, str] | None = None,
) -> None:
    """Fill the page of one browser, but for the HTML of its parts; `script` is its entry's address."""
    drawn = [own("twin.js")] if layout["places"]["robots"] else []
    ui.add_head_html(head(wording, script, *drawn, added=added, asks=asks))
    ui.html(PARTS_HERE, sanitize=False).classes("app")


def _with_parts(page: Response, parts: str) -> Response:
    whole = bytes(page.body).replace(PARTS_HERE.encode(), in_page(parts), 1)
    headers = {name: value for name, value in page.headers.items() if name != "content-length"}
    return Response(whole, page.status_code, headers)


@lru_cache(maxsize=8)
def in_page(parts: str) -> bytes:
    """HTML as NiceGUI writes it into its page, within a text of JSON; made once for all browsers.

    NiceGUI would make it anew for each: 30 ms of processor time where there are 100 cells.
    """
    return json.dumps(parts, ensure_ascii=False)[1:-1].translate(HTML_ESCAPE_TABLE).encode()


def head(
    wording: Words, *scripts: str, added: Sequence[Assets] = (), asks: Mapping[str, str] | None = None
) -> str:
    """The page's head: its styles, its scripts, and the few words that these use themselves; `asks` has the
    questions before acts of packages."""
    loaded = [each.of(each.script) for each in added if each.script]
    scripts_of = [each.package for each in added if each.script]
    more = {"added": [*zip(loaded, scripts_of, strict=True)], "asks": asks or {}}
    data = json.dumps(script_data(wording) | more).replace("<", "\\u003c")
    sheets = [own(f"{name}.css") for name in STYLES]
    sheets += [each.of(f"{name}.css") for each in added for name in each.styles]
    styles = "".join(f'<link rel="stylesheet" href="{sheet}">' for sheet in sheets)
    early = "".join(f'<link rel="modulepreload" href="{each}">' for each in loaded)
    modules = "".join(f'<script type="module" src="{script}"></script>' for script in scripts)
    return f"{styles}{early}<script>window.arboledaPage = {data};</script>{modules}"
