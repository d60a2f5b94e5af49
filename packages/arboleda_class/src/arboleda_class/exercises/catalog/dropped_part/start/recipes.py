"""Recipes of the cell."""

from arboleda.recipes import recipe, work


@recipe("fetch")
def fetch(cell):
    """Bring a part to the nest."""
    arm, jaw = cell.devices("arm", "jaw")
    return work(
        arm.visit("tray_1", jaw.close(width_mm=30, force_n=20)),
        arm.visit("nest", jaw.open()),
        arm.home(),
    )
