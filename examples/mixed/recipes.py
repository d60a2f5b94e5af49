"""What the line does with a part."""

from arboleda.recipes import Choice, Target, recipe, work


@recipe("deliver")
def deliver(cell, part=Target("tray"), speed=Choice(100, 200, 400)):
    """Lay a part on the belt, have it looked at where that ends, and carry it to the store."""
    arm, belt, cart, bed = cell.devices("arm", "belt", "cart", "bed")
    seen = belt.scan()
    asked = cell.device("operator").ask("Is the part at the exit good?", ["yes", "no"])
    bad = cell.fail("the part is bad")

    def carried():
        return [cart.go("exit"), bed.pick(), cart.go("store"), bed.drop(), cart.go("home")]

    return work(
        belt.gate(to="open"),
        arm.visit(part, arm.grip()),
        arm.visit("entry", arm.let_go()),
        arm.home(),
        belt.load(),
        belt.advance(to="exit", speed_mm_s=speed),
        belt.gate(to="closed"),
        seen,
        cell.choose(
            seen, {"good": carried(), "bad": [asked, cell.choose(asked, {"yes": carried(), "no": bad})]}
        ),
    )
