"""Recipes of the bench."""

from arboleda.recipes import recipe, work


@recipe("bake")
def bake(cell):
    """Bake in both ovens."""
    left, right, fan, lamp = cell.devices("left", "right", "fan", "lamp")
    return work(
        fan.run(on=True),
        left.bake(),
        right.bake(),
        fan.run(on=False),
        lamp.light(on=True),
    )
