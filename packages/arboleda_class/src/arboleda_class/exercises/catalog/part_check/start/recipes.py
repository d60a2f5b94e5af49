"""Recipes of the cell."""

from arboleda.recipes import recipe, work


@recipe("press")
def press(cell):
    """Feed a part and press it."""
    feeder, machine = cell.devices("feeder", "press")
    return work(feeder.feed(), machine.press())
