"""What the belt does with a part."""

from arboleda.recipes import Choice, recipe, work


@recipe("pass")
def pass_on(cell, speed: Choice[100, 200, 400]):
    """Take a part in, carry it to the exit, and look at it there."""
    belt = cell.device("belt")
    seen = belt.scan()
    judged = cell.choose(seen, {"good": [], "bad": cell.fail("the part is bad")})
    return work(
        belt.gate(to="open"),
        belt.load(),
        belt.advance(to="exit", speed_mm_s=speed),
        belt.gate(to="closed"),
        seen,
        judged,
    )
