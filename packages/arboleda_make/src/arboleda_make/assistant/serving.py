"""Serving of the MCP server: over stdio for one assistant, over HTTP on this machine for several."""

from __future__ import annotations

import socket
from collections.abc import Callable
from typing import Any

import uvicorn
from mcp.server.mcpserver import MCPServer
from mcp.server.transport_security import TransportSecuritySettings

from arboleda.client import AsyncPlant
from arboleda.runtime.endpoints import Place

from .desk import Call, Reach

PATIENCE_S = 5.0  # an assistant is answered soon, also that nobody is there
PATH = "/mcp"


def plants(place: Callable[[], Place], *, own_token: bool) -> Reach:
    """A maker of a client of the plant for each call: under the token of `place`, which may change with each
    start of the plant, or without `own_token` under the one that came with the call over HTTP."""

    def reach(call: Call) -> AsyncPlant:
        found = place()
        token = found.token if own_token else _token(call)
        return AsyncPlant(
            found.url, token=token, plant=found.plant, tls=found.believed(), patience_s=PATIENCE_S
        )

    return reach


def _token(call: Call) -> str:
    request = call.request_context.request
    kind, _, token = str(request.headers.get("authorization", "") if request else "").partition(" ")
    return token.strip() if kind.lower() == "bearer" else ""


def over_http(server: MCPServer[Any], listener: socket.socket) -> None:
    """Serve on a listener of this machine until Ctrl-C. A name that suddenly leads here is refused by its
    Host, a page of a browser by its Origin."""
    host, port = listener.getsockname()[:2]
    names = [f"{name}:{port}" for name in (host, "localhost")]
    security = TransportSecuritySettings(allowed_hosts=names, allowed_origins=[])
    app = server.streamable_http_app(
        streamable_http_path=PATH, json_response=True, stateless_http=True, transport_security=security
    )
    settings = uvicorn.Config(app, log_config=None, access_log=False, server_header=False)
    uvicorn.Server(settings).run(sockets=[listener])
