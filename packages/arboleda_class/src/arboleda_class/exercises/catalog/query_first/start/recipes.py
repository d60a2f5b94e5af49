"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("top_up")
def top_up(cell):
    """Top up a bottle."""
    pump, scale = cell.devices("pump", "scale")
    return work(pump.dispense(), scale.weigh())
