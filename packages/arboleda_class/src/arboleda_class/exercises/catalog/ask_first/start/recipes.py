"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("cure")
def cure(cell):
    """Cure the glue under the lamp."""
    lamp = cell.device("lamp")
    return work(lamp.light(on=True), cell.wait(2.0), lamp.light(on=False))
