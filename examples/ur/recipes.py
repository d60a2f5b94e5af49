"""What the arm does with a part."""

from arboleda.recipes import recipe, work


@recipe("load")
def load(cell):
    """Carry a part from the tray to the fixture."""
    arm = cell.device("arm")
    return work(
        arm.visit("tray", arm.grip()),
        arm.visit("fixture", arm.let_go()),
        arm.home(),
    )
