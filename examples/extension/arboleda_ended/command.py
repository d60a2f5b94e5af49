"""`arboleda ended`."""

from arboleda.extension import RunningPlant, StateFolder, client, say

from . import ENDED


def add_to(cli):
    cli.command()(ended)


def ended(plant: RunningPlant = None, state: StateFolder = None):
    """Show how many tasks ended in each cell."""
    for cell, count in client(plant, state).get("/api/ended").items():
        print(f"{cell}: {count} {say(ENDED())}")
