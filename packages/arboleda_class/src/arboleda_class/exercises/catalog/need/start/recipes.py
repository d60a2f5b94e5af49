"""Recipes of the cell; these stay as they are."""

from arboleda.recipes import recipe, work


@recipe("careful")
def careful(cell):
    """Press behind a closed door."""
    press = cell.device("press")
    return work(press.close(), press.press(), press.open())


@recipe("careless")
def careless(cell):
    """Press, with the door as it is."""
    return work(cell.device("press").press())


@recipe("reach")
def reach(cell):
    """Have somebody reach through the curtain, and close the door all the same."""
    press, curtain = cell.devices("press", "curtain")
    return work(curtain.show(what="hand"), press.close())
