"""Recipes of two presses that share an arm."""

from arboleda.recipes import Kit, recipe, work


@recipe("press")
def press(cell: Kit):
    """Ana says that there is a blank; the arm puts it into the press, waits elsewhere, and takes it out."""
    arm, jaw, press, ana = cell.devices("arm", "jaw", "press", "ana")
    asked = ana.ask("Is there a blank in the tray?", ["yes", "no"])
    load = cell.using(
        "arm",
        press.open(),
        arm.visit("tray", jaw.close(width_mm=30, force_n=20)),
        arm.visit("plate", jaw.open()),
    )
    unload = cell.using(
        "arm",
        press.open(),
        arm.visit("plate", jaw.close(width_mm=30, force_n=20)),
        arm.visit("tray", jaw.open()),
    )
    ways = {"yes": [load, press.close(), press.run(), unload], "no": cell.fail("there is no blank")}
    return work(cell.using("ana", asked), cell.choose(asked, ways))
