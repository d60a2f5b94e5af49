"""What the line does with a part."""

from arboleda.recipes import Choice, Target, recipe, work


@recipe("deliver")
def deliver(cell, part=Target("tray"), speed=Choice(100, 200, 400)):
    """Lay a part on the belt, carry it to the exit, and have it looked at there."""
    arm, belt = cell.devices("arm", "belt")
    seen = belt.scan()
    asked = cell.device("operator").ask("Is the part at the exit good?", ["yes", "no"])
    bad = cell.fail("the part is bad")
    return work(
        belt.gate(to="open"),
        arm.visit(part, arm.grip()),
        arm.visit("entry", arm.let_go()),
        arm.home(),
        belt.load(),
        belt.advance(to="exit", speed_mm_s=speed),
        belt.gate(to="closed"),
        seen,
        cell.choose(seen, {"good": [], "bad": [asked, cell.choose(asked, {"yes": [], "no": bad})]}),
    )
