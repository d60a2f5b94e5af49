"""Recipes of the cell."""

from arboleda.recipes import recipe, work


@recipe("bake")
def bake(cell):
    """Bake a part of the tray and put it into the rack."""
    arm, oven = cell.devices("arm", "oven")
    return work(
        arm.visit("tray", arm.grip()),
        arm.visit("inside", arm.let_go()),
        oven.bake(),
        arm.visit("inside", arm.grip()),
        arm.visit("rack", arm.let_go()),
        arm.home(),
    )
