"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("warm")
def warm(cell):
    """Warm a sample until somebody takes it."""
    ana, plate = cell.devices("ana", "plate")
    return work(plate.heat(celsius=60), ana.ask("Do you have the sample?", ["yes"]), plate.heat(celsius=20))
