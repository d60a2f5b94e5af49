"""One browser's window on the twin, and the way of the twin onto the page's server."""

from __future__ import annotations

import json
import threading
from typing import Any, Protocol

from fastapi import FastAPI, Response

from arboleda.geometry import bodies
from arboleda.model.errors import ArboledaError
from arboleda.web.request import SCENE

from ..toolkit import Client, GenericEventArguments, ui
from .show import Show
from .twin import Twin

EVENT = "arboleda-twin"
LOOK, LEAVE, DRAWN = "look", "leave", "drawn"


class Window:
    """Window: one open page; its script says when somebody looks at the twin, and what it has drawn."""

    def __init__(self, client: Client, show: Show) -> None:
        self._client = client
        self._show = show

    @property
    def connected(self) -> bool:
        return self._client.has_socket_connection

    def draw(self, number: int, patch: str) -> None:
        self._client.run_javascript(f"arboledaTwin.frame({number}, {patch})")

    def hear(self, event: GenericEventArguments) -> None:
        """Take an event of the script: ["look"], ["leave"] or ["drawn", number]; anything else is ignored."""
        args = event.args if isinstance(event.args, list) else [event.args]
        what, number = [*args, None, None][:2]
        if what == LOOK:
            self._show.look(self)
        elif what == LEAVE:
            self._show.leave(self)
        elif what == DRAWN and isinstance(number, int):
            self._show.drawn(self, number)


def open_window(client: Client, show: Show) -> None:
    """Let the page of one browser show the twin."""
    bring_three()
    window = Window(client, show)
    ui.on(EVENT, window.hear)
    client.on_delete(lambda: show.leave(window))


def bring_three() -> None:
    """Have NiceGUI serve its three.js; no scene of its own is made."""
    _ = ui.scene


class DrawablePlant(Protocol):
    """The interface of a plant that can be drawn."""

    def layout(self) -> dict[str, Any]: ...
    def urdf(self, robot: str) -> str: ...


class TwinOpening(Protocol):
    """Something that begins once there is a twin to draw; called from any thread."""

    def open(self, twin: Twin) -> None: ...


class Scene:
    """Scene of a plant, made once, when somebody first wants to see it: drawing robots takes a while. `show`
    opens then."""

    def __init__(self, plant: DrawablePlant, show: TwinOpening) -> None:
        self._plant = plant
        self._show = show
        self._making = threading.Lock()
        self._scene: str | None = None

    def answer(self) -> Response:
        """The scene as JSON; 503 with {"sentence"} where it cannot be drawn. Called in a thread."""
        try:
            with self._making:
                self._scene = self._scene or self._made()
        except (ArboledaError, ValueError) as error:
            return _json({"sentence": str(error)}, 503)
        return Response(self._scene, media_type="application/json")

    def _made(self) -> str:
        places = self._plant.layout()["places"]
        drawings = {robot["name"]: bodies.read(self._plant.urdf(robot["name"])) for robot in places["robots"]}
        twin = Twin(places, drawings)
        self._show.open(twin)
        return json.dumps(twin.scene)


def serve(server: FastAPI, scene: Scene) -> None:
    """Answer the browser's `SCENE`."""
    server.add_api_route(SCENE, scene.answer, include_in_schema=False)


def _json(what: Any, status: int) -> Response:
    return Response(json.dumps(what), status, media_type="application/json")
