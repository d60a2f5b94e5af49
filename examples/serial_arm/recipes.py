"""A part is carried from one spot of the desk to another one."""

from arboleda.recipes import Target, recipe, work


@recipe("carry")
def carry(cell, start=Target("spots"), goal=Target("spots")):
    """Take a part from one spot to another."""
    arm = cell.device("arm")
    return work(arm.visit(start, arm.grip()), arm.visit(goal, arm.let_go()), arm.home())
