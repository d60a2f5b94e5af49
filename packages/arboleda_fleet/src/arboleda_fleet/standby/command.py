"""`arboleda handover`: have the process that stands by lead the plant, without a failed task."""

from __future__ import annotations

import time

import typer

from arboleda.cli.plant_options import database
from arboleda.extension import ArboledaError, Phrase, RunningPlant, StartError, StateFolder, StoreAddress, say

PATIENCE_S = 30.0
LOOK_S = 0.05
NOBODY_LEADS = Phrase(
    "cli.handover.nobody_leads", "Nobody leads the plant of {plant}; start it with `arboleda up`."
)
NOBODY_WAITS = Phrase(
    "cli.handover.nobody_waits",
    "Nobody waits to lead the plant of {plant}: start `arboleda up --standby` on another host.",
)
LEADS_NOW = Phrase(
    "cli.handover.leads_now",
    "process {process} on {host} leads the plant now, {seconds} s after it was asked; "
    "for {gap} s of them nobody did",
)
STILL_LEADS = Phrase(
    "cli.handover.still_leads",
    "After {seconds} s process {process} on {host} still leads the plant; its log says why.",
)


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(handover)


def handover(plant: RunningPlant = None, state: StateFolder = None, store: StoreAddress = "") -> None:
    """Have the standby of a plant lead it: what is at work is held, and goes on there.

    From any host that reaches the plant's database. Exit status: 0 the other one leads, 1 it could not be.
    """
    others = database(plant, state, store)
    try:
        before = others.leader()
        if not before.leads:
            raise StartError(NOBODY_LEADS(plant=others.name))
        if not before.standbys:
            raise StartError(NOBODY_WAITS(plant=others.name))
        others.ask_for_handover()
        began = now = time.monotonic()
        free_at = None
        while now - began < PATIENCE_S:
            leader, now = others.leader(), time.monotonic()
            if not leader.leads and free_at is None:
                free_at = now
            if leader.epoch != before.epoch and leader.leads:
                gap_s = now - (free_at or now)
                seconds, gap = f"{now - began:.1f}", f"{gap_s:.1f}"
                process, host = leader.process, leader.host
                print(say(LEADS_NOW(process=process, host=host, seconds=seconds, gap=gap)))
                return
            time.sleep(LOOK_S)
        seconds = f"{PATIENCE_S:g}"
        raise ArboledaError(STILL_LEADS(seconds=seconds, process=before.process, host=before.host))
    finally:
        others.close()
