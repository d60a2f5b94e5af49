"""Recipes of the cell; these stay as they are."""

from arboleda.recipes import recipe, work


def carried(cell, source, goal):
    """A part goes from a target to another one."""
    arm, jaw = cell.devices("arm", "jaw")
    return work(
        arm.visit(source, jaw.close(width_mm=30, force_n=20)), arm.visit(goal, jaw.open()), arm.home()
    )


@recipe("fetch")
def fetch(cell):
    """Bring a part from the tray to the nest."""
    return carried(cell, "tray", "nest")


@recipe("pack")
def pack(cell):
    """Put the part of the nest into the box."""
    return carried(cell, "nest", "box")
