"""Recipes of the cell; this stays as it is."""

from arboleda.recipes import recipe, work


@recipe("bake")
def bake(cell):
    """Bake, then blow the air out."""
    oven, fan = cell.devices("oven", "fan")
    return work(oven.close(), oven.bake(), fan.run(on=True), cell.wait(3), fan.run(on=False), oven.open())
