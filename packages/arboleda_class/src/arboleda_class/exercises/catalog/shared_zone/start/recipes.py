"""Recipes of the cells; these stay as they are."""

from arboleda.recipes import recipe, work


@recipe("put")
def put(cell):
    """Put a part of the tray on the table."""
    arm = cell.device("arm")
    return work(arm.visit("tray", arm.grip()), arm.visit("table", arm.let_go()), arm.home())


@recipe("look")
def look(cell):
    """Go to the tray and come back."""
    arm = cell.device("arm")
    return work(arm.go("tray"), arm.home())
