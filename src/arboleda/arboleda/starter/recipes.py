"""The recipes of the cell: a function for each kind of task."""

from arboleda.recipes import Choice, Target, recipe, work


@recipe("press")
def press(cell, blank=Target("blanks"), seconds=Choice(1, 3, 5)):
    """Put a blank into the press, press it, and bring it back."""
    loader, machine = cell.devices("loader", "press")
    return work(
        loader.visit(blank, loader.grip()),
        loader.visit("press", loader.let_go()),
        machine.close(),
        machine.press(seconds=seconds),
        machine.open(),
        loader.visit("press", loader.grip()),
        loader.visit(blank, loader.let_go()),
        loader.home(),
    )
