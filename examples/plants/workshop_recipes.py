"""The recipes of the workshop: one that carries a part, and one that bakes it."""

from arboleda.recipes import Choice, Target, recipe, work


@recipe("carry")
def carry(cell, part=Target("shelf")):
    """Bring a part from the shelf to the tray."""
    loader = cell.device("loader")
    return work(
        loader.visit(part, loader.grip()),
        loader.visit("tray", loader.let_go()),
        loader.home(),
    )


@recipe("bake")
def bake(cell, part=Target("shelf"), seconds=Choice(2, 4)):
    """Bake a part of the shelf, and set it down on the tray."""
    loader, oven = cell.devices("loader", "oven")
    return work(
        oven.open(),
        loader.visit(part, loader.grip()),
        loader.visit("oven", loader.let_go()),
        oven.close(),
        oven.bake(seconds=seconds),
        oven.open(),
        loader.visit("oven", loader.grip()),
        loader.visit("tray", loader.let_go()),
        loader.home(),
    )
