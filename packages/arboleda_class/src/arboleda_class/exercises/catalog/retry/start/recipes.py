"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("inspect")
def inspect(cell):
    """Fill a sample and look at it."""
    pump, camera = cell.devices("pump", "camera")
    seen = camera.look()
    ways = {"good": [], "bad": cell.fail("the camera says that it is bad")}
    return work(pump.dispense(), seen, cell.choose(seen, ways))
