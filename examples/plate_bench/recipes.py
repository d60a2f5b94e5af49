"""What the bench does with a plate."""

from arboleda.recipes import Choice, recipe, work


Well = Choice["B1", "C1"]


@recipe("dilute")
def dilute(cell, to: Well):
    """Move 50 ul from A1 to another well, with a tip of its own; then warm the plate and shake it."""
    handler, hotplate = cell.device("handler"), cell.device("hotplate")
    return work(
        handler.take_tip(at=to),
        handler.draw(well="A1", ul=50.0),
        handler.pour(well=to, ul=50.0),
        handler.drop_tip(),
        hotplate.heat(celsius=37),
        hotplate.shake(rpm=300, seconds=3),
    )


@recipe("warm")
def warm(cell, celsius: Choice[37, 60]):
    """Warm the plate, and shake it."""
    hotplate = cell.device("hotplate")
    return work(hotplate.heat(celsius=celsius), hotplate.shake(rpm=300, seconds=3))
