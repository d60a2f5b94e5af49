"""`arboleda record replay --page`: the page on a record, for this machine only."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any
from urllib.parse import urlencode

from fastapi import FastAPI

from arboleda.dashboard.past import page
from arboleda.dashboard.past.past import Past
from arboleda.dashboard.past.side import Start
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.urdf import robot_urdf
from arboleda.runtime.interrupts import interruptible, until, until_interrupted
from arboleda.runtime.parts.records import Records
from arboleda.views import view
from arboleda.web.access.auth import Door
from arboleda.web.access.guard import Guard
from arboleda.web.access.names import LOCAL, names_for
from arboleda.web.api import answer_in_sentences
from arboleda.web.server import Server

if TYPE_CHECKING:
    from arboleda.recorder.reader import Record


class RecordedPast:
    """RecordedPast: a record as PastSide; NoRecord if it has nothing to see."""

    def __init__(self, record: Record, model: PlantModel) -> None:
        self._model = model
        self._layout = view.layout(model)
        path = record.paths[-1]
        self._records = Records(lambda: path, self._layout)
        self._records.past()  # errors are reported before the page opens

    def layout(self) -> dict[str, Any]:
        return self._layout

    def past(self, epoch: int | None = None) -> Past:
        return self._records.past(epoch)

    def starts(self) -> list[Start]:
        return self._records.starts()

    def urdf(self, robot: str) -> str:
        return robot_urdf(self._model, robot)


class RecordServer:
    """Serves the page from `start`, which returns its address, to `stop`."""

    def __init__(self, side: RecordedPast, port: int | None) -> None:
        app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None, redirect_slashes=False)
        answer_in_sentences(app)
        page.mount(app, side)
        self._server = Server(Guard(app, names_for(LOCAL, None), Door(None)), host=LOCAL, port=port)

    def start(self) -> str:
        return f"http://{LOCAL}:{self._server.start()}/"

    def stop(self) -> None:
        self._server.stop()


def show(record: Record, model: PlantModel, query: dict[str, str], port: int | None) -> None:
    """Serve the page until Ctrl-C; `query` names the place in the record that its address leads to."""
    server = RecordServer(RecordedPast(record, model), port)
    with interruptible():
        try:
            address = server.start()
            print(f"Page: {address}?{urlencode(query)}", flush=True)
            print("Ctrl-C ends it.", flush=True)
            with until_interrupted():
                until(threading.Event())
        finally:
            server.stop()
