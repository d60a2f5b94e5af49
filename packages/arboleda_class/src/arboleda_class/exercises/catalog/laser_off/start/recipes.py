"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("mark")
def mark(cell):
    """Mark a part with the laser."""
    laser, stage = cell.devices("laser", "stage")
    return work(laser.beam(on=True), stage.to_back(), stage.to_front(), laser.beam(on=False))
