"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("dry")
def dry(cell):
    """Dry a part."""
    dryer, valve = cell.devices("dryer", "valve")
    return work(valve.switch(on=True), dryer.dry(), valve.switch(on=False))
