"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("fill")
def fill(cell):
    """Fill a bottle."""
    pump, washer = cell.devices("pump", "washer")
    return work(cell.retry(pump.dispense(), times=10, pause_s=1), washer.rinse())
