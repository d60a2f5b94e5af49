"""`arboleda handover`: have the process that stands by lead the plant, without a failed task."""

from __future__ import annotations

import time

from arboleda.model.errors import ArboledaError, StartError

from .plant_options import PlantFile, StateFolder, StoreAddress, database

PATIENCE_S = 30.0
LOOK_S = 0.05


def handover(plant: PlantFile = None, state: StateFolder = None, store: StoreAddress = "") -> None:
    """Have the standby of a plant lead it: what is at work is held, and goes on there.

    From any host that reaches the plant's database. Exit status: 0 the other one leads, 1 it could not be.
    """
    others = database(plant, state, store)
    try:
        before = others.leader()
        if not before.leads:
            raise StartError(f"Nobody leads the plant of {others.name}; start it with `arboleda up`.")
        if not before.standbys:
            raise StartError(
                f"Nobody waits to lead the plant of {others.name}: start `arboleda up --standby` on"
                " another host."
            )
        others.ask_for_handover()
        began = now = time.monotonic()
        free_at = None
        while now - began < PATIENCE_S:
            leader, now = others.leader(), time.monotonic()
            if not leader.leads and free_at is None:
                free_at = now
            if leader.epoch != before.epoch and leader.leads:
                gap_s = now - (free_at or now)
                print(
                    f"process {leader.process} on {leader.host} leads the plant now, {now - began:.1f} s"
                    f" after it was asked; for {gap_s:.1f} s of them nobody did"
                )
                return
            time.sleep(LOOK_S)
        raise ArboledaError(
            f"After {PATIENCE_S:g} s process {before.process} on {before.host} still leads the plant; its"
            " log says why."
        )
    finally:
        others.close()
