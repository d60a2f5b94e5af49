"""`arboleda mcp`: a plant for assistants that speak the Model Context Protocol."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from arboleda.cli.plant_options import located
from arboleda.extension import ArboledaError, Phrase, PlantFile, Role, StartError, StateFolder, TokensFile
from arboleda.runtime import endpoints, invocation, tokens
from arboleda.runtime.endpoints import Place
from arboleda.runtime.state import find_running

WHAT = "Let an assistant (a language model) look at a plant, try its plant file, and propose changes."
HOW = """It speaks the Model Context Protocol over standard input and output, or with --port over HTTP on this
machine. The plant file has to allow it (`assistants: read`, `propose` or `submit`). What it proposes moves
nothing before a person has approved it; the stop is there always. Over HTTP each call needs a token of the
plant where the plant wants one, and has its role."""
HOST = "127.0.0.1"
NO_LIBRARY = Phrase(
    "cli.mcp.no_library",
    "The library mcp is not installed, which it needs: `{install} 'arboleda[mcp]'`",
)
NONE_RUNS = Phrase(
    "cli.mcp.none_runs", "No plant is running on {folder}; a person can start one with `arboleda up`."
)
Url = Annotated[
    str, typer.Option("--url", metavar="URL", help="The plant's address. [default: one that runs here]")
]
Port = Annotated[
    int | None, typer.Option(metavar="N", min=0, max=65535, help="Speak HTTP on this port; 0: a free one.")
]
As = Annotated[
    Role, typer.Option("--role", help="Over standard input: whose token is shown to a plant that wants one.")
]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command("mcp", help=f"{WHAT}\n\n{HOW}", short_help=WHAT)(mcp)


def mcp(
    plant: PlantFile = None,
    state: StateFolder = None,
    url: Url = "",
    tokens: TokensFile = None,
    port: Port = None,
    role: As = Role.ASSISTANT,
) -> None:
    try:
        from arboleda_make.assistant import serving
        from arboleda_make.assistant.bench import Bench
        from arboleda_make.assistant.server import made
    except ImportError as error:
        if (error.name or "").partition(".")[0] not in ("mcp", "mcp_types"):
            raise
        raise StartError(NO_LIBRARY(install=invocation.pip_install())) from error

    def place() -> Place:
        return _named(url, tokens) if url else _here(located(plant, state), role)

    bench = Bench(plant) if plant is not None else None
    server = made(serving.plants(place, own_token=port is None), bench)
    if port is None:
        server.run("stdio")
        return
    from arboleda.web.server import listen

    listener = listen(HOST, port)
    print(f"MCP: http://{HOST}:{listener.getsockname()[1]}{serving.PATH}", file=sys.stderr, flush=True)
    serving.over_http(server, listener)


def _named(url: str, file: Path | None) -> Place:
    """The plant at an address, with its token out of a file."""
    (found,) = endpoints.named([url])()
    known = {} if file is None else endpoints.tokens_of(file)
    return Place(url=found.url, token=known.get(found.url, ""))


def _here(state: Path, role: Role) -> Place:
    """The plant that runs on a state directory, with the token of a role if it wants one."""
    running = find_running(state)
    if running is None or running.port is None:
        raise ArboledaError(NONE_RUNS(folder=str(state)))  # an assistant reads its English
    token = tokens.TokenFile(state)()[role] if running.guarded else ""
    return Place(url=running.url, plant=running.plant, token=token, certificate=running.certificate)
