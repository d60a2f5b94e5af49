"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("incubate")
def incubate(cell):
    """Keep a sample warm for a while."""
    heater = cell.device("heater")
    return work(heater.clamp(on=True), heater.close(), heater.heat(celsius=60), heater.open())


@recipe("peek")
def peek(cell):
    """Have somebody look into the heater."""
    ana, heater = cell.devices("ana", "heater")
    return work(heater.open(), ana.ask("Have you seen it?", ["yes"]))
