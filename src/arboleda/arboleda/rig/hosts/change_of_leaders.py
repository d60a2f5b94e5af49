"""Change of leaders: another process leads a simulated plant, and the one before may not know it yet."""

from __future__ import annotations

import math
from dataclasses import dataclass

from arboleda.engine import Plant
from arboleda.model.messages import Event
from arboleda.wire.bridge import Bridge

from ..network import Client
from ..world import BRIDGE, PLANT, World


@dataclass(slots=True, eq=False)
class SupersededProcess:
    """A process that another one has superseded: its plant with what it had not taken in, its bridge with its
    client, and until when it is frozen.
    """

    plant: Plant
    bridge: Bridge
    client: Client
    inbox: list[Event]
    until: float


def change_leaders(world: World, epoch: int) -> SupersededProcess | None:
    """Have another process lead, plant and bridge, under this number and on what is kept; return what is
    left of the one before, if that runs.
    """
    world.plant_process.be_gone()
    client, bridge, left = world.broker.clients[BRIDGE], world.bridge, None
    client.superseded = True
    stalled = world.processes.stalled
    until = max(stalled.pop(PLANT, world.now), stalled.pop(BRIDGE, world.now))
    if bridge is None or not world.is_on(PLANT):
        world.broker.leave(client)
    else:
        left = SupersededProcess(world.plant, bridge, client, world.plant_process.inbox, until)
        world.broker.rename(client, f"{BRIDGE} before {epoch}")
        stalled[client.name] = math.inf  # only the holder of `left` steps it
    world.plant_process.lead(epoch)
    world.beat_reached_bridge_at = -math.inf
    world.start_bridge(epoch)
    return left


def bury(world: World, left: SupersededProcess) -> None:
    """Remove the rest of a process that led."""
    world.broker.leave(left.client)
    del world.processes.stalled[left.client.name]
