"""The application of a prepared plant behind its guard, to be asked in process."""

from __future__ import annotations

from functools import cache
from typing import Any

from fastapi import FastAPI
from starlette.types import ASGIApp

from arboleda.web.access.auth import Door, Role
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import names_for
from arboleda.web.api import make_app
from arboleda.web.package_routes import taking

from .in_process import ORIGIN, Caller
from .web_plant import TOKENS, Plant


class Present:
    """The plant of the test that runs. An application takes a tenth of a second to be made: all share one."""

    plant = Plant()

    def __getattr__(self, name: str) -> Any:
        return getattr(self.plant, name)


PRESENT = Present()


@cache
def shared_app() -> FastAPI:
    """The application of the plant that is present."""
    return make_app(PRESENT)


class Web:
    """A guarded application, and whoever asks it."""

    origin = ORIGIN
    cookie = "arboleda_8080"

    def __init__(self, app: ASGIApp, door: Door) -> None:
        self.app = app
        self.door = door

    def client(self, *, token: Role | None = None, login: Role | None = None, **headers: str) -> Caller:
        """Somebody with a token, a tool; or with a session, a browser; or with neither."""
        if token is not None:
            headers["authorization"] = f"Bearer {TOKENS[token]}"
        if login is None:
            return Caller(self.app, **headers)
        return Caller(self.app, cookies={self.cookie: self.session(login)}, origin=self.origin, **headers)

    def session(self, role: Role) -> str:
        session = self.door.log_in(TOKENS[role].encode())
        assert session
        return session


def guarded(
    plant: Plant,
    tokens: dict[Role, str] | None = None,
    public_url: str | None = None,
    behind: ASGIApp | None = None,
    name: str = "",
) -> Web:
    """The plant as on one's own machine, with tokens as on a network; `behind` is another application, `name`
    the plant's. It is the one present until the next one is guarded."""
    PRESENT.plant = plant
    door = Door((lambda: tokens) if tokens else None)
    bound = "0.0.0.0" if tokens and not public_url else "127.0.0.1"
    app, names = behind or shared_app(), names_for(bound, public_url)
    takes = {"takes": taking(app)} if isinstance(app, FastAPI) else {}
    return Web(Guard(app, names, door, plant=name, **takes), door)
