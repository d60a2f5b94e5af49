"""What the bench does with a part."""

from arboleda.recipes import Target, recipe, work


@recipe("carry")
def carry(cell, start=Target("slots"), goal=Target("slots")):
    """Take a part from one slot to another."""
    arm, jaw = cell.devices("arm", "jaw")
    return work(
        jaw.open(),
        arm.visit(start, jaw.close(width_mm=5.0, force_n=40.0)),
        arm.visit(goal, jaw.open()),
        arm.home(),
    )
