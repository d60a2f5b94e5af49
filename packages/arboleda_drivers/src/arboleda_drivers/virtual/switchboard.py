"""A small HTTP port on which the faults of a virtual controller are switched while it runs.

    curl localhost:4713/faults                       all of them, and which are on
    curl -X PUT localhost:4713/faults/mute           on
    curl -X DELETE localhost:4713/faults/mute        off

No page that a browser shows can switch them: browsers ask first before they PUT or DELETE elsewhere.
"""

from __future__ import annotations

import json
import threading
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from .faults import Faults
from .tcp_server import listen

ROOT = "/faults"


class Switchboard:
    """HTTP server on 127.0.0.1; port 0 takes a free one."""

    def __init__(self, faults: Faults, port: int) -> None:
        listener = listen("127.0.0.1", port)
        self.port: int = listener.getsockname()[1]
        self._server = ThreadingHTTPServer(
            ("127.0.0.1", self.port), partial(_Handler, faults), bind_and_activate=False
        )
        self._server.daemon_threads = True
        self._server.socket.close()
        self._server.socket = listener
        self._thread = threading.Thread(target=self._server.serve_forever, name="faults", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


class _Handler(BaseHTTPRequestHandler):
    def __init__(self, faults: Faults, *rest: Any) -> None:
        self._faults = faults
        super().__init__(*rest)

    def do_GET(self) -> None:
        if self.path != ROOT:
            self._answer(404, {"error": f"there is {ROOT} and {ROOT}/NAME"})
        else:
            self._answer(200, self._shown())

    def do_PUT(self) -> None:
        self._switch(on=True)

    def do_DELETE(self) -> None:
        self._switch(on=False)

    def log_message(self, format: str, *args: Any) -> None:
        """Does nothing: nobody reads such a log."""

    def _switch(self, *, on: bool) -> None:
        folder, _, name = self.path.rpartition("/")
        try:
            if folder != ROOT:
                raise ValueError(f"there is {ROOT} and {ROOT}/NAME")
            self._faults.switch(name, on=on)
        except ValueError as error:
            self._answer(404, {"error": str(error)})
        else:
            self._answer(200, self._shown())

    def _shown(self) -> dict[str, Any]:
        known = self._faults.known.items()
        return {name: {"on": name in self._faults, "what": what} for name, what in known}

    def _answer(self, status: int, content: dict[str, Any]) -> None:
        body = json.dumps(content, indent=2).encode() + b"\n"
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)
