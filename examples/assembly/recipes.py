"""How the station puts two parts together."""

from arboleda.recipes import Target, parallel, recipe, work


@recipe("assemble", ends_with={"fixture.clamped": False, "fixture.ram": "up", "seat": 1, "done": 1})
def assemble(cell, base=Target("bases"), lid=Target("lids")):
    """Press a lid on a base."""
    left, right, fixture = cell.devices("left", "right", "fixture")
    return work(
        fixture.lift(),  # a task that failed may have left its ram down, and then no arm gets in
        parallel(
            work(left.visit(base, left.grip()), left.visit("nest", left.let_go(), fixture.clamp(on=True))),
            right.visit(lid, right.grip()),
        ),
        right.visit("seat", right.let_go()),
        fixture.press(),
        fixture.lift(),
        left.visit("nest", left.grip(), fixture.clamp(on=False)),
        parallel(left.visit("done", left.let_go()), right.home()),
        left.home(),
    )
