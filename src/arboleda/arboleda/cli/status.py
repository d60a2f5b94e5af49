"""The command `arboleda status`: what the plant that runs is doing."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.live import Live

from arboleda.client.errors import NoAnswer

from .client import PlantClient, PlantGone
from .language import finding, step_name
from .plant_options import RunningPlant, StateFolder, StoreAddress, TokensFile, client
from .screen import table
from .working import working

STEP = "step"  # the key of its name
SENTENCES = frozenset({"held_by", "not_ready", "obstacle", "said", "what"})  # keys of a snapshot


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(status)


def status(
    plant: RunningPlant = None,
    state: StateFolder = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the whole snapshot as JSON.")] = False,
    watch: Annotated[bool, typer.Option("--watch", help="Show what changes, until Ctrl-C.")] = False,
    store: StoreAddress = "",
    tokens: TokensFile = None,
) -> None:
    """Show what the plant is doing that runs on this machine, or that another host leads.

    With --json and --watch each change is a line: its kind, and its row of the snapshot.
    """
    reached = client(plant, state, store, tokens)
    if watch:
        _watch(reached, as_json=as_json)
        return
    with working():
        snapshot = reached.status()
    if as_json:
        print(json.dumps(snapshot, indent=2, ensure_ascii=False))
        return
    Console(highlight=False).print(table(spoken(snapshot)))


def _watch(reached: PlantClient, *, as_json: bool) -> None:
    """Print the changes of the plant until it ends."""
    with suppress(PlantGone):
        if as_json:
            for kind, row in reached.changes():
                print(json.dumps({"kind": kind, "row": row}, ensure_ascii=False), flush=True)
            return
        with Live(console=Console(highlight=False), auto_refresh=False) as live:
            for _ in reached.changes():
                with suppress(NoAnswer):  # it may end between a change and the table of it
                    live.update(table(spoken(reached.status())), refresh=True)


def spoken(told: Any, name: str = "") -> Any:
    """The answer of a plant with its sentences in this language: over HTTP they are English."""
    if isinstance(told, dict):
        return {key: spoken(value, key) for key, value in told.items()}
    if isinstance(told, list):
        return [spoken(each, name) for each in told]
    if not isinstance(told, str):
        return told
    return step_name(told) if name == STEP else finding(told) if name in SENTENCES else told
