"""Recipes of the cell."""

from arboleda.recipes import recipe, work


@recipe("mill")
def mill(cell):
    """Mill a blank and put the part into the rack."""
    loader, machine = cell.devices("loader", "mill")
    return work(
        loader.visit("tray", loader.grip()),
        loader.visit("vise", machine.clamp(on=True), loader.let_go()),
    )
