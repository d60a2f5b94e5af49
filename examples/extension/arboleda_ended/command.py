"""`arboleda ended`."""

from arboleda.cli.language import say
from arboleda.cli.plant_options import RunningPlant, StateFolder, client

from . import ENDED


def add_to(cli):
    cli.command()(ended)


def ended(plant: RunningPlant = None, state: StateFolder = None):
    """Show how many tasks ended in each cell."""
    for cell, count in client(plant, state).get("/api/ended").items():
        print(f"{cell}: {say(ENDED(count=count))}")
