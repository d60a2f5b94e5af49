"""`arboleda record replay --page`: the page on a record, for this machine only."""

from __future__ import annotations

import threading
from functools import partial
from typing import TYPE_CHECKING
from urllib.parse import urlencode

from fastapi import FastAPI

from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.urdf import robot_urdf
from arboleda.runtime.interrupts import interruptible, until, until_interrupted
from arboleda.views import view
from arboleda.web.access.auth import Door
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import LOCAL, names_for
from arboleda.web.api import answer_in_sentences
from arboleda.web.server import Server

from .page import mount
from .records import Records

if TYPE_CHECKING:
    from arboleda.recorder.reader import Record


class RecordServer:
    """Serves the page from `start`, which returns its address, to `stop`; NoRecord for an empty record."""

    def __init__(self, record: Record, model: PlantModel, port: int | None) -> None:
        path, layout = record.paths[-1], view.layout(model)
        side = Records(lambda: path, lambda: layout, partial(robot_urdf, model))
        side.past()
        app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None, redirect_slashes=False)
        answer_in_sentences(app)
        mount(app, side)
        self._server = Server(Guard(app, names_for(LOCAL, None), Door(None)), host=LOCAL, port=port)

    def start(self) -> str:
        return f"http://{LOCAL}:{self._server.start()}/"

    def stop(self) -> None:
        self._server.stop()


def show(record: Record, model: PlantModel, query: dict[str, str], port: int | None) -> None:
    """Serve the page until Ctrl-C; `query` names the place in the record that its address leads to."""
    server = RecordServer(record, model, port)
    with interruptible():
        try:
            address = server.start()
            print(f"Page: {address}?{urlencode(query)}", flush=True)
            print("Ctrl-C ends it.", flush=True)
            with until_interrupted():
                until(threading.Event())
        finally:
            server.stop()
